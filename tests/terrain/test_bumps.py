"""Bumps are the arcs of Eq. 16, smoothly joined."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ski_addon.errors import SpecError
from ski_addon.spec import SlopeSpec
from ski_addon.terrain import BumpTrain, build_terrain, bump_angle, bump_radius

TRAIN = BumpTrain(count=3, height=0.3, width=8.0, start=10.0, fillet=0.25)
TRAINS = [TRAIN, BumpTrain(1, 0.1, 2.0, 0.0, 0.05), BumpTrain(4, 0.8, 3.0, 5.0, 1.0), BumpTrain(2, 3.0, 8.0, 1.0, 0.3)]


@pytest.mark.parametrize(("height", "radius", "angle"), [(3.0, 4.1667, 73.7), (0.3, 26.817, 8.6)])
def test_arcs_have_the_papers_radius_and_angle(height, radius, angle):
    assert bump_radius(height, 8.0) == pytest.approx(radius, rel=1e-4)
    assert math.degrees(bump_angle(height, 8.0)) == pytest.approx(angle, abs=0.1)


@pytest.mark.parametrize("train", TRAINS)
def test_crests_and_troughs_are_as_high_as_asked_and_as_round_as_the_equation_says(train):
    up, slope, bend = train.profile(train.crests())
    np.testing.assert_allclose(up, train.height)
    np.testing.assert_allclose(slope, 0.0, atol=1e-12)
    np.testing.assert_allclose(bend, -1.0 / train.radius)
    up, slope, bend = train.profile(train.troughs())
    np.testing.assert_allclose(up, -train.height)
    np.testing.assert_allclose(slope, 0.0, atol=1e-12)
    np.testing.assert_allclose(bend, 1.0 / train.radius)
    everywhere = train.profile(np.linspace(train.start, train.start + train.length, 5000))[0]
    assert np.max(np.abs(everywhere)) <= train.height * (1 + 1e-12)


@pytest.mark.parametrize("train", TRAINS)
def test_derivatives_of_the_profile_are_its_finite_differences(train):
    down = np.random.default_rng(2).uniform(train.start - 2, train.start + train.length + 2, 500)
    step = 1e-5
    (before, slope_before, _), (after, slope_after, _) = train.profile(down - step), train.profile(down + step)
    _, slope, bend = train.profile(down)
    np.testing.assert_allclose(slope, (after - before) / (2 * step), atol=1e-8)
    np.testing.assert_allclose(bend, (slope_after - slope_before) / (2 * step), atol=2e-4 * np.max(np.abs(bend)))


@pytest.mark.parametrize("train", TRAINS)
def test_one_place_has_the_profile_of_many(train):
    down = np.linspace(train.start - 1, train.start + train.length + 1, 777)
    single = np.array([train.profile_at(place) for place in down.tolist()]).T
    np.testing.assert_allclose(single, train.profile(down), atol=1e-13)


@pytest.mark.parametrize("train", TRAINS)
def test_the_arcs_outside_the_fillets_are_circles(train):
    side = np.linspace(-0.49, 0.49, 21) * train.width * (1 - train.fillet)
    crest = train.crests()[-1] - np.abs(side)  # the inner half of the last crest, or the ramp of an only one
    if train.count > 1:
        up = train.profile(crest)[0]
        np.testing.assert_allclose(np.hypot(side, up - train.height + train.radius), train.radius)
    for trough in train.troughs():
        up = train.profile(trough + side)[0]
        np.testing.assert_allclose(np.hypot(side, up + train.height - train.radius), train.radius)


def test_arcs_are_circles_in_the_world_too_on_a_slope():
    """The radius is measured where the skier skis it, not in the vertical projection."""
    terrain = build_terrain(SlopeSpec(kind="bumps", angle_deg=20, bump_height=0.5, bump_width=6, bump_start=0))
    trough = terrain.relief.troughs()[0]
    angle = math.radians(20)
    x = trough * math.cos(angle) - 0.5 * math.sin(angle) + np.linspace(-2.0, 2.0, 9)
    place = np.stack((x, terrain.height(x, 0.0)), axis=1)
    centre = trough * np.array((math.cos(angle), -math.sin(angle)))
    centre += (bump_radius(0.5, 6) - 0.5) * np.array((math.sin(angle), math.cos(angle)))
    np.testing.assert_allclose(np.linalg.norm(place - centre, axis=1), bump_radius(0.5, 6), rtol=1e-12)


@pytest.mark.parametrize("train", TRAINS)
def test_curvature_stays_within_a_fifth_of_the_arcs(train):
    _, slope, bend = train.profile(np.linspace(train.start, train.start + train.length, 20001))
    radius = (1 + slope**2) ** 1.5 / np.maximum(np.abs(bend), 1e-9)
    assert train.sharpest == pytest.approx(np.min(radius), rel=1e-4)
    assert train.steepest == pytest.approx(np.max(np.abs(slope)), rel=1e-4)
    if train.height <= 0.1 * train.width:
        assert train.radius / 1.2 < train.sharpest <= train.radius


def test_the_train_begins_and_ends_on_the_plane():
    before = np.array([0.0, TRAIN.start - 1e-9, TRAIN.start + TRAIN.length + 1e-9, 1e6])
    for part in TRAIN.profile(before):
        np.testing.assert_allclose(part, 0.0, atol=1e-12)
    ramp = TRAIN.profile(np.linspace(TRAIN.start, TRAIN.start + TRAIN.width, 100))
    assert np.all(np.diff(ramp[0]) > 0)
    assert np.max(ramp[1]) < 0.5 * TRAIN.steepest


def test_bumps_lie_where_the_slope_says():
    spec = SlopeSpec(kind="bumps", angle_deg=10, bump_start=7, bump_width=5, bump_count=4, bump_height=0.2)
    terrain = build_terrain(spec)
    np.testing.assert_allclose(terrain.relief.crests(), [12, 22, 32, 42])
    np.testing.assert_allclose(terrain.relief.troughs(), [17, 27, 37])
    angle = math.radians(10)
    x = 12 * math.cos(angle) + 0.2 * math.sin(angle)
    assert terrain.height(x, 3.0) == pytest.approx(-12 * math.sin(angle) + 0.2 * math.cos(angle))
    np.testing.assert_allclose(terrain.normal(x, 3.0), [math.sin(angle), 0, math.cos(angle)], atol=1e-12)


@pytest.mark.parametrize(
    ("keys", "line"),
    [
        (
            {"angle_deg": 5, "bump_height": 2.0, "bump_width": 3.0},
            "slope.bump_height = 2.0 is outside 0.02..1.5 m: an arc is at most half a circle: make bumps lower than "
            "1.5 m or wider than 4 m",
        ),
        (
            {"angle_deg": 30, "bump_height": 3.0, "bump_width": 8.0},
            "slope.bump_height = 3.0 makes sides of 66 degrees, which overhang on a slope of 30 degrees: a height of "
            "1.72 m or a slope under 19 degrees would work",
        ),
    ],
)
def test_bumps_that_cannot_be_are_refused_with_what_can(keys, line):
    with pytest.raises(SpecError) as caught:
        build_terrain(SlopeSpec(kind="bumps", **keys))
    assert str(caught.value) == line


def test_what_the_overhanging_line_offers_works():
    spec = SlopeSpec(kind="bumps", angle_deg=30, bump_height=3.0, bump_width=8.0)
    build_terrain(dataclasses.replace(spec, bump_height=1.72))
    build_terrain(dataclasses.replace(spec, angle_deg=18.9))
