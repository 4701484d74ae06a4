"""Courses that follow a path past obstacles: track, motion, and what is refused before any search."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ski_addon.course import build_track, ride_course
from ski_addon.course.follow_problem import LEAST_SPEED, obstacles_of
from ski_addon.errors import PlanInfeasible, SpecError
from ski_addon.spec import RunSpec, find_document
from ski_addon.terrain import build_terrain
from ski_addon.turning.following import DISC, LINE, POLYGON, body_on, follow
from ski_addon.turning.preview import preview_course

PATH = ((0, 0), (15, 1), (30, -1), (42, 0))
TREE = {"kind": DISC, "points": [[21, 0.2]], "radius": 0.3, "tolerance": 0.5, "name": "old fir"}


def course(*obstacles, points=PATH, angle: float = 10.0, **keys) -> RunSpec:
    rows = [{"x": float(x), "y": float(y)} for x, y in points]
    kept = {"kind": "follow", "start_speed": 7.0, "target_speed": 7.0, **keys}
    content = {"slope": {"angle_deg": angle}, "course": kept, "point": rows, "obstacle": list(obstacles)}
    return RunSpec.from_dict(content)


def track_of(spec: RunSpec):
    return build_track(spec, build_terrain(spec.slope))


def refused(spec: RunSpec, error: type = SpecError) -> str:
    with pytest.raises(error) as caught:
        track_of(spec)
    line = str(caught.value)
    assert "\n" not in line and len(line) <= 400 and caught.value.exit_code == 2
    return line


def test_track_goes_round_the_tree_on_the_path_and_ends_where_the_path_ends():
    spec = course(TREE)
    track = track_of(spec)
    down, left = track.position[:, 0] / np.cos(np.radians(10.0)), track.position[:, 1]
    gap = np.hypot(down - 21.0, left - 0.2).min()
    assert 0.8 - 0.04 < gap < 1.6 and abs(down[-1] - 42.0) < 1.0 and abs(left[-1]) < 1.0
    assert np.abs(track.curvature).max() < 1.1 / spec.course.plan_radius
    tangent = np.gradient(track.position, track.arc_length, axis=0)
    assert tangent[2:-2] == pytest.approx(track.tangent[2:-2], abs=2e-3)
    assert {-1, 0, 1} == set(track.phase.tolist())


def test_start_from_rest_runs_straight_until_there_is_speed_to_steer_with():
    spec = course(TREE, start_speed=0.0, angle=14.0)
    ride = ride_course(spec, build_terrain(spec.slope))
    slow = ride.speed < LEAST_SPEED - 0.01
    heading = ride.states[slow, 2]
    assert ride.stopped is None and ride.speed[0] < 0.05 and slow[:50].all() and np.ptp(heading) < 1e-9
    step = np.linalg.norm(np.diff(ride.states[:, :2], axis=0), axis=1) / np.diff(ride.time)
    assert step == pytest.approx(0.5 * (ride.speed[1:] + ride.speed[:-1]), abs=0.7)
    assert track_of(spec).length > 42.0


def test_traverse_begins_with_the_lean_that_is_balanced_there():
    spec = course(points=((0, 0), (15, 8), (30, 17)), angle=15.0)
    ride = ride_course(spec, build_terrain(spec.slope))
    assert ride.stopped is None and ride.states[0, 3] > 0.05  # into the hill, to the left... of a heading to the left
    assert np.abs(ride.states[:60, 3] - ride.states[0, 3]).max() < 0.35


def test_blocked_course_names_the_place_and_what_stops_it_and_keeps_the_preview_up_to_there():
    fence = {"kind": LINE, "points": [[30, -60], [30, 60]], "name": "fence"}
    line = refused(course(fence), PlanInfeasible)
    assert (
        line.startswith("the track cannot be skied at x = 2") and "there is no feasible plan: fence is in the" in line
    )
    preview = preview_course(course(fence))
    assert str(preview.problem) == line and 25.0 < preview.motion.position[-1, 0] < 30.0
    assert preview.motion.duration > 2.0


def test_preview_of_an_open_course_is_the_followed_motion():
    spec = course(TREE)
    preview = preview_course(spec)
    assert preview.problem is None and preview.motion.speed == pytest.approx(7.0)
    assert np.degrees(np.abs(preview.motion.lean).max()) <= 30.0 and preview.motion.leg_force.min() > 0.8


@pytest.mark.parametrize(
    ("obstacle", "words"),
    [
        ({"kind": DISC, "points": [[0.5, 0]]}, "point 1 starts inside obstacle 1 (disc) at x = 0.0, y = 0.0"),
        ({"kind": DISC, "points": [[42, 0]]}, "point 4 ends inside obstacle 1 (disc) at x = 42.0, y = 0.0"),
        (
            {"kind": POLYGON, "points": [[10, -9], [30, -9], [30, 9], [10, 9]], "name": "lake"},
            "inside lake at x = ",
        ),
        ({"kind": DISC, "points": [[5, 1], [6, 1]]}, "obstacle 1: points has 2 different places: a disc needs one"),
        ({"kind": LINE, "points": [[5, 1]]}, "obstacle 1: points has one place: a line needs at least 2"),
        ({"kind": LINE, "points": [[5, 1], [5, 1]]}, "obstacle 1: points has one place: a line needs at least 2"),
        ({"kind": POLYGON, "points": []}, "obstacle 1: points has 0 different places: a polygon needs at least 3"),
    ],
)
def test_impossible_obstacles_are_refused_before_any_search(obstacle, words, monkeypatch):
    monkeypatch.setattr("ski_addon.course.follow.follow_to_the_end", None)
    assert words in refused(course(obstacle))


def test_too_little_speed_is_refused_with_the_place():
    assert "no speed is left to balance with" in refused(course(angle=0.0, start_speed=0.0), PlanInfeasible)
    assert "at x = 0.0, y = 0.0" in refused(course(angle=0.0, start_speed=0.0), PlanInfeasible)
    line = refused(course(angle=0.0, start_speed=3.0), PlanInfeasible)
    assert "no speed is left to balance with" in line and "friction" in line


def test_paths_are_refused_as_drawn_ones_are():
    assert "goes uphill" in refused(course(points=((0, 0), (20, 0), (12, 9))))
    assert "there are no rows" in refused(replace(course(), point=()))


def test_stop_that_runs_into_an_obstacle_is_refused():
    fence = {"kind": LINE, "points": [[52, -30], [52, 30]], "name": "fence"}
    assert "runs into fence" in refused(course(fence, finish="stop"), PlanInfeasible)


def test_names_of_obstacles_without_one():
    assert [o.name for o in obstacles_of(course(TREE, {**TREE, "name": ""})).all] == ["old fir", "obstacle 2 (disc)"]


@pytest.mark.parametrize("name", ["tree_skiing", "slalom_by_planning", "corner", "potholes"])
def test_claim_13_examples_are_solved_without_a_collision(name):
    spec = RunSpec.from_toml(find_document(name))
    ride = ride_course(spec, build_terrain(spec.slope))
    places = ride.followed.places
    assert ride.stopped is None and not ride.problem.obstacles.hit_by(places[:-1], places[1:]).any()
    if name == "slalom_by_planning":  # the inner end of each line is passed on its own side
        for obstacle in ride.problem.obstacles.all[:8]:
            x, y = np.asarray(obstacle.points)[0]
            at = np.interp(x, places[:, 0], places[:, 1])
            assert (at - y) * np.sign(y) > 0.29


def test_claim_13_longer_plans_may_take_another_way_through_the_trees_at_about_the_same_cost():
    spec = RunSpec.from_toml(find_document("tree_skiing"))
    problem = ride_course(spec, build_terrain(spec.slope)).problem
    ways = []
    for stages in (10, 12):
        longer = replace(problem, settings=replace(problem.settings, stages=stages))
        ways.append(follow(longer, body_on(problem.lane)))
        places = ways[-1].places
        assert not ways[-1].reason and not problem.obstacles.hit_by(places[:-1], places[1:]).any()
    assert ways[0].cost == pytest.approx(ways[1].cost, rel=0.3)
