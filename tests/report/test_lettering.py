"""Letters as strokes: all are there, on their lines, and what cannot be drawn does no harm."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.report.lettering import CAPITAL, STROKES, text_strokes, text_width


def test_every_printable_letter_of_ascii_has_strokes():
    assert {chr(code) for code in range(32, 127)} <= set(STROKES)


def test_all_letters_differ():
    drawn = [np.concatenate(text_strokes(letter)).tobytes() for letter in STROKES if letter != " "]
    assert len(set(drawn)) == len(drawn)


@pytest.mark.parametrize("letter", [letter for letter in STROKES if letter != " "])
def test_letters_stand_between_their_tail_and_their_top(letter):
    points = np.concatenate(text_strokes(letter))
    assert points[:, 0].min() >= 0.0 and points[:, 0].max() <= text_width(letter)
    assert points[:, 1].min() >= -3.0 and points[:, 1].max() <= CAPITAL + 2.0


def test_capitals_and_digits_are_equally_high_and_stand_on_the_line():
    for letter in "ABCDEFGHIJKLMNOPRSTUVWXYZ0123456789":
        height = np.concatenate(text_strokes(letter))[:, 1]
        assert (height.min(), height.max()) == pytest.approx((0.0, CAPITAL), abs=0.3), letter


def test_mirrored_letters_are_mirrored():
    for letter in "AHIMOTUVWXY08":
        points = np.concatenate(text_strokes(letter))
        mirrored = points * (-1.0, 1.0) + (text_width(letter), 0.0)
        gap = np.linalg.norm(points[:, None] - mirrored[None], axis=2).min(axis=1).max()
        assert gap < 1e-9, letter


def test_words_are_as_wide_as_they_are_drawn():
    words = "Speed 12 m/s"
    assert np.concatenate(text_strokes(words))[:, 0].max() == pytest.approx(text_width(words), abs=1.0)
    assert text_width("") == 0.0
    assert text_strokes("") == []


def test_accents_are_left_out_and_unknown_letters_are_boxes():
    np.testing.assert_array_equal(np.concatenate(text_strokes("é")), np.concatenate(text_strokes("e")))
    assert len(text_strokes("世")) == 3
    assert text_width("a\nb") == text_width("a b")
