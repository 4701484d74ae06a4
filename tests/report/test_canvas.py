"""The canvas: what is covered, by how much, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.report.canvas import Canvas, rgb, width_of

BLACK = "#000000"


def ink(canvas):
    """How dark every pixel of a white canvas is, 0 to 1."""
    return 1.0 - canvas.pixels()[..., 0].astype(float)


def test_pixels_are_opaque_and_in_the_colour_asked_for():
    pixels = Canvas(30, 20, "#0072B2").pixels()
    assert pixels.shape == (20, 30, 4) and pixels.dtype == np.float32
    np.testing.assert_allclose(pixels[3, 5], [*rgb("#0072B2"), 1.0])


def test_rectangle_covers_pixels_by_their_share():
    canvas = Canvas(10, 10)
    canvas.rectangle((2.0, 3.5, 5.25, 6.0), BLACK)
    dark = ink(canvas)
    assert dark.sum() == pytest.approx(3.25 * 2.5, abs=1e-5)
    assert dark[3, 2] == pytest.approx(0.5) and dark[4, 5] == pytest.approx(0.25)


def test_rectangles_outside_are_no_trouble():
    canvas = Canvas(10, 10)
    canvas.rectangle((-50.0, -3.0, -1.0, 30.0), BLACK)
    canvas.rectangle((12.0, 2.0, 30.0, 4.0), BLACK)
    assert not ink(canvas).any()


@pytest.mark.parametrize("angle", np.radians([0.0, 17.0, 45.0, 80.0, 90.0]))
def test_line_has_the_area_of_its_length_and_width(angle):
    canvas = Canvas(220, 220)
    way = np.array([np.cos(angle), np.sin(angle)])
    canvas.lines([np.array([110.0 - 90.0 * way, 110.0 + 90.0 * way])], 4.0, BLACK)
    assert ink(canvas).sum() == pytest.approx(180.0 * 4.0 + np.pi * 4.0, rel=0.02)


def test_line_is_the_same_however_it_is_cut():
    whole, cut = Canvas(100, 40), Canvas(100, 40)
    whole.lines([np.array([[5.0, 9.0], [90.0, 31.0]])], 2.0, BLACK)
    cut.lines([np.linspace([5.0, 9.0], [90.0, 31.0], 77)], 2.0, BLACK)
    np.testing.assert_allclose(ink(whole), ink(cut), atol=1e-5)


def test_crossing_lines_of_one_call_are_not_darker():
    canvas = Canvas(40, 40)
    canvas.lines(
        [np.array([[5.0, 20.0], [35.0, 20.0]]), np.array([[20.0, 5.0], [20.0, 35.0]])], 3.0, BLACK, opacity=0.5
    )
    assert ink(canvas).max() == pytest.approx(0.5, abs=1e-5)


def test_dashes_leave_their_share_out():
    canvas = Canvas(220, 20)
    canvas.lines([np.array([[10.0, 10.0], [210.0, 10.0]])], 2.0, BLACK, dash=(6.0, 4.0))
    middle = ink(canvas)[10, 20:200]
    assert middle.mean() == pytest.approx(0.7, abs=0.12)  # round ends make dashes longer
    assert middle.min() < 0.05


def test_nothing_is_drawn_outside_the_clip():
    canvas = Canvas(60, 60)
    canvas.lines([np.array([[-500.0, -480.0], [900.0, 920.0]])], 5.0, BLACK, clip=(20.0, 20.0, 50.0, 45.0))
    dark = ink(canvas)
    assert dark[20:45, 20:50].any()
    dark[20:45, 20:50] = 0.0
    assert not dark.any()


def test_dot_is_round():
    canvas = Canvas(41, 41)
    canvas.lines([np.array([[20.5, 20.5]])], 20.0, BLACK)
    dark = ink(canvas)
    assert dark.sum() == pytest.approx(np.pi * 100.0, rel=0.01)
    np.testing.assert_allclose(dark, dark.T, atol=1e-6)


def test_band_fills_between_curves_in_either_order():
    x = np.array([10.0, 50.0])
    one, other = Canvas(60, 60), Canvas(60, 60)
    one.band(x, np.array([20.0, 20.0]), np.array([30.0, 40.0]), BLACK, 1.0, (0.0, 0.0, 60.0, 60.0))
    other.band(x, np.array([30.0, 40.0]), np.array([20.0, 20.0]), BLACK, 1.0, (0.0, 0.0, 60.0, 60.0))
    assert ink(one).sum() == pytest.approx(600.0, rel=0.01)
    np.testing.assert_array_equal(ink(one), ink(other))


def test_text_is_where_it_is_aligned():
    wide = width_of("HHHH", 20.0)
    for align, low in (("left", 100.0), ("center", 100.0 - 0.5 * wide), ("right", 100.0 - wide)):
        canvas = Canvas(220, 60)
        canvas.text((100.0, 40.0), "HHHH", 20.0, BLACK, align=align)
        columns = np.flatnonzero(ink(canvas).sum(axis=0) > 0.1)
        assert columns[0] == pytest.approx(low, abs=2.5) and columns[-1] == pytest.approx(low + wide, abs=2.5)
        rows = np.flatnonzero(ink(canvas).sum(axis=1) > 0.1)
        assert (rows[0], rows[-1]) == pytest.approx((20.0, 40.0), abs=2.0)


def test_bold_text_has_more_ink_and_is_as_wide():
    thin, bold = Canvas(300, 40), Canvas(300, 40)
    ends = [canvas.text((10.0, 30.0), "Speed", 12.0, BLACK, bold=canvas is bold) for canvas in (thin, bold)]
    assert ends[0] == ends[1]
    assert ink(bold).sum() > 1.3 * ink(thin).sum()
