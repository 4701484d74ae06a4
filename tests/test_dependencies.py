"""Missing libraries are found out without loading anything."""

from __future__ import annotations

import importlib.machinery
import subprocess
import sys
from pathlib import Path

import pytest

from ski_addon import dependencies

ROOT = Path(__file__).resolve().parents[1]


def test_nothing_is_missing_here() -> None:
    assert dependencies.missing_dependencies() == []


@pytest.mark.parametrize("absent", [{"osqp"}, {"mujoco", "scipy"}, set(dependencies.WHEELS)])
def test_what_cannot_be_found_is_named(monkeypatch: pytest.MonkeyPatch, absent: set[str]) -> None:
    def find_spec(name: str) -> importlib.machinery.ModuleSpec | None:
        return None if name in absent else importlib.machinery.ModuleSpec(name, None)

    monkeypatch.setattr(dependencies, "find_spec", find_spec)
    assert set(dependencies.missing_dependencies()) == absent


def test_nothing_is_loaded() -> None:
    code = "import sys; from ski_addon.dependencies import WHEELS, missing_dependencies; missing_dependencies();"
    code += "print(*[name for name in WHEELS if name in sys.modules])"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60, check=True
    )
    assert done.stdout.split() == []
