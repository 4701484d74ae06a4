"""Jobs for Flamenco: the job type script that its Manager runs, and the job to post to it.

https://flamenco.blender.org/usage/job-types/
"""

from __future__ import annotations

import platform
from pathlib import Path
from typing import Any

from ..spec.presets import preset_folder
from ..tasks.frame_list import frame_words
from .job import FarmJob
from .openjd_template import INPUT, OUTPUT

SCRIPT = "ski_simulate_bake_render.js"
"""File name of the job type."""
JOB_TYPE = "ski-simulate-bake-render"
"""Name of the job type: the Manager makes it of the file name."""
RENDER_OPTIONS = ("engine", "device", "samples", "size")
"""Options of `render` that are settings of the job type."""


def read_script() -> str:
    """Return the job type script that is shipped."""
    return (preset_folder("farm") / SCRIPT).read_text(encoding="utf-8")


def submitted_job(job: FarmJob, folder: Path) -> dict[str, Any]:
    """Return the job as the Manager's API takes it (`POST /api/v3/jobs`), for a bundle in `folder`.

    Flamenco knows absolute paths only; its two-way variables map them between systems.
    """
    settings: dict[str, Any] = {
        "command": job.command,
        "spec": str(folder / INPUT / job.document),
        "ground": str(folder / INPUT / job.ground_path) if job.ground else "",
        "frames": frame_words(job.frames, steps=False),  # its frameChunker knows no steps
        "chunk_size": job.chunk,
        "output": str(folder / OUTPUT),
        "force": job.force,
        "engine": job.render.get("engine", "cycles"),
        "device": job.render.get("device", "CPU"),
        "samples": int(job.render.get("samples", 0)),
        "size": job.render.get("size", ""),
        "workers": job.workers,
        "python": "python",
        "video": True,
        "fps": job.fps,
    }
    return {
        "name": job.name,
        "type": JOB_TYPE,
        "priority": 50,
        "settings": settings,
        "metadata": {},
        "submitter_platform": platform.system().lower(),
    }
