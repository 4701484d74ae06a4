"""Courses by rhythm: swings laid on the ground, the rows that ask for them, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.course import LEFT, RIGHT, build_track
from ski_addon.course.rhythm import build_rhythm_track
from ski_addon.errors import PlanInfeasible, SkiAddonError, SpecError
from ski_addon.spec import RunSpec, estimate, find_document
from ski_addon.terrain import build_terrain
from ski_addon.turning.preview import preview_course
from ski_addon.turning.rhythm import rhythm_targets, run_rhythm

PRESETS = ("falling_frequency", "rising_sharpness", "changing_heading")
SWING = {"time": 0, "period": 2.4, "sharpness_deg": 20}


def rhythm(*rows: dict, angle: float = 10.0, ground: str = "plane", **course) -> RunSpec:
    course = {"kind": "rhythm", "start_speed": 8, "target_speed": 9, **course}
    return RunSpec.from_dict(
        {"slope": {"angle_deg": angle, "kind": ground}, "course": course, "rhythm": list(rows or (SWING,))}
    )


def track_of(spec: RunSpec):
    return build_track(spec, build_terrain(spec.slope))


def refused(spec: RunSpec) -> str:
    with pytest.raises(SkiAddonError) as caught:
        build_track(spec, build_terrain(spec.slope))
    line = str(caught.value)
    assert "\n" not in line and len(line) < 330
    return line


def test_rows_are_keys_over_time():
    spec = rhythm(SWING, {"time": 4, "sharpness_deg": 30}, {"time": 8, "period": 1.4}, rhythm_duration=10)
    targets = rhythm_targets(spec, step=1.0)
    assert len(targets.sharpness) == 11
    np.testing.assert_allclose(np.rad2deg(targets.sharpness[:5, 0]), [20, 22.5, 25, 27.5, 30])
    np.testing.assert_allclose(2 * np.pi / targets.frequency[[0, 4, 8, 10], 0], [2.4, 1.9, 1.4, 1.4])
    np.testing.assert_allclose(targets.heading, 0.0)


def test_duration_is_a_swing_past_the_last_row_and_four_swings_at_least():
    for spec, seconds in ((rhythm(), 9.6), (rhythm(SWING, {"time": 20, "period": 3}), 23.0)):
        assert estimate(spec).simulated_seconds == pytest.approx(seconds)
        assert preview_course(spec).motion.duration == pytest.approx(seconds, abs=0.02)
    assert preview_course(rhythm(rhythm_duration=7)).motion.duration == pytest.approx(7.0, abs=0.02)


@pytest.mark.parametrize("first", ["left", "right"])
def test_turns_alternate_from_the_asked_side(first):
    track = track_of(rhythm(first_turn=first, entry="turn"))
    sides = track.phase[np.flatnonzero(np.diff(np.where(track.phase == 0, 0, track.turn), prepend=0) > 0)]
    side = LEFT if first == "left" else RIGHT
    np.testing.assert_array_equal(sides, side * np.where(np.arange(len(sides)) % 2, -1, 1))
    assert len(sides) >= 7


@pytest.mark.parametrize("ground", ["plane", "bumps", "moguls"])
def test_the_track_is_on_the_ground_and_smooth(ground):
    spec = rhythm(ground=ground)
    terrain = build_terrain(spec.slope)
    track = build_rhythm_track(spec, terrain)
    np.testing.assert_allclose(track.position[:, 2], terrain.height(*track.position[:, :2].T), atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(track.tangent, axis=1), 1.0, atol=1e-12)
    np.testing.assert_allclose(np.sum(track.tangent * track.surface_normal, axis=1), 0.0, atol=1e-9)
    if ground == "plane":
        moved = np.gradient(track.position, track.arc_length, axis=0)
        np.testing.assert_allclose(moved[2:-2], track.tangent[2:-2], atol=1e-3)
        assert np.abs(np.gradient(track.curvature, track.arc_length)).max() < 0.15, "no corner in the curvature"


def test_the_track_is_where_the_swinging_body_goes():
    """Rounding the corners of the curvature moves the track by millimetres."""
    spec = rhythm()
    run = run_rhythm(spec, np.deg2rad(10.0)).run
    track = track_of(spec)
    down = track.position[:, 0] / np.cos(np.deg2rad(10.0))
    left = np.interp(run.down[50:-50, 0], down, track.position[:, 1])
    np.testing.assert_allclose(left, run.left[50:-50, 0], atol=0.02)


def test_heading_is_where_the_swings_lead():
    for heading in (-15.0, 25.0):
        rows = ({**SWING, "heading_deg": heading},)
        motion = preview_course(rhythm(*rows, rhythm_duration=24)).motion
        late = motion.time > 12
        way = np.ptp(motion.position[late][:, :2], axis=0) * np.sign(
            np.diff(motion.position[late][[0, -1], :2], axis=0)
        )
        angle = np.rad2deg(np.arctan2(way[0, 1], way[0, 0] / np.cos(np.deg2rad(10.0))))
        assert angle == pytest.approx(heading, abs=3.0)


@pytest.mark.parametrize("name", PRESETS)
def test_the_preview_keeps_the_rhythm(name):
    preview = preview_course(RunSpec.from_toml(find_document(name)))
    assert preview.problem is None
    crossings = preview.motion.time[1:][np.diff(np.sign(preview.motion.lean)) != 0]
    assert len(crossings) > 8
    if name == "falling_frequency":
        assert np.diff(crossings)[-1] > 1.5 * np.diff(crossings)[1]
    if name == "rising_sharpness":
        assert np.rad2deg(np.abs(preview.motion.lean)).max() > 34


def test_mirrored_rhythm_is_mirrored():
    left, right = (track_of(rhythm(first_turn=side)) for side in ("left", "right"))
    np.testing.assert_allclose(left.position * [1, -1, 1], right.position, atol=1e-9)


# -- what is refused ---------------------------------------


def test_rows_are_asked_for_and_must_be_in_order():
    none = RunSpec.from_dict({"course": {"kind": "rhythm"}})
    with pytest.raises(SpecError, match=r"rhythm has no rows.*add \[\[rhythm\]\] rows"):
        track_of(none)
    line = refused(rhythm({"time": 3}, {"time": 3}))
    assert line.startswith("rhythm 2: time = 3") and "order of time" in line


def test_a_body_without_speed_cannot_be_steered():
    line = refused(rhythm(start_speed=0))
    assert line.startswith("course.start_speed = 0") and "1 m/s" in line


def test_an_ellipse_beyond_the_curvature_bound_names_the_bound_and_what_works():
    spec = rhythm(SWING, {"time": 8, "period": 1.0, "sharpness_deg": 40}, target_speed=8)
    line = refused(spec)
    assert "rhythm 1 (" in line and "course.tightest_radius" in line or "course.steering_rate" in line
    preview = preview_course(spec)
    assert str(preview.problem) == line and 2.0 < preview.motion.duration < 8.0, "what could be skied is kept"


def test_steering_faster_than_its_bound_is_refused_with_a_lean_that_works():
    line = refused(rhythm({"time": 0, "period": 1.2, "sharpness_deg": 20}, steering_rate=0.3))
    assert "more than course.steering_rate = 0.3" in line and "(lean " in line


def test_a_heading_that_is_never_reached_names_the_place():
    rows = ({"time": 0, "period": 1.2, "sharpness_deg": 4, "heading_deg": 0}, {"time": 2, "heading_deg": 75})
    spec = rhythm(*rows, rhythm_duration=20, angle=15)
    line = refused(spec)
    assert "degrees off" in line and "rhythm 2 (" in line
    assert preview_course(spec).motion.duration > 2.0


def test_friction_that_stops_the_body_is_named_and_the_part_before_it_is_kept():
    spec = RunSpec.from_dict(
        {
            "slope": {"angle_deg": 3},
            "snow": {"friction": 0.2},
            "course": {"kind": "rhythm", "start_speed": 6, "rhythm_duration": 20},
            "rhythm": [SWING],
        }
    )
    with pytest.raises(PlanInfeasible, match="at 1.9 m/s needs turns of .* ski faster"):
        track_of(spec)
    assert 1.0 < preview_course(spec).motion.duration < 19.0
