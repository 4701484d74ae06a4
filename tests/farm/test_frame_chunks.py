"""Chunks of the frames to render."""

from __future__ import annotations

import pytest

from ski_addon.errors import SpecError
from ski_addon.farm.frame_chunks import CHUNKS_MAX, read_chunk, read_farm_frames, split_frames


def test_frames_are_read_as_render_reads_them():
    assert read_farm_frames(" 20-22 , 0-10:5 ") == (0, 5, 10, 20, 21, 22)


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("-5", r"--frames = \"-5\" is outside frames of 0\.\.1048574 on a farm"),
        ("1-", r"--frames = \"1-\" is no list of frames"),
        (
            ",".join(str(k * k) for k in range(400)),
            r"--frames needs \d+ letters to write, allowed are 1024",
        ),
    ],
)
def test_frames_that_no_farm_takes_are_named(written, message):
    with pytest.raises(SpecError, match=f"^{message}"):
        read_farm_frames(written)


@pytest.mark.parametrize("written", ["0", "-1", "", "ten", "2.5", "1000001", "9" * 30])
def test_bad_chunks_are_named(written):
    with pytest.raises(SpecError, match=r"^--chunk = .* is outside 1\.\.1000000 frames"):
        read_chunk(written)


@pytest.mark.parametrize(
    ("frames", "size", "chunks"),
    [
        (range(1, 11), 4, [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10]]),
        (range(1, 9), 4, [[1, 2, 3, 4], [5, 6, 7, 8]]),
        ([1, 2, 3], 10, [[1, 2, 3]]),
        ([5], 1, [[5]]),
        ([1, 2, 3, 7, 8], 2, [[1, 2], [3, 7], [8]]),
    ],
)
def test_chunks_hold_every_frame_once(frames, size, chunks):
    assert [list(chunk) for chunk in split_frames(frames, size)] == chunks


def test_too_many_chunks_are_refused_before_they_are_made():
    assert len(split_frames(range(CHUNKS_MAX), 1)) == CHUNKS_MAX
    with pytest.raises(SpecError, match="--chunk = 1 makes 1000000 chunks, allowed are 1024"):
        split_frames(range(1_000_000), 1)
