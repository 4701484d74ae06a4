"""Holes are filled by a skin over them."""

from __future__ import annotations

import numpy as np

from ski_addon.terrain.fill import filled

X, Y = np.meshgrid(np.arange(61.0), np.arange(45.0), indexing="ij")
VALUES = np.sin(X / 9) * np.cos(Y / 7)


def test_what_is_known_stays():
    known = np.hypot(X - 30, Y - 20) < 15
    out = filled(np.where(known, VALUES, np.nan), known)
    np.testing.assert_array_equal(out[known], VALUES[known])
    assert np.all(np.isfinite(out))


def test_nothing_is_made_up_beyond_what_is_known():
    known = np.random.default_rng(5).uniform(size=VALUES.shape) < 0.01
    out = filled(VALUES, known)
    assert out.min() >= VALUES[known].min() - 1e-12 and out.max() <= VALUES[known].max() + 1e-12


def test_a_hole_in_a_plane_is_mended():
    plane, known = 0.3 * X - 0.2 * Y, np.hypot(X - 30, Y - 20) > 6
    assert np.abs(filled(plane, known) - plane).max() < 0.35  # a skin of sweeps, not of many


def test_it_goes_on_smoothly_from_the_border():
    known = np.hypot(X - 30, Y - 20) < 15
    out = filled(VALUES, known)
    steps = max(np.abs(np.diff(out, axis=k)).max() for k in (0, 1))
    inside = max(np.abs(np.diff(VALUES, axis=k)).max() for k in (0, 1))
    assert steps < 1.5 * inside


def test_one_known_value_is_everywhere():
    known = np.zeros((7, 5), dtype=bool)
    known[6, 0] = True
    np.testing.assert_allclose(filled(np.full((7, 5), 3.5), known), 3.5)
