"""Versions of what decides a recording's bytes."""

from __future__ import annotations

import platform
from importlib import import_module

from .. import __version__

LIBRARIES = ("numpy", "scipy", "osqp", "mujoco")


def library_versions() -> dict[str, str]:
    """Return the versions of Ski Addon, Python and the numeric libraries."""
    versions = {"ski_addon": __version__, "python": platform.python_version()}
    for name in LIBRARIES:
        versions[name] = str(import_module(name).__version__)
    return versions
