"""The benchmark of crowds: what one process and two do is measured, and what a worker remembers."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchmarks import crowd as benchmark
from benchmarks.measuring import How


@pytest.fixture(scope="module")
def found():
    return benchmark.measure(rounds=1, repeats=1, turns=1)


def test_every_round_has_both(found):
    assert len(found.one) == len(found.two) == len(found.by_work) == 1
    assert found.one[0] > 0.0 and 0.5 < found.by_work[0] < 3.0  # processor time, whatever else runs


def test_memory_grows_with_a_run_and_not_with_the_number_of_runs(found):
    assert len(found.memory) == len(found.skied) == benchmark.MEMBERS
    assert found.long_memory > found.memory[0] and found.long_skied > 2.0 * found.skied[0]
    assert 0.0 < found.per_second < 20e6
    assert found.memory[-1] - found.memory[1] < 0.5 * found.per_second * (found.skied[-1] - found.skied[1])


def test_growth_is_that_after_the_first_members(found):
    made = replace(found, skied=[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], memory=[10, 20, 30, 40, 45, 50])
    assert made.growth == pytest.approx(5.0)
    assert replace(found, long_skied=found.skied[0] + 2.0, long_memory=found.memory[0] + 8).per_second == pytest.approx(
        4
    )


def test_the_lines_tell_all_of_it(found, monkeypatch):
    text = benchmark.table(found)
    assert "two by one, processor time" in text and f"{found.memory[-1] / 1e6:.1f}" in text
    monkeypatch.setattr(benchmark, "measure", lambda *_given: found)
    rows = benchmark.measurements(How(quick=True))
    assert {row.subject for row in rows} == {"crowd"} and not any(row.checked for row in rows)
    assert rows[1].peer_ratio == pytest.approx(found.one[0] / found.two[0])
