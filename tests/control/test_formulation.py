"""The program that is built against one written down independently from MuJoCo's whole model."""

from __future__ import annotations

import dataclasses

import mujoco
import numpy as np
import pytest

from ski_addon.body import build_skier_model
from ski_addon.control import Dynamics, Formulation, Gains, TaskGain
from ski_addon.control.tasks import Desired
from ski_addon.frames import matrix_from_quaternion, rotation_about
from ski_addon.snow import Snow
from ski_addon.spec import SkierSpec, SnowSpec
from tests.control.naive_program import NaiveProgram, Snowpack, naive_program
from tests.ski_runs import default_model, random_dynamics

NORMAL = np.array([np.sin(0.2), 0.0, np.cos(0.2)])
EDGES = [(0.3, 0.35), (-0.3, -0.2), (0.0, 0.0), (0.06, -0.05), (np.deg2rad(0.6), np.deg2rad(-3.0))]
TASKS = ("ski", "edging", "com", "pose", "leg_pose", "pelvis", "angular_momentum")


def random_desired(seed: int) -> Desired:
    """Any wish whatever, in any axes."""
    rng = np.random.default_rng(seed)
    desired = Desired()
    for field in dataclasses.fields(Desired):
        array = getattr(desired, field.name)
        array[:] = 10.0 * rng.normal(size=array.shape)
    quaternions = rng.normal(size=(2, 4))
    desired.ski_axes[:] = matrix_from_quaternion(quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True))
    desired.com_axes[:] = rotation_about("x", 0.3)[1:]
    return desired


def formulation_of(model, gains: Gains | None = None, segments: int = 5, **snow) -> tuple[Formulation, Snowpack]:
    spec = SnowSpec(**snow)
    skeleton = model.skeleton
    limit = np.inf if spec.shear_limit == "unlimited" else spec.shear_limit
    pack = Snowpack(spec.friction, spec.friction_per_speed, limit, segments, skeleton.ski_length, skeleton.ski_width)
    return Formulation(model, Snow.of(spec, SkierSpec()), gains or Gains(), segments), pack


def dense(formulation: Formulation, problem) -> NaiveProgram:
    """The built program with its sparse non-zeros put where the patterns say."""
    P, A = formulation.hessian_pattern.copy(), formulation.constraint_pattern.copy()
    P.data, A.data = problem.hessian.copy(), problem.constraints.copy()
    upper = P.toarray()
    return NaiveProgram(
        upper + np.triu(upper, 1).T, problem.gradient.copy(), A.toarray(), problem.lower.copy(), problem.upper.copy()
    )


def assert_same(got: NaiveProgram, expected: NaiveProgram) -> None:
    for name in ("P", "q", "A", "lower", "upper"):
        a, b = getattr(got, name), getattr(expected, name)
        np.testing.assert_allclose(a, b, atol=1e-9 * max(1.0, np.abs(b).max()), err_msg=name)


def both(dynamics: Dynamics, formulation, pack, edges, seed=0, gains=None, absent=()):
    desired = random_desired(seed)
    edge_angle = np.array(edges)
    built = dense(formulation, formulation.build(dynamics, desired, edge_angle, NORMAL))
    return built, naive_program(dynamics, desired, gains or Gains(), pack, edge_angle, NORMAL, absent)


@pytest.mark.parametrize("seed", range(len(EDGES)))
def test_program_is_the_one_written_down_by_hand(seed):
    formulation, pack = formulation_of(default_model())
    assert_same(*both(random_dynamics(default_model(), seed), formulation, pack, EDGES[seed], seed))


def test_program_of_another_skier_on_other_snow():
    skier = SkierSpec(mass=95, height=1.9, sex="female", ski_length=1.6, ski_width=0.1, strength=0.6, pole_mass=0.8)
    model = build_skier_model(skier)
    formulation, pack = formulation_of(model, segments=3, friction=0.2, friction_per_speed=0.02, shear_limit=400)
    assert_same(*both(random_dynamics(model, 11, drag_factor=0.01), formulation, pack, (0.05, 0.4), 11))


def test_building_again_leaves_nothing_of_the_last_state():
    formulation, pack = formulation_of(default_model())
    formulation.build(random_dynamics(default_model(), 5), random_desired(5), np.array([0.3, -0.3]), NORMAL)
    assert_same(*both(random_dynamics(default_model(), 6), formulation, pack, (-0.01, 0.2), 6))


@pytest.mark.parametrize("task", TASKS)
def test_zero_weight_is_the_same_as_no_task(task):
    gains = dataclasses.replace(Gains(), **{task: TaskGain(100.0, 20.0, 0.0)})
    formulation, pack = formulation_of(default_model(), gains)
    assert_same(*both(random_dynamics(default_model(), 3), formulation, pack, (0.2, 0.2), 3, gains, absent=(task,)))


def test_every_task_has_an_effect():
    """Else the test above could not fail."""
    formulation, _ = formulation_of(default_model())
    dynamics, edge = random_dynamics(default_model(), 3), np.array([0.2, 0.2])
    with_all = dense(formulation, formulation.build(dynamics, random_desired(3), edge, NORMAL))
    for task in TASKS:
        gains = dataclasses.replace(Gains(), **{task: TaskGain(100.0, 20.0, 0.0)})
        without = formulation_of(default_model(), gains)[0]
        other = dense(without, without.build(dynamics, random_desired(3), edge, NORMAL))
        assert np.abs(other.P - with_all.P).max() > 1e-4, task
        assert np.abs(other.q - with_all.q).max() > 1e-4, task


def test_hessian_is_positive_definite():
    """So that every program has one answer."""
    formulation, _ = formulation_of(default_model())
    for seed in range(3):
        dynamics = random_dynamics(default_model(), seed)
        built = dense(formulation, formulation.build(dynamics, random_desired(seed), np.array([0.1, 0.1]), NORMAL))
        assert np.linalg.eigvalsh(built.P).min() > 1e-7


@pytest.mark.parametrize("seed", range(3))
def test_torques_are_the_inverse_dynamics_of_the_whole_model(seed):
    """mj_inverse of the 41 accelerations less the snow's and the air's forces; the root residual is what is missing."""
    model = default_model()
    dynamics = random_dynamics(model, seed)
    formulation, _ = formulation_of(model)
    formulation.build(dynamics, random_desired(seed), np.array([0.1, 0.1]), NORMAL)
    unknowns = np.random.default_rng(seed).normal(size=formulation.unknowns)
    torque, snow = formulation.torques(dynamics, unknowns), formulation.snow_force(unknowns)
    residual = formulation.root_residual(dynamics, unknowns)

    body, pole = model.body_dof, model.pole_dof
    full = np.zeros((41, 41))
    mujoco.mj_fullM(model.mujoco, dynamics.data, full)
    data = model.new_data()
    data.qpos[:], data.qvel[:] = dynamics.qpos, dynamics.qvel
    data.qacc[body] = unknowns[:37]
    free = dynamics.data.qfrc_passive + dynamics.applied - dynamics.data.qfrc_bias
    data.qacc[pole] = np.linalg.solve(full[np.ix_(pole, pole)], free[pole] - full[np.ix_(pole, body)] @ unknowns[:37])
    mujoco.mj_inverse(model.mujoco, data)
    needed = data.qfrc_inverse - dynamics.applied
    np.testing.assert_allclose(needed[model.actuated_dof] - snow[6:], torque, atol=1e-8 * np.abs(torque).max())
    np.testing.assert_allclose(needed[pole], 0.0, atol=1e-8)
    assert np.abs(needed[:6] - snow[:6]).max() == pytest.approx(residual, rel=1e-9)


# -- snow in the program ---------------------------------------------


def built_bounds(edges, **snow) -> tuple[np.ndarray, np.ndarray]:
    """Bounds (ski, normal or side, left or right edge, segment) of the forces [100 N]."""
    formulation, _ = formulation_of(default_model(), **snow)
    problem = formulation.build(random_dynamics(default_model(), 0), random_desired(0), np.array(edges), NORMAL)
    shape = (2, 2, 2, formulation.segments)
    return problem.lower[-formulation.forces :].reshape(shape), problem.upper[-formulation.forces :].reshape(shape)


def test_claim_27_only_the_edges_that_cut_the_snow_carry():
    """Leaning left, both skis stand on their left edges: nothing from the right ones, and no push from the left."""
    lower, upper = built_bounds((0.4, 0.4))
    assert np.all(upper[:, :, 1] == 0.0) and np.all(lower[:, :, 1] == 0.0)
    assert np.all(upper[:, 0, 0] > 5.0) and np.all(upper[:, 1, 0] > 5.0) and np.all(lower[:, 1, 0] == 0.0)
    mirrored_lower, mirrored_upper = built_bounds((-0.4, -0.4))
    np.testing.assert_array_equal(mirrored_upper[:, 0, ::-1], upper[:, 0])
    np.testing.assert_array_equal(-mirrored_lower[:, 1, ::-1], upper[:, 1])
    np.testing.assert_array_equal(-mirrored_upper[:, 1, ::-1], lower[:, 1])


def test_snow_never_pulls():
    for edges in EDGES:
        assert np.all(built_bounds(edges)[0][:, 0] == 0.0)


def test_bounds_change_evenly_with_the_edge_angle():
    """But for the step at half a degree where a flat ski begins to lift an edge."""
    angles = np.deg2rad(np.linspace(0.6, 9.0, 60))
    upper = np.array([built_bounds((angle, angle))[1] for angle in angles])
    lower = np.array([built_bounds((angle, angle))[0] for angle in angles])
    assert np.abs(np.diff(upper, axis=0)).max() < 0.05 and np.abs(np.diff(lower, axis=0)).max() < 0.05
    assert upper[:, :, 0, 1].min() == 0.0 < upper[0, 0, 0, 1, 0]


@pytest.mark.parametrize("edges", [(0.4, 0.4), (-0.4, 0.2), (0.05, 0.05), (0, 0)])
def test_grip_limit_is_a_whole_skis(edges):
    lower, upper = built_bounds(edges, shear_limit=300)
    for ski in range(2):
        assert 100.0 * upper[ski, 1].sum() <= 300.0 + 1e-9
        assert -100.0 * lower[ski, 1].sum() <= 300.0 + 1e-9


def test_friction_opposes_each_skis_motion_and_side_force_is_across_the_ski():
    formulation, pack = formulation_of(default_model())
    for seed in range(4):
        dynamics = random_dynamics(default_model(), seed)
        formulation.build(dynamics, random_desired(seed), np.array([0.2, 0.2]), NORMAL)
        for ski in range(2):
            for point in range(formulation.per_ski):
                unknowns = np.zeros(formulation.unknowns)
                unknowns[37 + ski * formulation.per_ski + point] = 1.0
                force = formulation.ski_forces(unknowns)
                assert np.all(force[1 - ski] == 0.0)
                normal, velocity = force[ski] @ NORMAL, dynamics.ski_velocity[ski, :3]
                velocity = velocity - (velocity @ NORMAL) * NORMAL
                if point < 2 * formulation.segments:
                    mu = pack.friction + pack.friction_per_speed * np.linalg.norm(velocity)
                    assert normal == pytest.approx(100.0)
                    expected = 100.0 * NORMAL - 100.0 * mu * velocity / np.linalg.norm(velocity)
                    np.testing.assert_allclose(force[ski], expected, atol=1e-9)
                else:
                    fore, left = dynamics.ski_rotation(ski)[:, 0], dynamics.ski_rotation(ski)[:, 1]
                    assert normal == pytest.approx(0.0, abs=1e-9) and force[ski] @ fore == pytest.approx(0.0, abs=1e-9)
                    assert np.linalg.norm(force[ski]) == pytest.approx(100.0)
                    level = np.sign(dynamics.ski_rotation(ski)[:, 2] @ NORMAL)
                    assert level * (force[ski] @ left) > 0


def test_edge_and_ski_forces_add_up():
    formulation, _ = formulation_of(default_model())
    dynamics = random_dynamics(default_model(), 1)
    formulation.build(dynamics, random_desired(1), np.array([0.2, 0.2]), NORMAL)
    unknowns = np.random.default_rng(0).uniform(0, 1, formulation.unknowns)
    normal, side = formulation.edge_forces(unknowns)
    force = formulation.ski_forces(unknowns)
    np.testing.assert_allclose(force @ NORMAL, normal.sum(axis=1), atol=1e-9)
    points = unknowns[37:].reshape(2, 2, 2, 5) * 100.0
    np.testing.assert_allclose(normal[1, 0], points[1, 0, 0].sum())
    np.testing.assert_allclose(side[0, 1], points[0, 1, 1].sum())
    np.testing.assert_allclose(formulation.snow_force(unknowns)[:3], force.sum(axis=0), atol=1e-9)


def test_load_moments_are_the_normal_forces_at_their_points():
    formulation, pack = formulation_of(default_model())
    dynamics = random_dynamics(default_model(), 2)
    formulation.build(dynamics, random_desired(2), np.array([0.2, 0.2]), NORMAL)
    unknowns = np.random.default_rng(3).uniform(0, 1, formulation.unknowns)
    forces = unknowns[37:].reshape(2, 2, 2, pack.segments)[:, 0] * 100.0
    along = (np.arange(pack.segments) + 0.5) * pack.length / pack.segments - 0.5 * pack.length
    for ski, moment in enumerate(formulation.load_moments(unknowns)):
        local = [np.sum(forces[ski] * along), 0.5 * pack.width * (forces[ski, 0] - forces[ski, 1]).sum(), 0.0]
        np.testing.assert_allclose(moment, dynamics.ski_rotation(ski) @ local, atol=1e-9)


def test_a_felt_push_is_reckoned_with_in_forces_and_torques():
    """M q'' + h - outside = tau + J'f: rows, torques and residual all shift by the push."""
    formulation, _ = formulation_of(default_model())
    dynamics, edge = random_dynamics(default_model(), 4), np.array([0.1, 0.1])
    unknowns = np.random.default_rng(4).normal(size=formulation.unknowns)

    def look():
        built = dense(formulation, formulation.build(dynamics, random_desired(4), edge, NORMAL))
        return built, formulation.torques(dynamics, unknowns)

    without, torque = look()
    outside = 50.0 * np.random.default_rng(5).normal(size=37)
    dynamics.outside = outside
    felt, felt_torque = look()
    scale = np.concatenate(
        (np.full(6, 0.01), 1.0 / np.maximum(dynamics.model.torque_upper, -dynamics.model.torque_lower))
    )
    np.testing.assert_allclose(felt.lower[:37] - without.lower[:37], scale * outside, atol=1e-9)
    np.testing.assert_allclose(felt.upper[:37] - without.upper[:37], scale * outside, atol=1e-9)
    np.testing.assert_allclose(felt_torque - torque, -outside[6:], atol=1e-9)
    for name in ("P", "q", "A"):
        np.testing.assert_array_equal(getattr(felt, name), getattr(without, name))


def test_freed_legs_are_those_of_lighter_gains():
    dynamics, edge = random_dynamics(default_model(), 6), np.array([0.1, 0.1])
    formulation, _ = formulation_of(default_model())
    light = dataclasses.replace(Gains(), leg_pose=dataclasses.replace(Gains().leg_pose, weight=0.3 * 0.02))
    lighter, _ = formulation_of(default_model(), light)
    freed = dense(formulation, formulation.build(dynamics, random_desired(6), edge, NORMAL, 0.3))
    assert_same(freed, dense(lighter, lighter.build(dynamics, random_desired(6), edge, NORMAL)))
