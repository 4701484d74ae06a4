"""Counting instructions: what valgrind writes, and what is said without it."""

from __future__ import annotations

import pytest

from benchmarks import instructions
from benchmarks.measuring import NotMeasuredError


def test_sum_is_read_from_the_end_of_the_file():
    assert instructions.total("desc: x\nevents: Ir\nfn=a\n1 5\nsummary: 1234567\n") == 1234567


def test_file_without_a_sum_is_refused():
    with pytest.raises(NotMeasuredError, match="no sum"):
        instructions.total("events: Ir\n")


def test_the_start_is_taken_off_steps_and_loops():
    step, loop = instructions.rows(1_000_000, 1_000_000 + 40 * 5000, 1_000_000 + 200 * 100)
    assert step.median == 5.0 and loop.median == 0.1 and step.ratio == 50.0


def test_without_valgrind_a_line_says_so(monkeypatch):
    monkeypatch.setattr(instructions.shutil, "which", lambda name: None)
    with pytest.raises(NotMeasuredError, match="valgrind is not here"):
        instructions.instruction_rows()
