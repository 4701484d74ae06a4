"""The table of bones of a user's own armature in its settings: found, changed by hand, kept as a bone map."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy

from ..errors import OutputError, SpecError

if TYPE_CHECKING:
    from ..animation.bone_map import BoneMap


def bone_group() -> type:
    """Return a new property group of one row: which bone does what another bone of a bone map does."""
    annotations: dict[str, Any] = {
        "wanted": bpy.props.StringProperty(name="In the Map", description="Name of the bone in the bone map"),
        "body": bpy.props.StringProperty(name="Follows", description="Part of the skier that the bone follows"),
        "bone": bpy.props.StringProperty(name="Bone", description="Bone of your armature; empty = none does it"),
    }
    group = type("SKI_PG_bone", (bpy.types.PropertyGroup,), {"__doc__": "One bone of a user's own armature."})
    group.__annotations__ = annotations
    return group


def fill_table(armature: bpy.types.Object, path: Path) -> list[str]:
    """Fill the table of `armature` by the bone map at `path`; returns the names in it that the armature has not."""
    from ..animation.bone_map import BoneMap
    from .armature_checks import check_object

    check_object(armature)
    settings, whole = armature.ski, BoneMap.load(path)
    bones = armature.data.bones.keys()
    there = whole.actual_names(bones)
    settings.bone_map = str(path)
    settings.bones.clear()
    for entry in whole.entries:
        row = settings.bones.add()
        row.wanted, row.body, row.bone = entry.bone, entry.body, there.get(entry.bone, "")
    return [row.wanted for row in settings.bones if not row.bone]


def own_map(armature: bpy.types.Object) -> BoneMap | None:
    """Return the bone map that the table of `armature` makes, or None without one; raises `SpecError`."""
    from ..animation.bone_map import BoneMap

    settings = armature.ski
    if not len(settings.bones):
        return None
    whole = BoneMap.load(settings.bone_map)
    names = {row.wanted: row.bone for row in settings.bones}
    for row in settings.bones:
        if row.bone and row.bone not in armature.data.bones:
            hint = f"choose a bone of {armature.name}, or leave it empty"
            raise SpecError(f"bones.{row.wanted}", row.bone, hint=hint, problem="is not a bone of the armature")
    names = {**whole.actual_names(armature.data.bones.keys()), **names}
    return whole.renamed(names)


def save_map(armature: bpy.types.Object, name: str) -> Path:
    """Write the table of `armature` as a bone map of the user's own; raises `SpecError` or `OutputError`."""
    from ..atomic import write_text
    from .armature_maps import user_map_folder

    made, stem = own_map(armature), re.sub(r"[^\w-]+", "_", name.strip()).strip("_").lower()
    if made is None or not stem:
        hint = "find the bones first, and give the map a name with letters"
        raise SpecError("bone map", name, hint=hint, problem="cannot be kept")
    folder = user_map_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(folder, error.strerror or str(error)) from error
    target = folder / f"{stem}.toml"
    write_text(target, replace(made, name=name.strip()).to_toml())
    return target
