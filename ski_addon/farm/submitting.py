"""From the options of `submit` to a job, and from a job to the files of its bundle."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ..errors import SpecError
from ..spec import RunSpec
from ..talk import json_text
from ..tasks.frame_list import FARTHEST
from . import bundle, flamenco, openjd_template
from .frame_chunks import read_chunk, read_farm_frames, split_frames
from .job import TERRAIN, FarmJob
from .render_options import read_render_options
from .subjects import Subject, find_heights, plain_name
from .variations import list_changes, read_variations

WORKERS: Mapping[str, str] = MappingProxyType({"openjd": "python", "flamenco": "blender"})
"""Farms that bundles are written for -> what their workers usually have."""
CORES_MAX, MEMORY_MAX = 1024, 65536


@dataclass(frozen=True)
class SubmitOptions:
    """What `submit` was told, as it was written; see its `--help`."""

    engine: str = "openjd"
    frames: str | None = None
    chunk: str = "10"
    render: Sequence[str] = ()
    vary: Sequence[str] = ()
    pairs: bool = False
    chunking: bool = False
    workers: str | None = None
    force: bool = False
    cores: str | None = None
    memory: str | None = None


def make_job(
    subject: Subject,
    options: SubmitOptions,
    check: Callable[[RunSpec], None],
    plan_seconds: Callable[[RunSpec], float],
    progress: Callable[[float, str], Any],
) -> FarmJob:
    """Return the job for a run or a crowd; raises `SkiAddonError` for an option that is wrong.

    Every run is given to `check`, which raises if it is too large. Without `options.frames` every run is planned by
    `plan_seconds`, which returns how long it lasts [s], and all frames of the longest are rendered.
    """
    render = read_render_options(options.render)
    _check_engine(options, render)
    variations = read_variations(options.vary, subject)
    varied = [subject.changed(changes) for changes in list_changes(variations, pairs=options.pairs)]
    runs = [run for one in varied for run in one.runs]
    for run in runs:
        check(run)
    chunk = read_chunk(options.chunk)
    ground = find_heights([run.slope for run in runs])
    ground_name = plain_name(ground) if ground else ""
    documents = subject.documents(f"{TERRAIN}/{ground_name}" if ground else "")
    if options.frames is not None:
        frames = read_farm_frames(options.frames)
    elif subject.command == "simulate":
        frames = _planned_frames(runs, plan_seconds, progress)
    else:
        hint = "name the frames to render, for instance --frames 1-240"
        raise SpecError("--frames", problem="is needed for a crowd, whose length is known when it was skied", hint=hint)
    split_frames(frames, chunk)  # says so if these are too many
    return FarmJob(
        name=" ".join(subject.name.split()) or "Ski run",
        command=subject.command,
        document=subject.document,
        documents=documents,
        frames=frames,
        chunk=chunk,
        render=render,
        ground=ground,
        ground_name=ground_name,
        variations=variations,
        pairs=options.pairs,
        chunking=options.chunking,
        force=options.force,
        workers=options.workers or WORKERS[options.engine],
        run_seconds=max(one.wall_seconds for one in varied),
        fps=subject.fps,
        cores=_whole("--cores", options.cores, CORES_MAX),
        memory=_whole("--memory", options.memory, MEMORY_MAX),
    )


def write_job(job: FarmJob, folder: Path, engine: str) -> bool:
    """Write the bundle of a job into `folder`; returns whether it was not there yet. Raises as `write_bundle`."""
    inputs = f"{openjd_template.INPUT}/"
    texts = {f"{inputs}{name}": text for name, text in job.documents.items()}
    if engine == "openjd":
        texts["template.json"] = json_text(openjd_template.job_template(job))
        texts["parameter_values.json"] = json_text(openjd_template.parameter_values(job))
    else:
        texts["job.json"] = json_text(flamenco.submitted_job(job, folder.resolve()))
        texts[flamenco.SCRIPT] = flamenco.read_script()
    copies = {f"{inputs}{job.ground_path}": job.ground} if job.ground else {}
    return bundle.write_bundle(folder, texts, copies, kept=openjd_template.OUTPUT)


def _check_engine(options: SubmitOptions, render: Mapping[str, str]) -> None:
    only_openjd: Mapping[str, object] = {
        "--vary": options.vary,
        "--chunking": options.chunking,
        "--cores": options.cores,
        "--memory": options.memory,
        **{f"--render {name}": name not in flamenco.RENDER_OPTIONS for name in render},
    }
    for name, value in only_openjd.items():
        if options.engine != "openjd" and value:
            raise SpecError(name, problem=f"is not for {options.engine}", hint="leave it out, or use --engine openjd")
    if options.pairs and len(options.vary) < 2:
        raise SpecError("--pairs", problem="needs two keys or more", hint="give --vary twice or more, or leave it out")


def _planned_frames(
    runs: Sequence[RunSpec], plan_seconds: Callable[[RunSpec], float], progress: Callable[[float, str], Any]
) -> tuple[int, ...]:
    """Return the frames from the first start to the last end of the planned runs."""
    spans = []
    for k, run in enumerate(runs):
        progress(k / len(runs), "planning")
        first = run.bake.frame_start
        spans.append((first, first + int(plan_seconds(run) * run.bake.fps)))
    first, last = min(span[0] for span in spans), max(span[1] for span in spans)
    if first < 0 or last > FARTHEST:
        hint = "set bake.frame_start to 1, or name the frames to render with --frames"
        raise SpecError("bake.frame_start", first, f"frames of 0..{FARTHEST} on a farm", hint)
    return tuple(range(first, last + 1))


def _whole(name: str, written: str | None, most: int) -> int | None:
    if written is None:
        return None
    value = int(written) if re.fullmatch("[0-9]{1,9}", written) else 0
    if not 1 <= value <= most:
        raise SpecError(name, written, f"1..{most}", "give a whole number in that range")
    return value
