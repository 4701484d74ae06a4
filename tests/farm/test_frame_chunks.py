"""Frames to render and their chunks."""

from __future__ import annotations

import pytest

from ski_addon.errors import SpecError
from ski_addon.farm.frame_chunks import CHUNKS_MAX, read_chunk, read_frames, show_frames, split_frames


@pytest.mark.parametrize(
    ("written", "spans"),
    [
        ("1-48", ((1, 48),)),
        ("7", ((7, 7),)),
        ("0", ((0, 0),)),
        (" 20-30 , 1-10 ", ((1, 10), (20, 30))),
        ("1048574", ((1048574, 1048574),)),
    ],
)
def test_frames_are_read(written, spans):
    assert read_frames(written) == spans
    assert read_frames(show_frames(spans)) == spans


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("10-1", '--frames = "10-1" ends before it starts: did you mean "1-10"?'),
        ("", "is not a range of frames: write the first and the last one"),
        ("1-", "is not a range of frames"),
        ("-5", "is not a range of frames"),
        ("1,,2", "is not a range of frames"),
        ("1.5", "is not a range of frames"),
        ("١-٥", "is not a range of frames"),
        ("1-10,5-20", "has frame 5 twice"),
        ("3,3", "has frame 3 twice"),
        ("1-1048575", "is outside frames of 0..1048574"),
        ("1" * 5000, "is not a range of frames"),
    ],
)
def test_bad_frames_are_named(written, message):
    with pytest.raises(SpecError, match="^--frames = ") as caught:
        read_frames(written)
    assert message in str(caught.value)


@pytest.mark.parametrize("written", ["0", "-1", "", "ten", "2.5", "1048575", "9" * 30])
def test_bad_chunks_are_named(written):
    with pytest.raises(SpecError, match=r"^--chunk = .* is outside 1\.\.1048574 frames"):
        read_chunk(written)


@pytest.mark.parametrize(
    ("spans", "size", "chunks"),
    [
        (((1, 10),), 4, [(1, 4), (5, 8), (9, 10)]),
        (((1, 8),), 4, [(1, 4), (5, 8)]),
        (((1, 3),), 10, [(1, 3)]),
        (((5, 5),), 1, [(5, 5)]),
        (((1, 3), (7, 8)), 2, [(1, 2), (3, 3), (7, 8)]),
    ],
)
def test_chunks_hold_every_frame_once(spans, size, chunks):
    assert split_frames(spans, size) == chunks


def test_too_many_chunks_are_refused_before_they_are_made():
    assert len(split_frames([(1, CHUNKS_MAX)], 1)) == CHUNKS_MAX
    with pytest.raises(SpecError, match="--chunk = 1 makes 1000000 chunks, allowed are 1024"):
        split_frames([(1, 1_000_000)], 1)
