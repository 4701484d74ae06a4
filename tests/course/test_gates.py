"""Gate courses from run documents: where poles stand, and the track past them."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.course import LEFT, RIGHT, TRANSITION, build_track, course_gates
from ski_addon.course.gate_settings import set_poles
from ski_addon.spec import RunSpec, find_document
from ski_addon.terrain import build_terrain
from tests.course.gate_courses import EVEN, generated, listed

SHIPPED = ("slalom", "giant_slalom_race", "uneven_slalom", "rolling_slalom", "rolling_giant_slalom")


def course_of(spec: RunSpec):
    terrain = build_terrain(spec.slope)
    return build_track(spec, terrain), course_gates(spec, terrain)


# -- the setting ---------------------------------------------


def test_slalom_and_giant_slalom_are_set_as_fis_sets_them():
    """Slalom: 6..13 m from turning pole to turning pole; giant slalom: at least 10 m, usually 22..28 m."""
    for setting, low, high, distance in (("slalom", 6, 13, 0.5), ("giant_slalom", 22, 28, 1.0)):
        poles = set_poles(generated(gate_setting=setting))
        gaps = np.hypot(np.diff(poles.down), np.diff(poles.left))
        assert low < gaps.min() and gaps.max() < high
        assert np.all(poles.distance == distance) and np.all(np.isnan(poles.radius))


def test_sides_alternate_from_the_first_turn_and_the_pole_is_inside_of_the_turn():
    for first, sign in (("left", 1.0), ("right", -1.0)):
        poles = set_poles(generated(first_turn=first, gate_offset=3))
        np.testing.assert_array_equal(poles.side, sign * (-1.0) ** np.arange(20))
        np.testing.assert_allclose(poles.left, -1.5 * poles.side)


def test_uneven_setting_is_that_of_its_seed_and_keeps_its_mean():
    one, again, other = (
        set_poles(generated(gate_variation=1, gate_count=200).with_overrides({"simulation.seed": seed}))
        for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(one.down, again.down)
    assert np.abs(one.down - other.down).max() > 1.0
    steps = np.diff(one.down)
    assert 7.5 <= steps.min() < 8.5 and 11.5 < steps.max() <= 12.5 and abs(steps.mean() - 10.0) < 0.4


def test_own_values_of_a_gate_come_before_those_of_all_gates():
    changes = {1: {"distance": 0.7, "radius": 6.0}, 2: {"side": "left"}}
    poles = set_poles(listed(changes=changes, gate_distance=0.4, gate_radius=9))
    np.testing.assert_allclose(poles.distance, (0.4, 0.7, 0.4, 0.4, 0.4, 0.4))
    np.testing.assert_allclose(poles.radius, (9, 6, 9, 9, 9, 9))
    np.testing.assert_array_equal(poles.side, (-1, 1, 1, -1, 1, -1))  # the next goes on alternating from it


def test_clearance_of_a_list_is_that_of_its_kind():
    wide = [(24.0 * (k + 1), 2.0 * (-1) ** k) for k in range(4)]
    assert set_poles(listed()).distance[0] == 0.5 and set_poles(listed(wide)).distance[0] == 1.0


# -- the track ---------------------------------------------


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_courses_pass_every_gate_as_asked(name):
    track, gates = course_of(RunSpec.from_toml(find_document(name)))
    apex = gates.apexes(track)
    assert np.all(np.diff(apex) > 0)
    offset = gates.position - track.position[apex]
    np.testing.assert_allclose(np.linalg.norm(offset[:, :2], axis=1), gates.distance, atol=0.01)
    assert np.all(gates.side * np.sum(offset * track.left[apex], axis=1) > 0.0)
    np.testing.assert_array_equal(track.phase[apex], gates.side)
    np.testing.assert_array_equal(track.turn[apex], np.arange(1, len(gates) + 1))


@pytest.mark.parametrize("name", SHIPPED)
def test_curvature_of_shipped_courses_is_bounded_and_changes_gently(name):
    track, _ = course_of(RunSpec.from_toml(find_document(name)))
    assert np.abs(track.curvature).max() < 1.0 / 4.0
    rate = np.diff(track.curvature) / np.diff(track.arc_length)
    assert np.abs(rate).max() < 0.06
    assert np.abs(np.diff(rate)).max() < 0.1 * np.abs(rate).max()  # the rate itself is continuous


def test_poles_stand_on_the_snow():
    for slope in ({"angle_deg": 15}, {"angle_deg": 12, "kind": "bumps", "bump_height": 0.1, "bump_width": 10}):
        spec = RunSpec.from_dict({**generated(gate_count=5).to_dict(), "slope": slope})
        terrain = build_terrain(spec.slope)
        gates = course_gates(spec, terrain)
        np.testing.assert_allclose(gates.position[:, 2], terrain.height(gates.position[:, 0], gates.position[:, 1]))
        down = gates.position[:, 0] / np.cos(np.radians(slope["angle_deg"]))
        np.testing.assert_allclose(down, set_poles(spec).down)
        assert gates.side.dtype == np.int8 and not gates.position.flags.writeable


def test_other_courses_have_no_gates():
    spec = RunSpec()
    assert course_gates(spec, build_terrain(spec.slope)) is None


def test_turns_and_transitions_take_turns():
    track, gates = course_of(generated(gate_count=6))
    changes = np.flatnonzero(np.diff(track.phase))
    labels = [int(track.phase[0]), *(int(track.phase[i + 1]) for i in changes)]
    expected = [TRANSITION]
    for side in gates.side:
        expected += [LEFT if side > 0 else RIGHT, TRANSITION]
    assert labels == expected


def test_run_in_is_straight_down_the_fall_line():
    for run_in in (20.0, 60.0):
        track, gates = course_of(generated(gate_count=4, run_in=run_in))
        down = (gates.position[0, 0] - track.position[0, 0]) / np.cos(np.radians(15))
        assert down == pytest.approx(run_in, abs=0.1)
        straight = track.arc_length < run_in - 15.5
        np.testing.assert_allclose(track.tangent[straight, 1], 0.0, atol=1e-7)
        assert np.abs(track.curvature[straight]).max() < 1e-6


def test_mirrored_course_has_the_mirrored_track():
    left, right = (
        course_of(generated(gate_count=6, gate_variation=0.5, first_turn=side)) for side in ("left", "right")
    )
    np.testing.assert_allclose(left[0].position * [1, -1, 1], right[0].position, atol=1e-6)
    np.testing.assert_array_equal(left[0].phase, -right[0].phase)
    np.testing.assert_array_equal(left[1].side, -right[1].side)


def test_asked_radius_is_skied():
    track, gates = course_of(listed(changes={3: {"radius": 5.0}}))
    assert np.abs(track.curvature[gates.apexes(track)[3]]) == pytest.approx(0.2, rel=0.01)
    assert np.abs(track.curvature).max() == pytest.approx(0.2, rel=0.02)


@pytest.mark.parametrize(
    ("radius", "distance", "spacing", "half_chord", "half_angle"),
    [(15, 1, 34, 5.39, 21.0), (15, 2, 40, 7.48, 29.9), (10, 1, 24, 4.36, 25.8)],
)
def test_claim_25_turn_of_figure_7(radius, distance, spacing, half_chord, half_angle):
    """[SG19 sec. 4.5] The circle's centre is r - d inside of the pole. The paper's arc ends on the line through the
    pole down the slope; ours eases from the apex on, so it crosses that line a little farther out.
    """
    assert half_chord == pytest.approx(np.sqrt(distance * (2 * radius - distance)), abs=0.01)
    assert half_angle == pytest.approx(np.rad2deg(np.arccos(1 - distance / radius)), abs=0.1)
    places = [(spacing * (k + 1), 0.09 * spacing * (-1) ** k) for k in range(4)]
    track, gates = course_of(listed(places, gate_radius=radius, gate_distance=distance))
    down = np.cross([0.0, 1.0, 0.0], track.surface_normal[0])
    for pole, side, apex in zip(gates.position, gates.side, gates.apexes(track), strict=True):
        assert np.linalg.norm(track.position[apex] - pole) == pytest.approx(distance, abs=0.01)
        centre = track.position[apex] + side * track.left[apex] / abs(track.curvature[apex])
        assert np.linalg.norm(centre - pole) == pytest.approx(radius - distance, abs=0.02)
        assert np.sign((centre - pole)[1]) == side
        across, along = track.position[:, 1] - pole[1], (track.position - pole) @ down
        crossed = np.abs(along[np.flatnonzero(np.diff(np.sign(across)))])
        assert np.all((0.99 * half_chord < np.sort(crossed)[:2]) & (np.sort(crossed)[:2] < 1.6 * half_chord))


def test_a_single_gate_is_turned_round():
    track, gates = course_of(listed([(20.0, 0.0)], changes={0: {"side": "left"}}))
    assert track.turn.max() == 1 and track.phase.max() == LEFT and track.phase.min() == TRANSITION
    assert track.position[gates.apexes(track)[0], 1] == pytest.approx(-0.5, abs=0.01)


def test_two_gates_on_one_side_are_passed_on_that_side():
    """A delayed gate: two left turns after each other."""
    places = [*EVEN[:3], (43.0, -1.5), (53.0, -1.0), (63.0, 1.5)]
    track, gates = course_of(listed(places, changes={3: {"side": "left"}, 4: {"side": "left"}}))
    apex = gates.apexes(track)
    assert gates.side.tolist() == [-1, 1, -1, 1, 1, -1]
    assert np.all(track.curvature[apex] * gates.side > 0.0)
