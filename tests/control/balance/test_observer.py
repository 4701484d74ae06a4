"""Feeling a push, at the real body in motion."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from ski_addon.control import Dynamics
from ski_addon.control.balance import DisturbanceObserver
from tests.ski_runs import default_model, random_dynamics

STEP = 0.001


def felt(dynamics: Dynamics, body: str, force: np.ndarray, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """The estimate (37,) after some steps of a constant force at a body's centre of mass, and the true one."""
    model = dynamics.model
    observer = DisturbanceObserver(dynamics, STEP)
    rng, jacobian = np.random.default_rng(1), np.zeros((3, model.mujoco.nv))
    number = model.skeleton.body(body) + 1
    true = np.zeros(model.mujoco.nv)
    for _ in range(steps):
        dynamics.update()
        estimate = observer.update()
        torque, snow = 20.0 * rng.normal(size=31), 50.0 * rng.normal(size=37)
        observer.commanded(torque, snow)
        mujoco.mj_jacBodyCom(model.mujoco, dynamics.data, jacobian, None, number)
        true = force @ jacobian
        dynamics.integrate(dynamics.accelerations(torque, snow, true), STEP)
    return estimate.copy(), true[model.body_dof]


def quiet(seed: int) -> Dynamics:
    dynamics = random_dynamics(default_model(), seed)
    dynamics.qvel[:] *= 0.2
    return dynamics


@pytest.mark.parametrize("body", ["head", "abdomen", "shank.L", "ski.R"])
def test_a_constant_push_is_found_within_five_percent(body):
    force = np.array([40.0, -180.0, 30.0])
    estimate, true = felt(quiet(3), body, force, 40)
    np.testing.assert_allclose(estimate[:3], force, atol=0.05 * np.linalg.norm(force))
    assert np.linalg.norm(estimate - true) < 0.05 * np.linalg.norm(true)


def test_without_a_push_nothing_is_felt():
    estimate, _ = felt(quiet(4), "head", np.zeros(3), 30)
    assert np.abs(estimate).max() < 1e-6


def test_the_first_step_feels_nothing():
    assert np.all(felt(quiet(5), "head", np.array([0.0, 500.0, 0.0]), 1)[0] == 0.0)


def test_a_push_fades_in_with_the_time_of_the_filter():
    from ski_addon.control.balance.observer import SMOOTHING_TIME

    force = np.array([0.0, 100.0, 0.0])
    steps = round(SMOOTHING_TIME / STEP)
    estimate, _ = felt(quiet(6), "abdomen", force, steps + 1)
    assert estimate[1] == pytest.approx(100.0 * (1.0 - (1.0 - STEP / SMOOTHING_TIME) ** steps), rel=0.02)
