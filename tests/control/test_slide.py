"""Skis thrown across the track: the whole plan moves along them with the body, and comes back."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ski_addon.control.slide import (
    ACROSS_COSINE,
    PULL,
    RETURN_TIME,
    STRAIGHT_COSINE,
    Slide,
    share_of_sliding,
)

STEP = 0.001
COLUMNS = {
    "com": slice(0, 3),
    "ski_position": slice(3, 9),
    "along": slice(9, 12),
    "tangent": slice(12, 15),
    "track_position": slice(15, 18),
    "joints": slice(18, 20),
}
MOVED = [*range(9), *range(15, 18)]
"""Columns that move with the body: places, not directions or hinges."""
TANGENT, ACROSS = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])


class Skier:
    """A body and the motion it follows, whose plan stands still at the origin with skis along `along`."""

    def __init__(self, along: np.ndarray) -> None:
        self.dynamics = SimpleNamespace(com=np.zeros(3), com_velocity=np.zeros(3))
        self.motion = SimpleNamespace(columns=COLUMNS, value=np.zeros(20), velocity=np.zeros(20))
        self.along = along
        self.slide = Slide(self.dynamics, self.motion, STEP)

    def apply(self) -> Slide:
        """Read the plan anew, as a step of control does, and shift it."""
        self.motion.value[:], self.motion.velocity[:] = 0.0, 0.0
        self.motion.value[COLUMNS["along"]], self.motion.value[COLUMNS["tangent"]] = self.along, TANGENT
        self.slide.apply()
        return self.slide


def test_share_is_none_along_the_track_and_all_across_it():
    assert share_of_sliding(1.0) == share_of_sliding(STRAIGHT_COSINE) == 0.0
    assert share_of_sliding(ACROSS_COSINE) == share_of_sliding(0.0) == share_of_sliding(-0.5) == 1.0
    assert share_of_sliding(0.5 * (STRAIGHT_COSINE + ACROSS_COSINE)) == pytest.approx(0.5)


def test_share_rises_smoothly_as_the_skis_are_turned():
    angle = np.linspace(0.0, np.pi / 2, 2001)
    share = np.array([share_of_sliding(cosine) for cosine in np.cos(angle)])
    rate = np.gradient(share, angle)
    assert np.all(np.diff(share) >= 0.0) and np.abs(np.diff(rate)).max() < 0.05, "without a kink"


def test_nothing_is_moved_while_the_skis_point_down_the_track():
    skier = Skier(TANGENT)
    skier.dynamics.com[:], skier.dynamics.com_velocity[:] = (0.3, -0.2, 0.1), (2.0, 1.0, 0.0)
    before = skier.motion.value.copy()
    slide = skier.apply()
    assert not slide.active and slide.share == 0.0 and not slide.shift.any()
    assert not skier.motion.velocity.any() and not skier.motion.value[MOVED].any() and not before.any()


def test_plan_follows_a_body_that_slides_along_skis_across_the_track():
    """At 0.5 m/s for a second: half a metre along the skis, and as fast; nothing across them."""
    skier = Skier(ACROSS)
    skier.dynamics.com_velocity[:] = 0.2, 0.5, 0.0
    for _ in range(1000):
        skier.dynamics.com += STEP * skier.dynamics.com_velocity
        slide = skier.apply()
    assert slide.active and slide.share == 1.0
    np.testing.assert_allclose(slide.shift, [0.0, 0.5, 0.0], atol=0.002)
    for name in ("com", "track_position"):
        np.testing.assert_allclose(skier.motion.value[COLUMNS[name]], [0.0, 0.5, 0.0], atol=0.002)
        np.testing.assert_allclose(skier.motion.velocity[COLUMNS[name]], [0.0, 0.5, 0.0], atol=0.01)
    np.testing.assert_allclose(skier.motion.value[COLUMNS["ski_position"]].reshape(2, 3)[:, 1], 0.5, atol=0.002)
    np.testing.assert_array_equal(skier.motion.value[COLUMNS["along"]], ACROSS)
    assert not skier.motion.value[COLUMNS["joints"]].any() and not skier.motion.velocity[COLUMNS["joints"]].any()


def test_plan_is_drawn_to_a_body_that_stands_beside_it():
    skier = Skier(ACROSS)
    skier.dynamics.com[:] = 0.0, 0.1, 0.0
    for _ in range(300):
        slide = skier.apply()
    assert slide.shift[1] == pytest.approx(0.1 * (1.0 - np.exp(-0.3 * PULL)), rel=0.01)


def test_velocity_of_the_moved_plan_is_the_rate_of_its_shift():
    skier = Skier(np.array([0.5, np.sqrt(0.75), 0.0]))
    skier.dynamics.com[:], skier.dynamics.com_velocity[:] = (0.05, 0.08, 0.0), (0.4, -0.3, 0.0)
    for _ in range(50):
        before = skier.slide.shift.copy()
        skier.apply()
        rate = skier.motion.velocity[COLUMNS["com"]]
        np.testing.assert_allclose((skier.slide.shift - before) / STEP, rate, atol=1e-9)
        assert 0.0 < skier.slide.share < 1.0


def test_back_on_the_track_the_shift_decays_to_nothing():
    skier = Skier(ACROSS)
    skier.dynamics.com[:] = 0.0, 0.2, 0.0
    for _ in range(1000):
        skier.apply()
    there = skier.slide.shift.copy()
    assert there[1] > 0.199
    skier.along = TANGENT
    for _ in range(1000):
        slide = skier.apply()
    np.testing.assert_allclose(slide.shift, there * np.exp(-1.0 / RETURN_TIME), rtol=0.01)
    assert slide.active, "the plan is still moved"
    for _ in range(12000):
        slide = skier.apply()
    assert not slide.active and not slide.shift.any()
    np.testing.assert_array_equal(skier.motion.value[MOVED], 0.0)
