"""Frames to render, as people write them, and the chunks of them that one task renders."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ..errors import SpecError

Span = tuple[int, int]
"""First and last frame, both rendered."""
FRAME_MAX = 1_048_574
"""Blender's last frame."""
CHUNKS_MAX = 1024
"""The most values of a task parameter that Open Job Description allows [section 3.4.1.1 of its template schema]."""
_SPAN = re.compile(r"([0-9]{1,9})(?:-([0-9]{1,9}))?")
_ALLOWED = f"frames of 0..{FRAME_MAX}"
_HINT = 'write the first and the last one, for instance "1-48", or several "1-10,20-30"'


def read_frames(written: str) -> tuple[Span, ...]:
    """Return the spans of "1-48" or "1-10,20-30", in order; raises `SpecError` naming `--frames`."""
    spans = sorted(_read_span(part.strip()) for part in written.split(","))
    for (_, last), (first, _) in zip(spans, spans[1:], strict=False):
        if first <= last:
            raise SpecError("--frames", written, hint="name each frame once", problem=f"has frame {first} twice")
    return tuple(spans)


def _read_span(part: str) -> Span:
    match = _SPAN.fullmatch(part)
    if not match:
        raise SpecError("--frames", part, hint=_HINT, problem="is not a range of frames")
    first, last = int(match[1]), int(match[2] or match[1])
    if last > FRAME_MAX:
        raise SpecError("--frames", part, _ALLOWED, _HINT)
    if last < first:
        raise SpecError("--frames", part, hint=f'did you mean "{last}-{first}"?', problem="ends before it starts")
    return first, last


def read_chunk(written: str) -> int:
    """Return the number of frames in a chunk; raises `SpecError` naming `--chunk`."""
    size = int(written) if re.fullmatch("[0-9]{1,9}", written.strip()) else 0
    if not 1 <= size <= FRAME_MAX:
        raise SpecError("--chunk", written, f"1..{FRAME_MAX} frames", "give how many frames one task renders")
    return size


def split_frames(spans: Sequence[Span], size: int) -> list[Span]:
    """Return consecutive chunks of at most `size` frames; raises `SpecError` if they are more than `CHUNKS_MAX`."""
    count = sum(-(-(last - first + 1) // size) for first, last in spans)
    if count > CHUNKS_MAX:
        hint = "render more frames in each"
        raise SpecError("--chunk", size, hint=hint, problem=f"makes {count} chunks, allowed are {CHUNKS_MAX}")
    return [(start, min(start + size - 1, last)) for first, last in spans for start in range(first, last + 1, size)]


def show_span(span: Span) -> str:
    """Return a span as `render --frames` takes it."""
    return f"{span[0]}-{span[1]}"


def show_frames(spans: Sequence[Span]) -> str:
    """Return spans as `read_frames` takes them; single frames as one number."""
    return ",".join(str(first) if first == last else f"{first}-{last}" for first, last in spans)
