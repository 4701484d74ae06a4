"""The small system against the exact solution of the program as it is written down."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from ski_addon.control import Effort, Program, SmallProgram
from ski_addon.control.solver import OsqpSolver
from ski_addon.pipeline import start_simulation
from ski_addon.snow import Snow
from ski_addon.spec import SkierSpec, SnowSpec
from tests.control.exact_solution import Certified, exact_solution
from tests.control.test_formulation import EDGES, NORMAL, dense, formulation_of, random_desired
from tests.ski_runs import COARSE, FAST, WEAK, default_model, planned, random_dynamics

RUNS = {
    "at ease": ("paper_main", COARSE, 60),
    "at 42 degrees of lean": ("paper_main", {**FAST, "technique.balance": "tracking"}, 60),
    "between gates": ("slalom", {"simulation.time_step": 0.002}, 90),
    "over moguls": ("moguls", {"simulation.time_step": 0.002}, 90),
}


@dataclass(frozen=True)
class Step:
    """What the small system answered at one step, None if it would not, and the exact solution of the whole program."""

    effort: Effort | None
    exact: Certified
    torque: np.ndarray
    snow: np.ndarray
    limits: int
    """Torque and hinge rows at a limit."""


def compare(program: Program, steps: list[Step], every: int) -> None:
    """Make `program` note every so many steps how the small system answers, warm as it is, and what is exact."""
    small, formulation = program.small, program.formulation
    solve, calls = small.solve, []

    def noting(dynamics, desired, edge_angle, normal, leg_freedom):
        effort = solve(dynamics, desired, edge_angle, normal, leg_freedom)
        calls.append(None)
        if len(calls) % every == 0:
            written = dense(formulation, formulation.build(dynamics, desired, edge_angle, normal, leg_freedom))
            exact = exact_solution(written)
            n = formulation.accelerations
            rows = written.A @ exact.x
            room = np.minimum(rows - written.lower, written.upper - rows)[6 : n + formulation.hinges]
            torque, snow = formulation.torques(dynamics, exact.x), formulation.snow_force(exact.x)
            steps.append(Step(effort, exact, torque, snow, int(np.sum(room < 1e-7))))
        return effort

    small.solve = noting


@functools.cache
def steps_of(name: str) -> tuple[Step, ...]:
    preset, changes, every = RUNS[name]
    simulation = start_simulation(planned(preset, changes))
    steps: list[Step] = []
    compare(simulation.controller.program, steps, every)
    simulation.advance(1600)
    assert simulation.running or simulation.finished
    return tuple(steps)


@pytest.mark.parametrize("name", RUNS)
def test_answers_are_exact(name):
    """Accelerations to 1e-3 rad/s^2 and m/s^2, torques to a hundredth of a newton metre."""
    steps = steps_of(name)
    answered = [step for step in steps if step.effort is not None]
    assert len(answered) > 5 and len(answered) >= 0.5 * len(steps)
    for step in answered:
        assert step.exact.worst < 1e-6
        effort = step.effort
        np.testing.assert_allclose(effort.solution.unknowns[:37], step.exact.x[:37], atol=1e-3)
        np.testing.assert_allclose(effort.torque, step.torque, atol=1e-2)
        np.testing.assert_allclose(effort.snow, step.snow, atol=1e-2)
        assert effort.root_residual <= 1e-6


@pytest.mark.parametrize("name", RUNS)
def test_it_answers_where_no_limit_is_reached_and_only_there(name):
    for step in steps_of(name):
        assert (step.effort is None) == (step.limits > 0)


def test_moguls_bring_skiers_to_their_limits():
    """Else the test above would know one case only."""
    assert any(step.limits for step in steps_of("over moguls"))


@pytest.mark.parametrize("seed", range(len(EDGES)))
def test_forces_add_up_as_in_the_program_written_down(seed):
    """Any state, any forces: wrench on the body, force on root and hinges, sums by edge, moments of the load."""
    model = default_model()
    dynamics, edge = random_dynamics(model, seed), np.array(EDGES[seed])
    formulation, _ = formulation_of(model)
    small = SmallProgram(model, Snow.of(SnowSpec(), SkierSpec()), formulation.gains, 5)
    problem = formulation.build(dynamics, random_desired(seed), edge, NORMAL)
    patch = small.patch
    patch.place(dynamics, NORMAL)
    patch.set_bounds(edge)
    forces = np.random.default_rng(seed).normal(size=patch.count)
    unknowns = np.concatenate((np.zeros(37), forces))
    snow = formulation.snow_force(unknowns)
    np.testing.assert_allclose(patch.wrenches @ forces, dynamics.about_com @ snow[:6], atol=1e-8)
    wrench = patch.ski_wrenches(forces)
    np.testing.assert_allclose(np.einsum("si,sij->j", wrench, dynamics.ski_jacobian), snow, atol=1e-8)
    np.testing.assert_allclose(wrench[:, :3], formulation.ski_forces(unknowns), atol=1e-9)
    normal, side = formulation.edge_forces(unknowns)
    np.testing.assert_allclose(patch.edge_forces(forces)[:, 0], normal, atol=1e-9)
    np.testing.assert_allclose(patch.edge_forces(forces)[:, 1], side, atol=1e-9)
    np.testing.assert_allclose(patch.load_moments(dynamics, forces), formulation.load_moments(unknowns), atol=1e-9)
    np.testing.assert_array_equal(patch.lower, problem.lower[-patch.count :])
    np.testing.assert_array_equal(patch.upper, problem.upper[-patch.count :])


def weak_program(solver: str) -> SimpleNamespace:
    """A skier of 42 percent of strength in a turn of 12 m/s: beyond what the muscles give."""
    simulation = start_simulation(planned("paper_main", {**WEAK, "simulation.solver": solver}))
    simulation.advance(300)
    return simulation


def test_where_a_limit_is_reached_the_program_is_solved_as_it_is_written_down():
    simulation = weak_program("small")
    program, controller = simulation.controller.program, simulation.controller
    tried, asked = [], []
    small, osqp = program.small.solve, program.osqp.solve
    program.small.solve = lambda *given: tried.append(small(*given)) or tried[-1]
    program.osqp.solve = lambda problem: asked.append(osqp(problem)) or asked[-1]
    effort = controller.step(simulation.progress).effort
    assert tried == [None] and len(asked) == 1
    assert effort.solution is asked[0] and effort.solution.iterations > 1
    limit = np.where(effort.torque > 0, simulation.model.torque_upper, simulation.model.torque_lower)
    assert (effort.torque / limit).max() == pytest.approx(1.0, abs=1e-3)


def test_torques_never_pass_the_limits():
    """Of those who are at them often."""
    simulation = weak_program("small")
    recording = simulation.recording()
    assert (recording.torque_ratio > 0.999).any()
    assert recording.torque_ratio.max() <= 1.0 + 1e-9


def test_asked_for_osqp_only_osqp_is_used():
    program = start_simulation(planned("paper_main", {**COARSE, "simulation.solver": "osqp"})).controller.program
    assert program.small is None and isinstance(program.osqp, OsqpSolver)


def test_both_solvers_ski_the_same_run():
    """Two turns: where they part they differ by OSQP's tolerance only."""
    runs = []
    for solver in ("small", "osqp"):
        simulation = start_simulation(planned("paper_main", {**COARSE, "simulation.solver": solver}))
        simulation.advance(5000)
        runs.append(simulation.recording())
    small, osqp = runs
    assert small.header["status"] == osqp.header["status"] == "finished"
    assert len(small.time) == len(osqp.time)
    np.testing.assert_allclose(small.com, osqp.com, atol=2e-3)
    np.testing.assert_allclose(small.snow_force, osqp.snow_force, atol=0.05 * np.abs(osqp.snow_force).max())
    assert np.all(small.solver_iterations <= osqp.solver_iterations)
