"""The reference by planned time: derivatives by finite differences, and the plan at its own places."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.frames import matrix_from_quaternion, quaternion_conjugate, quaternion_multiply
from ski_addon.planning import Reference
from tests.ski_runs import MAIN, planned

PLACES = np.random.default_rng(0).uniform(0.1, 3.4, 60)
STEP = 1e-4


@pytest.fixture(scope="module")
def run():
    return planned("paper_main", MAIN)


@pytest.fixture(scope="module")
def plan(run):
    return run.plan


@pytest.fixture(scope="module")
def reference(run):
    return Reference(run.plan, run.model)


def test_first_and_second_derivatives_by_finite_differences(reference, plan):
    for place in PLACES:
        i = np.searchsorted(plan.time, place) - 1
        place = np.clip(place, plan.time[i] + 2 * STEP, plan.time[i + 1] - 2 * STEP)
        before, here, after = (reference.at(place + d) for d in (-STEP, 0.0, STEP))
        np.testing.assert_allclose((after[0] - before[0]) / (2 * STEP), here[1], atol=1e-5)
        np.testing.assert_allclose((after[1] - before[1]) / (2 * STEP), here[2], atol=2e-5)


def test_values_and_slopes_are_continuous_at_the_knots(reference, plan):
    for knot in plan.time[10:-10:37]:
        before, after = reference.at(knot - 1e-9), reference.at(knot + 1e-9)
        np.testing.assert_allclose(before[0], after[0], atol=1e-7)
        np.testing.assert_allclose(before[1], after[1], atol=1e-6)
        np.testing.assert_allclose(before[2], after[2], atol=1e-4)


def test_reference_is_the_plan_at_its_own_places(reference, plan, run):
    columns = reference.columns
    for i in (0, 7, 311, len(plan.time) - 1):
        value = reference.at(plan.time[i])[0]
        np.testing.assert_allclose(value[columns["com"]], plan.com[i], atol=1e-12)
        np.testing.assert_allclose(value[columns["ski_position"]], plan.ski_position[i].ravel(), atol=1e-12)
        np.testing.assert_allclose(value[columns["joints"]], plan.pose[i, run.model.actuated_qpos], atol=1e-12)
        np.testing.assert_allclose(value[columns["edge_angle"]], plan.edge_angle[i], atol=1e-12)
        np.testing.assert_allclose(value[columns["track_position"]], plan.position[i], atol=1e-12)
        for name in ("inclination", "curvature", "speed", "turn_phase", "arc_length"):
            assert value[columns[name]][0] == pytest.approx(getattr(plan, name)[i], abs=1e-12)
        left = np.cross(plan.surface_normal[i], plan.tangent[i])
        np.testing.assert_allclose(value[columns["across"]], left, atol=1e-12)


def test_quaternions_are_those_of_skis_and_pelvis(reference, plan):
    place = reference.columns["quaternion"]
    for i in (3, 200, 600):
        quaternions = reference.at(plan.time[i])[0][place].reshape(3, 4)
        expected = (*plan.ski_rotation[i], matrix_from_quaternion(plan.pose[i, 3:7]))
        for got, rotation in zip(quaternions, expected, strict=True):
            np.testing.assert_allclose(matrix_from_quaternion(got), rotation, atol=1e-9)


def test_quaternions_never_jump(reference, plan):
    table = np.array([reference.at(s)[0][reference.columns["quaternion"]] for s in plan.time[::5]])
    assert np.abs(np.diff(table, axis=0)).max() < 0.05
    between = np.array([reference.at(s)[0][reference.columns["quaternion"]].reshape(3, 4) for s in PLACES])
    np.testing.assert_allclose(np.linalg.norm(between, axis=2), 1.0, atol=1e-8)


def test_rotation_vector_per_second_turns_the_quaternions(reference):
    """omega = 2 q' q* of the quaternion channel, at places between the knots."""
    columns = reference.columns
    for place in PLACES:
        value, slope, _ = reference.at(place)
        q, rate = value[columns["quaternion"]].reshape(3, 4), slope[columns["quaternion"]].reshape(3, 4)
        omega = 2.0 * quaternion_multiply(rate, quaternion_conjugate(q))[:, 1:]
        np.testing.assert_allclose(omega, value[columns["turning"]].reshape(3, 3), atol=2e-5)


def test_rotation_vector_per_second_by_finite_differences_of_the_rotations(reference):
    columns = reference.columns
    for place in PLACES[:20]:
        rotation = [
            matrix_from_quaternion(reference.at(place + d)[0][columns["quaternion"]].reshape(3, 4))
            for d in (-STEP, STEP)
        ]
        spin = (rotation[1] - rotation[0]) / (2 * STEP) @ np.swapaxes(0.5 * (rotation[0] + rotation[1]), -1, -2)
        omega = np.stack((spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]), axis=1)
        np.testing.assert_allclose(omega, reference.at(place)[0][columns["turning"]].reshape(3, 3), atol=3e-5)


def test_looking_up_in_any_order_gives_the_same(reference, plan, run):
    fresh = Reference(plan, run.model)
    for place in PLACES:
        np.testing.assert_array_equal(reference.at(place), fresh.at(place))
    ordered = {place: fresh.at(place) for place in sorted(PLACES)}
    for place in PLACES:
        np.testing.assert_array_equal(ordered[place], reference.at(place))


def test_reference_goes_on_past_its_ends(reference, plan):
    """The last step may look a little past the end: no jump there."""
    for end, inside in ((plan.duration, -1e-4), (0.0, 1e-4)):
        np.testing.assert_allclose(reference.at(end - inside)[0], reference.at(end + inside)[0], atol=5e-3)
    assert reference.end == plan.duration
