"""Counting what is allocated."""

from __future__ import annotations

import sys
import tracemalloc

import numpy as np
import pytest

from benchmarks.allocations import WHOLE, ObjectCounter, peak_kib, step_allocations
from ski_addon.pipeline import make_plan
from tests.ski_runs import preset


class Thing:
    """Something that no free list keeps."""


def test_kept_things_are_counted():
    def make():
        return [Thing() for _ in range(200)]

    found, count = ObjectCounter().count(make)
    assert len(found) == 200 and 200 <= count < 3000


def test_things_that_are_dropped_at_once_are_counted_too():
    def make():
        for _ in range(200):
            Thing()

    assert ObjectCounter().count(make)[1] >= 200


def test_nothing_allocates_nothing():
    assert ObjectCounter().count(lambda: None)[1] <= 3


def test_tracing_ends_with_the_call():
    before = sys.gettrace()
    with pytest.raises(ZeroDivisionError):
        ObjectCounter().count(lambda: 1 // 0)
    assert sys.gettrace() is before


def test_peak_sees_arrays_that_are_gone_at_the_end():
    tracemalloc.start()
    try:
        _, kib = peak_kib(lambda: float(np.ones(100_000).sum()))
    finally:
        tracemalloc.stop()
    assert 700 < kib < 1000


def test_stages_of_a_step_are_parts_of_the_whole():
    planned = make_plan(preset("paper_main", {"course.turn_count": 1, "course.turn_duration": 0.5}))
    found = step_allocations(planned, steps=2, warm_up=3)
    whole = found.pop(WHOLE)
    assert found and whole.objects > 0 and whole.kib > 0
    assert sum(one.objects for one in found.values()) < 1.2 * whole.objects
