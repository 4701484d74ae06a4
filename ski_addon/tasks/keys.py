"""What decides the result of a task, as digests."""

from __future__ import annotations

import contextlib
import hashlib
import importlib.metadata
import json
import platform
import re
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .. import __version__
from ..errors import MissingInputError
from ..spec import RunSpec, find_ground

BLOCK = 1 << 20


def digest(content: object) -> str:
    """Return the SHA-256 hex digest of what can be written as JSON."""
    return hashlib.sha256(json.dumps(content, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def digest_file(path: str | Path) -> str:
    """Return the SHA-256 hex digest of a file's bytes; raises `MissingInputError`."""
    found = hashlib.sha256()
    try:
        with open(path, "rb") as stream:
            while block := stream.read(BLOCK):
                found.update(block)
    except OSError as error:
        raise MissingInputError(path, error.strerror or str(error)) from None
    return found.hexdigest()


def ground_digest(spec: RunSpec) -> str:
    """Return the digest of the heights that a run lies on, or "" if it needs no file; raises `MissingInputError`."""
    return digest_file(find_ground(spec.slope.grid_file)) if spec.slope.kind == "grid" else ""


def spec_inputs(spec: RunSpec) -> dict[str, Any]:
    """Return what a run document asks for: its values, with a file of heights by content, wherever it lies."""
    values = spec.to_dict()
    ground = ground_digest(spec)
    if ground:
        values["slope"] = values["slope"] | {"grid_file": ground}
    return {"spec": values}


def versions(*libraries: str) -> dict[str, str]:
    """Return the versions of Ski Addon, Python and `libraries`, none of which is imported ("": it is not there)."""
    found = {"ski_addon": __version__, "python": platform.python_version()}
    return found | {name: _version(name) for name in libraries}


def host() -> dict[str, Any]:
    """Return on what this runs."""
    return {"name": platform.node(), "system": platform.system(), "machine": platform.machine()}


def one_line_of(values: Mapping[str, Any]) -> str:
    """Return names and values on one line."""
    return ", ".join(f"{name} {value}" for name, value in values.items() if value not in (None, ""))


def _version(name: str) -> str:
    if name == "bpy" and name in sys.modules:
        text = str(sys.modules[name].app.version_string)
        found = re.match(r"[\d.]+", text)
        return found[0] if found else text
    for package in (name, f"{name}-core"):  # the extension brings MuJoCo's core alone
        with contextlib.suppress(importlib.metadata.PackageNotFoundError):
            return importlib.metadata.version(package)
    return str(getattr(sys.modules.get(name), "__version__", ""))
