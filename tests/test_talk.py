"""What a summary says on a screen."""

from __future__ import annotations

import pytest

from ski_addon.talk import gate_words, summary_lines


def gates(distances, missed=()):
    """The keys of a summary about gates."""
    return {
        "gates": len(distances),
        "gates_passed": len(distances) - len(missed),
        "gates_missed": list(missed),
        "gate_distances_m": distances,
    }


@pytest.mark.parametrize(
    ("summary", "words"),
    [
        (gates([0.47, 0.5, 0.53]), "3 of 3 passed, 0.47 to 0.53 m from their poles"),
        (gates([0.5, 0.5, 0.1], [3]), "2 of 3 passed, 0.50 to 0.50 m from their poles; missed: 3"),
        (gates([0.5, None, None], [2, 3]), "1 of 3 passed, 0.50 to 0.50 m from their poles; not reached: 2, 3"),
        (
            gates([0.5, 0.2, 0.5, 0.1, *[None] * 4], [2, 4, 5, 6, 7, 8]),
            "2 of 8 passed, 0.50 to 0.50 m from their poles; missed: 2, 4; not reached: 5 to 8",
        ),
        (gates([None] * 4, [1, 2, 3, 4]), "0 of 4 passed; not reached: 1 to 4"),
    ],
)
def test_gates_are_counted_and_the_missed_ones_named(summary, words):
    assert gate_words(summary) == words


def test_only_gate_courses_have_a_line_about_gates():
    plain = {"duration_s": 12.0, "speed_max": 9.0}
    assert not any("gates" in line for line in summary_lines(plain))
    *others, last = summary_lines(plain | gates([0.5, 0.6]))
    assert others == summary_lines(plain)
    label, _, words = last.strip().partition(" ")
    assert (label, words.strip()) == ("gates", gate_words(gates([0.5, 0.6])))
    assert last.index("2 of 2") == others[0].index("12.00"), "the values stand below each other"
