"""Runs in which nobody moves."""

from __future__ import annotations

import pytest

from ski_addon.errors import PlanInfeasible
from ski_addon.pipeline import make_plan
from ski_addon.spec import RunSpec
from ski_addon.turning.preview import preview_motion


@pytest.mark.parametrize("kind", ["alpine", "snowboard"])
@pytest.mark.parametrize("ground", [{"slope.kind": "moguls"}, {"slope.kind": "plane"}])
def test_who_is_held_at_the_start_by_friction_is_told_so(kind, ground):
    course = {"course.kind": "bumps" if "moguls" in ground.values() else "turns", "course.start_speed": 0}
    stuck = {"figure.kind": kind, "snow.friction": 0.45, **course, **ground}
    with pytest.raises(PlanInfeasible, match="friction stops the skier"):
        preview_motion(RunSpec().with_overrides(stuck))


@pytest.mark.parametrize("ground", [{"slope.kind": "moguls"}, {"slope.kind": "plane"}])
def test_who_stands_on_flat_ground_without_friction_is_told_so(ground):
    flat = {"slope.angle_deg": 0, "course.start_speed": 0, "technique.equations": "frictionless", **ground}
    with pytest.raises(PlanInfeasible, match="friction stops the skier"):
        make_plan(RunSpec().with_overrides(flat))
