"""Turn tracks: their timing, their geometry, their speed."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ski_addon.course import LEFT, RIGHT, TRANSITION, build_track
from ski_addon.course.turns import turn_schedule
from ski_addon.errors import PlanInfeasible
from ski_addon.spec import CourseSpec, RunSpec
from ski_addon.terrain import build_terrain
from tests.ski_runs import FRICTIONLESS, preset


def track_of(spec: RunSpec):
    return build_track(spec, build_terrain(spec.slope))


def track(name: str = "paper_main", **changes):
    return track_of(preset(name, {key.replace("__", "."): value for key, value in changes.items()}))


def heading(run) -> np.ndarray:
    """Angle from the fall line, positive to the left [rad]."""
    down = np.array([run.surface_normal[0, 2], 0.0, -run.surface_normal[0, 0]])
    return np.unwrap(np.arctan2(run.tangent[:, 1], run.tangent @ down))


def transition_centres(course: CourseSpec) -> list[float]:
    """Middles of the transitions between two turns."""
    schedule = turn_schedule(course)
    spans = zip(schedule.time, schedule.time[1:], schedule.phase, strict=False)
    between = [0.5 * (a + b) for a, b, phase in spans if phase == TRANSITION]
    return between if course.entry == "turn" else between[1:-2]


# -- timing ---------------------------------------------


def test_claim_19_timing_of_the_main_case():
    """Fig. 11: 13.5 s, five transitions centred 1.75 + 2.5 k seconds."""
    course = preset("paper_main").course
    assert turn_schedule(course).time[-1] == pytest.approx(13.5)
    assert transition_centres(course) == pytest.approx([1.75, 4.25, 6.75, 9.25, 11.75])


def test_claim_23_timing_of_figure_15():
    """The figure's dips, 7.5, 9.5 and 11.5 s, are the middles of transitions; three turns are left, four right."""
    course = preset("paper_fig15").course
    assert transition_centres(course) == pytest.approx([1.5, 3.5, 5.5, 7.5, 9.5, 11.5])
    phase = turn_schedule(course).phase
    assert (np.sum(phase == LEFT), np.sum(phase == RIGHT)) == (3, 4) and phase[0] == RIGHT


def test_straight_entry_adds_half_a_transition_before_and_a_whole_one_after():
    course = CourseSpec(turn_count=2, turn_duration=1.0, transition_duration=1.5, entry="straight", first_turn="left")
    schedule = turn_schedule(course)
    assert schedule.time == pytest.approx([0, 0.75, 1.75, 3.25, 4.25, 5.0, 5.75])
    assert schedule.curvature * course.turn_radius == pytest.approx([0, 1, 1, -1, -1, 0, 0])
    assert schedule.phase.tolist() == [0, 1, 0, -1, 0, 0]


def test_half_first_turn_lasts_half_as_long():
    whole, half = (
        turn_schedule(CourseSpec(entry="turn", half_first_turn=half, turn_duration=1.2)) for half in (False, True)
    )
    assert np.diff(whole.time)[0] == pytest.approx(1.2) and np.diff(half.time)[0] == pytest.approx(0.6)
    np.testing.assert_allclose(np.diff(whole.time)[1:], np.diff(half.time)[1:])


def test_turns_are_numbered_and_alternate():
    schedule = turn_schedule(CourseSpec(turn_count=5, first_turn="left", entry="turn"))
    assert schedule.turn.tolist() == [1, 1, 2, 2, 3, 3, 4, 4, 5]
    assert schedule.phase[::2].tolist() == [1, -1, 1, -1, 1]


@pytest.mark.parametrize("entry", ["turn", "straight"])
def test_curvature_is_continuously_differentiable_in_time(entry):
    course = CourseSpec(turn_count=3, turn_radius=10, transition_duration=0.8, turn_duration=0.5, entry=entry)
    schedule, step = turn_schedule(course), 1e-4
    time = np.arange(0.0, schedule.time[-1], step)
    curvature = schedule.curvature_at(time)
    assert np.abs(curvature).max() == pytest.approx(0.1)
    rate = np.diff(curvature) / step
    steepest = 0.5 * np.pi**2 * 0.2 / 0.4**2  # of a half cosine over half a transition, generously
    assert np.abs(np.diff(rate)).max() < steepest * step * 1.01


# -- geometry ---------------------------------------------


@pytest.mark.parametrize("name", ["paper_main", "giant_slalom"])
def test_geometry_is_consistent(name):
    """Position, tangent and curvature by finite differences; on the snow; unit vectors."""
    run = track(name, **{"course__turn_count": 3})
    s, middle = run.arc_length, slice(5, -5)
    assert np.all(np.diff(s) > 0)
    np.testing.assert_allclose(np.gradient(run.position, s, axis=0)[middle], run.tangent[middle], atol=2e-5)
    bend = np.gradient(run.tangent, s, axis=0)
    np.testing.assert_allclose(np.sum(bend * run.left, axis=1)[middle], run.curvature[middle], atol=2e-4)
    np.testing.assert_allclose(np.linalg.norm(run.tangent, axis=1), 1.0, atol=1e-12)
    np.testing.assert_allclose(np.sum(run.tangent * run.surface_normal, axis=1), 0.0, atol=1e-12)
    angle = preset(name).slope.angle_deg
    np.testing.assert_allclose(run.position[:, 2], -math.tan(math.radians(angle)) * run.position[:, 0], atol=1e-9)


def test_claim_18_heading_change_in_a_turn_is_the_integral_of_v_over_r():
    run = track(**{"course__turn_count": 3})
    for turn in (1, 2, 3):
        inside = np.flatnonzero((run.turn == turn) & (run.phase != TRANSITION))
        assert np.ptp(run.curvature[inside]) < 1e-12
        arc = run.arc_length[inside[-1]] - run.arc_length[inside[0]]
        change = heading(run)[inside[-1]] - heading(run)[inside[0]]
        assert change == pytest.approx(arc / 15.0 * run.phase[inside[0]], rel=1e-6)


@pytest.mark.parametrize("name", ["paper_main", "paper_fig15"])
def test_first_whole_turn_is_centred_on_the_fall_line(name):
    """Else the whole track drifts to one side: it starts turned out by half of what the turn takes back."""
    run = track(name, snow__friction=0, snow__friction_per_speed=0)
    first = np.flatnonzero((run.turn == 1) & (run.phase != TRANSITION))
    middle = heading(run)[first[len(first) // 2]]
    assert abs(middle) < 0.01
    assert np.sign(heading(run)[0]) == -run.phase[first[0]]


def test_half_first_turn_starts_down_the_fall_line():
    run = track(course__half_first_turn=True)
    assert heading(run)[0] == pytest.approx(0.0, abs=1e-12)
    straight = track(course__half_first_turn=True, course__entry="straight")
    begin = np.flatnonzero(straight.phase != TRANSITION)[0]
    assert heading(straight)[begin] == pytest.approx(0.0, abs=2e-3)


@pytest.mark.parametrize("entry", ["turn", "straight"])
@pytest.mark.parametrize("half", [False, True])
def test_left_and_right_runs_mirror_each_other(entry, half):
    changes = {"course__turn_count": 3, "course__entry": entry, "course__half_first_turn": half}
    left, right = (track(**changes, course__first_turn=side) for side in ("left", "right"))
    np.testing.assert_allclose(left.position * [1, -1, 1], right.position, atol=1e-12)
    np.testing.assert_allclose(left.curvature, -right.curvature, atol=1e-15)
    np.testing.assert_array_equal(left.phase, -right.phase)
    np.testing.assert_array_equal(left.arc_length, right.arc_length)
    first = np.flatnonzero(left.phase)[0]
    assert left.phase[first] == LEFT and left.curvature[first] > 0


# -- speed ---------------------------------------------


def planned_speed(run) -> np.ndarray:
    """The speed that the track was laid out with, by central differences at its even times."""
    time = np.linspace(0.0, 1.0, len(run.arc_length))
    return np.gradient(run.arc_length, time, edge_order=2)


def test_claim_18_frictionless_energy():
    """v^2 - v0^2 = 2 g dH along the whole track, with turns."""
    spec = preset("paper_main", {**FRICTIONLESS, "course.turn_count": 4, "course.start_speed": 3})
    run = track_of(spec)
    duration = turn_schedule(spec.course).time[-1]
    speed = planned_speed(run) / duration
    gained = -2 * 9.81 * (run.position[:, 2] - run.position[0, 2])
    np.testing.assert_allclose(speed[2:-2] ** 2, 9.0 + gained[2:-2], rtol=2e-5)
    assert speed[-3] > 8


def test_straight_run_with_friction_reaches_the_analytic_speed():
    """v' = a - b v has v(t) = a/b + (v0 - a/b) exp(-b t)."""
    spec = preset("paper_main", {"course.turn_radius": 200, "course.turn_count": 1, "course.turn_duration": 3})
    run, angle = track_of(spec), math.radians(5)
    a = 9.81 * (math.sin(angle) - 0.071 * math.cos(angle))
    b = 0.004 * 9.81 * math.cos(angle)
    time = np.linspace(0.0, 3.0, len(run.arc_length))
    expected = a / b + (9.0 - a / b) * np.exp(-b * time)
    np.testing.assert_allclose((planned_speed(run) / 3.0)[2:-2], expected[2:-2], rtol=1e-3)


def test_drag_limits_the_speed():
    """Without friction the run tends to sqrt(g sin(phi) / drag)."""
    spec = preset(
        "paper_main",
        {
            **FRICTIONLESS,
            "skier.drag_area": 2,
            "slope.angle_deg": 10,
            "course.turn_radius": 200,
            "course.start_speed": 5,
            "course.turn_count": 1,
            "course.turn_duration": 25,
        },
    )
    run = track_of(spec)
    terminal = math.sqrt(9.81 * math.sin(math.radians(10)) / (0.5 * 1.2 * 2 / 50))
    straight = np.abs(heading(run)) < 0.2
    speed = planned_speed(run) / 25.0
    assert speed[straight].max() < terminal
    assert speed[straight][-1] == pytest.approx(terminal, rel=0.04)


def test_friction_that_stops_the_skier_is_refused_with_the_place():
    with pytest.raises(PlanInfeasible, match=r"turn \d+ \(\d+\.\d m, \d+\.\d s\): friction stops the skier"):
        track(snow__friction=0.3, course__start_speed=3)


def test_arrays_of_a_track_are_read_only():
    with pytest.raises(ValueError, match="read-only"):
        track(**{"course__turn_count": 1}).position[0] = 0.0
