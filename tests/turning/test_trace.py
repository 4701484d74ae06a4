"""A body's way on the map, lifted onto the ground."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.gravity import STANDARD_GRAVITY as G
from ski_addon.spec import SlopeSpec
from ski_addon.terrain import PlaneTerrain, build_terrain
from ski_addon.turning.body import TurningBody
from ski_addon.turning.motion import TurningMotion
from ski_addon.turning.trace import motion_on_ground

STEP = 0.01
TIME = STEP * np.arange(700)


def circle(radius: float = 20.0, speed: float = 8.0) -> np.ndarray:
    """Places (n, 2) on a circle to the left, starting along x."""
    angle = speed / radius * TIME
    return radius * np.stack((np.sin(angle), 1.0 - np.cos(angle)), axis=1)


def traced(place: np.ndarray, terrain, **more) -> TurningMotion:
    zero = np.zeros(len(place))
    values = {"lean": 0.3 * np.sin(2.0 * TIME), "lean_rate": 0.6 * np.cos(2.0 * TIME), "curvature": zero + 0.05, **more}
    return motion_on_ground(TurningBody(), terrain, TIME, place, speed=zero + 8.0, **values)


def test_flat_circle_keeps_its_heading_and_length():
    motion = traced(circle(), PlaneTerrain(0.0))
    angle = 0.4 * TIME
    expected = np.stack((np.cos(angle), np.sin(angle), 0.0 * angle), axis=1)
    np.testing.assert_allclose(motion.heading_direction[1:-1], expected[1:-1], atol=2e-5)
    assert motion.distance[-1] == pytest.approx(8.0 * TIME[-1], rel=1e-5)
    assert motion.duration == TIME[-1] and not motion.position.flags.writeable


@pytest.mark.parametrize("slope", [SlopeSpec(angle_deg=12), SlopeSpec(kind="moguls", angle_deg=15, bump_start=0.0)])
def test_support_lies_on_the_ground_and_goes_within_it(slope):
    terrain = build_terrain(slope)
    motion = traced(circle(), terrain)
    x, y, z = motion.position.T
    np.testing.assert_allclose(z, terrain.height(x, y), atol=1e-12)
    np.testing.assert_allclose(np.sum(motion.heading_direction * motion.surface_normal, axis=1), 0.0, atol=1e-12)
    step = np.diff(motion.position, axis=0)
    left = np.cross(motion.surface_normal, motion.heading_direction)
    sideways = np.sum(step * 0.5 * (left[1:] + left[:-1]), axis=1)
    assert np.abs(sideways).max() <= 5e-3 * np.linalg.norm(step, axis=1).max()


def test_standing_still_keeps_the_last_direction():
    place = circle()
    place[300:] = place[300]
    motion = traced(place, PlaneTerrain(0.2))
    assert np.isfinite(motion.heading_direction).all()
    np.testing.assert_allclose(motion.heading_direction[400], motion.heading_direction[299], atol=0.01)
    still = traced(0.0 * place, PlaneTerrain(0.2))
    np.testing.assert_allclose(still.heading_direction[5], [np.cos(0.2), 0.0, -np.sin(0.2)], atol=1e-12)


def test_leg_bears_the_weight_of_an_upright_body_and_more_in_a_turn():
    zero = np.zeros(len(TIME))
    upright = traced(circle(), PlaneTerrain(0.0), lean=zero, lean_rate=zero, curvature=zero)
    np.testing.assert_allclose(upright.leg_force, 1.0, atol=1e-12)
    lean = np.arctan(8.0**2 / (19.0 * G))
    turning = traced(circle(), PlaneTerrain(0.0), lean=zero + lean, lean_rate=zero, curvature=zero + 0.05)
    np.testing.assert_allclose(turning.leg_force, 1.0 / np.cos(lean), rtol=0.03)


def test_a_known_phase_is_kept():
    phase = (3.0 * TIME) % (2.0 * np.pi)
    np.testing.assert_array_equal(traced(circle(), PlaneTerrain(0.0), phase=phase).phase, phase)
