"""The crowd of a skier: what its settings ask for, where its recordings lie, and the job that simulates it."""

from __future__ import annotations

import contextlib
import re
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import bpy

from ..crowd.child import CrowdProcess, can_start, raise_failure
from ..crowd.crowd_spec import SECTIONS, CrowdSpec, MemberRun, section_fields
from ..crowd.documents import write_crowd
from ..crowd.running import steps_here
from ..crowd.skied import is_crowd_folder, read_skied
from ..crowd.skiing import recordings_in
from ..crowd.summary import SUMMARY
from ..spec.estimate import show_bytes
from ..workers import read_jobs
from .cache import FOLDER, user_cache
from .fields import read_field, write_field
from .frame_rate import scene_rate
from .jobs import Job
from .properties import read_spec

LOOK_SECONDS = 0.02
"""Pause between two looks at a process while there is no window [s]."""


def read_crowd_spec(settings: Any, scene: bpy.types.Scene) -> CrowdSpec:
    """Return the crowd that a skier's settings ask for: its own run, skied by many; raises `SpecError`."""
    run = read_spec(settings)
    base = run.with_tables({"bake": {"fps": scene_rate(scene)}})  # starts are whole frames of the scene
    infos = [info for section in SECTIONS for info in section_fields(section)]
    values = {info.key: read_field(getattr(settings, info.section), info) for info in infos}
    return CrowdSpec((MemberRun(base),), f"{run.name[:100]}, crowd").with_values(values)


def write_crowd_spec(settings: Any, crowd: CrowdSpec) -> None:
    """Set a skier's settings to ask for the numbers of `crowd`; its runs are not taken over."""
    for section in SECTIONS:
        for info in section_fields(section):
            write_field(getattr(settings, section), info, getattr(getattr(crowd, section), info.name))


def crowd_folder(skier: str) -> Path:
    """Return the folder, made if it is missing, for the recordings of the crowd of `skier`."""
    name = re.sub(r"[^\w.-]+", "_", skier) or "skier"
    if bpy.data.filepath:
        blend = Path(bpy.data.filepath)
        folder = blend.parent / FOLDER / f"{blend.stem}_{name}_crowd"
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError:
            pass  # the .blend lies where nothing may be written
        else:
            return folder
    folder = user_cache() / f"{name}_crowd"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def kept_path(folder: Path) -> str:
    """Return a folder as Blender keeps it: relative to a saved file beside it."""
    return bpy.path.relpath(str(folder)) if bpy.data.filepath else str(folder)


def found_folder(settings: Any) -> Path | None:
    """Return the folder of the crowd that was simulated last, if it is still there."""
    if not settings.crowd_folder:
        return None
    folder = Path(bpy.path.abspath(settings.crowd_folder))
    return folder if is_crowd_folder(folder) else None


def crowd_job(crowd: CrowdSpec, folder: Path, jobs: int = 0) -> Job:
    """Simulate `crowd` into `folder` in processes of their own, or here where none can be started.

    Members that are there already are kept. Returns the summary (crowd.json), also when it is stopped.
    Raises `SkiAddonError` if there is nothing to show.
    """
    stop = yield 0.0, "Starting"
    _forget(crowd, folder)
    if can_start():
        document = write_crowd(crowd, folder)
        count = jobs or read_jobs(None)
        process = CrowdProcess([str(document), "-o", str(folder), "--jobs", str(count), "--force"])
        try:
            while process.running and not stop:
                if bpy.app.background:
                    time.sleep(LOOK_SECONDS)
                stop = yield process.look()
        finally:
            process.stop()
        exit_code, said = process.result()
        if not is_crowd_folder(folder):
            if stop:
                return None
            raise_failure(exit_code, said)
    else:
        with contextlib.closing(steps_here(crowd, folder)) as steps:
            for fraction, text in steps:
                stop = yield fraction, text
                if stop:
                    break
    return read_skied(folder).summary if is_crowd_folder(folder) else None


def busy_here() -> bool:
    """Return whether a crowd's job computes in this process."""
    return not can_start()


def crowd_lines(summary: Mapping[str, Any]) -> list[str]:
    """Return what became of a crowd, for the sidebar."""
    kept = f" ({summary['kept']} kept)" if summary["kept"] else ""
    lines = [f"{summary['finished']} of {summary['count']} skied to the end{kept}"]
    if summary["least_distance_m"] is not None:
        lines.append(f"Never nearer than {summary['least_distance_m']:.1f} m (asked {summary['apart_m']:g} m)")
    lines.append(f"{summary['duration_s']:.1f} s in all, {show_bytes(summary['recordings_bytes'])} of recordings")
    troubled = [member for member in summary["members"] if member["problem"]]
    lines += [f"Member {member['member']}: {member['problem']}" for member in troubled[:3]]
    if len(troubled) > 3:
        lines.append(f"and {len(troubled) - 3} others")
    return lines


def _forget(crowd: CrowdSpec, folder: Path) -> None:
    """Take away the summary of an earlier crowd, and recordings past the count of this one."""
    (folder / SUMMARY).unlink(missing_ok=True)
    for path in recordings_in(folder):
        number = path.stem.removeprefix("member_")
        if number.isdigit() and int(number) > crowd.crowd.count:
            path.unlink(missing_ok=True)
