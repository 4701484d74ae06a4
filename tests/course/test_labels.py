"""Turns, transitions and their numbers along a curve."""

from __future__ import annotations

import numpy as np

from ski_addon.course.labels import label_turns


def test_sine_has_turns_where_it_is_above_half_of_its_peak():
    place = np.linspace(0.0, 4.0 * np.pi, 4001)
    bend = 0.1 * np.sin(place)
    phase, turn = label_turns(bend, 0.02)
    np.testing.assert_array_equal(phase, np.where(np.abs(bend) >= 0.05 * (1 - 1e-6), np.sign(bend), 0))
    changes = np.flatnonzero(np.diff(turn))
    np.testing.assert_allclose(place[changes], np.pi * np.arange(1, 4) + np.pi / 6, atol=0.01)


def test_transition_belongs_to_the_turn_it_leaves_and_the_first_to_turn_one():
    phase, turn = label_turns(np.array([0, 0, 0.1, 0.1, 0, -0.1, -0.1, 0]), 0.02)
    assert phase.tolist() == [0, 0, 1, 1, 0, -1, -1, 0]
    assert turn.tolist() == [1, 1, 1, 1, 1, 2, 2, 2]


def test_slight_bends_are_no_turns():
    phase, turn = label_turns(0.01 * np.sin(np.linspace(0, 20, 500)), 0.02)
    assert not phase.any() and np.all(turn == 1)


def test_slight_bend_between_two_bends_to_one_side_does_not_end_the_turn():
    phase, turn = label_turns(np.array([0.1, 0.1, 0.0, -0.01, 0.0, 0.1, -0.1]), 0.02)
    assert phase.tolist() == [1, 1, 0, 0, 0, 1, -1] and turn.tolist() == [1, 1, 1, 1, 1, 1, 2]


def test_straight_line_is_one_transition():
    phase, turn = label_turns(np.zeros(10), 0.01)
    assert not phase.any() and np.all(turn == 1) and phase.dtype == np.int8
