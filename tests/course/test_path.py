"""Drawn paths: what is smoothed, what stays, what is refused."""

from __future__ import annotations

import re

import numpy as np
import pytest

from ski_addon.course import LEFT, RIGHT, build_track
from ski_addon.course.path import curvature_limit
from ski_addon.course.smoothing import curvature, interpolated, smoothed, smoothed_to
from ski_addon.errors import SpecError
from ski_addon.spec import RunSpec, find_document
from ski_addon.terrain import build_terrain

WAVES = [(12.0 * k, 4.0 * (-1) ** k if 0 < k < 8 else 0.0) for k in range(9)]


def drawn(points, angle: float = 12.0, **course) -> RunSpec:
    rows = [{"x": float(x), "y": float(y)} for x, y in points]
    return RunSpec.from_dict({"slope": {"angle_deg": angle}, "course": {"kind": "path", **course}, "point": rows})


def track_of(spec: RunSpec):
    return build_track(spec, build_terrain(spec.slope))


def plan_view(track, angle: float = 12.0) -> np.ndarray:
    return np.stack((track.position[:, 0] / np.cos(np.radians(angle)), track.position[:, 1]), axis=1)


def gap(track, point) -> float:
    return float(np.min(np.linalg.norm(plan_view(track) - np.array(point), axis=1)))


def refused(spec: RunSpec, terrain: object = None) -> str:
    with pytest.raises(SpecError) as caught:
        build_track(spec, terrain or build_terrain(spec.slope))
    line = str(caught.value)
    assert "\n" not in line and len(line) < 300
    return line


# -- smoothing ---------------------------------------------


def test_smoothing_leaves_parabolas_and_takes_away_short_bends():
    """The filter's answer to a wave of number k is 1 / (1 + (k length)^6)."""
    x = np.arange(0.0, 80.0, 0.1)
    parabola = np.stack((x, 0.001 * x**2), axis=1)
    np.testing.assert_allclose(smoothed(parabola, 3.0)[:, 1], parabola[:, 1], atol=2e-3)
    for wave in (6.0, 12.0, 24.0):
        path = np.stack((x, 0.01 * np.sin(2 * np.pi * x / wave)), axis=1)
        inside = slice(200, -200)
        share = np.ptp(smoothed(path, 2.0)[inside, 1]) / 0.02
        assert share == pytest.approx(1.0 / (1.0 + (2.0 * 2 * np.pi / wave) ** 6), abs=0.02)


def test_smoothing_holds_both_ends():
    path = interpolated(np.array(WAVES))
    np.testing.assert_allclose(smoothed(path, 8.0)[[0, -1]], path[[0, -1]], atol=0.02)


def test_curvature_of_a_circle():
    angle = np.linspace(0.0, 2.0, 401)
    circle = 20.0 * np.stack((np.sin(angle), 1.0 - np.cos(angle)), axis=1)
    np.testing.assert_allclose(curvature(circle)[3:-3], 1.0 / 20.0, rtol=1e-4)


def test_interpolated_path_goes_through_its_points_at_even_steps():
    path = interpolated(np.array(WAVES))
    for point in WAVES:
        assert np.min(np.linalg.norm(path - np.array(point), axis=1)) < 0.06
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    assert steps.max() / steps.min() < 1.01 and steps.max() < 0.101


def test_smoothing_grows_only_where_it_must():
    """One tight wiggle in a gentle path: the gentle part stays in its place."""
    x = np.arange(0.0, 120.0, 0.1)
    y = 5.0 * np.sin(x / 15.0) + 1.5 * np.sin(x) * np.exp(-(((x - 60.0) / 4.0) ** 2))
    path = np.stack((x, y), axis=1)
    result = smoothed_to(path, 0.1)
    assert np.abs(curvature(result)).max() <= 0.1
    far = np.abs(x - 60.0) > 30.0
    assert np.linalg.norm(result - path, axis=1)[far].max() < 0.02
    assert np.linalg.norm(result - path, axis=1).max() > 0.5


# -- the track ---------------------------------------------


def test_slow_path_goes_through_its_points_and_turns_where_they_say():
    track = track_of(drawn(WAVES, start_speed=3))
    assert max(gap(track, point) for point in WAVES) < 0.15
    assert track.turn.max() == 7
    at = [int(np.argmin(np.linalg.norm(plan_view(track) - np.array(p), axis=1))) for p in WAVES[1:-1]]
    assert track.phase[at].tolist() == [LEFT, RIGHT] * 3 + [LEFT]


@pytest.mark.parametrize("speed", [6.0, 9.0, 12.0])
def test_faster_path_is_smoothed_to_what_the_lean_allows(speed):
    spec = drawn(WAVES, start_speed=speed)
    track = track_of(spec)
    limit = curvature_limit(spec)
    assert limit == pytest.approx(min(9.81 * np.tan(np.radians(45)) / speed**2, 1.0 / 3.0))
    assert np.abs(track.curvature).max() < 1.03 * limit
    assert gap(track, WAVES[0]) < 0.05 and gap(track, WAVES[-1]) < 0.05


def test_speed_to_hold_comes_before_the_start_speed():
    held = drawn(WAVES, start_speed=3, target_speed=9)
    assert curvature_limit(held) == curvature_limit(drawn(WAVES, start_speed=9)) < curvature_limit(drawn(WAVES))
    assert curvature_limit(drawn(WAVES, start_speed=0)) == pytest.approx(1.0 / 3.0)


def test_curvature_is_continuous():
    for name in ("drawn_path", "s_curve"):
        spec = RunSpec.from_toml(find_document(name))
        track = build_track(spec, build_terrain(spec.slope))
        assert np.abs(np.diff(track.curvature)).max() < 0.03 * np.abs(track.curvature).max()


def test_hand_drawn_noise_is_smoothed_away():
    rng = np.random.default_rng(3)
    x = np.arange(0.0, 120.0, 0.25)
    clean = 5.0 * np.sin(x / 9.0)
    track = track_of(drawn(zip(x, clean + rng.normal(0.0, 0.03, len(x)), strict=True), start_speed=8))
    view = plan_view(track)
    assert np.abs(np.interp(view[:, 0], x, clean) - view[:, 1])[40:-40].max() < 0.15
    assert 4 <= track.turn.max() <= 6  # the noise of the two ends may add one each


def test_repeated_points_are_one_point():
    twice = [point for point in WAVES for _ in range(3)]
    np.testing.assert_allclose(track_of(drawn(twice)).position, track_of(drawn(WAVES)).position, atol=1e-12)


def test_two_points_are_a_straight_run():
    track = track_of(drawn([(0, 0), (40, 10)]))
    assert track.length == pytest.approx(np.hypot(40, 10), abs=1e-6)
    assert np.abs(track.curvature).max() < 1e-6 and track.turn.max() == 1 and not track.phase.any()


def test_five_thousand_points_are_a_path():
    x = np.linspace(0.0, 1000.0, 5000)
    track = track_of(drawn(zip(x, 10.0 * np.sin(x / 20.0), strict=True), start_speed=8))
    assert track.length > 1000.0 and np.abs(track.curvature).max() < 0.16


# -- refusals ---------------------------------------------


@pytest.mark.parametrize("points", [[], [(3, 4)], [(3, 4), (3.0, 4.01)]])
def test_path_without_two_distinct_points(points):
    assert re.match(
        r"point is not a path: there (are no rows|is one row|are 2 rows, all in one place): add", refused(drawn(points))
    )


def test_path_that_crosses_itself_names_both_segments_and_the_place():
    line = refused(drawn([(0, 0), (30, 0), (35, 10), (20, -10), (50, -12)], angle=0))
    assert line.startswith("point 4 crosses the path: points 3-4 cross points 1-2 at x = 27.5, y = 0.0: ")


def test_path_uphill_names_the_point_how_far_and_what_would_work():
    line = refused(drawn([(0, 0), (20, 5), (12, 10), (40, 12)]))
    assert line == "point 3 goes uphill by 8.0 m, to x = 12.0, y = 10.0: x of at least 20.0 would work"
    track_of(drawn([(0, 0), (20, 5), (20, 10), (40, 12)]))


def test_path_off_the_terrain():
    class Strip:
        mean_angle, extent = 0.0, (-50.0, 200.0, -5.0, 5.0)

        def contains(self, x, y):
            return np.abs(y) <= 5.0

    line = refused(drawn([(0, 0), (20, 2), (40, 9), (60, 2)]), Strip())
    assert re.match(r"point [23] leaves the terrain at x = \d\d.\d, y = 5.0: ", line) and "from y = -5.0 to 5.0" in line


def test_asked_smoothing_that_leaves_too_tight_a_turn():
    zigzag = [(0, 0), (10, 0), (13, 8), (20, 8)]
    line = refused(drawn(zigzag, path_smoothing=0.3))
    assert re.match(r"point [23] makes a turn of [0-2]\.\d m radius, tighter than 3 m \(3.0 m\): use more", line), line
    track_of(drawn(zigzag, path_smoothing=3))
