"""The built zip, installed where Blender has nothing but numpy: its wheels are what the simulation runs on."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Callable
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from types import ModuleType

import pytest

pytestmark = pytest.mark.skipif("SKI_ADDON_ZIP" not in os.environ, reason="needs SKI_ADDON_ZIP, a built zip")


@pytest.fixture(scope="module")
def folder(core: Callable[[str], ModuleType]) -> Path:
    """The folder the extension was installed into."""
    return Path(core("spec").__file__).resolve().parents[2]


def test_the_installed_code_is_the_zip_s(folder: Path) -> None:
    user_folder = Path(os.environ["BLENDER_USER_RESOURCES"]).resolve()
    assert folder == user_folder / "extensions" / "user_default" / "ski_addon"
    assert not (folder / "tests").exists()
    assert (folder / "presets" / "runs" / "giant_slalom.toml").is_file()


@pytest.mark.parametrize("name", ["mujoco", "osqp", "scipy", "jinja2"])
def test_library_comes_from_the_wheels(extension: str, name: str) -> None:
    module = import_module(name)
    assert ".local" in Path(module.__file__).parts, f"{name} was found in {module.__file__}"


def test_numpy_is_blender_s(extension: str) -> None:
    import numpy

    assert ".local" not in Path(numpy.__file__).parts


def test_versions_are_the_manifest_s(extension: str, folder: Path) -> None:
    manifest = tomllib.loads((folder / "blender_manifest.toml").read_text())
    for wheel in manifest["wheels"]:
        name, wanted = Path(wheel).name.split("-")[:2]
        assert version(name.replace("_", "-")) == wanted


def test_nothing_is_missing(core: Callable[[str], ModuleType]) -> None:
    assert core("dependencies").missing_dependencies() == []


def test_a_short_run_is_simulated(core: Callable[[str], ModuleType], folder: Path) -> None:
    spec = core("spec").RunSpec.from_toml(folder / "presets" / "runs" / "giant_slalom.toml")
    pipeline = core("pipeline")
    planned = pipeline.make_plan(spec.with_overrides({"course.turn_count": "1"}))
    recording, _ = pipeline.run_simulation(planned, lambda fraction, text: None)
    assert recording.header["status"] == "finished"
    assert float(recording.ski_error.max()) < 0.01
