"""Which of the compiled libraries are there, found out without importing them (that takes a second)."""

from __future__ import annotations

from importlib.util import find_spec

# What the extension's wheels bring, by import name. numpy comes with Blender; osqp imports jinja2 itself.
WHEELS = ("mujoco", "osqp", "scipy", "jinja2", "markupsafe")


def missing_dependencies() -> list[str]:
    """Import names of the libraries that a simulation needs and this Python cannot find; empty if all is well."""
    return [name for name in WHEELS if find_spec(name) is None]
