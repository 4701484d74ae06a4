"""Tests inside Blender's Python module: the extension as a user has it, in a user folder of its own.

The working tree is linked into the user's extensions and enabled; with SKI_ADDON_ZIP set to a built zip, that zip is
installed instead. Fixtures: `extension` (its package name), `core` (imports a module of it), `scene` (an empty scene),
`ski` (the settings of a skier in it).
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

PACKAGE = "bl_ext.user_default.ski_addon"
ROOT = Path(__file__).resolve().parents[2]

# Blender reads this when bpy is imported: the settings and extensions of whoever runs the tests stay untouched.
_user_folder = Path(tempfile.mkdtemp(prefix="ski_addon_user_"))
os.environ["BLENDER_USER_RESOURCES"] = str(_user_folder)
_exit_code = 0


def _link_tree() -> None:
    """Put the working tree where Blender looks for the user's extensions (before bpy is imported)."""
    folder = _user_folder / "extensions" / "user_default"
    folder.mkdir(parents=True)
    (folder / "ski_addon").symlink_to(ROOT, target_is_directory=True)


def _install_zip(path: Path) -> None:
    """Install and enable a built zip the way the preferences do."""
    import bpy

    bpy.ops.extensions.package_install_files(repo="user_default", filepath=str(path), enable_on_install=True)


@pytest.fixture(scope="session")
def extension() -> str:
    """The full name of the extension's package, installed and enabled."""
    zip_path = os.environ.get("SKI_ADDON_ZIP")
    if not zip_path:
        _link_tree()
    bpy = pytest.importorskip("bpy", reason="these tests need Blender's Python module (bpy)")
    if zip_path:
        _install_zip(Path(zip_path).resolve(strict=True))
    else:
        import addon_utils

        addon_utils.enable(PACKAGE, default_set=True)
    # An installation that failed still says FINISHED: only this tells.
    assert PACKAGE in bpy.context.preferences.addons, "the extension was not enabled: see the messages above"
    return PACKAGE


@pytest.fixture(scope="session")
def core(extension: str) -> Callable[[str], ModuleType]:
    """A function that imports a core module as it is inside the extension: `core("simulation.recording")`."""

    def load(name: str) -> ModuleType:
        return import_module(f"{extension}.ski_addon.{name}")

    return load


@pytest.fixture
def scene(extension: str) -> Iterator[Any]:
    """An empty scene, with the extension enabled."""
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    yield bpy.context.scene


@pytest.fixture
def ski(core: Callable[[str], ModuleType], scene: Any) -> Any:
    """The settings of a new skier, the only one in the scene."""
    return core("blender.skiers").add_skier(scene).ski


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    """Remember the result for the exit below."""
    global _exit_code
    _exit_code = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    """Leave at once: Blender's module hangs or crashes in some versions when Python shuts down."""
    shutil.rmtree(_user_folder, ignore_errors=True)
    if "bpy" in sys.modules:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(_exit_code)
