"""Tasks: the reference's own acceleration on the reference, and a pull back to it everywhere else."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from ski_addon.control import Dynamics, Gains, TaskSet, progress_rate
from ski_addon.frames import matrix_from_quaternion
from ski_addon.planning import Reference
from tests.ski_runs import MAIN, planned, random_configuration

PLACES = (100, 260, 420, 600)
"""Samples of the plan: in the first turn, twice in the transition, in the second turn."""
GAINS = Gains()


@pytest.fixture(scope="module")
def reference() -> Reference:
    run = planned("paper_main", MAIN)
    return Reference(run.plan, run.model)


def on_plan(reference: Reference, place: int, rate: float = 1.0) -> tuple[Dynamics, float, float]:
    """The skier exactly as planned at a sample, moving on at `rate` times the planned speed."""
    run = planned("paper_main", MAIN)
    plan, model, columns = run.plan, run.model, reference.columns
    now = float(plan.time[place])
    value, slope, _ = reference.at(now)
    dynamics = Dynamics(model)
    dynamics.qpos[:] = plan.pose[place]
    velocity = np.zeros(41)
    velocity[model.actuated_dof] = slope[columns["joints"]] * rate
    rotation = matrix_from_quaternion(plan.pose[place, 3:7])
    velocity[3:6] = rotation.T @ value[columns["turning"]][6:9] * rate
    dynamics.qvel[:] = velocity
    dynamics.update()
    velocity[:3] = slope[columns["com"]] * rate - dynamics.com_velocity
    dynamics.qvel[:] = velocity
    dynamics.update()
    return dynamics, now, rate


def along(reference: Reference, now: float, rate: float, time: float) -> np.ndarray:
    """The reference values `time` later, at a constant rate of progress."""
    return reference.at(now + rate * time)[0]


@pytest.mark.parametrize("place", PLACES)
def test_on_the_reference_the_tasks_ask_for_its_own_acceleration(reference, place):
    """Second differences in time of the reference as the skier passes along it."""
    dynamics, now, rate = on_plan(reference, place)
    columns, step = reference.columns, 2e-3
    desired = TaskSet(reference, GAINS, dynamics).update(reference.at(now), rate)
    before, here, after = (along(reference, now, rate, t) for t in (-step, 0.0, step))
    second = (after - 2 * here + before) / step**2
    ski = second[columns["ski_position"]].reshape(2, 3)
    np.testing.assert_allclose(desired.ski[:, :3], ski, atol=0.03)
    com = desired.com_axes @ second[columns["com"]]
    np.testing.assert_allclose(desired.com, com, atol=0.05)
    np.testing.assert_allclose(desired.joints, second[columns["joints"]], atol=0.05)
    assert np.abs(desired.ski_offset).max() < 1e-6 and np.abs(desired.ski_turn).max() < 1e-5
    assert np.abs(desired.com_offset).max() < 1e-8
    assert np.abs(desired.angular_momentum_rate).max() < 0.05


@pytest.mark.parametrize("place", PLACES)
def test_on_the_reference_the_rotations_turn_as_it_does(reference, place):
    """Angular acceleration of skis and pelvis, by finite differences of their angular velocities."""
    dynamics, now, rate = on_plan(reference, place)
    turning, step = reference.columns["turning"], 1e-3
    desired = TaskSet(reference, GAINS, dynamics).update(reference.at(now), rate)
    after, before = (along(reference, now, rate, t)[turning] * rate for t in (step, -step))
    spin = ((after - before) / (2 * step)).reshape(3, 3)
    for ski in range(2):
        np.testing.assert_allclose(desired.ski_axes[ski] @ desired.ski[ski, 3:], spin[ski], atol=0.05)
    np.testing.assert_allclose(dynamics.root_rotation @ desired.pelvis, spin[2], atol=0.02)


def test_progress_is_that_of_the_clock_on_the_plan_and_of_the_skier_off_it(reference):
    for place in PLACES:
        for rate in (1.0, 0.5, 1.6):
            dynamics, now, _ = on_plan(reference, place, rate)
            assert progress_rate(reference, reference.at(now), dynamics) == pytest.approx(rate, rel=2e-3)


def test_progress_follows_the_skier_who_is_ahead_or_behind(reference):
    dynamics, now, rate = on_plan(reference, PLACES[0])
    ahead = progress_rate(reference, reference.at(now - 0.01), dynamics)
    behind = progress_rate(reference, reference.at(now + 0.01), dynamics)
    assert behind < rate - 0.05 < rate + 0.05 < ahead


def shifted(reference: Reference, offset: np.ndarray) -> tuple[Dynamics, np.ndarray, float]:
    dynamics, now, rate = on_plan(reference, PLACES[1])
    dynamics.qpos[:3] += offset
    dynamics.update()
    return dynamics, reference.at(now), rate


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_shifted_skier_is_pulled_back(reference, axis):
    """By kp times the offset, on top of what the reference asks."""
    offset = 0.02 * np.eye(3)[axis]
    dynamics, sample, rate = shifted(reference, offset)
    moved = TaskSet(reference, GAINS, dynamics).update(sample, rate)
    still = TaskSet(reference, GAINS, shifted(reference, np.zeros(3))[0]).update(sample, rate)
    pull = np.broadcast_to(-GAINS.ski.kp * offset, (2, 3))
    np.testing.assert_allclose(moved.ski[:, :3] - still.ski[:, :3], pull, atol=1e-8)
    np.testing.assert_allclose(moved.com - still.com, -GAINS.com.kp * moved.com_axes @ offset, atol=1e-8)
    np.testing.assert_allclose(moved.com_offset, -offset, atol=1e-7)
    np.testing.assert_allclose(moved.ski_offset, np.broadcast_to(-offset, (2, 3)), atol=1e-6)


def test_the_pull_along_the_track_is_left_to_gravity(reference):
    """Nothing but gravity drives a skier: the centre of mass is only guided sideways and in height."""
    run = planned("paper_main", MAIN)
    dynamics, sample, rate = shifted(reference, np.zeros(3))
    desired = TaskSet(reference, GAINS, dynamics).update(sample, rate)
    np.testing.assert_allclose(desired.com_axes @ run.plan.tangent[PLACES[1]], 0.0, atol=1e-9)
    np.testing.assert_allclose(desired.com_axes @ desired.com_axes.T, np.eye(2), atol=1e-9)


def test_rotation_errors_lead_to_the_reference():
    """exp(error) times the rotation as it is gives the reference's, for any error below half a turn."""
    run = planned("paper_main", MAIN)
    reference = Reference(run.plan, run.model)
    rng = np.random.default_rng(0)
    sample = reference.at(2.3)
    quaternions = sample[0, reference.columns["quaternion"]].reshape(3, 4)
    exponential = np.empty(9)
    for _ in range(20):
        dynamics = Dynamics(run.model)
        dynamics.qpos[:] = random_configuration(run.model, rng)
        dynamics.update()
        desired = TaskSet(reference, GAINS, dynamics).update(sample, 1.0)
        for ski in range(2):
            error = desired.ski_turn[ski]
            angle = np.linalg.norm(error)
            assert angle <= np.pi + 1e-9
            quaternion = np.empty(4)
            mujoco.mju_axisAngle2Quat(quaternion, error / angle, angle)
            mujoco.mju_quat2Mat(exponential, quaternion)
            reached = exponential.reshape(3, 3) @ dynamics.ski_rotation(ski)
            np.testing.assert_allclose(reached, matrix_from_quaternion(quaternions[ski]), atol=1e-6)


def test_a_turned_ski_is_turned_back(reference):
    """About its own axes by kp times the angle; the roll has a gain of its own."""
    gains = Gains(edging=type(GAINS.edging)(900.0, 60.0, 5.0))
    dynamics, now, rate = on_plan(reference, PLACES[0])
    still = TaskSet(reference, gains, dynamics).update(reference.at(now), rate).ski.copy()
    for hinge, axis, kp in (("foot_x.L", 0, 900.0), ("foot_y.L", 1, 400.0)):
        turned, now, rate = on_plan(reference, PLACES[0])
        velocity = turned.ski_velocity[0].copy()
        turned.qpos[turned.model.skeleton.qpos_of(hinge)] += 1e-3
        turned.update()
        moved = TaskSet(reference, gains, turned).update(reference.at(now), rate).ski
        slip = turned.ski_velocity[0, 3:] - velocity[3:]
        assert np.abs(slip).max() < 0.01
        assert (moved[0, 3 + axis] - still[0, 3 + axis]) == pytest.approx(-kp * 1e-3, rel=0.08)


def test_velocity_errors_are_damped(reference):
    """Pushing the whole skier to the left adds -kd times that velocity."""
    dynamics, now, rate = on_plan(reference, PLACES[0])
    tasks = TaskSet(reference, GAINS, dynamics)
    still = tasks.update(reference.at(now), rate)
    ski, com = still.ski.copy(), still.com.copy()
    push = 0.3 * reference.at(now)[0][reference.columns["across"]]
    dynamics.qvel[:3] += push
    dynamics.update()
    moved = tasks.update(reference.at(now), rate)
    np.testing.assert_allclose(moved.ski[0, :3] - ski[0, :3], -GAINS.ski.kd * push, atol=1e-9)
    np.testing.assert_allclose(moved.com - com, -GAINS.com.kd * moved.com_axes @ push, atol=1e-9)


def test_gains_are_critically_damped():
    for name in ("ski", "edging", "com", "pose", "leg_pose", "pelvis"):
        gain = getattr(GAINS, name)
        assert gain.kd == pytest.approx(2.0 * np.sqrt(gain.kp))
