"""Frames as a person or a farm writes them."""

from __future__ import annotations

import pytest

from ski_addon.errors import SpecError
from ski_addon.tasks.frame_list import frame_words, read_frames


@pytest.mark.parametrize(
    ("text", "frames"),
    [
        ("5", [5]),
        ("1-4", [1, 2, 3, 4]),
        ("1-9:4", [1, 5, 9]),
        ("8-10, 1-2,9", [1, 2, 8, 9, 10]),
        ("-2-1", [-2, -1, 0, 1]),
        ("-3--2", [-3, -2]),
    ],
)
def test_frames_are_listed_once_and_in_order(text, frames):
    assert read_frames(text) == frames


@pytest.mark.parametrize("text", ["", "a", "1-", "4-1", "1-9:0", "1..4", "1,,2", "1-2000000", "9" * 30, "1-9-2"])
def test_wrong_lists_are_refused_by_name(text):
    with pytest.raises(SpecError, match="^--frames"):
        read_frames(text)


@pytest.mark.parametrize(
    ("frames", "words", "plain"),
    [
        ([1, 2, 3, 7, 9, 10], "1-3,7,9-10", "1-3,7,9-10"),
        ([-1, 0, 4], "-1-0,4", "-1-0,4"),
        ([1, 2, 4, 6, 8, 20], "1-2,4-8:2,20", "1-2,4,6,8,20"),
        ([5], "5", "5"),
        ([], "", ""),
    ],
)
def test_frames_are_said_as_they_are_written(frames, words, plain):
    assert frame_words(frames) == words and frame_words(frames, steps=False) == plain
    if frames:
        assert read_frames(words) == read_frames(plain) == frames


def test_many_frames_with_steps_are_said_at_once():
    frames = list(range(0, 1_000_000, 3))
    assert frame_words(frames) == "0-999999:3"
    assert frame_words(frames, steps=False).count(",") == len(frames) - 1
