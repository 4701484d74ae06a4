"""How gates were passed, on ski motions made from formulas."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.body.skeleton import build_skeleton
from ski_addon.course import Gates
from ski_addon.simulation import GatePassing, gate_summary, recorded_gates
from ski_addon.simulation.clearance import (
    POLE_RADIUS,
    SkiPlaces,
    gate_clearances,
    measure_gates,
    pole_distances,
    ski_places,
)
from ski_addon.spec import RunSpec, SkierSpec
from tests.synthetic_recording import synthetic_recording

LENGTH, WIDTH, STANCE = 1.6, 0.08, 0.24


def gliding(heading: float = 0.0, edge: float = 0.0, count: int = 4001, begin: float = -20.0) -> SkiPlaces:
    """Two parallel skis that glide through the origin in a straight line, edged to the left by `edge` [rad]."""
    along = np.array([np.cos(heading), np.sin(heading)])
    left = np.array([-along[1], along[0]])
    way = np.linspace(begin, 20.0, count)
    middle = way[:, None, None] * along + 0.5 * STANCE * np.array([left, -left])
    shape = np.ones((count, 2, 1))
    return SkiPlaces(middle, shape * along, shape * left * np.cos(edge), 0.5 * LENGTH, 0.5 * WIDTH)


@pytest.mark.parametrize("heading", [0.0, 0.6, -1.1])
@pytest.mark.parametrize("side", [1, -1])
def test_clearance_is_from_the_surface_of_the_pole_to_the_nearer_edge(heading, side):
    left = np.array([-np.sin(heading), np.cos(heading)])
    poles = np.array([side * gap * left for gap in (0.4, 0.5, 1.7)])
    clearance = gate_clearances(gliding(heading), poles, np.full(3, side))
    expected = np.array([0.4, 0.5, 1.7]) - 0.5 * STANCE - 0.5 * WIDTH - POLE_RADIUS
    np.testing.assert_allclose(clearance, expected, atol=1e-9)
    np.testing.assert_allclose(pole_distances(gliding(heading), poles), (0.4, 0.5, 1.7), atol=1e-4)


def test_clearance_is_negative_on_the_wrong_side():
    poles = np.array([[3.0, -0.5, 0.0]])
    right = gate_clearances(gliding(), poles, np.array([-1]))
    wrong = gate_clearances(gliding(), poles, np.array([1]))
    assert right[0] > 0.3 and wrong[0] == pytest.approx(-right[0])


@pytest.mark.parametrize("offset", [0.0, 0.03, -0.05])
def test_pole_between_the_skis_is_not_passed_on_either_side(offset):
    for side in (1, -1):
        assert gate_clearances(gliding(), np.array([[0.0, offset]]), np.array([side]))[0] < 0.0


def test_pole_under_a_ski_has_negative_clearance():
    poles = np.array([[2.0, 0.5 * STANCE + 0.01]])
    clearance = gate_clearances(gliding(), poles, np.array([1]))[0]
    assert clearance == pytest.approx(-(0.5 * WIDTH - 0.01) - POLE_RADIUS, abs=1e-6)


def test_edged_ski_is_narrower_from_above():
    poles = np.array([[0.0, 0.5]])
    flat, edged = (gate_clearances(gliding(edge=edge), poles, np.array([1]))[0] for edge in (0.0, np.radians(60)))
    assert edged - flat == pytest.approx(0.5 * WIDTH * 0.5, abs=1e-9)


def test_tips_of_turned_skis_reach_farther():
    """Skis that skid at 30 degrees to their way: their tips or tails come nearer to the pole."""
    skis = gliding()
    angle = np.radians(30)
    along = np.ones((len(skis.middle), 2, 1)) * np.array([np.cos(angle), np.sin(angle)])
    across = np.ones((len(skis.middle), 2, 1)) * np.array([-np.sin(angle), np.cos(angle)])
    skidding = SkiPlaces(skis.middle, along, across, skis.half_length, skis.half_width)
    reach = 0.5 * LENGTH * np.sin(angle) + 0.5 * WIDTH * np.cos(angle)
    clearance = gate_clearances(skidding, np.array([[0.0, 1.0]]), np.array([1]))[0]
    assert clearance == pytest.approx(1.0 - 0.5 * STANCE - reach - POLE_RADIUS, abs=1e-3)


def test_gates_that_were_not_reached_have_no_clearance():
    poles = np.array([[0.0, 0.5], [19.9, 0.5], [60.0, 0.5], [0.0, 30.0]])
    clearance = gate_clearances(gliding(), poles, np.ones(4))
    assert np.isfinite(clearance[:2]).all() and np.isnan(clearance[2:]).all()
    stopped = gliding().part(np.arange(1000))  # at -10 m
    assert np.isnan(gate_clearances(stopped, poles, np.ones(4))).all()


def gates(places, sides, asked=0.5) -> Gates:
    """Gates at `places` (n, 3)."""
    return Gates(np.array(places, dtype=float), np.array(sides, dtype=np.int8), np.full(len(sides), asked))


def test_passing_of_a_recorded_skeleton_is_where_kinematics_has_its_skis():
    """The skier stands upright and slides down the x axis."""
    skeleton = build_skeleton(SkierSpec(mass=75, height=1.8))
    qpos = np.zeros((3000, skeleton.nq))
    qpos[:, 0], qpos[:, 2], qpos[:, 3] = np.linspace(-15.0, 15.0, 3000), 1.0, 1.0
    skis = ski_places(skeleton, qpos)
    outer = float(skis.middle[0, 0, 1]) + 0.5 * skeleton.ski_width
    assert float(skis.middle[0, 1, 1]) == pytest.approx(-float(skis.middle[0, 0, 1]))
    poles = [[-5.0, 0.6, -3.0], [0.0, -0.6, 2.0], [5.0, -0.6, 0.0], [40.0, 0.6, 0.0]]
    passing = measure_gates(skeleton, qpos, gates(poles, [1, -1, 1, 1]))
    gap = 0.6 - outer - POLE_RADIUS
    np.testing.assert_allclose(passing.clearance, [gap, gap, -gap, np.nan], atol=1e-6)
    np.testing.assert_allclose(passing.distance, [0.6, 0.6, 0.6, np.nan], atol=1e-4)
    np.testing.assert_array_equal(passing.passed, [True, True, False, False])


def test_no_steps_reach_no_gates():
    skeleton = build_skeleton(SkierSpec())
    passing = measure_gates(skeleton, np.zeros((0, skeleton.nq)), gates([[0, 1, 0], [9, -1, 0]], [1, -1]))
    assert np.isnan(passing.distance).all() and not passing.passed.any()
    assert gate_summary(passing)["gate_clearance_min_m"] is None


def test_summary_holds_plain_numbers_and_names_gates_from_one():
    distance, clearance = np.array([0.6, 0.5, 0.4, np.nan]), np.array([0.3, -0.2, 0.1, np.nan])
    passing = GatePassing(gates(np.zeros((4, 3)), [1, -1, 1, -1]), distance, clearance)
    assert gate_summary(passing) == {
        "gates": 4,
        "gates_passed": 2,
        "gates_missed": [2, 4],
        "gate_distances_m": [0.6, 0.5, 0.4, None],
        "gate_clearances_m": [0.3, -0.2, 0.1, None],
        "gate_clearance_min_m": -0.2,
    }


def test_gates_of_a_recording_are_those_of_its_header_and_the_skier_that_of_its_document():
    """The skier of the recording glides along its track, upright, with skis along it."""
    spec = RunSpec().with_overrides({"skier.height": 1.9})
    recording = synthetic_recording(spec, gates=5)
    passing = recorded_gates(recording)
    assert passing.gates.position.tolist() == recording.header["gates"]["position"]
    np.testing.assert_allclose(passing.distance, passing.gates.distance, atol=0.01)
    narrow = ski_places(build_skeleton(spec.skier), recording.qpos[:1]).middle[0, 0]
    half_stance = np.linalg.norm(narrow - recording.track_position[0, :2])
    expected = passing.gates.distance - half_stance - 0.5 * spec.skier.ski_width - POLE_RADIUS
    np.testing.assert_allclose(passing.clearance, expected, atol=0.04)  # the skis' ends stand off the curved track
    assert passing.passed.all()


def test_other_recordings_and_those_of_earlier_versions_have_no_gates():
    recording = synthetic_recording()
    assert recorded_gates(recording) is None
    recording.header["gates"] = {}
    assert recorded_gates(recording) is None
