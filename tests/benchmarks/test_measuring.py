"""Percentiles, samples and ratios to the calibration loop."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.measuring import Samples, Spent, in_turn, percentiles, spent


def test_percentiles_of_known_numbers():
    assert percentiles(np.arange(101.0)) == {"median": 50.0, "p99": 99.0}


def test_percentiles_of_one_number_are_that_number():
    assert percentiles([3.0]) == {"median": 3.0, "p99": 3.0}


def test_ratio_is_the_median_of_work_by_the_loop_around_it():
    samples = Samples()
    for wall, work, loop in ((9.0, 2.0, 1.0), (9.0, 8.0, 2.0), (9.0, 18.0, 3.0)):
        samples.add(wall, loop, work)
    assert samples.ratio == 4.0
    assert samples.row("a", "b", "s").median == 9.0


def test_without_work_the_wall_times_count():
    samples = Samples()
    samples.add([1.0, 2.0, 6.0], 0.5)
    assert samples.ratio == 4.0 and samples.all.tolist() == [1.0, 2.0, 6.0]


def test_share_counts_in_time_and_ratio():
    samples = Samples()
    samples.add_spent([Spent(2.0, 1.0)], 0.1)
    row = samples.row("bake", "a key", "us", 0.001)
    assert row.median == pytest.approx(2000.0) and row.ratio == pytest.approx(0.01)


def test_rate_is_amount_by_time_and_its_p99_the_slow_end():
    samples = Samples()
    for seconds in (1.0, 2.0, 4.0):
        samples.add(seconds, 1.0)
    row = samples.rate_row("files", "write", "MB/s", 8.0)
    assert row.median == 4.0 and 2.0 <= row.p99 < 2.1 and row.ratio == 2.0


def test_over_another_is_the_median_over_the_rounds():
    one, other = Samples(), Samples()
    for mine, theirs in ((2.0, 1.0), (9.0, 3.0), (8.0, 2.0)):
        one.add(2 * mine, 1.0, mine)
        other.add(theirs, 1.0)
    assert one.over(other) == 3.0 and one.wall_over(other) == 6.0


def test_spent_returns_what_the_function_returns():
    found, took = spent(lambda: "found")
    assert found == "found" and took.wall > 0.0 and took.work >= 0.0


def test_functions_are_called_in_turn():
    called = []
    samples = in_turn({"a": lambda: called.append("a"), "b": lambda: called.append("b")}, 3)
    assert called == ["a", "b"] * 3
    assert all(len(samples[name].all) == len(samples[name].loop) == 3 for name in "ab")
