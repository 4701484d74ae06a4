"""The capture bound: against the pendulum it is derived from, and its limits."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.robustness.bound import DELAY, capture_bound, push_bound
from tests.ski_runs import planned

MASS, GRAVITY, HEIGHT = 50.0, 9.77, 0.733
COURSE = {"course.turn_count": 3, "course.start_speed": 8}
TURN, CHANGE = 3.0, 4.25  # [s] the middle of a left turn and of the transition after it


def growing_part(force: float, reach: float, sideways: float, duration: float) -> float:
    """x exp(-w t) after 6 s of x' = w (x - E - s) + F / (m w), integrated step by step."""
    w, step = np.sqrt(GRAVITY / HEIGHT), 1e-4
    x = 0.0
    for t in (np.arange(60_000) + 0.5) * step:
        skis = 0.5 * sideways * max(t - DELAY, 0.0) ** 2
        x += np.exp(-w * t) * step * ((force if t < duration else 0.0) / (MASS * w) - w * (skis + reach))
    return x


@pytest.mark.parametrize(("reach", "sideways", "duration"), [(0.12, 6.25, 0.5), (0.065, 0.0, 0.5), (0.05, 12.0, 0.2)])
def test_just_below_the_bound_the_pendulum_is_caught_and_just_above_it_falls(reach, sideways, duration):
    bound = capture_bound(HEIGHT, GRAVITY, reach, sideways, duration, MASS)
    assert growing_part(0.99 * bound, reach, sideways, duration) < 0
    assert growing_part(1.01 * bound, reach, sideways, duration) > 0


@pytest.mark.parametrize(
    ("reach", "sideways", "force"), [(0.065, 0, 52), (0.135, 0, 107), (0.235, 0, 187), (0.12, 6.25, 354)]
)
def test_bounds_of_a_light_skier(reach, sideways, force):
    """Fixed skis on one edge, on both, in a wide stance; steered at 5 m/s (w = 3.65 / s, 50 kg)."""
    assert capture_bound(9.77 / 3.65**2, 9.77, reach, sideways, 0.5, 50.0) == pytest.approx(force, rel=0.01)


def bound_of(time: float, body: str, direction: str, changes: dict | None = None) -> float | None:
    run = planned("paper_main", COURSE | (changes or {}))
    return push_bound(run.plan, int(np.searchsorted(run.plan.time, time)), run.model.skeleton, body, direction, 0.5)


def test_only_sideways_pushes_well_above_the_snow_have_a_bound():
    for direction in ("forward", "back", "up", "down"):
        assert bound_of(TURN, "head", direction) is None
    for body in ("ski.L", "ski.R", "foot.L"):
        assert bound_of(TURN, body, "left") is None
    assert bound_of(TURN, "abdomen", "left") > 0


def test_higher_pushes_tip_more():
    head, abdomen, shank = (bound_of(CHANGE, body, "left") for body in ("head", "abdomen", "shank.L"))
    assert head < abdomen < shank
    assert abdomen / head == pytest.approx(1.75 / 1.26, rel=0.1)


def test_in_the_middle_of_a_change_both_sides_are_alike():
    assert bound_of(CHANGE, "abdomen", "left") == pytest.approx(bound_of(CHANGE, "abdomen", "right"), rel=0.25)


def test_a_push_to_the_inside_of_a_turn_has_less_steering_left_at_speed():
    slow, fast = ({"course.start_speed": speed} for speed in (6, 9))
    outside, inside = (bound_of(TURN, "abdomen", side, fast) for side in ("right", "left"))
    assert inside < bound_of(CHANGE, "abdomen", "left", fast)
    assert outside > inside
    assert bound_of(CHANGE, "abdomen", "left", slow) < bound_of(CHANGE, "abdomen", "left", fast)
