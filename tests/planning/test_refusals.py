"""What cannot be skied is refused by name, place and a speed that would work."""

from __future__ import annotations

import re

import numpy as np
import pytest

from ski_addon.errors import PlanInfeasible, SpecError
from ski_addon.gravity import GRAVITY
from ski_addon.pipeline import make_plan
from ski_addon.planning import build_stance
from ski_addon.planning.checks import check_reach
from ski_addon.planning.line import TrackSpline
from ski_addon.planning.pose import PlannedPoses
from ski_addon.planning.ride import Body, SpeedControl, plan_ride
from ski_addon.snow import Snow
from tests.ski_runs import FRICTIONLESS, planned, preset

EVEN = {
    **FRICTIONLESS,
    "slope.angle_deg": 0.01,
    "course.turn_count": 1,
    "course.turn_duration": 1.0,
    "technique.inclination_max_deg": 30,
}
"""One turn on nearly flat frictionless ground at an even speed: what works in one place works everywhere."""
SHORT = {"course.turn_count": 2}


def refusal(name, changes) -> PlanInfeasible:
    with pytest.raises(PlanInfeasible) as caught:
        make_plan(preset(name, changes))
    assert "\n" not in str(caught.value)
    return caught.value


def printed_speed(error: PlanInfeasible) -> float:
    return float(re.search(r"a speed of ([\d.]+) m/s there would work", str(error))[1])


def steepest(plan) -> float:
    return np.rad2deg(np.abs(plan.inclination).max())


@pytest.mark.parametrize("radius", [8, 40])
def test_speed_that_would_work_works_at_that_radius(radius):
    bend = {**EVEN, "course.turn_radius": radius}
    error = refusal("paper_main", {**bend, "course.start_speed": 20 * (radius / 40) ** 0.5})
    works = make_plan(preset("paper_main", {**bend, "course.start_speed": 0.999 * error.speed})).plan
    assert 29.0 < steepest(works) <= 30.0
    again = refusal("paper_main", {**bend, "course.start_speed": 1.02 * error.speed})
    assert again.speed == pytest.approx(error.speed, rel=1e-3)


def test_flat_frictionless_ground_needs_lean_too():
    level = {**EVEN, "slope.angle_deg": 0, "technique.inclination_max_deg": 60, "course.start_speed": 8}
    assert steepest(make_plan(preset("paper_main", level)).plan) > 15.0


@pytest.mark.parametrize(
    ("start", "limit"),
    [(9, 25), (16, 55), (9, 10), (12, 20)],
)
def test_printed_speed_works_at_the_start_of_a_braking_run(start, limit):
    """Friction slows this run from its first turn on, so the speed that works in turn 1 is a start speed that works."""
    changes = {**SHORT, "technique.inclination_max_deg": limit}
    error = refusal("paper_main", {**changes, "course.start_speed": start})
    assert error.place.startswith("turn 1 (") and 0 < error.speed < start
    make_plan(preset("paper_main", {**changes, "course.start_speed": printed_speed(error)}))


def test_printed_speed_is_not_rounded_up():
    for limit in (21.0, 26.0, 31.0, 36.0):
        error = refusal("paper_main", {**EVEN, "technique.inclination_max_deg": limit, "course.start_speed": 16})
        assert printed_speed(error) <= error.speed


def test_refusal_does_not_say_that_a_number_exceeds_itself():
    error = refusal("paper_main", {**SHORT, "technique.inclination_max_deg": 25, "course.start_speed": 8.55})
    assert "needs 25 degrees of lean, more than technique.inclination_max_deg = 25" not in str(error)


def test_refusal_names_limit_and_place_where_the_lean_is_largest():
    """Frictionless on a slope the speed only grows: the last turn is the one that fails."""
    error = refusal("paper_fig15", {**FRICTIONLESS, "course.start_speed": 4})
    assert re.match(r"turn 7 \(\d+\.\d m, \d+\.\d s\)$", error.place) and error.exit_code == 2
    assert 12 < error.speed < 16
    assert "technique.inclination_max_deg = 55" in str(error) and "use a larger radius" in str(error)


def test_leg_that_would_be_too_short_makes_the_skier_come_down():
    """Nearly straight legs under an upright trunk: the outside leg cannot reach down to a ski in a lean."""
    run = planned("paper_main", {**SHORT, "technique.knee_bend_deg": 30, "technique.angulation": -1})
    plan, skeleton = run.plan, run.model.skeleton
    stance = build_stance(skeleton, np.deg2rad(30))
    over = np.linalg.norm(plan.com - plan.position, axis=1)
    leaning, upright = np.argmax(np.abs(plan.inclination)), np.argmin(np.abs(plan.inclination))
    assert over[leaning] < stance.height - 0.01 < over[upright]
    knees = np.rad2deg(plan.pose[:, [skeleton.qpos_of(f"shank_y.{side}") for side in "LR"]])
    assert 15.0 < knees.min() < 30.0


@pytest.mark.parametrize(("ski", "error"), [(0, 0.031), (1, -0.031)])
def test_leg_that_cannot_reach_is_refused(ski, error):
    """Going lower answers every lean that was tried, so the check is asked about poses that are made up."""
    run = planned("paper_main", SHORT)
    snow = Snow.of(run.spec.snow, run.spec.skier)
    body = Body(-(run.track.surface_normal @ GRAVITY), arc_length=run.track.arc_length, swing=0.0 * run.track.curvature)
    line = TrackSpline(run.track).line(plan_ride(run.track, snow, body, SpeedControl()), snow)
    reach_error = np.zeros((len(line.time), 2))
    unused = np.zeros((len(line.time), 0))
    check_reach(line, PlannedPoses(unused, unused, unused, unused, reach_error))
    worst = int(np.argmax(line.time > 1.2))
    reach_error[worst, ski] = error
    with pytest.raises(PlanInfeasible) as caught:
        check_reach(line, PlannedPoses(unused, unused, unused, unused, reach_error))
    assert caught.value.speed is None
    assert caught.value.place == f"the transition after turn 1 ({line.arc_length[worst]:.1f} m, 1.2 s)"
    assert "a leg would have to be 31 mm longer or shorter than it can be" in str(caught.value)


def test_hinge_past_its_range_is_refused_by_name():
    error = refusal("paper_main", {**SHORT, "course.start_speed": 12, "technique.angulation": -1})
    assert error.speed is None
    assert re.search(r"thigh_[xyz]\.[LR] would bend \d+\.\d degrees past its range", str(error))


def test_friction_that_stops_the_leaning_skier_is_refused():
    error = refusal("paper_main", {"course.start_speed": 1.0, "snow.friction": 0.12})
    assert error.speed is None and "friction stops the skier" in str(error)


def test_without_inclination_nothing_is_refused_for_lean():
    changes = {**SHORT, "technique.inclination": False, "technique.inclination_max_deg": 5}
    plan = make_plan(preset("paper_main", changes)).plan
    assert np.all(plan.inclination == 0.0) and np.all(np.abs(plan.edge_angle) < 1e-3)


# -- bumps ---------------------------------------------


FEW = {"slope.bump_count": 2, "slope.mogul_count": 3}


@pytest.mark.parametrize(("name", "key", "height"), [("bumps", "bump_height", 3), ("moguls", "mogul_height", 1.8)])
def test_bumps_that_nobody_can_stand_over_are_explained(name, key, height):
    """[reading s] The paper's h = 3 m by w = 8 m among them; the height the line names is then skied."""
    with pytest.raises(SpecError) as caught:
        make_plan(preset(name, {f"slope.{key}": height, **FEW}))
    line = str(caught.value)
    assert line.startswith(f"slope.{key} = {height:.1f} is more than a skier can take: ") and "\n" not in line
    works = float(re.search(r"a height of ([\d.]+) m would work", line)[1])
    assert make_plan(preset(name, {f"slope.{key}": works, **FEW})).plan.length > 10.0


def test_paper_bumps_of_three_metres_end_a_run_with_one_line(tmp_path, capsys):
    from ski_addon.cli import main

    assert main(["run", "bumps", "--set", "slope.bump_height=3", "--quiet", "-o", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and "arcs meet at 73.7 degrees" in said and "above 6.4 m/s" in said
    assert not (tmp_path / "out" / "recording.npz").exists()


def test_bumps_past_an_ankle_name_the_bumps_as_the_remedy():
    with pytest.raises(PlanInfeasible, match=r"degrees past its range \(lower slope.bump_height, bring"):
        make_plan(preset("bumps", {"slope.bump_height": 1.0, "slope.bump_count": 2}))
