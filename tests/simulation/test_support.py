"""Where the skis stand against the plan, and where the snow carries them."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.control import Dynamics, rotation_error
from ski_addon.planning import Reference
from ski_addon.simulation.support import SkiGauge, SkiStates
from tests.ski_runs import MAIN, planned

PLACE = 30
NORMAL = planned("paper_main", MAIN).plan.surface_normal[PLACE]


class Skier:
    """A skier on the plan whose skis are measured: one state at a time, of what the gauge measures for many."""

    def __init__(self) -> None:
        run = planned("paper_main", MAIN)
        reference, self.dynamics = Reference(run.plan, run.model), Dynamics(run.model)
        self.dynamics.qpos[:] = run.plan.pose[PLACE]
        self.dynamics.update()
        self.value, self.columns = reference.at(float(run.plan.time[PLACE]))[0], reference.columns
        self.gauge = SkiGauge(run.model.skeleton, reference.columns)

    @property
    def skis(self) -> SkiStates:
        dynamics = self.dynamics
        quaternion = dynamics.xquat[dynamics.model.ski_body]
        return SkiStates(*(part[None] for part in (dynamics.ski_places, dynamics.ski_rotations, quaternion)))

    def planned_error(self) -> float:
        return float(self.gauge.planned_error(self.value[None], self.skis)[0])

    def track_offset(self) -> np.ndarray:
        return self.gauge.track_offset(self.value[None], self.skis.place, self.dynamics.com[None])[0]

    def zero_moment_point(self, loads, arms, edge_angle=(0.0, 0.0)) -> np.ndarray:
        """Of normal forces on both skis [N] at `arms` (2, 3) [m, world] from their middles."""
        loads, arms = np.array(loads, dtype=float), np.array(arms, dtype=float)
        moments, angles = loads[:, None] * arms, np.array(edge_angle)
        found = self.gauge.zero_moment_point(self.skis, loads[None], moments[None], angles[None], NORMAL[None])
        return found[0]


@pytest.fixture
def skier() -> Skier:
    return Skier()


def test_on_the_plan_there_is_no_error(skier):
    assert skier.planned_error() < 1e-5
    assert np.abs(skier.track_offset()).max() < 1e-6


def test_a_shift_to_the_left_is_one(skier):
    tangent = skier.value[skier.columns["tangent"]]
    left = np.cross(NORMAL, tangent)
    skier.dynamics.qpos[:3] += 0.3 * left + 0.1 * tangent
    skier.dynamics.update()
    assert skier.track_offset() == pytest.approx((0.3, 0.3), abs=1e-6)
    assert skier.planned_error() == pytest.approx(np.hypot(0.3, 0.1), rel=1e-3)


def test_a_turned_ski_moves_its_corners(skier):
    """A turn of 0.01 rad about the ski's own left moves its ends by half its length times that."""
    hinge = skier.dynamics.model.skeleton.qpos_of("foot_y.L")
    before = skier.dynamics.ski_rotation(0).copy()
    skier.dynamics.qpos[hinge] += 0.01
    skier.dynamics.update()
    half = 0.5 * skier.dynamics.model.skeleton.ski_length
    assert before.shape == (3, 3)
    assert skier.planned_error() == pytest.approx(0.01 * half, rel=0.3)
    assert rotation_error([1, 0, 0, 0], [1, 0, 0, 0]) == (0.0, 0.0, 0.0)


def test_even_loads_in_the_middles_are_carried_in_the_middle(skier):
    x, y, border = skier.zero_moment_point((200, 200), np.zeros((2, 3)))
    assert (x, y) == pytest.approx((0.0, 0.0), abs=1e-9)
    skeleton = skier.dynamics.model.skeleton
    assert border == pytest.approx(0.5 * skeleton.stance_width + 0.5 * skeleton.ski_width, abs=2e-3)


def test_the_load_moves_to_the_ski_that_carries_and_to_where_it_carries(skier):
    half = 0.5 * skier.dynamics.model.skeleton.stance_width
    _, left, border = skier.zero_moment_point((300, 100), np.zeros((2, 3)))
    assert left == pytest.approx(0.5 * half, rel=0.05) and border > 0.0
    ahead = 0.4 * skier.dynamics.ski_rotation(0)[:, 0]
    forward, _, _ = skier.zero_moment_point((200, 200), (ahead, ahead))
    assert forward == pytest.approx(0.4, abs=2e-3)


def test_lifted_edges_do_not_bear(skier):
    """Leaning to the left the right border is the left edge of the right ski."""
    flat, leaning = (
        skier.zero_moment_point((100, 300), np.zeros((2, 3)), angles) for angles in ((0.0, 0.0), (0.4, 0.4))
    )
    width = skier.dynamics.model.skeleton.ski_width
    assert flat[1] == leaning[1] < 0.0
    assert flat[2] - leaning[2] == pytest.approx(0.5 * width * (1.0 + np.cos(0.4)), abs=1e-9)


def test_a_skier_in_the_air_has_no_zero_moment_point(skier):
    assert skier.zero_moment_point((0, 0), np.zeros((2, 3))).tolist() == [0.0, 0.0, 0.0]
