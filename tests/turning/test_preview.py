"""Instant motion of any course, against the plan and the track it stands for."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.course import build_track
from ski_addon.spec import RunSpec
from ski_addon.terrain import build_terrain
from ski_addon.turning.motion import TurningMotion
from ski_addon.turning.preview import preview_motion
from tests.ski_runs import PRESETS, planned, preset

ON_PLANES = {"giant_slalom": 0.5, "medium_carving": 0.5, "deep_carving": 0.7, "s_curve": 0.5, "short_turns": 1.2}
"""Preset -> how far [degrees, rms] the preview's lean may be from the plan's, whose legs bend."""


def previewed(name: str) -> TurningMotion:
    return preview_motion(preset(name))


@pytest.mark.parametrize("name", sorted(path.stem for path in PRESETS.glob("*.toml")))
def test_every_preset_has_a_preview(name):
    motion = previewed(name)
    for values in vars(motion).values():
        assert np.isfinite(values).all() and len(values) == len(motion.time)
    assert np.diff(motion.time) == pytest.approx(motion.time[1], rel=1e-9)
    assert np.abs(np.linalg.norm(motion.heading_direction, axis=1) - 1.0).max() < 1e-12
    assert np.abs(motion.lean).max() < np.deg2rad(75) and motion.leg_force.min() > 0.2


@pytest.mark.parametrize("name", ON_PLANES)
def test_preview_leans_and_runs_as_the_plan_does(name):
    plan, motion = planned(name).plan, previewed(name)
    lean = np.interp(plan.arc_length, motion.distance, motion.lean)
    assert np.rad2deg(np.sqrt(np.mean((lean - plan.inclination) ** 2))) < ON_PLANES[name]
    assert motion.duration == pytest.approx(plan.duration, rel=0.015)
    reached = np.interp(plan.arc_length, motion.distance, motion.time)
    assert np.abs(reached - plan.time).max() < 0.02 * plan.duration


def test_support_follows_the_track_with_its_curvature():
    spec = preset("giant_slalom")
    track, motion = build_track(spec, build_terrain(spec.slope)), previewed("giant_slalom")
    assert motion.distance[-1] == pytest.approx(track.length, rel=1e-4)
    places = np.stack([np.interp(motion.distance, track.arc_length, column) for column in track.position.T], axis=1)
    assert np.linalg.norm(places - motion.position, axis=1).max() < 0.02
    turned = np.cross(motion.heading_direction[:-1], motion.heading_direction[1:])
    rate = np.sum(turned * motion.surface_normal[1:], axis=1) / np.diff(motion.distance)
    between = 0.5 * (motion.curvature[1:] + motion.curvature[:-1])
    np.testing.assert_allclose(rate[2:-2], between[2:-2], atol=2e-3)


@pytest.mark.parametrize("name", ["giant_slalom", "moguls", "rolling_slalom"])
def test_skis_of_a_preview_do_not_slip_sideways(name):
    motion = previewed(name)
    step = np.diff(motion.position, axis=0)
    middle = 0.5 * (motion.heading_direction[1:] + motion.heading_direction[:-1])
    normal = 0.5 * (motion.surface_normal[1:] + motion.surface_normal[:-1])
    sideways = np.abs(np.sum(step * np.cross(normal, middle), axis=1))
    assert sideways.sum() <= 5e-3 * motion.distance[-1] and sideways.max() <= 5e-3 * np.linalg.norm(step, axis=1).max()


def test_run_that_stops_stands_at_the_end():
    motion = preview_motion(preset("giant_slalom", {"course.finish": "stop", "course.turn_count": 3}))
    assert motion.speed[-1] < 0.05 and motion.speed.max() > 5.0
    assert np.abs(motion.lean[-1]) < np.deg2rad(2.0)
    np.testing.assert_allclose(motion.heading_direction[-1, 1], 0.0, atol=0.05)


def test_run_from_rest_speeds_up():
    motion = preview_motion(preset("medium_carving", {"course.start_speed": 0}))
    assert motion.speed[0] < 0.1 and motion.speed.max() > 4.0


def test_mirrored_course_is_previewed_mirrored():
    one, other = (preview_motion(preset("short_turns", {"course.first_turn": side})) for side in ("left", "right"))
    np.testing.assert_allclose(one.lean, -other.lean, atol=1e-9)
    np.testing.assert_allclose(one.position[:, 1], -other.position[:, 1], atol=1e-9)
    np.testing.assert_allclose(one.leg_force, other.leg_force, atol=1e-9)


def test_friction_that_ends_a_run_ends_its_preview():
    spec = RunSpec.from_dict({"slope": {"angle_deg": 1.0}, "course": {"kind": "bumps", "run_length": 60}})
    motion = preview_motion(spec)
    assert motion.speed[-1] < 0.3 and motion.distance[-1] < 40.0
