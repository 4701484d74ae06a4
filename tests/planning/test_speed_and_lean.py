"""The ride and the lean of a plan belong together, however they were found."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.body import build_skier_model
from ski_addon.course import build_track
from ski_addon.gravity import GRAVITY
from ski_addon.planning import as_planned, build_stance
from ski_addon.planning.absorption import Sink, legs_for
from ski_addon.planning.line import TrackSpline
from ski_addon.planning.pendulum import balanced_pendulum
from ski_addon.planning.ride import Body, plan_ride
from ski_addon.planning.speed_and_lean import SpeedAndLean, speed_control
from ski_addon.snow import Snow
from ski_addon.terrain import build_terrain
from tests.ski_runs import MAIN, preset


def parts(name: str):
    spec = as_planned(preset(name, MAIN if name == "paper_main" else None))
    track, technique = build_track(spec, build_terrain(spec.slope)), spec.technique
    skeleton = build_skier_model(spec.skier).skeleton
    return spec, track, build_stance(skeleton, np.deg2rad(technique.knee_bend_deg), technique.tuck)


@pytest.mark.parametrize("name", ["paper_main", "moguls"])
def test_the_ride_of_a_body_that_leans_so_is_the_one_that_needs_this_lean(name):
    spec, track, stance = parts(name)
    line, pendulum = SpeedAndLean(spec, track, stance).found(Sink(track))
    snow = Snow.of(spec.snow, spec.skier, spec.technique.tuck)
    again = plan_ride(track, snow, Body(pendulum.normal, pendulum.swing, line.arc_length), speed_control(spec, track))
    speed = np.interp(line.arc_length, again.arc_length, again.speed)
    np.testing.assert_allclose(speed, line.speed, atol=3e-6)


def test_plain_rides_in_turn_end_at_the_same_speed():
    spec, track, stance = parts("paper_main")
    snow, spline, sink = Snow.of(spec.snow, spec.skier, spec.technique.tuck), TrackSpline(track), Sink(track)
    body = Body(-(track.surface_normal @ GRAVITY), np.zeros_like(track.arc_length), track.arc_length)
    for _ in range(12):
        line = spline.line(plan_ride(track, snow, body, speed_control(spec, track)), snow)
        pendulum = balanced_pendulum(line, legs_for(spec, line, stance, sink))
        body = Body(pendulum.normal, pendulum.swing, line.arc_length)
    found, _ = SpeedAndLean(spec, track, stance).found(sink)
    np.testing.assert_allclose(np.interp(found.arc_length, line.arc_length, line.speed), found.speed, atol=1e-6)


def test_what_was_found_for_one_depth_is_where_the_next_begins():
    spec, track, stance = parts("paper_main")
    from_before = SpeedAndLean(spec, track, stance)
    from_before.found(Sink(track))
    sink = Sink(track)
    sink.depth = sink.depth + 0.01
    line, pendulum = from_before.found(sink)
    other, fresh = SpeedAndLean(spec, track, stance).found(sink)
    np.testing.assert_allclose(np.interp(line.arc_length, other.arc_length, other.speed), line.speed, atol=2e-6)
    np.testing.assert_allclose(pendulum.h.min(), fresh.h.min(), atol=1e-6)
