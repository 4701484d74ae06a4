"""Lines over bumps and moguls."""

from __future__ import annotations

import re

import numpy as np
import pytest

from ski_addon.course import build_track
from ski_addon.course.bump_line import crest_places
from ski_addon.errors import SpecError
from ski_addon.spec import RunSpec
from ski_addon.terrain import build_terrain, mogul_crests


def over(kind: str = "moguls", slope=None, **course) -> RunSpec:
    ground = {"angle_deg": 20, "kind": kind, **(slope or {})}
    return RunSpec.from_dict({"slope": ground, "course": {"kind": "bumps", **course}})


def track_of(spec: RunSpec):
    return build_track(spec, build_terrain(spec.slope))


@pytest.mark.parametrize("kind", ["moguls", "bumps", "plane"])
def test_straight_line_goes_down_the_fall_line_over_all_crests(kind):
    spec = over(kind)
    track = track_of(spec)
    np.testing.assert_allclose(track.position[:, 1], 0.0, atol=1e-12)
    assert not track.phase.any() and np.all(track.turn == 1)
    down = track.position[:, 0] / np.cos(np.radians(20))
    assert down[0] < crest_places(spec)[0] and down[-1] > crest_places(spec)[-1] + 3.0


def plan_view(track) -> np.ndarray:
    """Places (n, 2) down the slope and to the left [m]."""
    return np.stack((track.position[:, 0] / np.cos(np.radians(20)), track.position[:, 1]), axis=1)


@pytest.mark.parametrize(("kind", "middle"), [("moguls", 1.75), ("bumps", 0.0), ("plane", 0.0)])
def test_turning_line_turns_beside_each_crest_at_its_amplitude(kind, middle):
    """On moguls the line runs half-way between two columns, 3.5 m apart; elsewhere down the middle."""
    spec = over(kind, turn_amplitude=0.6, first_turn="left")
    track, places = track_of(spec), crest_places(spec)
    if kind == "moguls":
        np.testing.assert_allclose(places, mogul_crests(spec.slope, 0.0)[:, 0])
    view = plan_view(track)
    for k, down in enumerate(places):
        gaps = np.linalg.norm(view - (down, middle), axis=1)
        near = int(np.argmin(gaps))
        side = (-1) ** k
        assert gaps[near] == pytest.approx(0.6, abs=2e-3)
        assert side * (middle - view[near, 1]) > 0.0  # turning left, the line is to the right of the middle
        assert track.phase[near] == side and track.turn[near] == k + 1


def test_turns_one_and_a_half_moguls_apart_each_go_round_a_crest():
    """Neighbouring columns are offset by half a spacing: to the left and to the right there is a crest in turn."""
    spec = over(turn_amplitude=0.6, turn_spacing=5.25, first_turn="left")
    view, crests = plan_view(track_of(spec)), mogul_crests(spec.slope, 4.0)
    for k, down in enumerate(crest_places(spec)):
        here = np.array([down, np.interp(down, *view.T)])
        inside = crests[(-1) ** k * (crests[:, 1] - here[1]) > 0.0]
        nearest = inside[np.argmin(np.linalg.norm(inside - here, axis=1))]
        np.testing.assert_allclose(nearest, [down, 3.5 if k % 2 == 0 else 0.0], atol=1e-9)


@pytest.mark.parametrize("across", ["auto", 5.0])
def test_turning_line_crosses_the_middle_between_the_turns(across):
    """There the ground between two columns of moguls is that of the slope without them."""
    spec = over(slope={"mogul_across": across}, turn_amplitude=0.6)
    track, terrain = track_of(spec), build_terrain(spec.slope)
    middle = 1.75 if across == "auto" else 2.5
    view, crests = plan_view(track), crest_places(spec)
    between = 0.5 * (crests[1:] + crests[:-1])[1:-1]
    assert np.abs(np.interp(between, *view.T) - middle).max() < 0.1
    level = terrain.height(between * np.cos(np.radians(20)), np.full_like(between, middle))
    np.testing.assert_allclose(level, -between * np.sin(np.radians(20)), atol=1e-9)


def test_straight_line_down_moguls_stays_on_its_column():
    spec = over(slope={"mogul_across": 5.0})
    np.testing.assert_allclose(track_of(spec).position[:, 1], 0.0, atol=1e-12)


def test_run_length_is_the_length_of_the_run():
    for amplitude in (0.0, 0.5):
        track = track_of(over(run_length=30, turn_amplitude=amplitude))
        down = track.position[:, 0] / np.cos(np.radians(20))
        assert down[-1] - down[0] == pytest.approx(30.0, abs=0.2)


def test_turn_spacing_is_taken_over():
    spec = over("plane", turn_amplitude=1.0, turn_spacing=7.0)
    np.testing.assert_allclose(np.diff(crest_places(spec)), 7.0)
    assert track_of(spec).turn.max() == len(crest_places(spec))


def test_amplitude_too_large_with_one_that_works():
    with pytest.raises(SpecError) as caught:
        track_of(over(turn_amplitude=3))
    match = re.fullmatch(
        r"course.turn_amplitude = 3.0 makes turns tighter than 1.5 m .* of 3.5 m: at most ([\d.]+) m would work",
        str(caught.value),
    )
    assert match, caught.value
    track_of(over(turn_amplitude=float(match[1])))
