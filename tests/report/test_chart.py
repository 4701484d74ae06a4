"""One plot: its ticks, its scale, and what happens with values that are no numbers."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.report.canvas import Canvas
from ski_addon.report.chart import Chart, number, ticks, value_range

BOX = (50.0, 40.0, 250.0, 140.0)


@pytest.mark.parametrize(
    ("low", "high", "most", "expected"),
    [
        (0.0, 10.0, 5, [0, 2, 4, 6, 8, 10]),
        (-42.0, 42.0, 5, [-40, -20, 0, 20, 40]),
        (0.0, 31.3, 9, [0, 5, 10, 15, 20, 25, 30]),
        (0.501, 0.559, 3, [0.52, 0.54]),
    ],
)
def test_ticks_are_round(low, high, most, expected):
    np.testing.assert_allclose(ticks(low, high, most), expected, atol=1e-12)


def test_ticks_are_few_for_any_range():
    for power in range(-9, 9):
        for high in (1.0, 1.7, 3.3, 9.9):
            found = ticks(0.1 * 10.0**power, high * 10.0**power, 6)
            assert 1 <= len(found) <= 7
            assert len({number(value) for value in found}) == len(found)


def test_zero_has_no_sign():
    assert [number(value) for value in ticks(-1.0, 1.0, 4)] == ["-1", "-0.5", "0", "0.5", "1"]


def test_range_holds_finite_values_only():
    low, high = value_range(np.array([1.0, np.nan, 3.0]), np.array([np.inf, 2.0]))
    assert low < 1.0 and 3.0 < high < 4.0
    assert value_range(np.array([np.nan])) == pytest.approx((-0.08, 1.08))
    low, high = value_range(np.array([5.0, 5.0]), least=2.0)
    assert (low, high) == pytest.approx((4.0, 6.0))
    assert value_range(np.array([1.0, 2.0]), floor=0.0)[0] == 0.0


def test_coordinates_become_pixels():
    chart = Chart(Canvas(300, 180), BOX, (0.0, 10.0), (-1.0, 1.0))
    np.testing.assert_allclose(chart.place(5.0, 0.0), [150.0, 90.0])
    np.testing.assert_allclose(chart.place(np.array([0.0, 10.0]), 1.0), [[50.0, 40.0], [250.0, 40.0]])


def test_an_empty_range_is_widened():
    chart = Chart(Canvas(300, 180), BOX, (2.0, 2.0), (0.0, 0.0))
    np.testing.assert_allclose(chart.place(2.0, 0.0), [150.0, 90.0])


def test_curve_goes_where_its_values_are_and_leaves_out_what_is_no_number():
    canvas = Canvas(300, 180)
    chart = Chart(canvas, BOX, (0.0, 1.0), (0.0, 1.0))
    time = np.linspace(0.0, 1.0, 5000)
    values = np.full(5000, 0.25)
    values[100:200] = np.nan
    chart.curve(time, values, "#000000", width=2.0)
    rows = np.flatnonzero((canvas.pixels()[..., 0] < 0.5).any(axis=1))
    np.testing.assert_array_equal(rows, [114, 115])
    chart.curve(time, np.full(5000, np.nan), "#000000")
    chart.band(time, np.full(5000, np.nan), values, "#000000")


def test_a_peak_of_one_step_is_seen():
    canvas = Canvas(300, 180)
    values = np.zeros(60000)
    values[31234] = 0.9
    Chart(canvas, BOX, (0.0, 1.0), (0.0, 1.0)).curve(np.linspace(0.0, 1.0, 60000), values, "#000000")
    assert (canvas.pixels()[52:56, :, 0] < 0.8).any()
