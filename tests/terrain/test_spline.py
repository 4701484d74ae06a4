"""The bicubic spline: exact at samples and for cubics, the same as SciPy's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import RectBivariateSpline

from ski_addon.terrain.spline import evaluate, evaluate_at, slope_weights, spline_coefficients, value_weights

RNG = np.random.default_rng(5)
SIZES = [(4, 4), (5, 4), (4, 6), (5, 7), (23, 11)]


@pytest.fixture(params=SIZES, ids=str)
def samples(request):
    return RNG.normal(size=request.param)


def places(samples, count=200):
    return RNG.uniform((0, 0), np.array(samples.shape) - 1, (count, 2)).T


def test_value_and_slopes_are_those_of_scipys_interpolating_spline(samples):
    i, j = places(samples)
    other = RectBivariateSpline(*(range(size) for size in samples.shape), samples)
    value, along, aside = evaluate(spline_coefficients(samples), i, j)
    np.testing.assert_allclose(value, other.ev(i, j), atol=1e-12)
    np.testing.assert_allclose(along, other.ev(i, j, dx=1), atol=1e-12)
    np.testing.assert_allclose(aside, other.ev(i, j, dy=1), atol=1e-12)


def test_samples_are_met(samples):
    i, j = np.meshgrid(*(np.arange(float(size)) for size in samples.shape), indexing="ij")
    np.testing.assert_allclose(evaluate(spline_coefficients(samples), i, j)[0], samples, atol=1e-12)


def test_one_place_has_the_value_of_many(samples):
    coefficients = spline_coefficients(samples)
    i, j = places(samples, 50)
    single = [evaluate_at(coefficients, *place) for place in zip(i.tolist(), j.tolist(), strict=True)]
    np.testing.assert_allclose(np.transpose(single), evaluate(coefficients, i, j), atol=1e-14)


def test_cubics_are_kept_even_a_little_beyond_the_ends(samples):
    def cubic(i, j):
        return (2.0 - i + 0.3 * i**2 - 0.02 * i**3) * (1.0 + 0.5 * j - 0.1 * j**3)

    i, j = np.meshgrid(*(np.arange(float(size)) for size in samples.shape), indexing="ij")
    coefficients = spline_coefficients(cubic(i, j))
    i, j = RNG.uniform(-0.5, np.array(samples.shape) - 0.5, (100, 2)).T
    np.testing.assert_allclose(evaluate(coefficients, i, j)[0], cubic(i, j), rtol=1e-9, atol=1e-9)


def test_samples_are_not_changed(samples):
    before = samples.copy()
    spline_coefficients(samples)
    np.testing.assert_array_equal(samples, before)


@pytest.mark.parametrize("t", [0.0, 0.3, 1.0])
def test_weights_are_shares_and_their_slopes_are_finite_differences(t):
    assert sum(value_weights(t)) == pytest.approx(1.0)
    assert sum(slope_weights(t)) == pytest.approx(0.0, abs=1e-15)
    step = 1e-6
    difference = (np.array(value_weights(t + step)) - np.array(value_weights(t - step))) / (2 * step)
    np.testing.assert_allclose(slope_weights(t), difference, atol=1e-9)
