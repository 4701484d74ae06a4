"""Moguls lie in rows and columns, offset by half, and rise out of the plane smoothly."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ski_addon.errors import SpecError
from ski_addon.spec import SlopeSpec
from ski_addon.terrain import MogulField, build_terrain, mogul_crests, mogul_troughs

FIELD = MogulField(count=4, height=0.5, spacing=3.5, across=5.0, start=10.0)
SLOPE = SlopeSpec(kind="moguls", angle_deg=20, mogul_count=4, mogul_across=5.0)


@pytest.mark.parametrize(("places", "up"), [(mogul_crests(SLOPE, 12.0), 0.25), (mogul_troughs(SLOPE, 12.0), -0.25)])
def test_crests_and_troughs_are_level_extremes_of_full_height(places, up):
    assert len(places) == {0.25: 3 * 4 + 2 * 3, -0.25: 3 * 3 + 2 * 4}[up]
    height, along, across = FIELD.over(*places.T)
    np.testing.assert_allclose(height, up, rtol=1e-12)
    np.testing.assert_allclose(np.stack((along, across)), 0.0, atol=1e-12)


def test_no_place_is_higher_than_a_crest():
    down, left = np.meshgrid(np.linspace(5, 35, 601), np.linspace(-10, 10, 401), indexing="ij")
    up = FIELD.over(down, left)[0]
    assert np.max(np.abs(up)) <= 0.25 * (1 + 1e-12)
    assert np.ptp(up) == pytest.approx(0.5, rel=1e-3)


def test_columns_are_offset_by_half():
    crests = FIELD.crests(5.0)
    assert crests[crests[:, 1] == 0.0][:, 0].tolist() == [13.5, 17.0, 20.5, 24.0]
    assert crests[crests[:, 1] == 5.0][:, 0].tolist() == [15.25, 18.75, 22.25]
    np.testing.assert_allclose(np.sort(FIELD.troughs(2.0)[:, 0]), [15.25, 18.75, 22.25])


def test_columns_lie_a_spacing_apart_unless_said_otherwise():
    crests = mogul_crests(SlopeSpec(kind="moguls", mogul_spacing=4.0), 8.0)
    assert np.unique(crests[:, 1]).tolist() == [-8.0, -4.0, 0.0, 4.0, 8.0]
    assert len(mogul_crests(SlopeSpec(kind="moguls", mogul_count=1), 1.0)) == 1
    assert mogul_troughs(SlopeSpec(kind="moguls", mogul_count=1), 1.0).shape == (0, 2)


def test_the_radius_on_a_crest_is_that_of_the_fall_line():
    step = 1e-3
    up = FIELD.over(17.0 + np.array([-step, 0.0, step]), np.zeros(3))[0]
    assert FIELD.radius == pytest.approx(-(step**2) / (up[0] - 2 * up[1] + up[2]), rel=1e-5)


def test_the_field_begins_and_ends_on_the_plane():
    down = np.array([0.0, 10.0, 10.0 + FIELD.length, 500.0])
    np.testing.assert_allclose(FIELD.over(down, np.zeros(4)), 0.0, atol=1e-12)
    assert FIELD.length == 5 * 3.5


def test_the_mirrored_place_is_the_same():
    down, left = np.random.default_rng(3).uniform((8, -9), (32, 9), (200, 2)).T
    up, along, across = FIELD.over(down, left)
    np.testing.assert_allclose(FIELD.over(down, -left), (up, along, -across), atol=1e-15)
    again, back, _ = FIELD.over(2 * 10.0 + FIELD.length - down, left)
    np.testing.assert_allclose((again, back), (up, -along), atol=1e-12)


def test_crests_lie_on_the_terrain_where_they_are_said_to():
    terrain, angle = build_terrain(SLOPE), math.radians(20)
    for down, left in mogul_crests(SLOPE, 5.0):
        x = down * math.cos(angle) + 0.25 * math.sin(angle)
        assert terrain.height(x, left) == pytest.approx(0.25 * math.cos(angle) - down * math.sin(angle))
        np.testing.assert_allclose(terrain.normal(x, left), [math.sin(angle), 0, math.cos(angle)], atol=1e-9)


def test_moguls_that_overhang_are_refused():
    with pytest.raises(SpecError) as caught:
        build_terrain(SlopeSpec(kind="moguls", angle_deg=45, mogul_height=2.0, mogul_spacing=2.0))
    line = str(caught.value)
    assert line.startswith(
        "slope.mogul_height = 2.0 makes sides of 72 degrees, which overhang on a slope of 45 degrees"
    )
    works = float(line.split("a height of ")[1].split()[0])
    build_terrain(SlopeSpec(kind="moguls", angle_deg=45, mogul_height=works, mogul_spacing=2.0))
