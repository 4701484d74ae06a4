"""What has to be said twice is said the same: versions, wheels, names that other tools rely on."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import ski_addon

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
MANIFEST = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
WHEELS = [Path(path).name for path in MANIFEST["wheels"]]


def test_one_version_everywhere() -> None:
    assert MANIFEST["version"] == PROJECT["version"] == ski_addon.__version__


def test_the_changelog_knows_the_version() -> None:
    text = (ROOT / "CHANGELOG.md").read_text()
    assert re.search(rf"^## \[(Unreleased|{re.escape(PROJECT['version'])})\]", text, re.MULTILINE)


def test_one_licence_everywhere() -> None:
    assert MANIFEST["license"] == [f"SPDX:{PROJECT['license']}"] == ["SPDX:GPL-3.0-or-later"]
    assert (ROOT / "LICENSE").read_text().lstrip().startswith("GNU GENERAL PUBLIC LICENSE")


def test_every_platform_and_python_has_every_library() -> None:
    platforms = {"manylinux": "x86_64.whl", "macosx": "arm64.whl", "win": "amd64.whl"}
    for library in ("scipy", "osqp", "mujoco_core", "markupsafe"):
        for python in ("cp311", "cp313"):
            for start, end in platforms.items():
                fitting = [
                    name
                    for name in WHEELS
                    if name.startswith(f"{library}-") and f"-{python}-{python}-{start}" in name and name.endswith(end)
                ]
                assert len(fitting) == 1, f"{library} for {python} on {start}: {fitting}"
    assert len(WHEELS) == 4 * 2 * 3 + 1  # and jinja2, which is pure Python


def test_the_zip_carries_what_the_tests_ran_with() -> None:
    pinned = dict(re.findall(r"^(scipy|osqp|mujoco)==([\d.]+)$", "\n".join(PROJECT["dependencies"]), re.MULTILINE))
    shipped = {name.split("-")[0]: name.split("-")[1] for name in WHEELS}
    assert pinned["scipy"] == shipped["scipy"]
    assert pinned["osqp"] == shipped["osqp"]
    assert pinned["mujoco"] == shipped["mujoco_core"]


@pytest.mark.parametrize("name", ["numpy", "mujoco-", "glfw", "matplotlib"])
def test_the_zip_never_carries(name: str) -> None:
    assert not [wheel for wheel in WHEELS if wheel.startswith(name)]


@pytest.mark.parametrize("script", [".ci/run", ".ci/find-python", ".ci/blender-env", ".ci/bpy-run", ".ci/types"])
def test_scripts_can_be_run(script: str) -> None:
    assert os.access(ROOT / script, os.X_OK)


def find_python(*versions: str) -> subprocess.CompletedProcess:
    command = [str(ROOT / ".ci" / "find-python"), *versions]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)


def test_a_python_that_fits_blender_is_found() -> None:
    this = f"{sys.version_info[0]}.{sys.version_info[1]}"
    done = find_python(this)
    assert done.returncode == 0, done.stderr
    shown = subprocess.run([done.stdout.strip(), "--version"], capture_output=True, text=True, timeout=60, check=True)
    assert shown.stdout.startswith(f"Python {this}.")


def test_no_fitting_python_is_one_line_that_says_what_to_install() -> None:
    done = find_python("3.98", "3.99")
    assert done.returncode == 1
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    assert "needs Python 3.98 or 3.99" in done.stderr


@pytest.mark.parametrize("target", ["env", "test", "demo", "build", "build-dev", "lint", "types", "benchmark", "clean"])
def test_make_target_exists(target: str) -> None:
    assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(), re.MULTILINE)


@pytest.mark.parametrize("name", ["paper_main", "paper_r10", "paper_r25", "paper_fig15", "giant_slalom"])
def test_preset_exists(name: str) -> None:
    assert (ROOT / "presets" / "runs" / f"{name}.toml").is_file()


PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_between_pages_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\((?!https?:|#|mailto:)([^)#]+)(?:#[^)]*)?\)", page.read_text()):
        assert (page.parent / target).exists(), f"{page} links to {target}"
