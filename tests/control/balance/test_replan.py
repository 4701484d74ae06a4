"""The re-planned motion: velocities that belong to its places, a body that goes on from where it is."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from ski_addon.control import Dynamics
from ski_addon.control.balance.deviation import DeviationGauge
from ski_addon.control.balance.lean import BEYOND_FLAT, FLATTEST, flattening, measured_lean, steered_heading
from ski_addon.control.balance.replan import LOOSE_LEGS, Replanner
from ski_addon.control.motion import Motion
from ski_addon.planning import Reference
from tests.ski_runs import MAIN, planned

RATE = 1.15
MIDDLE = 1.7


def steered(time: float) -> SimpleNamespace:
    """A line that swings to the left and back, with its derivatives."""
    w, e = 2.1, 0.4
    return SimpleNamespace(
        offset=e * math.sin(w * time),
        rate=e * w * math.cos(w * time),
        acceleration=-e * w**2 * math.sin(w * time),
        jerk=-e * w**3 * math.cos(w * time),
        shift=0.0,
    )


@pytest.fixture(scope="module")
def skier() -> SimpleNamespace:
    run = planned("paper_main", MAIN)
    reference = Reference(run.plan, run.model)
    dynamics = Dynamics(run.model)
    place = int(np.searchsorted(run.plan.time, MIDDLE))
    dynamics.qpos[:] = run.plan.pose[place]
    dynamics.qvel[:3] = RATE * reference.at(float(run.plan.time[place]))[1, reference.columns["com"]]
    dynamics.update()
    motion = Motion(reference)
    return SimpleNamespace(reference=reference, dynamics=dynamics, motion=motion, now=float(run.plan.time[place]))


def replanned(skier, time: float, blend: float = 0.0, steering=None, tipping: float = 0.0) -> Motion:
    """The motion `time` [s] after the skier's present place, read and re-planned."""
    motion = skier.motion.read(skier.reference.at(skier.now + RATE * time), RATE)
    deviation = DeviationGauge(motion, skier.dynamics).measure()
    planned_sideways = deviation.sideways / RATE**2
    steering = steering or steered(time)
    Replanner(motion, skier.dynamics).apply(blend, steering, deviation, planned_sideways, 0.0, tipping)
    return motion


@pytest.mark.parametrize("time", [-0.4, 0.0, 0.3])
def test_skis_move_as_their_places_change(skier, time):
    """Central differences in time."""
    step, skis = 1e-3, skier.reference.columns["ski_position"]
    before, after = (replanned(skier, time + shift).value[skis].copy() for shift in (-step, step))
    motion = replanned(skier, time)
    here = motion.value[skis]
    np.testing.assert_allclose(motion.velocity[skis], (after - before) / (2 * step), atol=2e-3)
    np.testing.assert_allclose(motion.acceleration[skis], (after - 2 * here + before) / step**2, atol=0.12)


@pytest.mark.parametrize("part", [0, 1, 2])
def test_skis_and_pelvis_turn_as_their_rotations_change(skier, part):
    """From the difference of two quaternions: 2 (q+ - q-) q* / dt is (0, spin)."""
    step, own = 1e-3, slice(4 * part, 4 * part + 4)
    columns = skier.reference.columns["quaternion"]

    def unit(time: float) -> np.ndarray:
        q = replanned(skier, time).value[columns][own].copy()
        return q / np.linalg.norm(q)

    before, here, after = unit(-step), unit(0.0), unit(step)
    w, x, y, z = (after - before) / step
    a, b, c, d = here[0], -here[1], -here[2], -here[3]
    spin = [w * b + x * a + y * d - z * c, w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a]
    motion = replanned(skier, 0.0)
    np.testing.assert_allclose(motion.spin[3 * part : 3 * part + 3], spin, atol=0.01)


def test_skis_lie_on_the_steered_line_and_point_along_it(skier):
    motion = replanned(skier, 0.3)
    columns, steering = skier.reference.columns, steered(0.3)
    across = motion.value[columns["across"]]
    skis = motion.value[columns["ski_position"]].reshape(2, 3)
    middle = skis.mean(axis=0) - motion.value[columns["track_position"]]
    assert float(across @ middle) == pytest.approx(steering.offset, abs=1e-3)
    apart = skis[0] - skis[1]
    pace = motion.velocity[columns["ski_position"]].reshape(2, 3).mean(axis=0)
    assert abs(float(apart @ pace)) < 0.02 * np.linalg.norm(apart) * np.linalg.norm(pace)


def test_without_steering_or_blend_nothing_changes(skier):
    idle = SimpleNamespace(offset=0.0, rate=0.0, acceleration=0.0, jerk=0.0, shift=0.0)
    before = skier.motion.read(skier.reference.at(skier.now), RATE).table.copy()
    motion = replanned(skier, 0.0, steering=idle)
    np.testing.assert_allclose(motion.table, before, atol=1e-12)
    assert motion.leg_freedom == 1.0


def test_the_body_goes_on_from_where_it_is(skier):
    """Sideways the re-planned centre of mass passes through the present one, at its velocity; so do the legs."""
    dynamics, columns = skier.dynamics, skier.reference.columns
    dynamics.qpos[:3] += (0.02, 0.09, 0.0)
    dynamics.qvel[1] += 0.4
    dynamics.update()
    try:
        motion = replanned(skier, 0.0, blend=1.0)
        across = motion.value[columns["across"]]
        assert float(across @ (motion.value[columns["com"]] - dynamics.com)) == pytest.approx(0.0, abs=1e-9)
        assert float(across @ (motion.velocity[columns["com"]] - dynamics.com_velocity)) == pytest.approx(0.0, abs=1e-9)
        model = dynamics.model
        legs = np.searchsorted(model.actuated_dof, np.sort(model.leg_dof.ravel()))
        joints = motion.value[columns["joints"]]
        np.testing.assert_allclose(joints[legs], dynamics.qpos[model.actuated_qpos[legs]])
        assert motion.leg_freedom == pytest.approx(LOOSE_LEGS)
    finally:
        dynamics.qpos[:3] -= (0.02, 0.09, 0.0)
        dynamics.qvel[1] -= 0.4
        dynamics.update()


def off_plan(**changes) -> SimpleNamespace:
    """Upright and straight on at 6 m/s."""
    values = {
        "planned_y": 0.0, "planned_h": 0.7, "planned_y_rate": 0.0, "planned_h_rate": 0.0, "y": 0.0, "y_rate": 0.0,
        "h": 0.7, "h_rate": 0.0, "speed": 6.0, "centripetal": 0.0, "turning": 0.0, "pull": 9.81 / 0.7, "sideways": 0.0,
    }  # fmt: skip
    return SimpleNamespace(**{**values, **changes})


def test_the_body_is_accelerated_as_a_leg_of_fixed_length_that_falls():
    """y'' = g sin cos of the lean: a rigid pendulum let go at rest, by its own equation."""
    lean = 0.5
    y, h = 0.7 * math.sin(lean), 0.7 * math.cos(lean)
    steering = SimpleNamespace(offset=0.0, rate=0.0, acceleration=0.0, shift=0.0)
    found = measured_lean(steering, off_plan(y=y, h=h), 0.0, 0.0)
    assert found.angle == pytest.approx(lean)
    assert found.rise == pytest.approx(h - 0.7)
    assert found.sideways == pytest.approx(9.81 * math.sin(lean) * math.cos(lean))
    assert found.rise_acceleration == pytest.approx(-9.81 * math.sin(lean) ** 2)


def test_skis_that_go_along_with_the_body_do_not_tip_it():
    """Body and skis off by the same: no lean, no sideways acceleration."""
    steering = SimpleNamespace(offset=0.4, rate=0.7, acceleration=0.0, shift=0.0)
    found = measured_lean(steering, off_plan(y=0.4, y_rate=0.7), 0.0, 0.0)
    assert max(abs(found.angle), abs(found.rate), abs(found.sideways), abs(found.rise)) < 1e-12


def test_a_load_shifted_to_the_left_pushes_to_the_right():
    steering = SimpleNamespace(offset=0.0, rate=0.0, acceleration=0.0, shift=0.05)
    assert measured_lean(steering, off_plan(), 0.0, 0.0).sideways == pytest.approx(-0.05 * 9.81 / 0.7)


def test_the_heading_is_that_of_the_line():
    found = steered_heading(steered(0.0), off_plan())
    assert math.tan(found.angle) == pytest.approx(0.4 * 2.1 / 6.0)
    later, before = (steered_heading(steered(t), off_plan()) for t in (1e-4, -1e-4))
    assert found.rate == pytest.approx((later.angle - before.angle) / 2e-4, rel=1e-3, abs=1e-4)
    assert found.acceleration == pytest.approx((later.rate - before.rate) / 2e-4, rel=1e-3)
    assert steered_heading(steered(0.0), off_plan(), 0.0).angle == 0.0


def test_edges_are_let_go_only_before_a_push_over_them():
    assert flattening(0.3, 3.0) == 0.0 == flattening(-0.3, -3.0)
    assert flattening(0.3, -9.0) == -FLATTEST and flattening(-0.3, 9.0) == FLATTEST
    assert flattening(0.02, -9.0) == pytest.approx(-(0.02 + BEYOND_FLAT))
    assert 0.0 > flattening(0.3, -0.5) > -FLATTEST
