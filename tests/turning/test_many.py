"""Many motions at once, against each on its own."""

from __future__ import annotations

import numpy as np

from benchmarks.preview import SLOPE, swing_many
from ski_addon.terrain import PlaneTerrain
from ski_addon.turning.body import TurningBody
from ski_addon.turning.trace import motion_on_ground


def test_many_motions_are_what_each_is_on_the_ground():
    run, many = swing_many(5, 0.01)
    terrain = PlaneTerrain(float(np.arctan2(SLOPE.gravity_down, SLOPE.gravity_normal)))
    for body in range(5):
        single = motion_on_ground(
            TurningBody(),
            terrain,
            run.time,
            many.position[:, body, :2],
            run.lean[:, body],
            run.lean_rate[:, body],
            run.curvature[:, body],
            run.speed[:, body],
            run.phase[:, body],
        )
        for name, tolerance in (("position", 1e-9), ("heading_direction", 2e-3), ("distance", 1e-3)):
            found = getattr(many, name)[:, body]
            np.testing.assert_allclose(found, getattr(single, name), atol=tolerance)
        np.testing.assert_allclose(many.leg_force[:, body], single.leg_force, atol=2e-3)
        assert np.abs(np.sum(many.heading_direction[:, body] * many.surface_normal, axis=1)).max() < 1e-12


def test_bodies_of_the_benchmark_all_differ_and_ride_to_the_end():
    run, many = swing_many(40, 0.02)
    assert np.all(run.ended == 0) and many.position.shape == (501, 40, 3)
    assert len(np.unique(many.position[-1, :, 1].round(6))) == 40


def test_support_does_not_slip_sideways():
    _, many = swing_many(20, 0.01)
    step = np.diff(many.position, axis=0)
    heading = 0.5 * (many.heading_direction[1:] + many.heading_direction[:-1])
    aside = np.abs(np.sum(step * np.cross(many.surface_normal, heading), axis=-1))
    assert np.all(aside.sum(axis=0) <= 5e-3 * many.distance[-1])
