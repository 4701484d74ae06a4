"""Every Jacobian and bias by finite differences, and the reduced dynamics against MuJoCo's whole model."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from ski_addon.body import build_skier_model
from ski_addon.body.model import GRAVITY
from ski_addon.control import Dynamics
from ski_addon.spec import SkierSpec
from tests.ski_runs import default_model, random_dynamics

SEEDS = range(6)
STEP = 1e-5


def with_stiff_poles():
    """Heavy poles on strong springs: what their elimination leaves out would show."""
    return build_skier_model(SkierSpec(pole_mass=1.0, pole_stiffness=50.0, pole_damping=2.0))


MODELS = {"default": default_model, "heavy poles": with_stiff_poles}


@pytest.fixture(params=[(kind, seed) for kind in MODELS for seed in SEEDS[: 6 if kind == "default" else 2]], ids=str)
def dynamics(request) -> Dynamics:
    kind, seed = request.param
    return random_dynamics(MODELS[kind](), seed)


def moved(dynamics: Dynamics, time: float, acceleration: np.ndarray | None = None) -> Dynamics:
    """The same skier a little later (or earlier), by the Taylor series of its motion."""
    other = Dynamics(dynamics.model, dynamics.drag_factor)
    other.qpos[:] = dynamics.qpos
    acceleration = np.zeros(len(dynamics.qvel)) if acceleration is None else acceleration
    mujoco.mj_integratePos(dynamics.model.mujoco, other.qpos, dynamics.qvel + 0.5 * time * acceleration, time)
    other.qvel[:] = dynamics.qvel + time * acceleration
    other.update()
    return other


def central(dynamics: Dynamics, quantity, acceleration: np.ndarray | None = None, step: float = STEP) -> np.ndarray:
    """Time derivative of `quantity(dynamics)` by central differences along the motion."""
    after, before = (moved(dynamics, sign * step, acceleration) for sign in (1, -1))
    return (quantity(after) - quantity(before)) / (2 * step)


def ski_pose_rate(dynamics: Dynamics, direction: np.ndarray) -> np.ndarray:
    """Velocity (2, 6) of the ski frames when the velocity were `direction` (41,), by finite differences of poses."""
    probe = moved(dynamics, 0.0)
    probe.qvel[:] = direction
    after, before = (moved(probe, sign * STEP) for sign in (1, -1))
    out = np.empty((2, 6))
    for ski in range(2):
        out[ski, :3] = (after.ski_position(ski) - before.ski_position(ski)) / (2 * STEP)
        spin = (after.ski_rotation(ski) - before.ski_rotation(ski)) / (2 * STEP) @ dynamics.ski_rotation(ski).T
        out[ski, 3:] = spin[2, 1], spin[0, 2], spin[1, 0]
    return out


def basis(dynamics: Dynamics, column: int) -> np.ndarray:
    """Unit velocity (41,) of the `column`-th of the 37 controlled degrees of freedom."""
    out = np.zeros(len(dynamics.qvel))
    out[dynamics.model.body_dof[column]] = 1.0
    return out


# -- Jacobians ---------------------------------------------


def test_ski_jacobian_by_finite_differences(dynamics):
    for column in range(37):
        rate = ski_pose_rate(dynamics, basis(dynamics, column))
        np.testing.assert_allclose(dynamics.ski_jacobian[:, :, column], rate, atol=1e-7)


def test_ski_velocity_is_the_jacobians(dynamics):
    np.testing.assert_allclose(dynamics.ski_velocity, ski_pose_rate(dynamics, dynamics.qvel.copy()), atol=1e-6)
    np.testing.assert_allclose(dynamics.ski_velocity, dynamics.ski_jacobian @ dynamics.velocity, atol=1e-12)


def test_com_jacobian_is_the_mass_matrix_over_the_mass_by_finite_differences(dynamics):
    """M[0:3] / m of the whole model; poles move the centre of mass too."""
    full = np.zeros((41, 41))
    mujoco.mj_fullM(dynamics.model.mujoco, dynamics.data, full)
    for column in range(41):
        probe = moved(dynamics, 0.0)
        probe.qvel[:] = np.eye(41)[column]
        rate = central(probe, lambda d: d.com.copy())
        np.testing.assert_allclose(full[:3, column] / dynamics.model.mass, rate, atol=1e-8)
    np.testing.assert_allclose(dynamics.com_velocity, full[:3] @ dynamics.qvel / dynamics.model.mass, atol=1e-12)


def test_momentum_is_mujocos(dynamics):
    matrix = np.zeros((6, 41))
    mujoco.mj_angmomMat(dynamics.model.mujoco, dynamics.data, matrix[:3], 1)
    np.testing.assert_allclose(dynamics.momentum, matrix[:3] @ dynamics.qvel, atol=1e-10)


# -- biases ---------------------------------------------


def free_accelerations(dynamics: Dynamics, seed: int = 9) -> tuple[np.ndarray, np.ndarray]:
    """Any accelerations (37,) of the body, and with them those of the whole model (41,) with passive poles."""
    body, pole = dynamics.model.body_dof, dynamics.model.pole_dof
    wanted = np.random.default_rng(seed).normal(size=37) * 5.0
    full = np.zeros((41, 41))
    mujoco.mj_fullM(dynamics.model.mujoco, dynamics.data, full)
    net = dynamics.data.qfrc_bias - dynamics.data.qfrc_passive - dynamics.applied
    whole = np.zeros(41)
    whole[body] = wanted
    whole[pole] = np.linalg.solve(full[np.ix_(pole, pole)], -net[pole] - full[np.ix_(pole, body)] @ wanted)
    return wanted, whole


def test_ski_bias_by_finite_differences(dynamics):
    """J' q' : what is left of the skis' acceleration when no velocity changes."""
    rate = central(dynamics, lambda d: d.ski_velocity.copy())
    np.testing.assert_allclose(dynamics.ski_bias, rate, atol=1e-5 * np.abs(rate).max())


def test_ski_acceleration_by_finite_differences(dynamics):
    wanted, whole = free_accelerations(dynamics)
    rate = central(dynamics, lambda d: d.ski_velocity.copy(), whole)
    got = dynamics.ski_jacobian @ wanted + dynamics.ski_bias
    np.testing.assert_allclose(got, rate, atol=1e-5 * np.abs(rate).max())


def test_com_acceleration_by_finite_differences(dynamics):
    """The reduced M[0:3] q'' / m + com_bias, with the poles swinging as they must."""
    wanted, whole = free_accelerations(dynamics)
    rate = central(dynamics, lambda d: d.com_velocity.copy(), whole)
    got = dynamics.inertia[:3] @ wanted / dynamics.model.mass + dynamics.com_bias
    np.testing.assert_allclose(got, rate, atol=1e-6)


def test_momentum_matrix_and_bias_by_finite_differences(dynamics):
    wanted, whole = free_accelerations(dynamics)
    rate = central(dynamics, lambda d: d.momentum.copy(), whole)
    got = dynamics.momentum_matrix @ wanted + dynamics.momentum_bias
    np.testing.assert_allclose(got, rate, atol=2e-6 * max(1.0, np.abs(rate).max()))


# -- equations of motion ---------------------------------------------


def random_forces(seed: int = 3) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return 30.0 * rng.normal(size=31), 200.0 * rng.normal(size=37)


def mujoco_acceleration(dynamics: Dynamics, torque: np.ndarray, snow: np.ndarray) -> np.ndarray:
    """q'' (41,) by MuJoCo's own forward dynamics, all forces given as applied ones."""
    model, data = dynamics.model, dynamics.model.new_data()
    data.qpos[:], data.qvel[:] = dynamics.qpos, dynamics.qvel
    data.qfrc_applied[:] = dynamics.applied
    data.qfrc_applied[model.actuated_dof] += torque
    data.qfrc_applied[model.body_dof] += snow
    mujoco.mj_forward(model.mujoco, data)
    return data.qacc.copy()


def test_forward_dynamics_is_mujocos(dynamics):
    torque, snow = random_forces()
    expected = mujoco_acceleration(dynamics, torque, snow)
    got = dynamics.accelerations(torque, snow)
    np.testing.assert_allclose(got, expected, atol=1e-8 * np.abs(expected).max())


def test_eliminating_the_poles_changes_nothing(dynamics):
    """37 degrees of freedom give the same root and hinge accelerations as all 41."""
    torque, snow = random_forces()
    force = snow - dynamics.bias
    force[6:] += torque
    reduced = np.linalg.solve(dynamics.inertia, force)
    whole = mujoco_acceleration(dynamics, torque, snow)[dynamics.model.body_dof]
    np.testing.assert_allclose(reduced, whole, atol=1e-8 * np.abs(whole).max())
    np.testing.assert_allclose(dynamics.inertia, dynamics.inertia.T, atol=1e-12)
    assert np.linalg.eigvalsh(dynamics.inertia).min() > 0


def test_inverse_dynamics_of_the_whole_model_gives_the_forces_back(dynamics):
    """mj_inverse of the accelerations: the torques on driven hinges, nothing on the poles' beyond spring and air."""
    torque, snow = random_forces()
    data = dynamics.model.new_data()
    data.qpos[:], data.qvel[:] = dynamics.qpos, dynamics.qvel
    data.qacc[:] = dynamics.accelerations(torque, snow)
    mujoco.mj_inverse(dynamics.model.mujoco, data)
    needed = data.qfrc_inverse - dynamics.applied
    needed[dynamics.model.body_dof] -= snow
    np.testing.assert_allclose(needed[dynamics.model.actuated_dof], torque, atol=1e-7)
    np.testing.assert_allclose(needed[dynamics.model.pole_dof], 0.0, atol=1e-7)
    np.testing.assert_allclose(needed[:6], 0.0, atol=1e-6)


# -- air ---------------------------------------------


def test_drag_decelerates_the_centre_of_mass_and_nothing_else():
    """Falling freely: c'' = g - k |v| v, and no angular momentum about the centre of mass changes."""
    dynamics = random_dynamics(default_model(), 1, drag_factor=0.01)
    fall = dynamics.accelerations(np.zeros(31), np.zeros(37))
    acceleration = central(dynamics, lambda d: d.com_velocity.copy(), fall)
    velocity = dynamics.com_velocity
    np.testing.assert_allclose(acceleration, GRAVITY - 0.01 * np.linalg.norm(velocity) * velocity, atol=1e-6)
    np.testing.assert_allclose(central(dynamics, lambda d: d.momentum.copy(), fall), 0.0, atol=1e-5)


def test_without_drag_nothing_is_applied():
    dynamics = random_dynamics(default_model(), 1, drag_factor=0.0)
    assert np.all(dynamics.applied == 0.0)


def test_integration_is_semi_implicit():
    dynamics = random_dynamics(default_model(), 2)
    qpos, qvel = dynamics.qpos.copy(), dynamics.qvel.copy()
    acceleration = np.random.default_rng(0).normal(size=41)
    dynamics.integrate(acceleration, 0.01)
    np.testing.assert_allclose(dynamics.qvel, qvel + 0.01 * acceleration)
    mujoco.mj_integratePos(dynamics.model.mujoco, qpos, qvel + 0.01 * acceleration, 0.01)
    np.testing.assert_array_equal(dynamics.qpos, qpos)
    assert dynamics.data.time == pytest.approx(0.01)
