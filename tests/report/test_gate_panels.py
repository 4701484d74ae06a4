"""Gates in the report: what is drawn is read back from the axes."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.course import Gates
from ski_addon.simulation import GatePassing

pytest.importorskip("matplotlib")
from matplotlib import rc_context
from matplotlib.figure import Figure

from ski_addon.report import gate_panels, style

COUNT = 5


@pytest.fixture
def passing():
    """Five gates, left and right in turn; the third is missed and the fifth never reached."""
    side = np.array([1, -1, 1, -1, 1], dtype=np.int8)
    position = np.stack((20.0 * np.arange(COUNT), -2.0 * side, np.zeros(COUNT)), axis=1)
    distance = np.array([0.52, 0.49, 0.3, 0.5, np.nan])
    clearance = np.array([0.3, 0.28, -0.1, 0.31, np.nan])
    return GatePassing(Gates(position, side, np.full(COUNT, 0.5)), distance, clearance)


def drawn(draw, passing):
    with rc_context(style.RC):
        axes = Figure().add_subplot()
        draw(axes, passing)
    return axes


def markers(axes, marker):
    """Places (n, 2) and colours of all markers of one kind."""
    lines = [line for line in axes.lines if line.get_marker() == marker]
    places = [np.stack(line.get_data(), axis=1) for line in lines]
    colors = [line.get_color() for line, some in zip(lines, places, strict=True) for _ in some]
    return np.concatenate(places), colors


def test_poles_stand_at_their_places_in_the_colour_of_their_side(passing):
    axes = drawn(gate_panels.draw_poles, passing)
    places, colors = markers(axes, "o")
    np.testing.assert_array_equal(places, passing.gates.position[[0, 1, 3], :2])
    assert colors == [style.LEFT, style.RIGHT, style.RIGHT]


def test_missed_poles_are_crosses(passing):
    places, colors = markers(drawn(gate_panels.draw_poles, passing), "X")
    np.testing.assert_array_equal(places, passing.gates.position[[2, 4], :2])
    assert set(colors) == {gate_panels.MISSED}


def test_numbers_stand_on_the_far_side_of_each_pole(passing):
    notes = drawn(gate_panels.draw_poles, passing).texts
    assert [note.get_text() for note in notes] == ["1", "2", "3", "4", "5"]
    for note, side in zip(notes, passing.gates.side, strict=True):
        assert np.sign(note.xyann[1]) == side, "a pole to the left of the skis has its number further left"


def test_distances_are_drawn_beside_what_was_asked_and_what_was_free(passing):
    axes = drawn(gate_panels.draw_gates, passing)
    places, colors = markers(axes, "o")
    order = np.argsort(places[:, 0])
    np.testing.assert_array_equal(places[order], [(1, 0.52), (2, 0.49), (4, 0.5)])
    assert [colors[i] for i in order] == [style.LEFT, style.RIGHT, style.RIGHT]
    asked = np.array(axes.collections[0].get_segments())
    np.testing.assert_array_equal(asked[:, :, 1], np.full((COUNT, 2), 0.5))
    np.testing.assert_allclose(asked[:, :, 0].mean(axis=1), np.arange(1, COUNT + 1))
    assert [bar.get_height() for bar in axes.patches] == [0.3, 0.28, 0.0, 0.31, 0.0]
    assert axes.get_title(loc="left") == "Gates: 3 of 5 passed, distance of the pole"


def test_missed_gates_are_marked_and_named(passing):
    axes = drawn(gate_panels.draw_gates, passing)
    places, _ = markers(axes, "X")
    np.testing.assert_array_equal(places, [(3, 0), (5, 0)])
    assert "missed" in [text.get_text() for text in axes.get_legend().get_texts()]


def test_gates_in_order_have_nothing_missed_in_the_legend(passing):
    good = GatePassing(passing.gates, np.full(COUNT, 0.5), np.full(COUNT, 0.3))
    axes = drawn(gate_panels.draw_gates, good)
    assert "missed" not in [text.get_text() for text in axes.get_legend().get_texts()]
    assert axes.get_ylim()[0] == 0.0


def test_of_many_gates_some_are_numbered():
    count = 200
    gates = Gates(np.zeros((count, 3)), np.ones(count, dtype=np.int8), np.ones(count))
    many = GatePassing(gates, np.ones(count), np.where(np.arange(count) == 7, -1.0, 0.5))
    assert len(drawn(gate_panels.draw_gates, many).get_xticks()) == 40
    notes = [note.get_text() for note in drawn(gate_panels.draw_poles, many).texts]
    assert len(notes) == 41 and "8" in notes, "missed gates are always named"


@pytest.mark.parametrize(("length", "width", "factor"), [(230, 3.3, 5), (230, 15, 2), (230, 60, 1), (40, 0, 5)])
def test_long_and_narrow_courses_are_drawn_wider(length, width, factor):
    track = np.array([[0.0, 0.0, 0.0], [length, width, 0.0]])
    assert gate_panels.widening(track) == factor
