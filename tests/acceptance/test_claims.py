"""What the 2019 paper claims about simulated motion; claims carry the numbers of the project's list of them.

Claims that a plan or a model alone decides are tested there: 17 and 22 in planning, 18 in course, 27 in snow,
28 in control and simulation, 29 in simulation.
"""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.body import forward_kinematics
from ski_addon.course import TRANSITION
from ski_addon.simulation import Recording
from tests.acceptance.test_paper_cases import CASES
from tests.ski_runs import planned, simulated

FIGURE_15 = CASES["fig15 frictionless at 2"]


def left_of(recording: Recording) -> np.ndarray:
    return np.cross(recording.surface_normal, recording.track_tangent)


def part(force: np.ndarray, direction: np.ndarray) -> np.ndarray:
    return np.sum(force * direction, axis=-1)


def body_weights(recording: Recording) -> np.ndarray:
    """Whole snow force (n, 3) in units of the skier's weight."""
    return recording.snow_force.sum(axis=1) / (recording.header["mass"] * 9.81)


def lean_of(recording: Recording, case, body: str) -> np.ndarray:
    """Lean of a body's up axis from the snow's normal, positive to the left."""
    skeleton = planned(*case).model.skeleton
    _, rotation = forward_kinematics(skeleton, recording.qpos)
    up = rotation[:, skeleton.body(body), :, 2]
    return np.arctan2(part(up, left_of(recording)), part(up, recording.surface_normal))


def transitions(recording: Recording) -> list[slice]:
    """Runs of steps between two turns."""
    edges = np.flatnonzero(np.diff((recording.phase == TRANSITION).astype(int))) + 1
    return [slice(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


# -- claim 19 -----------------------------------------------------------------------


def test_claim_19_the_skier_leans_into_every_turn_and_the_upper_body_out_of_it():
    recording = simulated(*FIGURE_15)
    chest = lean_of(recording, FIGURE_15, "chest")
    sides = []
    for turn in range(1, 8):
        steps = np.flatnonzero((recording.turn == turn) & (recording.phase != TRANSITION))
        steps = steps[len(steps) // 3 : -len(steps) // 3]
        inward = recording.phase[steps[0]]
        sides.append(int(inward))
        assert np.all(inward * recording.inclination[steps] > 0)
        if np.abs(recording.inclination[steps]).min() > np.deg2rad(8):
            assert np.all(inward * chest[steps] < 0.6 * inward * recording.inclination[steps])
            assert np.all(inward * recording.edge_angle[steps] > 0)
    assert sides == [-1, 1, -1, 1, -1, 1, -1], "the first turn is a right one"


def test_claim_19_leans_grow_with_the_speed():
    """Frictionless, each turn is faster than the last, and leans more."""
    recording = simulated(*FIGURE_15)
    lean = [np.abs(recording.inclination[recording.turn == turn]).max() for turn in range(1, 8)]
    speed = [recording.speed[recording.turn == turn].max() for turn in range(1, 8)]
    assert np.all(np.diff(speed) > 0) and np.all(np.diff(lean) > 0)
    assert np.rad2deg(lean[-1]) > 45 > 10 > np.rad2deg(lean[0])


def test_claim_19_load_of_the_last_turns():
    """[C] 1.6 to 1.9 body weights at 53 to 58 degrees; 1 / cos(lean) on a plane."""
    recording = simulated(*FIGURE_15)
    total = np.linalg.norm(body_weights(recording), axis=1)
    last = np.flatnonzero((recording.turn == 7) & (recording.phase != TRANSITION))
    middle = last[len(last) // 2]
    assert total[middle] == pytest.approx(1.0 / np.cos(recording.inclination[middle]), rel=0.05)
    assert 1.3 < total.max() < 1.9


# -- claim 21 -----------------------------------------------------------------------


def test_claim_21_tighter_turns_lean_and_angulate_more():
    tight, wide = CASES["r10 at 9"], CASES["main at 9"]
    lean, angulation = [], []
    for case in (tight, wide):
        recording = simulated(*case)
        lean.append(np.abs(recording.inclination).max())
        angulation.append(np.abs(recording.inclination - lean_of(recording, case, "chest")).max())
    assert lean[0] > 1.2 * lean[1] and angulation[0] > 1.2 * angulation[1]


# -- claim 23 -----------------------------------------------------------------------


def test_claim_23_side_force_follows_the_inclination():
    """Fig. 15: the force along the turn's inward direction rises and falls with the lean, over seven turns."""
    recording = simulated(*FIGURE_15)
    side = part(body_weights(recording), left_of(recording))
    assert np.corrcoef(side, recording.inclination)[0, 1] > 0.98
    assert np.corrcoef(side, np.tan(recording.inclination))[0, 1] > 0.995
    assert side.min() < -1.0 and side.max() > 0.7


def test_claim_23_side_force_grows_within_a_turn():
    """The skier gains speed in the turn: more at its end than at its beginning, before the lean gives way."""
    recording = simulated(*FIGURE_15)
    side = np.abs(part(body_weights(recording), left_of(recording)))
    for turn in range(2, 7):
        steps = np.flatnonzero((recording.turn == turn) & (recording.phase != TRANSITION))
        first, middle = side[steps[len(steps) // 10]], side[steps[len(steps) // 2]]
        assert middle > first


def test_claim_23_normal_force_dips_in_the_middle_of_transitions():
    """Less than before and after, lowest within a tenth of a second of the middle, deeper as the skier gets faster."""
    recording = simulated(*FIGURE_15)
    normal = part(body_weights(recording), recording.surface_normal)
    spans, depth = transitions(recording), []
    assert len(spans) == 6
    for span in spans:
        lowest = span.start + int(np.argmin(normal[span]))
        middle = 0.5 * (recording.time[span.start] + recording.time[span.stop - 1])
        assert abs(recording.time[lowest] - middle) < 0.1
        depth.append(min(normal[span.start], normal[span.stop]) - normal[lowest])
    assert np.all(np.array(depth) > 0) and np.all(np.diff(depth) > 0)
    assert depth[-1] > 0.2


def test_claim_23_dips_are_where_the_figure_has_them():
    """At 7.5, 9.5 and 11.5 s."""
    recording = simulated(*FIGURE_15)
    normal = part(body_weights(recording), recording.surface_normal)
    for time in (7.5, 9.5, 11.5):
        near = np.abs(recording.time - time) < 0.8
        assert recording.time[near][np.argmin(normal[near])] == pytest.approx(time, abs=0.2)


def test_claim_23_edges_change_with_the_lean():
    """Both skis change edges together, in the middle of the transition."""
    recording = simulated(*FIGURE_15)
    for span in transitions(recording):
        for ski in range(2):
            crossings = np.flatnonzero(np.diff(np.sign(recording.edge_angle[span, ski])))
            assert len(crossings) == 1
            middle = 0.5 * (span.stop - span.start)
            assert abs(crossings[0] - middle) < 0.15 * (span.stop - span.start)
