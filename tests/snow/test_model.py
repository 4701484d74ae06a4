"""Snow: friction, drag and penetration."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.snow import Snow, penetration_depth
from ski_addon.spec import SkierSpec, SnowSpec

SNOW = Snow.of(SnowSpec(), SkierSpec())
LENGTH, WIDTH = 1.5, 0.07


def force_of_ski(depth: float, edge_angle: float) -> float:
    """[SG19 Eq. 20] for a whole ski: hardness times displaced volume; a flat ski has two points to a segment."""
    if edge_angle == 0.0:
        return 2.0 * (SNOW.hardness * LENGTH * WIDTH * depth / 2.0)
    return SNOW.hardness * LENGTH * depth**2 / (2.0 * np.tan(abs(edge_angle)))


@pytest.mark.parametrize("angle", [-40.0, -10.0, 0.0, 5.0, 20.0, 60.0])
@pytest.mark.parametrize("force", [1.0, 250.0, 1500.0])
def test_penetration_inverts_equation_20(force, angle):
    depth = penetration_depth(SNOW, force, np.deg2rad(angle), LENGTH, WIDTH)
    assert force_of_ski(float(depth), np.deg2rad(angle)) == pytest.approx(force, rel=1e-12)


def test_penetration_is_as_deep_as_measured():
    """[claim v] 1.4 body weights on one edge, 10 to 45 degrees: 0.8 to 2.0 mm, not the linearisation's 17 to 98."""
    force = 1.4 * 50 * 9.81 / 2
    depth = penetration_depth(SNOW, np.full(2, force), np.deg2rad([10.0, 45.0]), LENGTH, WIDTH)
    assert 0.5e-3 < depth[0] < depth[1] < 2.1e-3


def test_penetration_is_continuous_grows_with_load_and_edge_and_never_negative():
    angles = np.deg2rad(np.linspace(-20, 20, 4001))
    depth = penetration_depth(SNOW, 300.0, angles, LENGTH, WIDTH)
    assert np.abs(np.diff(depth)).max() < 2e-5
    np.testing.assert_allclose(depth, depth[::-1], rtol=1e-9)
    assert np.all(np.diff(depth[2000:]) >= -1e-15)
    loads = penetration_depth(SNOW, np.linspace(-50, 2000, 300), 0.3, LENGTH, WIDTH)
    assert loads[0] == 0.0 and np.all(np.diff(loads) >= 0.0)


def test_friction_coefficient_is_equation_24():
    """[claim 28] mu(v) = .071 + .004 v"""
    assert SNOW.friction_coefficient(0.0) == 0.071
    np.testing.assert_allclose(SNOW.friction_coefficient(np.array([5.0, 10.0])), [0.091, 0.111])


def test_friction_and_drag_oppose_the_motion():
    rng = np.random.default_rng(0)
    for speed, normal in zip(rng.uniform(0.1, 40, 20), rng.uniform(1, 20, 20), strict=True):
        assert SNOW.glide_acceleration(0.0, normal, speed) < 0.0
        assert SNOW.glide_acceleration(2.0, normal, speed) < 2.0


def test_glide_balances_at_the_terminal_speed():
    """[claim o] 4.1 m/s on 5 degrees, 26 on 10, 49 on 15 without drag."""
    still = Snow.of(SnowSpec(), SkierSpec(drag_area=0))
    for degrees, speed in ((5, 4.1), (10, 26.3), (15, 49.2)):
        angle = np.deg2rad(degrees)
        gain = [still.glide_acceleration(9.81 * np.sin(angle), 9.81 * np.cos(angle), speed + d) for d in (-0.1, 0.1)]
        assert gain[0] > 0 > gain[1]


def test_drag_is_half_rho_cda_v_squared_over_the_mass():
    snow = Snow.of(SnowSpec(friction=0, friction_per_speed=0), SkierSpec(mass=80, drag_area=0.6))
    assert 80 * snow.glide_acceleration(0.0, 9.81, 20.0) == pytest.approx(-0.5 * 1.2 * 0.6 * 20.0**2)


def test_unlimited_grip_is_infinite():
    assert np.isinf(SNOW.shear_limit)
    assert Snow.of(SnowSpec(shear_limit=400), SkierSpec()).shear_limit == 400.0
