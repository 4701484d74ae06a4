"""What was simulated obeys mechanics: checked on recorded data alone, by finite differences."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ski_addon.body import centre_of_mass, forward_kinematics
from ski_addon.body.model import GRAVITY
from ski_addon.control import Dynamics
from ski_addon.pipeline import start_simulation
from ski_addon.simulation import Recording
from tests.ski_runs import FRICTIONLESS, MAIN, mirrored_qpos, planned, simulated

STRAIGHT = {"course.turn_radius": 200, "course.turn_count": 1, "course.turn_duration": 1.2, "course.start_speed": 6}
DRAGGED = {**STRAIGHT, "skier.drag_area": 2, "course.start_speed": 20}
QUICK = {
    "course.turn_count": 3,
    "course.turn_duration": 0.5,
    "course.transition_duration": 0.7,
    "simulation.time_step": 0.002,
}
TURNS = [("friction", MAIN), ("drag", {"course.turn_count": 1, "skier.drag_area": 2, "course.start_speed": 12})]


@pytest.fixture(params=TURNS, ids=[name for name, _ in TURNS])
def turning(request) -> tuple[Recording, dict]:
    changes = request.param[1]
    return simulated("paper_main", changes), changes


def central(values: np.ndarray, step: float) -> np.ndarray:
    return (values[2:] - values[:-2]) / (2 * step)


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.sum(a * b, axis=-1)


def drag_force(changes: dict, velocity: np.ndarray) -> np.ndarray:
    area = planned("paper_main", changes).spec.skier.drag_area
    return -0.5 * 1.2 * area * np.linalg.norm(velocity, axis=-1, keepdims=True) * velocity


# -- forces and motion ------------------------------------------------------------


def test_momentum_of_the_centre_of_mass(turning):
    """m c'' = snow forces + weight + drag, at every step."""
    recording, changes = turning
    step, mass = recording.header["time_step"], recording.header["mass"]
    acceleration = np.diff(recording.com, 2, axis=0) / step**2
    force = recording.snow_force.sum(axis=1)[1:-1] + drag_force(changes, central(recording.com, step))
    np.testing.assert_allclose(mass * acceleration, force + mass * GRAVITY, atol=0.2)


def test_recorded_centre_of_mass_speed_and_skis_are_those_of_the_recorded_pose(turning):
    recording, changes = turning
    run = planned("paper_main", changes)
    skeleton = run.model.skeleton
    position, rotation = forward_kinematics(skeleton, recording.qpos)
    np.testing.assert_allclose(centre_of_mass(skeleton, position, rotation), recording.com, atol=1e-9)
    speed = np.linalg.norm(central(recording.com, recording.header["time_step"]), axis=1)
    np.testing.assert_allclose(speed, recording.speed[1:-1], atol=0.01)
    for ski, side in enumerate("LR"):
        axes = rotation[:, skeleton.body(f"ski.{side}")]
        across, up = dot(axes[:, :, 1], recording.surface_normal), dot(axes[:, :, 2], recording.surface_normal)
        np.testing.assert_allclose(-np.arctan2(across, up), recording.edge_angle[:, ski], atol=1e-9)


def test_velocities_are_the_rates_of_the_configurations(turning):
    recording, _ = turning
    hinges = (recording.qpos[1:, 7:] - recording.qpos[:-1, 7:]) / recording.header["time_step"]
    np.testing.assert_allclose(hinges, recording.qvel[1:, 6:], atol=1e-7)
    np.testing.assert_allclose(np.linalg.norm(recording.qpos[:, 3:7], axis=1), 1.0, atol=1e-12)


def test_torques_are_the_inverse_dynamics_of_the_recorded_motion():
    """mj_inverse of the recorded accelerations less the snow's forces; those act between the skis' ends."""
    import mujoco

    recording, run = simulated("paper_main", MAIN), planned("paper_main", MAIN)
    model, step = run.model, recording.header["time_step"]
    data = model.new_data()
    upper = [i for i, joint in enumerate(model.skeleton.actuated) if "." not in model.skeleton.joint_names[joint]] + [
        i for i, joint in enumerate(model.skeleton.actuated) if "arm" in model.skeleton.joint_names[joint]
    ]
    for i in range(50, 3500, 250):
        data.qpos[:], data.qvel[:] = recording.qpos[i], recording.qvel[i]
        data.qacc[:] = (recording.qvel[i + 1] - recording.qvel[i]) / step
        mujoco.mj_inverse(model.mujoco, data)
        np.testing.assert_allclose(data.qfrc_inverse[:3], recording.snow_force[i].sum(axis=0), atol=0.05)
        torque = data.qfrc_inverse[model.actuated_dof]
        np.testing.assert_allclose(torque[upper], recording.tau[i, upper], atol=1e-4)  # snow does not reach these
        np.testing.assert_allclose(data.qfrc_inverse[model.pole_dof], 0.0, atol=1e-6)


# -- snow -----------------------------------------------------------------------


def test_claim_28_snow_only_pushes(turning):
    recording, _ = turning
    assert recording.snow_edge_force.min() > -0.05
    normal = np.einsum("nsi,ni->ns", recording.snow_force, recording.surface_normal)
    np.testing.assert_allclose(recording.snow_edge_force.sum(axis=2), normal, atol=1e-9)
    assert normal.min() > 50.0, "each ski keeps a load"


def test_snow_force_is_normal_friction_and_side_force(turning):
    """[SG19 Eq. 24] friction mu(v) times the normal force against the ski's motion; the rest is across the ski."""
    recording, changes = turning
    run, step = planned("paper_main", changes), recording.header["time_step"]
    skeleton = run.model.skeleton
    position, rotation = forward_kinematics(skeleton, recording.qpos)
    normal = recording.surface_normal[1:-1]
    for ski, side in enumerate("LR"):
        velocity = central(position[:, skeleton.body(f"ski.{side}")], step)
        velocity -= dot(velocity, normal)[:, None] * normal
        speed = np.linalg.norm(velocity, axis=1)
        across = np.cross(normal, rotation[1:-1, skeleton.body(f"ski.{side}"), :, 0])
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        load = recording.snow_edge_force[1:-1, ski].sum(axis=1)[:, None]
        push = recording.snow_edge_side[1:-1, ski].sum(axis=1)[:, None]
        friction = (0.071 + 0.004 * speed)[:, None] * load * velocity / speed[:, None]
        np.testing.assert_allclose(recording.snow_force[1:-1, ski], load * normal - friction + push * across, atol=0.5)


def test_claim_27_edges_that_carry():
    """Past eight degrees of edging only the edges on the inside of the turn carry anything."""
    recording = simulated("paper_main", MAIN)
    for ski in range(2):
        left = recording.edge_angle[:, ski] > np.deg2rad(8.0)
        right = recording.edge_angle[:, ski] < -np.deg2rad(8.0)
        assert left.sum() > 500 and right.sum() > 500
        assert np.abs(recording.snow_edge_force[left, ski, 1]).max() < 0.05
        assert np.abs(recording.snow_edge_force[right, ski, 0]).max() < 0.05
        assert recording.snow_edge_side[left, ski, 0].min() > -0.05, "snow pushes a ski towards its lean"
        assert recording.snow_edge_side[right, ski, 1].max() < 0.05


# -- energy ----------------------------------------------------------------------


def energy(recording: Recording, changes: dict) -> np.ndarray:
    """Kinetic and potential energy of all bodies [J]."""
    run = planned("paper_main", changes)
    dynamics = Dynamics(run.model)
    import mujoco

    full, out = np.zeros((41, 41)), []
    for qpos, qvel in zip(recording.qpos[::20], recording.qvel[::20], strict=True):
        dynamics.qpos[:], dynamics.qvel[:] = qpos, qvel
        dynamics.update()
        mujoco.mj_fullM(run.model.mujoco, dynamics.data, full)
        out.append(0.5 * qvel @ full @ qvel + run.model.mass * 9.81 * dynamics.com[2])
    return np.array(out)


@pytest.mark.parametrize("changes", [STRAIGHT, DRAGGED], ids=["friction", "drag"])
def test_energy_falls_by_the_work_of_friction_and_drag(changes):
    """On a nearly straight run muscles do nothing worth mentioning."""
    recording = simulated("paper_main", changes)
    step, speed = recording.header["time_step"], recording.speed
    load = recording.snow_edge_force.sum(axis=(1, 2))
    area = planned("paper_main", changes).spec.skier.drag_area
    power = (0.071 + 0.004 * speed) * load * speed + 0.5 * 1.2 * area * speed**3
    lost = energy(recording, changes)
    count = 20 * (len(lost) - 1)
    assert lost[0] - lost[-1] == pytest.approx(power[: count + 1].mean() * count * step, rel=0.01)
    assert np.all(np.diff(lost) < 0)


def test_snow_takes_energy_away_in_turns_too():
    """Side and normal forces do no work on a carving ski: what the snow takes is friction, at every step."""
    recording, run = simulated("paper_main", MAIN), planned("paper_main", MAIN)
    skeleton, step = run.model.skeleton, recording.header["time_step"]
    position, _ = forward_kinematics(skeleton, recording.qpos)
    power = np.zeros(len(recording.time) - 2)
    friction = np.zeros_like(power)
    for ski, side in enumerate("LR"):
        velocity = central(position[:, skeleton.body(f"ski.{side}")], step)
        power += dot(recording.snow_force[1:-1, ski], velocity)
        speed = np.linalg.norm(velocity, axis=1)
        friction += (0.071 + 0.004 * speed) * recording.snow_edge_force[1:-1, ski].sum(axis=1) * speed
    assert power.max() < 0
    np.testing.assert_allclose(power, -friction, rtol=0.05)


def test_frictionless_straight_run_keeps_its_energy():
    changes = {**STRAIGHT, **FRICTIONLESS}
    recording = simulated("paper_main", changes)
    kept = energy(recording, changes)
    assert np.ptp(kept) < 1e-3 * 0.5 * 50 * recording.speed[0] ** 2
    drop = recording.com[0, 2] - recording.com[:, 2]
    np.testing.assert_allclose(recording.speed**2 - recording.speed[0] ** 2, 2 * 9.81 * drop, atol=0.02)


# -- closed forms -------------------------------------------------------------------


def test_straight_run_has_the_analytic_speed():
    """v' = a - b v; the run is a circle of 200 m, so that gravity along it changes by a thousandth."""
    recording = simulated("paper_main", STRAIGHT)
    slope = math.radians(5)
    a = 9.81 * (math.sin(slope) - 0.071 * math.cos(slope))
    b = 0.004 * 9.81 * math.cos(slope)
    expected = a / b + (recording.speed[0] - a / b) * np.exp(-b * recording.time)
    np.testing.assert_allclose(recording.speed, expected, rtol=3e-4)
    assert np.abs(recording.inclination).max() < np.deg2rad(1.5)


def test_steady_turn_leans_as_derived():
    """[claim 17] in the middle of a turn, within half a degree: tan(lean) = u^2 / (g R) with gravity's side part."""
    recording = simulated("paper_main", {"course.turn_count": 1, "skier.drag_area": 2, "course.start_speed": 12})
    i = 500
    over = recording.com[i] - recording.track_position[i]
    left = np.cross(recording.surface_normal[i], recording.track_tangent[i])
    own_radius = 15.0 - abs(over @ left)
    sideways = -(recording.speed[i] ** 2) / own_radius - left @ GRAVITY  # the first turn is a right one
    lean = math.atan(sideways / -(recording.surface_normal[i] @ GRAVITY))
    assert recording.inclination[i] == pytest.approx(lean, abs=np.deg2rad(0.5))


# -- symmetry and repeatability ------------------------------------------------------


def test_mirrored_track_gives_the_mirrored_motion():
    """Three turns, the first to the right or to the left: states to 1e-6, forces and torques to match."""
    right, left = (simulated("paper_main", {**QUICK, "course.first_turn": side}) for side in ("right", "left"))
    model = planned("paper_main", MAIN).model
    assert right.status == left.status == "finished" and set(right.phase) == {-1, 0, 1}
    mirrored = mirrored_qpos(model, left.qpos)
    mirrored[:, 3:7] *= np.sign(dot(mirrored[:, 3:7], right.qpos[:, 3:7]))[:, None]
    assert np.abs(right.qpos[:, 1]).max() > 0.5, "there is something to mirror"
    np.testing.assert_allclose(mirrored, right.qpos, atol=1e-6)
    np.testing.assert_allclose(left.snow_force[:, ::-1] * [1, -1, 1], right.snow_force, atol=1e-3)
    np.testing.assert_allclose(-left.inclination, right.inclination, atol=1e-6)
    np.testing.assert_allclose(-left.edge_angle[:, ::-1], right.edge_angle, atol=1e-6)
    np.testing.assert_allclose(left.snow_edge_force[:, ::-1, ::-1], right.snow_edge_force, atol=1e-3)
    np.testing.assert_array_equal(left.phase, -right.phase)


def test_time_step_hardly_matters():
    """Twice as long steps: the same motion to millimetres."""
    changes = {"course.turn_count": 1, "course.turn_duration": 0.4}
    fine, coarse = (simulated("paper_main", {**changes, "simulation.time_step": step}) for step in (0.001, 0.002))
    count = len(coarse.time) - 1
    np.testing.assert_allclose(coarse.time[:count], fine.time[: 2 * count : 2], atol=1e-12)
    np.testing.assert_allclose(coarse.com[:count], fine.com[: 2 * count : 2], atol=3e-3)


def test_skier_starts_as_planned():
    run = planned("paper_main", MAIN)
    recording = simulated("paper_main", MAIN)
    np.testing.assert_allclose(recording.qpos[0], run.plan.pose[0], atol=1e-12)
    assert recording.arc_length[0] == 0.0 and recording.time[0] == 0.0
    planned_com_speed = np.linalg.norm(np.diff(run.plan.com[:2], axis=0)) / np.diff(run.plan.time[:2])[0]
    assert recording.speed[0] == pytest.approx(planned_com_speed, rel=1e-3)


def test_progress_runs_from_start_to_end_of_the_track():
    run, recording = planned("paper_main", MAIN), simulated("paper_main", MAIN)
    assert np.all(np.diff(recording.arc_length) > 0)
    assert recording.arc_length[-1] < run.plan.length <= recording.arc_length[-1] + 0.02
    simulation = start_simulation(run)
    assert simulation.fraction == 0.0 and simulation.running
    np.testing.assert_allclose(
        recording.time, np.arange(len(recording.time)) * recording.header["time_step"], atol=1e-12
    )
