"""The solver on programs of real steps, against exact solutions: easy ones, limited ones, impossible ones."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from unittest import mock

import numpy as np

from ski_addon.control import Controller, Dynamics, Formulation, Gains, OsqpSolver, Solution, TaskGain
from ski_addon.control.formulation import Problem
from ski_addon.control.gains import END_STOP_STRENGTH
from ski_addon.control.tasks import Desired
from ski_addon.pipeline import start_simulation
from ski_addon.snow import Snow
from ski_addon.spec import PushSpec, SkierSpec, SnowSpec
from tests.control.exact_solution import exact_solution, is_feasible
from tests.control.naive_program import NaiveProgram
from tests.ski_runs import COARSE, FAST, WEAK, default_model, planned, random_configuration, simulated

PLAIN = {"simulation.solver": "osqp"}


@dataclass(frozen=True)
class Recorded:
    """A step's program as it was built, as a dense one, and what the solver answered."""

    problem: Problem
    program: NaiveProgram
    solution: Solution


def copy_of(problem: Problem) -> Problem:
    arrays = (problem.hessian, problem.gradient, problem.constraints, problem.lower, problem.upper, problem.end_stops)
    return Problem(*(array.copy() for array in arrays))


def dense(formulation: Formulation, problem: Problem) -> NaiveProgram:
    P, A = formulation.hessian_pattern.copy(), formulation.constraint_pattern.copy()
    P.data, A.data = problem.hessian.copy(), problem.constraints.copy()
    upper = P.toarray()
    symmetric = upper + np.triu(upper, 1).T
    return NaiveProgram(symmetric, problem.gradient.copy(), A.toarray(), problem.lower.copy(), problem.upper.copy())


@functools.cache
def bank(weak: bool) -> tuple[Formulation, tuple[Recorded, ...]]:
    """Programs at recorded states of a run at 12 m/s and 42 degrees of lean, a strong skier's or a weak one's."""
    # states are set by hand here: a skier who steers to stay up would feel a push at every leap from state to state
    changes = PLAIN | (WEAK if weak else {**FAST, "technique.balance": "tracking"})
    recording, simulation = simulated("paper_main", changes), start_simulation(planned("paper_main", changes))
    controller, dynamics = simulation.controller, simulation.dynamics
    recorded = recorded_programs(controller)
    for i in range(1, 400, 20) if weak else (*range(2, 850, 60), *range(856, 1000, 8)):
        dynamics.qpos[:], dynamics.qvel[:] = recording.qpos[i], recording.qvel[i]
        dynamics.update()
        controller.step(float(recording.progress[i]))
    return controller.program.formulation, tuple(recorded)


def recorded_programs(controller: Controller) -> list[Recorded]:
    """A list to which every program that `controller` solves from now on is added."""
    solve, recorded = controller.program.osqp.solve, []

    def recording_solve(problem: Problem) -> Solution:
        solution = solve(problem)
        program = dense(controller.program.formulation, problem)
        recorded.append(Recorded(copy_of(problem), program, solution))
        return solution

    controller.program.osqp.solve = recording_solve
    return recorded


def steered_bank() -> tuple[Formulation, list[Recorded]]:
    """Every twentieth step that is re-planned after a push of 150 N in the first turn."""
    push = PushSpec("abdomen", "left", 150.0, 0.3, 0.3)
    simulation = start_simulation(planned("paper_main", {**PLAIN, **COARSE, "push": (push,)}))
    controller = simulation.controller
    recorded, steered = recorded_programs(controller), []
    while simulation.step_done < 800 and simulation.advance(1):
        if controller.balance.blend > 0.5 and simulation.step_done % 20 == 0:
            steered.append(recorded[-1])
        recorded.clear()
    assert simulation.running
    return controller.program.formulation, steered


def ordinary_bank() -> tuple[Formulation, tuple[Recorded, ...]]:
    """Every sixtieth step of the strong skier's first turn."""
    formulation, steps = bank(weak=False)
    return formulation, steps[:15]


def limits_reached(formulation: Formulation, step: Recorded) -> tuple[int, int, int]:
    """How many torque rows, hinge rows and snow rows are at a bound."""
    rows = step.program.A @ step.solution.unknowns
    room = np.minimum(step.program.upper - rows, rows - step.program.lower)
    open_rows = step.program.upper - step.program.lower > 1e-9
    reached = (room < 1e-4) & open_rows
    n, hinges = formulation.accelerations, formulation.hinges
    return int(reached[6:n].sum()), int(reached[n : n + hinges].sum()), int(reached[n + hinges :].sum())


def assert_solved(formulation: Formulation, step: Recorded, acceleration: float, torque: float) -> None:
    """The exact solution is certified; accelerations [rad/s^2, m/s^2] and torques [of the human limit] are near it."""
    exact = exact_solution(step.program)
    assert exact.stationarity < 1e-7 and exact.infeasibility < 1e-7 and exact.complementarity < 1e-7
    n = formulation.accelerations
    error = step.solution.unknowns - exact.x
    assert np.abs(error[:n]).max() < acceleration
    assert np.abs(step.program.A[6:n] @ error).max() < torque
    root = step.program.A[:6] @ step.solution.unknowns - step.program.lower[:6]
    assert np.abs(root).max() / 0.01 <= 0.05, "root equations of motion [N, N m]"


def test_ordinary_steps_are_solved_to_a_thousandth():
    formulation, steps = ordinary_bank()
    for step in steps:
        assert step.solution.status == 0 and step.solution.attempts == 1
        assert_solved(formulation, step, 1e-3, 1e-2)


def test_steps_at_edge_switches_are_solved_to_a_thousandth():
    """A ski's second edge takes its load and gives it up again; its forces are at their fading bounds."""
    formulation, steps = bank(weak=False)
    steps = steps[15:]
    fading = []
    for step in steps:
        caps = step.program.upper[-formulation.forces :].reshape(2, 2, 2, formulation.segments)[:, 0, :, 0]
        fading.append(np.sum((caps > 0) & (caps < 4.0)))
        assert step.solution.status == 0
        assert_solved(formulation, step, 1e-3, 1e-2)
    assert np.sum(np.array(fading) > 0) > 5, "no edge was fading"
    assert sum(limits_reached(formulation, step)[2] > 0 for step in steps) > 3, "no snow force reached a bound"


def test_steps_of_a_skier_who_steers_to_stay_up_are_solved():
    """Within two thousandths of the largest acceleration, muscles and hinges at their limits or not."""
    formulation, steps = steered_bank()
    assert len(steps) > 10 and sum(max(limits_reached(formulation, step)) > 0 for step in steps) > 5
    for step in steps:
        assert step.solution.status == 0 and step.solution.attempts == 1
        largest = np.abs(step.solution.unknowns[: formulation.accelerations]).max()
        assert_solved(formulation, step, 2e-3 * largest, 1e-2)


def test_steps_at_torque_and_hinge_limits_are_solved():
    """Muscles of 42 percent are too weak: hips, ankles and trunk are at their limits until the skier falls."""
    formulation, steps = bank(weak=True)
    reached = np.array([limits_reached(formulation, step) for step in steps])
    assert np.sum(reached[:, 0] > 0) > 10 and np.sum(reached[:, 1] > 0) > 3
    for step in steps:
        assert step.solution.status == 0
        assert_solved(formulation, step, 1e-3, 1e-3)


def test_torques_and_hinges_stay_within_their_limits_to_the_tolerance():
    formulation, steps = bank(weak=True)
    for step in steps:
        rows = step.program.A @ step.solution.unknowns
        beyond = np.maximum(rows - step.program.upper, step.program.lower - rows)
        assert beyond[6:37].max() < 1e-3, "of the human torque"
        assert beyond[37:68].max() < 0.05, "rad/s^2"


def test_claim_28_snow_pushes_and_the_root_is_moved_by_nothing_else():
    """[SG19 Eq. 29] normal forces are not negative, and the six root rows are met to the solver's tolerance."""
    for formulation, steps in (bank(weak=False), bank(weak=True)):
        for step in steps:
            forces = step.solution.unknowns[37:].reshape(2, 2, 2, formulation.segments)
            assert 100.0 * forces[:, 0].min() > -0.05
            assert np.abs((step.program.A @ step.solution.unknowns - step.program.lower)[:6]).max() < 5e-4


def test_solving_again_from_cold_gives_the_same_answer():
    formulation, steps = ordinary_bank()
    for step in steps[::6]:
        again = OsqpSolver(formulation).solve(step.problem)
        np.testing.assert_allclose(again.unknowns[:37], step.solution.unknowns[:37], atol=3e-3)


# -- programs that cannot be solved ---------------------------------------------


def racing(speed: float, end_stops: bool = True) -> tuple[Formulation, Problem]:
    """A skier all of whose hinges race to the ends of their ranges at `speed` [rad/s], with or without end stops."""
    model = default_model()
    dynamics = Dynamics(model)
    rng = np.random.default_rng(0)
    dynamics.qpos[:] = random_configuration(model, rng, spread=0.0)
    dynamics.qpos[model.actuated_qpos] = model.joint_upper - 0.01
    dynamics.qvel[model.actuated_dof] = speed
    dynamics.update()
    strength = END_STOP_STRENGTH if end_stops else 0.0
    with mock.patch("ski_addon.control.hinge_ranges.END_STOP_STRENGTH", strength):
        formulation = Formulation(model, Snow.of(SnowSpec(), SkierSpec()), Gains(), 5)
    desired = Desired()
    desired.ski_axes[:] = np.eye(3)
    desired.com_axes[:] = np.eye(3)[1:]
    return formulation, formulation.build(dynamics, desired, np.zeros(2), np.array([0.0, 0.0, 1.0]))


def test_program_that_contradicts_itself_is_recognised_and_answered_without_hinge_ranges():
    """Hinges that cannot be stopped by any allowed torque: the ranges give way, torques and snow keep theirs."""
    formulation, problem = racing(12.0, end_stops=False)
    program = dense(formulation, problem)
    assert not is_feasible(program)
    solution = OsqpSolver(formulation).solve(copy_of(problem))
    assert solution.attempts == 3 and np.all(np.isfinite(solution.unknowns))
    kept = np.ones(len(program.lower), dtype=bool)
    kept[formulation.hinge_rows] = False
    relaxed = NaiveProgram(program.P, program.q, program.A[kept], program.lower[kept], program.upper[kept])
    assert is_feasible(relaxed) and solution.status == 0
    exact = exact_solution(relaxed)
    assert exact.infeasibility < 1e-6 and exact.stationarity < 1e-5
    rows = relaxed.A @ solution.unknowns
    assert max((rows - relaxed.upper)[:37].max(), (relaxed.lower - rows)[:37].max()) < 1e-2
    assert np.abs(solution.unknowns[:37] - exact.x[:37]).max() < 0.01 * np.abs(exact.x[:37]).max()


def test_end_stops_hold_hinges_that_muscles_cannot():
    """The same skier with bones and boots: every hinge stops within its range, those that run into an end by it."""
    formulation, problem = racing(12.0)
    assert is_feasible(dense(formulation, problem))
    solution = OsqpSolver(formulation).solve(copy_of(problem))
    assert solution.status == 0 and solution.attempts < 3
    rows = dense(formulation, problem).A @ solution.unknowns
    assert (rows - problem.upper)[formulation.hinge_rows].max() < 0.05
    assert np.all(formulation.torque_lower < formulation.model.torque_lower)
    np.testing.assert_array_equal(formulation.torque_upper, formulation.model.torque_upper)


def test_same_skier_going_slowly_can_be_answered():
    formulation, problem = racing(0.05)
    assert is_feasible(dense(formulation, problem))
    assert OsqpSolver(formulation).solve(problem).status == 0


def test_an_impossible_step_leaves_no_trace():
    """The step after one that could not be solved is answered as if nothing had been."""
    formulation, steps = ordinary_bank()
    step = steps[5]
    solver = OsqpSolver(formulation)
    before = solver.solve(step.problem)
    _, impossible = racing(12.0, end_stops=False)
    assert solver.solve(copy_of(impossible)).attempts == 3
    after = solver.solve(step.problem)
    assert (after.status, after.attempts) == (0, 1)
    np.testing.assert_allclose(after.unknowns[:37], before.unknowns[:37], atol=5e-3)
    for _ in range(3):  # warm from its own answer again, it is as quick as ever
        after = solver.solve(step.problem)
    assert after.iterations <= 15


def test_program_with_no_numbers_in_it_is_not_called_solved():
    formulation, steps = ordinary_bank()
    broken = copy_of(steps[0].problem)
    broken.gradient[:] = np.nan
    solution = OsqpSolver(formulation).solve(broken)
    assert solution.status != 0 and np.all(np.isfinite(solution.unknowns))


def test_exact_solutions_are_exact():
    """The judge is judged: a program small enough to solve by hand, one unknown fixed, one at its bound, one free."""
    bounds = np.array([[-1.0, 5.0], [-1.0, 2.0], [4.0, 4.0]]).T
    program = NaiveProgram(np.diag([2.0, 2.0, 2.0]), np.array([-2.0, -6.0, 0.0]), np.eye(3), *bounds)
    found = exact_solution(program)
    np.testing.assert_allclose(found.x, [1.0, 2.0, 4.0], atol=1e-12)
    np.testing.assert_allclose(found.y, [0.0, 2.0, -8.0], atol=1e-12)
    assert found.worst < 1e-12


def test_weights_change_the_answer_as_they_should():
    """Ten times the weight on the centre of mass brings its acceleration nearer to what is asked."""
    errors = []
    model = default_model()
    for weight in (0.1, 1.0, 10.0):
        dynamics = Dynamics(model)
        dynamics.qpos[:] = random_configuration(model, np.random.default_rng(1), spread=0.3)
        dynamics.update()
        gains = Gains(com=TaskGain(100.0, 20.0, weight))
        formulation = Formulation(model, Snow.of(SnowSpec(), SkierSpec()), gains, 5)
        desired = Desired()
        desired.ski_axes[:] = np.eye(3)
        desired.com_axes[:] = np.eye(3)[1:]
        desired.com[:] = 3.0, 2.0
        problem = formulation.build(dynamics, desired, np.zeros(2), np.array([0.0, 0.0, 1.0]))
        x = OsqpSolver(formulation).solve(problem).unknowns
        got = desired.com_axes @ (dynamics.inertia[:3] @ x[:37] / model.mass + dynamics.com_bias)
        errors.append(np.linalg.norm(got - desired.com))
    assert errors[0] > errors[1] > errors[2]
