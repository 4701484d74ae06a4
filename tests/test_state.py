"""What objects remember is taken out and put back by name."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.state import StateError, put_state, take_state


class Part:
    STATE = ("place", "word")

    def __init__(self):
        self.place, self.word, self.scratch = np.zeros(2), None, 7


class Whole:
    STATE = ("part", "count")

    def __init__(self):
        self.part, self.count = Part(), 0


def changed():
    whole = Whole()
    whole.part.place[:], whole.part.word, whole.part.scratch, whole.count = (1.0, 2.0), "left", 8, 3
    return whole


def test_state_goes_over_into_another_object_and_scratch_does_not():
    whole, view = Whole(), None
    view = whole.part.place
    put_state(whole, take_state(changed()))
    assert (whole.count, whole.part.word, whole.part.scratch) == (3, "left", 7)
    assert view.tolist() == [1.0, 2.0], "arrays are written in place"


def test_what_was_taken_does_not_change_with_the_object():
    whole = changed()
    state = take_state(whole)
    whole.part.place[:] = 9.0
    assert state["part.place"].tolist() == [1.0, 2.0] and list(state) == ["part.place", "part.word", "count"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"part.place": np.zeros(3)}, r"part.place is float64 \(3,\) instead of float64 \(2,\)"),
        ({"part.place": np.zeros(2, dtype=int)}, "part.place is int64"),
        ({"part.place": 1.0}, "part.place is of another kind"),
        ({"count": np.zeros(1)}, "count is of another kind"),
        ({"more": 1}, "more is missing or unknown"),
    ],
)
def test_state_of_another_kind_is_refused_and_nothing_changes(change, words):
    whole = Whole()
    with pytest.raises(StateError, match=words):
        put_state(whole, take_state(changed()) | change)
    assert whole.count == 0 and not whole.part.place.any()
