"""The bone map that fits a user's armature, of the user's own and the shipped ones."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import bpy

from ..animation.bone_map import BoneMap
from ..animation.target import REQUIRED, main_bones
from ..errors import SkiAddonError, SpecError
from .armature_checks import check_object
from .bake import BONE_MAP
from .preferences import user_folder


@dataclass(frozen=True)
class FoundMap:
    """A bone map that fits an armature: `bone_map` in the armature's names, the file `path` it came from, the names of
    bones that are `missing`, and `unreadable`, one line for each map that could not be read.
    """

    bone_map: BoneMap
    path: Path
    missing: tuple[str, ...]
    unreadable: tuple[str, ...] = ()


def user_map_folder() -> Path:
    """Return the folder for the user's own bone maps; it may not be there yet."""
    return user_folder("bone_maps")


def detect_bone_map(armature: bpy.types.Object, folders: tuple[Path, ...] | None = None) -> FoundMap:
    """Return the bone map that fits `armature` best, of those in `folders` (default: the user's, then the shipped).

    A map fits if the armature has its bones of pelvis and legs; the best has the largest part of its bones there.
    Raises `SpecError` that names the nearest map and what is missing if none fits.
    """
    check_object(armature)
    if folders is None:
        folders = (user_map_folder(), BONE_MAP.parent)
    unreadable: list[str] = []
    found: list[tuple[bool, float, int, Path, BoneMap, tuple[str, ...]]] = []
    for path in (path for folder in folders for path in sorted(folder.glob("*.toml"))):
        try:
            whole = BoneMap.load(path)
        except SkiAddonError as error:
            unreadable.append(str(error))
            continue
        fitting, missing = whole.resolved(armature.data.bones.keys())
        there = len(fitting.entries)
        fits = set(REQUIRED) <= main_bones(fitting).keys()
        found.append((fits, there / (there + len(missing)), there, path, fitting, missing))
    if not found:
        raise SpecError("bone maps", None, "", "; ".join(unreadable) or "put one there", problem="cannot be found")
    fits, _, _, path, bone_map, missing = max(found, key=lambda row: row[:3])
    if not fits:
        hint = f"the nearest, {path.name}, misses {', '.join(missing[:6])}; write a bone map for it"
        raise SpecError(armature.name, None, "", hint, problem="fits no bone map")
    return FoundMap(bone_map, path, missing, tuple(unreadable))
