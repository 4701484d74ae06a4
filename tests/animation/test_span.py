"""The part of a run that is baked, in seconds and in frames."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.animation.span import ALL_FRAMES, FRAMES, SECONDS, FrameSpan, Part
from ski_addon.errors import SpecError

RATE, START, DURATION = 25.0, 11.0, 4.0  # frames 11 to 111
FRAME = START + np.arange(101.0)


def kept(part: Part) -> tuple[float, float, int]:
    """First and last frame of a part, and how many."""
    frame = FRAME[part.span(RATE, START, DURATION).within(FRAME)]
    return float(frame[0]), float(frame[-1]), len(frame)


def test_the_whole_run_is_the_default() -> None:
    assert Part().span(RATE, START, DURATION) == ALL_FRAMES
    assert kept(Part()) == (11.0, 111.0, 101)


def test_seconds_count_from_the_start_of_the_run() -> None:
    assert kept(Part(SECONDS, 1.0, 2.0)) == (36.0, 61.0, 26)
    assert kept(Part(SECONDS, 3.0, 0.0)) == (86.0, 111.0, 26), "0 is the end of the run"


def test_frames_are_those_of_the_scene() -> None:
    assert kept(Part(FRAMES, 20.0, 30.0)) == (20.0, 30.0, 11)


def test_the_same_part_in_either_unit_is_the_same() -> None:
    assert Part(SECONDS, 0.4, 1.2).span(RATE, START, DURATION) == FrameSpan(21.0, 41.0)


def test_what_lies_beyond_the_run_is_left_out() -> None:
    assert kept(Part(FRAMES, -50.0, 20.0)) == (11.0, 20.0, 10)
    assert kept(Part(SECONDS, 3.0, 100.0)) == (86.0, 111.0, 26)


def test_rounding_does_not_lose_a_frame() -> None:
    third = START + np.arange(0.0, 20.0)
    span = Part(SECONDS, 7 / 24, 14 / 24).span(24.0, START, 3.0)
    assert third[span.within(third)].tolist() == list(range(18, 26))


@pytest.mark.parametrize(
    ("part", "words"),
    [
        (Part(SECONDS, 2.0, 1.0), '"2 to 1 s" ends before it begins'),
        (Part(FRAMES, 30.0, 30.0), '"30 to 30 frames" ends before it begins'),
        (Part(SECONDS, 9.0, 12.0), '"9 to 12 s" is not in the run, 0 to 4.0 s'),
        (Part(FRAMES, 200.0, 300.0), '"200 to 300 frames" is not in the run, frames 11 to 111'),
        (Part(FRAMES, 1.0, 5.0), "is not in the run, frames 11 to 111"),
        (Part(SECONDS, 1.01, 1.03), "has fewer than two frames: make it longer"),
        (Part(FRAMES, 1.0, 11.0), "has fewer than two frames"),
        (Part(SECONDS, 9.0, 0.0), "ends before it begins"),
    ],
)
def test_a_part_that_cannot_be_is_answered_in_one_line(part: Part, words: str) -> None:
    with pytest.raises(SpecError) as caught:
        part.span(RATE, START, DURATION)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
