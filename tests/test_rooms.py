"""Who may import what: Blender only in its rooms, the core by relative imports, heavy libraries only when needed."""

from __future__ import annotations

import ast
import functools
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CORE = ROOT / "ski_addon"
BLENDER = {"bpy", "bmesh", "blf", "gpu", "mathutils", "bpy_extras", "addon_utils", "bl_ui"}
COMMAND_LINE = {"ski_addon/cli.py", "ski_addon/results.py"}
BLENDER_ROOMS = ("operators", "ski_addon/blender", "tests/blender", "tests/gui", "benchmarks/blender.py")


def python_files() -> list[str]:
    """Every Python file of the project, relative to its root."""
    folders = ("ski_addon", "operators", "tests", "benchmarks", ".ci")
    found = [path for folder in folders for path in (ROOT / folder).rglob("*.py")]
    return sorted(str(path.relative_to(ROOT)) for path in [*found, ROOT / "__init__.py"])


def core_modules() -> list[str]:
    """The names of every module of the core: everything in ski_addon but its Blender room."""
    found = []
    for path in sorted(CORE.rglob("*.py")):
        parts = path.relative_to(ROOT).with_suffix("").parts
        if parts[1] != "blender" and parts[-1] != "__main__":
            found.append(".".join(parts[:-1] if parts[-1] == "__init__" else parts))
    return found


@functools.cache
def imports(path: str) -> tuple[tuple[int, str], ...]:
    """The number of leading dots and the first name of every import in a file, inside functions too."""
    found: list[tuple[int, str]] = []
    for node in ast.walk(ast.parse((ROOT / path).read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found += [(0, alias.name.split(".")[0]) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            found.append((node.level, (node.module or "").split(".")[0]))
    return tuple(found)


def offenders(files: list[str], banned: set[str], *, relative: bool = False) -> list[str]:
    """The files that import one of the banned names, absolutely or relatively."""
    return [path for path in files if {name for level, name in imports(path) if bool(level) == relative} & banned]


def test_no_blender_outside_its_rooms() -> None:
    assert offenders([path for path in python_files() if not path.startswith(BLENDER_ROOMS)], BLENDER) == []


def test_the_extension_imports_itself_relatively() -> None:
    files = [path for path in python_files() if path.startswith(("ski_addon/", "operators/"))]
    assert files
    assert offenders(files, {"ski_addon", "operators"}) == []


def test_the_core_does_not_look_back() -> None:
    """operators -> ski_addon.blender -> the core; only the command line starts Blender, when a step needs it."""
    core = [path for path in python_files() if path.startswith("ski_addon/") and not path.startswith(BLENDER_ROOMS)]
    assert offenders(core, {"operators"}, relative=True) == []
    assert set(offenders(core, {"blender"}, relative=True)) <= COMMAND_LINE


BLOCKED = """
import importlib, sys
class Block:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in {blocked!r}:
            raise ImportError(f"{{name}} is blocked")
sys.meta_path.insert(0, Block())
for name in {modules!r}:
    importlib.import_module(name)
print("imported")
"""


def run_blocked(blocked: set[str], modules: list[str]) -> subprocess.CompletedProcess:
    """Import modules in a new Python in which some libraries cannot be imported."""
    code = BLOCKED.format(blocked=blocked, modules=modules)
    return subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
    )


def test_the_core_imports_without_blender() -> None:
    done = run_blocked(BLENDER, core_modules())
    assert done.stdout.strip() == "imported", done.stderr[-2000:]


def test_starting_up_loads_no_heavy_library() -> None:
    """The command line and the add-on start fast, and say something useful where a wheel is missing."""
    start = [f"ski_addon{name}" for name in ("", ".spec", ".errors", ".dependencies", ".cli", ".pipeline")]
    done = run_blocked(BLENDER | {"mujoco", "osqp", "scipy", "matplotlib"}, start)
    assert done.stdout.strip() == "imported", done.stderr[-2000:]


def test_the_root_package_imports_nothing() -> None:
    code = "import importlib.util, sys; before = set(sys.modules)\n"
    code += f"spec = importlib.util.spec_from_file_location('extension', {str(ROOT / '__init__.py')!r})\n"
    code += "spec.loader.exec_module(importlib.util.module_from_spec(spec))\n"
    code += "print(*sorted(name for name in set(sys.modules) - before if name.startswith(('bpy', 'ski', 'numpy'))))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.split() == []


RUNS_CODE = {"eval", "exec", "compile", "__import__"}
"""Calls that run what a text says."""


def test_nothing_that_is_read_from_a_file_can_run() -> None:
    """No pickles, no eval, no exec: whatever a document, a recording or a cache holds, it is data."""
    assert offenders([*core_files(), "__init__.py"], {"pickle", "shelve", "marshal", "dill", "joblib"}) == []
    for path in core_files():
        for node in ast.walk(ast.parse((ROOT / path).read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                assert node.func.id not in RUNS_CODE, f"{path} line {node.lineno} calls {node.func.id}"
            if isinstance(node, ast.keyword) and node.arg == "allow_pickle":
                assert isinstance(node.value, ast.Constant) and node.value.value is False, path
            if isinstance(node, ast.Attribute) and node.attr == "load" and ast.unparse(node.value) in ("np", "numpy"):
                assert "allow_pickle=False" in (ROOT / path).read_text(encoding="utf-8"), path


def core_files() -> list[str]:
    """Every file that is shipped."""
    return [path for path in python_files() if path.startswith(("ski_addon/", "operators/"))]
