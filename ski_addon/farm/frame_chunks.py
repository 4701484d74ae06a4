"""The chunks of frames that one task renders each."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ..errors import SpecError
from ..tasks.frame_list import FARTHEST, MOST, frame_words, read_frames

CHUNKS_MAX = 1024
"""The most values of a task parameter that Open Job Description allows [section 3.4.1.1 of its template schema]."""
LETTERS_MAX = 1024
"""The most letters of a text parameter there."""


def read_farm_frames(written: str) -> tuple[int, ...]:
    """Return the frames of `--frames` as `read_frames` does, none of them negative; raises `SpecError`."""
    frames = read_frames(written)
    if frames[0] < 0:
        hint = "set bake.frame_start to 1, and name the frames that then are there"
        raise SpecError("--frames", written, f"frames of 0..{FARTHEST} on a farm", hint)
    words = frame_words(frames)
    if len(words) > LETTERS_MAX:
        problem = f"needs {len(words)} letters to write, allowed are {LETTERS_MAX}"
        raise SpecError("--frames", problem=problem, hint="name ranges, or submit several jobs")
    return tuple(frames)


def read_chunk(written: str) -> int:
    """Return the number of frames in a chunk; raises `SpecError` naming `--chunk`."""
    size = int(written) if re.fullmatch("[0-9]{1,9}", written.strip()) else 0
    if not 1 <= size <= MOST:
        raise SpecError("--chunk", written, f"1..{MOST} frames", "give how many frames one task renders")
    return size


def split_frames(frames: Sequence[int], size: int) -> list[Sequence[int]]:
    """Return chunks of `size` frames, the last one with the rest; raises `SpecError` for more than `CHUNKS_MAX`."""
    count = -(-len(frames) // size)
    if count > CHUNKS_MAX:
        hint = "render more frames in each"
        raise SpecError("--chunk", size, hint=hint, problem=f"makes {count} chunks, allowed are {CHUNKS_MAX}")
    return [frames[start : start + size] for start in range(0, len(frames), size)]
