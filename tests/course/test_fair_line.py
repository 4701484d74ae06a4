"""The smoothest line past poles: it keeps its distances, and nothing near it is smoother."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from benchmarks.gate_lines import Curve, half_angle, half_chord, paper_line, quickest
from ski_addon.course.fair_line import Poles, fair_line, turning_curvature
from tests.course.gate_courses import even_poles, pole_gaps


def line_past(poles: Poles):
    gaps = np.diff(poles.down)
    return fair_line(poles, 1.5 * gaps[0], 1.5 * gaps[-1])


def uneven_poles(seed: int) -> Poles:
    rng = np.random.default_rng(seed)
    poles = even_poles(12)
    down = poles.down + rng.uniform(-1, 1, 12)
    return dataclasses.replace(poles, down=down, left=poles.left * rng.uniform(0.7, 1.5, 12))


@pytest.mark.parametrize("seed", range(4))
def test_every_pole_is_passed_at_its_distance_on_its_side(seed):
    poles = dataclasses.replace(uneven_poles(seed), distance=np.linspace(0.3, 0.8, 12))
    line = line_past(poles)
    assert line.settled
    down, left, curvature = line.sampled(0.005)
    np.testing.assert_allclose(pole_gaps(down, left, poles), poles.distance, atol=2e-5)
    at = np.interp(poles.down, down, left)
    assert np.all(poles.side * (poles.left - at) > 0.0)  # a pole to be passed turning left stands to the left
    assert np.all(poles.side * np.interp(line.apex, down, curvature) > 0.0)


def test_geometry_is_consistent():
    """Heading and curvature by finite differences of the places."""
    down, left, curvature = line_past(uneven_poles(1)).sampled(0.02)
    arc = Curve(down, left, curvature).arc
    heading = np.arctan2(np.gradient(left, arc), np.gradient(down, arc))
    np.testing.assert_allclose(np.gradient(heading, arc)[3:-3], curvature[3:-3], atol=2e-4)
    assert np.diff(arc).max() < 0.022 and np.diff(arc).min() > 0.017


def test_curvature_and_its_rate_are_continuous():
    """The largest step of each halves with the spacing of the samples."""
    line = line_past(uneven_poles(2))
    for order in (1, 2):
        steps = [np.abs(np.diff(line.sines(np.arange(line.begin, line.end, h), order))).max() for h in (0.02, 0.01)]
        assert steps[1] < 0.55 * steps[0]


def test_starts_and_ends_straight_down_the_fall_line_between_its_turns():
    poles = even_poles(8)
    line = line_past(poles)
    ends = np.array([line.begin, line.end])
    np.testing.assert_allclose(line.sines(ends), 0.0, atol=1e-14)
    np.testing.assert_allclose(line.sines(ends, 1), 0.0, atol=1e-14)
    _, left, _ = line.sampled(0.05)
    np.testing.assert_allclose((left[0], left[-1]), 0.0, atol=1e-8)


def test_mirrored_poles_have_the_mirrored_line():
    poles = uneven_poles(3)
    mirrored = dataclasses.replace(poles, left=-poles.left, side=-poles.side)
    one, other = line_past(poles), line_past(mirrored)
    places = np.linspace(one.begin, one.end, 500)
    np.testing.assert_allclose(one.sines(places), -other.sines(places), atol=1e-8)


def roughness(line) -> float:
    """Integral of the squared rate of change of curvature over the arc length."""
    places = np.linspace(line.begin, line.end, 20001)
    cosine = np.sqrt(1.0 - line.sines(places) ** 2)
    return float(np.sum(line.sines(places, 2) ** 2 * cosine) * (places[1] - places[0]))


def test_a_line_with_less_freedom_is_rougher():
    """Asking for other radii than the line chooses by itself makes it change more quickly."""
    poles = even_poles(8)
    free = line_past(poles)
    natural = 1.0 / np.abs(free.sines(free.apex, 1))
    for factor in (0.8, 1.15):
        asked = line_past(dataclasses.replace(poles, radius=factor * natural))
        assert roughness(asked) > 1.05 * roughness(free)


@pytest.mark.parametrize("radius", [4.0, 6.0, 7.5])
def test_asked_radius_is_the_tightest_place_of_its_turn(radius):
    poles = even_poles(6, radius=radius)
    line = line_past(poles)
    assert line.settled
    np.testing.assert_allclose(1.0 / np.abs(line.sines(line.apex, 1)), radius, rtol=2e-3)
    down, left, curvature = line.sampled(0.005)
    assert 1.0 / np.abs(curvature).max() > 0.98 * radius
    np.testing.assert_allclose(pole_gaps(down, left, poles), 0.5, atol=2e-5)


def test_tight_turns_have_straight_runs_between_them():
    """Curvature falls away from a turn and does not swing to the other side before the next."""
    poles = even_poles(6, spacing=20.0, radius=4.0)
    line = line_past(poles)
    middles = 0.5 * (line.apex[1:] + line.apex[:-1])
    assert np.abs(line.sines(middles[1:-1], 1)).max() < 0.08 / 4.0
    for k in range(1, 4):
        half = np.linspace(line.apex[k] + 0.5, middles[k], 100)
        assert np.diff(poles.side[k] * line.sines(half, 1)).max() < 1e-3


def test_radius_larger_than_fits_shows_as_tighter_places_elsewhere():
    line = line_past(even_poles(6, radius=12.0))
    _, _, curvature = line.sampled(0.02)
    assert 1.0 / np.abs(curvature).max() < 0.9 * 12.0


def test_bends_before_the_first_turn_and_after_the_last_are_left_out_of_turns():
    poles = even_poles(4)
    line = line_past(poles)
    places = np.linspace(line.begin, line.end, 2000)
    turning, all_of_it = turning_curvature(poles, line, places), line.sines(places, 1)
    inside = (places > line.apex[0]) & (places < line.apex[-1])
    np.testing.assert_array_equal(turning[inside], all_of_it[inside])
    assert all_of_it[places < line.apex[0]].min() < -0.01 and turning[places < line.apex[0]].min() == 0.0


# -- the paper's line, to compare ---------------------------------------------


@pytest.mark.parametrize(
    ("radius", "distance", "chord", "degrees"), [(15, 1, 5.39, 21.0), (15, 2, 7.48, 29.9), (10, 1, 4.36, 25.8)]
)
def test_claim_25_arcs_of_the_paper(radius, distance, chord, degrees):
    assert half_chord(radius, distance) == pytest.approx(chord, abs=0.006)
    assert np.degrees(half_angle(radius, distance)) == pytest.approx(degrees, abs=0.06)
    assert radius * np.sin(half_angle(radius, distance)) == pytest.approx(half_chord(radius, distance))


def test_claim_25_apex_is_at_the_distance_and_the_arc_ends_beside_the_pole():
    poles = dataclasses.replace(even_poles(2, spacing=30.0, offset=4.0), distance=np.full(2, 1.0))
    curve = paper_line(poles, 15.0)
    np.testing.assert_allclose(pole_gaps(curve.down, curve.left, poles), 1.0, atol=1e-3)
    assert curve.left[0] == pytest.approx(poles.left[0], abs=1e-9)  # on the line down the slope through the pole
    assert poles.down[0] - curve.down[0] == pytest.approx(5.39, abs=0.006)


@pytest.mark.parametrize(("spacing", "offset", "distance"), [(10.0, 2.0, 0.5), (24.0, 4.5, 1.0)])
def test_line_changes_curvature_several_times_less_quickly_than_the_papers(spacing, offset, distance):
    poles = dataclasses.replace(even_poles(10, spacing, offset), distance=np.full(10, distance))
    down, left, curvature = line_past(poles).sampled(0.05)
    tightest = 1.0 / np.abs(curvature).max()
    assert quickest(Curve(down, left, curvature)) < 0.25 * quickest(paper_line(poles, tightest))


def test_edge_change_of_a_slalom_takes_half_a_second_at_12_m_s():
    """From one turn's tightest place to the next one's by the quickest rate there is."""
    line = line_past(even_poles(10))
    places = np.linspace(line.begin, line.end, 5000)
    rate = np.abs(line.sines(places, 2)) * np.sqrt(1.0 - line.sines(places) ** 2)
    change = 2.0 * np.abs(line.sines(places, 1)).max()
    assert change / rate.max() / 12.0 > 0.5
