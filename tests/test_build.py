"""The build script: which wheel goes where, and what it refuses."""

from __future__ import annotations

import importlib.util
import sys
import tomllib
import zipfile
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[1]
LINUX = "scipy-1.17.1-cp311-cp311-manylinux_2_27_x86_64.manylinux_2_28_x86_64.whl"
MAC = "scipy-1.17.1-cp313-cp313-macosx_12_0_arm64.whl"
WINDOWS = "scipy-1.17.1-cp313-cp313-win_amd64.whl"
ANY = "jinja2-3.1.6-py3-none-any.whl"


@pytest.fixture(scope="module")
def build() -> ModuleType:
    spec = importlib.util.spec_from_file_location("ski_addon_build", ROOT / ".ci" / "build.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("name", [LINUX, MAC, WINDOWS, ANY])
def test_a_wheel_s_name_is_taken_apart_and_put_together(build: ModuleType, name: str) -> None:
    assert build.Wheel.parse(name).file_name == name


@pytest.mark.parametrize("name", ["scipy-1.17.1.tar.gz", "scipy-1.17.1.whl"])
def test_what_is_no_wheel_is_refused(build: ModuleType, name: str) -> None:
    with pytest.raises(build.BuildError, match=r"scipy-1\.17\.1"):
        build.Wheel.parse(name)


@pytest.mark.parametrize(
    ("platform", "wheels"),
    [("linux-x64", {LINUX, ANY}), ("macos-arm64", {MAC, ANY}), ("windows-x64", {WINDOWS, ANY})],
)
def test_each_platform_gets_its_wheels(build: ModuleType, platform: str, wheels: set[str]) -> None:
    fitting = {name for name in (LINUX, MAC, WINDOWS, ANY) if build.fits_platform(build.Wheel.parse(name), platform)}
    assert fitting == wheels


def test_python_version_of_a_wheel(build: ModuleType) -> None:
    assert build.Wheel.parse(LINUX).python_version == "3.11"
    assert build.Wheel.parse(ANY).python_version is None


def test_wheels_that_are_there_are_not_downloaded(build: ModuleType, tmp_path: Path, monkeypatch) -> None:
    (tmp_path / LINUX).touch()
    asked: list[str] = []

    def download(folder: Path, requirements: list[str], *options: str) -> None:
        asked.extend(requirements)
        (folder / ANY).touch()

    monkeypatch.setattr(build, "pip_download", download)
    build.fetch([build.Wheel.parse(LINUX), build.Wheel.parse(ANY)], tmp_path)
    assert asked == ["jinja2==3.1.6"]


def test_a_wheel_under_another_name_is_refused(build: ModuleType, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(build, "pip_download", lambda folder, *rest: (folder / MAC).touch())
    with pytest.raises(build.BuildError, match="update blender_manifest"):
        build.fetch([build.Wheel.parse(LINUX)], tmp_path)


def test_development_manifest_changes_wheels_and_platforms_only(build: ModuleType) -> None:
    text = (ROOT / "blender_manifest.toml").read_text()
    changed = tomllib.loads(build.development_manifest(text, [build.Wheel.parse(ANY)]))
    assert changed.pop("wheels") == [f"./wheels/{ANY}"]
    original = tomllib.loads(text)
    assert changed == {key: value for key, value in original.items() if key not in ("wheels", "platforms")}


def test_a_development_tag_must_look_like_one(build: ModuleType, tmp_path: Path) -> None:
    with pytest.raises(build.BuildError, match="cp314"):
        build.development_wheels({"wheels": []}, "3.14", tmp_path)


def make_zip(path: Path, *members: str) -> Path:
    with zipfile.ZipFile(path, "w") as archive:
        for member in members:
            archive.writestr(member, "")
    return path


def test_a_right_zip_passes(build: ModuleType, tmp_path: Path) -> None:
    path = make_zip(tmp_path / "a.zip", "__init__.py", "blender_manifest.toml", "ski_addon/cli.py", f"wheels/{ANY}")
    build.check_zip(path, [build.Wheel.parse(ANY)])


@pytest.mark.parametrize(
    ("member", "message"),
    [
        ("tests/test_a.py", "not ship: tests"),
        (f"wheels/{MAC}", "other wheels"),
        (".venv/x", "not ship: .venv"),
    ],
)
def test_a_zip_with_something_else_is_refused(build: ModuleType, tmp_path: Path, member: str, message: str) -> None:
    path = make_zip(tmp_path / "a.zip", "__init__.py", f"wheels/{ANY}", member)
    with pytest.raises(build.BuildError, match=message):
        build.check_zip(path, [build.Wheel.parse(ANY)])


def test_staging_leaves_out_what_python_and_tools_write(build: ModuleType, tmp_path: Path) -> None:
    build.stage(tmp_path / "stage", "id = 'x'\n", [], tmp_path)
    names = {path.name for path in (tmp_path / "stage").rglob("*")}
    assert {
        "__init__.py",
        "blender_manifest.toml",
        "presets",
        "giant_slalom.toml",
        "ski_simulate_bake_render.js",
    } <= names
    assert not names & {"__pycache__", "tests", ".git", ".venv"}
