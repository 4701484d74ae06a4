"""Contact points and the edges that bear."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.snow import contact_points, edge_bearing, edge_lift
from ski_addon.snow.contact import FADE_FROM, FADE_TO

ANGLES = np.deg2rad(np.linspace(-15, 15, 3001))


def test_contact_points_lie_on_both_edges_at_segment_centres():
    points = contact_points(1.5, 0.08, 5)
    assert points.shape == (2, 5, 3)
    np.testing.assert_allclose(points[:, :, 0], np.broadcast_to([-0.6, -0.3, 0, 0.3, 0.6], (2, 5)), atol=1e-15)
    assert np.all(points[0, :, 1] == 0.04) and np.all(points[1, :, 1] == -0.04)
    assert np.all(points[:, :, 2] == 0.0)


def test_claim_27_edges_that_bear():
    """Leaning left the left edges, leaning right the right ones, flat all four [SG19 Eq. 27]."""
    assert edge_bearing(np.deg2rad(20)) == (1.0, 0.0)
    assert edge_bearing(np.deg2rad(-20)) == (0.0, 1.0)
    assert edge_bearing(0.0) == (1.0, 1.0)


def test_one_edge_always_bears_fully_and_the_other_fades_evenly():
    left, right = np.array([edge_bearing(float(angle)) for angle in ANGLES]).T
    assert np.all(np.maximum(left, right) == 1.0)
    assert np.all((left >= 0) & (right >= 0))
    assert np.all(np.diff(left) >= 0) and np.all(np.diff(right) <= 0)


def test_bearing_is_continuous_and_mirror_symmetric():
    left, right = np.array([edge_bearing(float(angle)) for angle in ANGLES]).T
    step = ANGLES[1] - ANGLES[0]
    steepest = 1.5 / (FADE_TO - FADE_FROM)
    assert np.abs(np.diff(left)).max() <= 1.01 * steepest * step
    np.testing.assert_allclose(left, right[::-1], atol=1e-12)


def test_bearing_has_a_continuous_slope():
    _, right = np.array([edge_bearing(float(angle)) for angle in ANGLES]).T
    step = ANGLES[1] - ANGLES[0]
    assert np.abs(np.diff(right, 2)).max() / step**2 <= 1.01 * 6.0 / (FADE_TO - FADE_FROM) ** 2


def test_an_edged_ski_stands_on_its_edge():
    """The middle of the base is half a width times sin(angle) over the snow; smooth and even through flat."""
    lift = edge_lift(ANGLES, 0.07)
    np.testing.assert_allclose(lift, edge_lift(-ANGLES, 0.07))
    assert edge_lift(0.0, 0.07) == pytest.approx(0.0, abs=1e-15)
    steep = np.deg2rad([30.0, 45.0, 60.0])
    exact = 0.035 * np.sin(steep)
    assert np.all(np.abs(edge_lift(steep, 0.07) - exact) < 2e-3)
    slope = np.gradient(lift, ANGLES)
    assert np.abs(np.diff(slope)).max() < 5e-4
