"""Pushes from outside: what they do to a free body and to a skier, and what the controller may not know of them."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from ski_addon.body import centre_of_mass, forward_kinematics
from ski_addon.errors import SpecError
from ski_addon.pipeline import make_plan
from ski_addon.simulation.pushes import AXES, Pushes, world_force
from ski_addon.spec import PushSpec
from ski_addon.spec.rows import DIRECTIONS
from tests.ski_runs import default_model, mirrored_qpos, planned, preset, random_dynamics, simulated

SHORT = {"course.turn_count": 1, "course.turn_duration": 0.4, "simulation.time_step": 0.002}
PUSHED = {**SHORT, "push": (PushSpec("abdomen", "left", 100.0, 0.1, 0.1), PushSpec("head", "back", 60.0, 0.15, 0.2))}
TANGENT, NORMAL = np.array([0.8, 0.6, 0.0]), np.array([0.0, 0.0, 1.0])


def one_push(push: PushSpec, seed: int = 1):
    """A random state and the push's first step at it."""
    dynamics = random_dynamics(default_model(), seed)
    pushes = Pushes((push,), dynamics.model, 0.001)
    pushes.update(round(push.start / 0.001), dynamics, TANGENT, NORMAL)
    return dynamics, pushes


# -- a free body ---------------------------------------------------------------------


@pytest.mark.parametrize("body", ["pelvis", "head", "hand.L", "ski.R"])
def test_a_pushed_free_body_gains_its_impulse_and_the_moment_of_it(body):
    dynamics, pushes = one_push(PushSpec(body, "left", 200.0, 0.0, 0.5))
    model, none = dynamics.model, np.zeros(31)
    change = dynamics.accelerations(none, np.zeros(37), pushes.generalised) - dynamics.accelerations(none, np.zeros(37))
    full = np.zeros((41, 41))
    mujoco.mj_fullM(model.mujoco, dynamics.data, full)
    np.testing.assert_allclose(full[:3] @ change, pushes.force, atol=1e-9)
    rotation, root = dynamics.root_rotation, dynamics.body_position(1)
    at = dynamics.data.xipos[model.skeleton.body(body) + 1]
    about_com = rotation @ (full[3:6] @ change) - np.cross(dynamics.com - root, full[:3] @ change)
    np.testing.assert_allclose(about_com, np.cross(at - dynamics.com, pushes.force), atol=1e-9)


def test_a_flying_body_speeds_up_by_impulse_over_mass():
    """Without snow and torques, two flights from the same state: with and without the push."""
    model, speeds = default_model(), []
    for force in (0.0, 120.0):
        dynamics = random_dynamics(model, 3, drag_factor=0.0)
        pushes = Pushes((PushSpec("chest", "up", force, 0.005, 0.02),), model, 0.001)
        for step in range(40):
            dynamics.update()
            pushes.update(step, dynamics, TANGENT, NORMAL)
            dynamics.integrate(dynamics.accelerations(np.zeros(31), np.zeros(37), pushes.generalised), 0.001)
        dynamics.update()
        speeds.append(dynamics.com_velocity.copy())
    np.testing.assert_allclose(speeds[1] - speeds[0], [0, 0, 120.0 * 0.02 / model.mass], atol=2e-4)


def test_a_push_on_a_ski_acts_at_that_ski():
    """It works on the motion of that ski's centre of mass and reaches the root and the right leg's hinges only."""
    dynamics, pushes = one_push(PushSpec("ski.R", "forward", 50.0, 0.0, 0.5), seed=5)
    skeleton, body, step = dynamics.model.skeleton, dynamics.model.skeleton.body("ski.R"), 1e-6
    places = []
    for sign in (-1.0, 1.0):
        qpos = dynamics.qpos.copy()
        mujoco.mj_integratePos(dynamics.model.mujoco, qpos, dynamics.qvel, sign * step)
        position, rotation = forward_kinematics(skeleton, qpos[None])
        places.append(position[0, body] + rotation[0, body] @ skeleton.com[body])
    velocity = (places[1] - places[0]) / (2 * step)
    assert pushes.generalised @ dynamics.qvel == pytest.approx(pushes.force @ velocity, rel=1e-6)
    reached = {skeleton.joint_names[i - 6] for i in np.flatnonzero(pushes.generalised) if i >= 6}
    assert reached <= {f"{hinge}.R" for hinge in ("thigh_x", "thigh_y", "thigh_z", "shank_y", "foot_x", "foot_y")}
    assert len(reached) >= 5


# -- directions and times ----------------------------------------------------------------


def test_directions_are_the_six_of_the_tracks_frame():
    left = np.cross(NORMAL, TANGENT)
    expected = {"forward": TANGENT, "left": left, "up": NORMAL, "back": -TANGENT, "right": -left, "down": -NORMAL}
    assert set(AXES) == set(DIRECTIONS) == set(expected)
    for direction, axis in expected.items():
        np.testing.assert_allclose(
            world_force(PushSpec("head", direction, 3.0, 0.0), TANGENT, NORMAL), 3 * axis, atol=1e-15
        )


def test_direction_stays_as_it_was_when_the_push_started():
    dynamics, pushes = one_push(PushSpec("head", "left", 10.0, 0.02, 0.5))
    before = pushes.force.copy()
    pushes.update(21, dynamics, np.array([0.0, 1.0, 0.0]), NORMAL)
    np.testing.assert_array_equal(pushes.force, before)


@pytest.mark.parametrize(("start", "duration", "steps"), [(0.0, 0.01, 10), (0.0123, 0.05, 50), (0.02, 0.0104, 10)])
def test_a_push_acts_for_whole_steps_and_at_least_one(start, duration, steps):
    dynamics = random_dynamics(default_model(), 1)
    pushes = Pushes((PushSpec("head", "left", 10.0, start, duration),), dynamics.model, 0.001)
    active = []
    for step in range(100):
        pushes.update(step, dynamics, TANGENT, NORMAL)
        active.append(pushes.force.any() and pushes.generalised.any())
    assert sum(active) == steps and active.index(True) == round(start / 0.001)
    single = Pushes((PushSpec("head", "left", 10.0, 0.0, 0.01),), dynamics.model, 0.5)
    single.update(0, dynamics, TANGENT, NORMAL)
    assert np.linalg.norm(single.force) == pytest.approx(10.0)


# -- in a run ------------------------------------------------------------------------


def test_momentum_balances_in_the_recording_to_rounding():
    """Root rows of M q'' + h less the snow's force are the recorded push, at every step."""
    recording, model = simulated("paper_main", PUSHED), planned("paper_main", PUSHED).model
    data, step = model.new_data(), recording.header["time_step"]
    for i in range(len(recording.time) - 1):
        data.qpos[:], data.qvel[:] = recording.qpos[i], recording.qvel[i]
        data.qacc[:] = (recording.qvel[i + 1] - recording.qvel[i]) / step
        mujoco.mj_inverse(model.mujoco, data)
        force = data.qfrc_inverse[:3] - recording.snow_force[i].sum(axis=0)
        np.testing.assert_allclose(force, recording.push_force[i], atol=1e-9)


def test_recorded_pushes_are_those_asked_for():
    recording = simulated("paper_main", PUSHED)
    size = np.linalg.norm(recording.push_force, axis=1)
    first, both, second = size[50:75], size[75:100], size[100:175]
    np.testing.assert_allclose(first, 100.0, rtol=1e-6)
    np.testing.assert_allclose(both, np.hypot(100, 60), rtol=0.02)  # the track turns a little between the two starts
    np.testing.assert_allclose(second, 60.0, rtol=1e-6)
    assert not size[:50].any() and not size[175:].any()
    left = np.cross(recording.surface_normal[50], recording.track_tangent[50])
    np.testing.assert_allclose(recording.push_force[60], 100 * left, rtol=1e-6, atol=1e-6)
    assert not simulated("paper_main", SHORT).push_force.any()


def test_the_controller_learns_of_a_push_by_its_motion_only():
    """Torques and snow forces at the push's first step are those of the run without it; the next ones are not."""
    pushed, free = simulated("paper_main", PUSHED), simulated("paper_main", SHORT)
    np.testing.assert_array_equal(pushed.tau[:51], free.tau[:51])
    np.testing.assert_array_equal(pushed.snow_force[:51], free.snow_force[:51])
    assert np.abs(pushed.tau[51] - free.tau[51]).max() > 0.1


def test_mirrored_push_on_a_mirrored_track_is_the_mirrored_motion():
    runs = []
    for side, other in (("left", "right"), ("right", "left")):
        push = (PushSpec("hand.L" if side == "left" else "hand.R", other, 60.0, 0.05, 0.1),)
        runs.append(simulated("paper_main", {**SHORT, "course.first_turn": side, "push": push}))
    left, right = runs
    count = min(len(left.time), len(right.time))
    model = planned("paper_main", SHORT).model
    np.testing.assert_allclose(mirrored_qpos(model, left.qpos[:count]), right.qpos[:count], atol=1e-5)
    np.testing.assert_allclose(left.push_force[:count] * [1, -1, 1], right.push_force[:count], atol=1e-6)


def test_the_centre_of_mass_moves_the_way_it_was_pushed():
    pushed, free = simulated("paper_main", PUSHED), simulated("paper_main", SHORT)
    position, rotation = forward_kinematics(planned("paper_main", SHORT).model.skeleton, pushed.qpos)
    com = centre_of_mass(planned("paper_main", SHORT).model.skeleton, position, rotation)
    moved = (com[74] - free.com[74]) @ pushed.push_force[60] / 100.0
    assert moved == pytest.approx(0.5 * 100.0 / 50.0 * 0.05**2, rel=0.5)


# -- refusals ------------------------------------------------------------------------


def test_a_push_after_the_end_of_the_run_is_refused():
    late = (PushSpec("head", "left", 10.0, 0.1), PushSpec("head", "left", 10.0, 3.0))
    with pytest.raises(SpecError) as caught:
        make_plan(preset("paper_main", {**SHORT, "push": late}))
    assert str(caught.value) == (
        "push 2: start = 3.0 is outside 0..0.4 s, the planned run: start it earlier or make the course longer"
    )
