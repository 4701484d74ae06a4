"""Plans to compare with: the printed equations, a stiff body, and what the technique switches take away."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.body import forward_kinematics
from ski_addon.course import TRANSITION
from ski_addon.planning import as_planned
from ski_addon.spec import RunSpec
from tests.ski_runs import FAST, MAIN, planned

QUICK = {**FAST, "course.transition_duration": 0.6}
"""42 degrees of lean that change side in 0.6 s."""


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.sum(a * b, axis=-1)


def left_of(plan) -> np.ndarray:
    return np.cross(plan.surface_normal, plan.tangent)


def lean_of(run, body: str) -> np.ndarray:
    """Lean of a body's up axis from the snow's normal, positive to the left."""
    _, rotation = forward_kinematics(run.model.skeleton, run.plan.pose)
    up = rotation[:, run.model.skeleton.body(body), :, 2]
    return np.arctan2(dot(up, left_of(run.plan)), dot(up, run.plan.surface_normal))


def load_misses_the_skis_by(plan) -> float:
    """Largest distance [m] sideways from the middle of the skis to where the planned force of the snow acts."""
    gravity = np.array([0.0, 0.0, -9.81])
    velocity = np.gradient(plan.com, plan.time, axis=0, edge_order=2)
    force = np.gradient(velocity, plan.time, axis=0, edge_order=2) - gravity
    over, left, up = plan.com - plan.position, left_of(plan), plan.surface_normal
    point = dot(over, left) - dot(over, up) * dot(force, left) / dot(force, up)
    return float(np.abs(point[40:-40]).max())


# -- the printed equations -----------------------------------------------------------


def test_run_that_compares_nothing_is_planned_as_it_is():
    spec = RunSpec()
    assert as_planned(spec) is spec
    for word in ("rigid_lean", "clock", "printed_sign"):
        changed = spec.with_overrides({"technique.equations": word})
        assert as_planned(changed) is changed


@pytest.mark.parametrize("equations", ["frictionless", "paper"])
def test_frictionless_plan_keeps_its_energy_where_the_snow_would_take_it(equations):
    changes = {**MAIN, "course.start_speed": 5}
    free, real = (planned("paper_main", {**changes, "technique.equations": word}) for word in (equations, "mended"))
    assert (free.spec.snow.friction, as_planned(free.spec).snow.friction) == (0.071, 0.0)
    for run, keeps in ((free, True), (real, False)):
        plan = run.plan
        speed = np.linalg.norm(np.gradient(plan.com, plan.time, axis=0, edge_order=2), axis=1)
        gained = speed**2 - speed[0] ** 2 + 2 * 9.81 * (plan.com[:, 2] - plan.com[0, 2])
        assert (np.abs(gained).max() < 1.0) == keeps, np.abs(gained).max()
    assert free.plan.speed[-1] > 1.5 * real.plan.speed[-1]


@pytest.mark.parametrize("equations", ["rigid_lean", "paper"])
def test_rigid_lean_is_the_force_balance_of_the_instant(equations):
    """[SG19 Eq. 7, 14] A leg of one length, along gravity less the skis' acceleration."""
    plan = planned("paper_main", {**MAIN, "technique.equations": equations}).plan
    gravity = np.array([0.0, 0.0, -9.81])
    side = plan.curvature * plan.speed**2 - left_of(plan) @ gravity
    np.testing.assert_allclose(np.tan(plan.inclination), side / -(plan.surface_normal @ gravity), atol=1e-6)
    leg = np.linalg.norm(plan.com - plan.position, axis=1)
    np.testing.assert_allclose(leg, leg[0], atol=1e-9)


def test_rigid_lean_asks_for_a_load_beside_the_skis():
    """[reading p] 12 m/s and 0.6 s: outside of a stance of 0.2 m, where no snow can push; the balanced one is not."""
    rigid, balanced = (
        planned("paper_main", {**QUICK, "technique.equations": word}) for word in ("rigid_lean", "mended")
    )
    half = 0.5 * (balanced.model.skeleton.stance_width + balanced.model.skeleton.ski_width)
    assert load_misses_the_skis_by(balanced.plan) < 0.01 < 2 * half < load_misses_the_skis_by(rigid.plan)


def test_printed_sign_turns_right_where_it_should_turn_left():
    """[reading k] Algorithm 1 adds the centripetal acceleration: the track bends away from the lean."""
    changes = {"course.first_turn": "left", "course.turn_count": 1, "technique.equations": "printed_sign"}
    plan = planned("paper_main", changes).plan
    turn = plan.phase != TRANSITION
    assert np.all(plan.phase[turn] == 1) and np.all(plan.curvature[turn] < -0.05)
    assert np.all(plan.inclination[turn] > np.deg2rad(10))
    ahead = plan.tangent[0]
    gone = (plan.position - plan.position[0]) @ np.cross(plan.surface_normal[0], ahead)
    mended = planned("paper_main", {**changes, "technique.equations": "mended"}).plan
    assert gone[-1] < -2.0
    assert (mended.position[-1] - mended.position[0]) @ np.cross(mended.surface_normal[0], mended.tangent[0]) > 2.0


# -- technique switches ----------------------------------------------------------------


def test_inclination_only_leans_as_one_piece():
    """Oberegger's skier: the chest leans with the legs, whatever the document says of angulation."""
    whole = planned("paper_main", MAIN)
    stiff = planned("paper_main", {**MAIN, "technique.controller": "inclination_only"})
    np.testing.assert_allclose(lean_of(stiff, "chest"), stiff.plan.inclination, atol=1e-3)
    apex = np.argmax(np.abs(whole.plan.inclination))
    assert np.abs(lean_of(whole, "chest")[apex]) < 0.6 * np.abs(lean_of(stiff, "chest")[apex])
    leg = np.linalg.norm(stiff.plan.com - stiff.plan.position, axis=1)
    assert np.ptp(leg) < 1e-3, "no leg bends"


def test_angulation_can_be_off_constant_or_by_the_turn():
    """In deeper turns the hip takes back a constant share or, with auto, a larger one."""
    share = {}
    for angulation in (0, -0.5, "auto"):
        for speed in (6, 12):
            run = planned("paper_main", {**FAST, "course.start_speed": speed, "technique.angulation": angulation})
            apex = np.argmax(np.abs(run.plan.inclination))
            share[angulation, speed] = 1 - lean_of(run, "pelvis")[apex] / run.plan.inclination[apex]
    assert share[0, 6] == pytest.approx(0, abs=0.01) and share[0, 12] == pytest.approx(0, abs=0.01)
    assert share[-0.5, 6] == pytest.approx(0.5, abs=0.05) and share[-0.5, 12] == pytest.approx(0.5, abs=0.05)
    assert share["auto", 12] > share["auto", 6] + 0.1


def test_claim_20_without_angulation_the_upper_body_swings_like_a_pendulum():
    """beta_a = 0: the chest swings as far as the legs; with the paper's -0.5 hardly at all."""
    swing = {}
    for angulation in (0, -0.5):
        run = planned("paper_main", {**FAST, "technique.angulation": angulation})
        swing[angulation] = np.ptp(lean_of(run, "chest")) / np.ptp(run.plan.inclination)
    assert swing[0] > 0.98 and swing[-0.5] < 0.5


# -- bumps -----------------------------------------------------------------------------

BUMPS = {"slope.bump_count": 2, "course.start_speed": 6}


def moved(run) -> tuple[np.ndarray, np.ndarray]:
    """Height of the snow over the mean slope, and of the body over the snow (n,) [m], both along the mean normal."""
    angle = np.deg2rad(run.spec.slope.angle_deg)
    up = np.array([np.sin(angle), 0.0, np.cos(angle)])
    return run.plan.position @ up, (run.plan.com - run.plan.position) @ up


def test_claim_26_legs_extend_in_hollows_and_retract_on_crests():
    run = planned("bumps", BUMPS)
    snow, body = moved(run)
    on = (run.plan.position[:, 0] > 10) & (run.plan.position[:, 0] < 34)
    assert np.corrcoef(snow[on], body[on])[0, 1] < -0.85
    assert body[on][np.argmax(snow[on])] < body[0] - 0.05 < body[0] + 0.05 < body[on][np.argmin(snow[on])]
    stiff_snow, stiff = moved(planned("bumps", {**BUMPS, "technique.absorption": 0}))
    assert np.ptp(stiff) < 0.02 < np.ptp(stiff_snow)


def test_claim_26_absorption_evens_out_load_and_height_of_the_body():
    soft, half, stiff = (planned("bumps", {**BUMPS, "technique.absorption": share}).plan for share in (1, 0.5, 0))
    spread = [np.ptp(plan.load) for plan in (soft, half, stiff)]
    assert spread[0] < spread[1] < spread[2] and spread[0] < 0.7 * spread[2]
    height = [np.ptp(sum(moved(planned("bumps", {**BUMPS, "technique.absorption": share})))) for share in (1, 0)]
    assert height[0] < 0.75 * height[1]
