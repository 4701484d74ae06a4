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


BESIDE = 1.75
"""A line that turns runs between two columns of moguls, half their distance beside the one in the middle [m]."""


@pytest.mark.parametrize("kind", ["moguls", "bumps", "plane"])
def test_straight_line_goes_down_the_fall_line_over_all_crests(kind):
    spec = over(kind)
    track = track_of(spec)
    np.testing.assert_allclose(track.position[:, 1], 0.0, atol=1e-12)
    assert not track.phase.any() and np.all(track.turn == 1)
    down = track.position[:, 0] / np.cos(np.radians(20))
    assert down[0] < crest_places(spec)[0] and down[-1] > crest_places(spec)[-1] + 3.0


def test_turning_line_rounds_each_mogul_at_its_amplitude():
    spec = over(turn_amplitude=0.6, first_turn="left")
    track = track_of(spec)
    crests = mogul_crests(spec.slope, 0.0)
    np.testing.assert_allclose(crests[:, 0], crest_places(spec))
    view = np.stack((track.position[:, 0] / np.cos(np.radians(20)), track.position[:, 1]), axis=1)
    for k, crest in enumerate(crests):
        gaps = np.linalg.norm(view - (crest + (0.0, BESIDE)), axis=1)
        near = int(np.argmin(gaps))
        side = (-1) ** k
        assert gaps[near] == pytest.approx(0.6, abs=2e-3)
        assert side * (crest[1] + BESIDE - view[near, 1]) > 0.0  # turning left, it is to the left of the line
        assert track.phase[near] == side and track.turn[near] == k + 1


def test_turning_line_crosses_between_the_crests():
    """Half-way from crest to crest the line is in the middle between two columns."""
    spec = over(turn_amplitude=0.6)
    track = track_of(spec)
    crests = crest_places(spec)
    down = track.position[:, 0] / np.cos(np.radians(20))
    middles = 0.5 * (crests[1:] + crests[:-1])
    assert np.abs(np.interp(middles[1:-1], down, track.position[:, 1]) - BESIDE).max() < 0.1


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
