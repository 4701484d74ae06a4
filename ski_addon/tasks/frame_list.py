"""Frames to render, as a person or a farm writes them: `1-250`, `1-9,20`, `1-100:5` (every fifth)."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ..errors import SpecError

FARTHEST = 1_048_574
"""Blender's last frame."""
MOST = 1_000_000
"""Most frames of one list."""
_PART = re.compile(r"(-?\d{1,9})(?:-(-?\d{1,9})(?::(\d{1,9}))?)?")


def read_frames(text: str, option: str = "--frames") -> list[int]:
    """Return the frames that `text` lists, each once, in ascending order; raises `SpecError` naming `option`."""
    frames: set[int] = set()
    for part in text.split(","):
        found = _PART.fullmatch(part.strip())
        if not found:
            hint = "write for instance 1-250, or 1-9,20, or 1-100:5"
            raise SpecError(option, text, hint=hint, problem="is no list of frames")
        first, last = int(found[1]), int(found[2] or found[1])
        step = int(found[3] or 1)
        if last < first or step < 1:
            raise SpecError(option, part, hint="write the smaller frame first", problem="is no range of frames")
        if not (first >= -FARTHEST and last <= FARTHEST) or (last - first) // step >= MOST:
            raise SpecError(option, part, f"-{FARTHEST}..{FARTHEST}", "give frames that Blender has")
        frames.update(range(first, last + 1, step))
    return sorted(frames)


def frame_words(frames: Sequence[int], *, steps: bool = True) -> str:
    """Return ascending frames as `read_frames` takes them: `1-3,7`, and with `steps` also `1-99:2`."""
    words, start = [], 0
    while start < len(frames):
        first = frames[start]
        step = frames[start + 1] - first if start + 1 < len(frames) else 1
        end = start + 1
        while (steps or step == 1) and end < len(frames) and frames[end] - frames[end - 1] == step:
            end += 1
        if step > 1 and end - start == 2:
            end -= 1  # two frames apart are no range
        last = frames[end - 1]
        words.append(str(first) if last == first else f"{first}-{last}" + (f":{step}" if step > 1 else ""))
        start = end
    return ",".join(words)
