"""`FarmJob`: what a farm is asked to do, whichever farm it is."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

from ..tasks.frame_list import frame_words
from .frame_chunks import split_frames
from .variations import Variation, list_changes

TERRAIN = "terrain"
"""Folder of the heights, beside the document that names them."""
SIMULATE_SECONDS_LEAST = 900
"""A simulation is not stopped before that [s], however short the run: the first start of a worker is slow."""
SLOWNESS = 10.0
"""How many times slower than the estimate a worker may be before its simulation is stopped."""
BAKE_SECONDS = 3600
"""Time that baking may take [s]."""
FRAME_SECONDS = 900
"""Time that one frame may take to render [s]."""
LAUNCHES: Mapping[str, tuple[str, str, tuple[str, ...]]] = MappingProxyType(
    {
        "python": ("Python", "python", ("-m", "ski_addon")),
        "blender": ("Blender", "blender", ("--command", "ski")),
    }
)
"""What workers have -> the job parameter that names the program, its default, and what comes before a command."""


@dataclass(frozen=True)
class FarmJob:
    """One run or crowd, or those that `variations` make of it, simulated, baked and rendered.

    `command` simulates `document`, one of `documents` (TOML by file name), whose ground is `ground_name` in the folder
    `terrain` beside it, a copy of the file `ground` (both empty for a ground without a file). `frames` are rendered in
    chunks of `chunk`, with the options `render`. With `pairs` the variations go together, value by value. With `force`
    large runs are simulated, too. `workers` is a key of `LAUNCHES`. `run_seconds` is the estimated time of the longest
    simulation [s]. `cores` and `memory` [GB] are what a worker must have at least.
    """

    name: str
    documents: Mapping[str, str]
    frames: tuple[int, ...]
    chunk: int
    command: str = "simulate"
    document: str = "spec.toml"
    ground: Path | None = None
    ground_name: str = ""
    render: Mapping[str, str] = field(default_factory=dict)
    variations: tuple[Variation, ...] = ()
    pairs: bool = False
    chunking: bool = False
    force: bool = False
    workers: str = "python"
    run_seconds: float = 0.0
    fps: float = 24.0
    cores: int | None = None
    memory: int | None = None

    @property
    def ground_path(self) -> str:
        """Path of the ground beside the document, with forward slashes, or ""."""
        return f"{TERRAIN}/{self.ground_name}" if self.ground else ""

    @property
    def run_count(self) -> int:
        """How many runs are simulated."""
        return len(list_changes(self.variations, pairs=self.pairs))

    @property
    def task_count(self) -> int:
        """How many tasks there are, with `chunk` frames in each that renders."""
        return self.run_count * (2 + len(split_frames(self.frames, self.chunk)))

    @property
    def described(self) -> str:
        """One clause for a person: "1 run, frames 1-48, 7 tasks"."""
        runs = "1 run" if self.run_count == 1 else f"{self.run_count} runs"
        return f"{runs}, frames {frame_words(self.frames)}, {self.task_count} tasks"

    @property
    def simulate_seconds(self) -> int:
        """Time that simulating may take [s]."""
        return max(SIMULATE_SECONDS_LEAST, math.ceil(SLOWNESS * self.run_seconds))

    @property
    def render_seconds(self) -> int:
        """Time that rendering one chunk may take [s]."""
        return FRAME_SECONDS * (self.chunk + 1)
