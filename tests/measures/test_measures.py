"""Motion measures: each says what a run that was made for it shows."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest

from ski_addon.course.track import LEFT, RIGHT, TRANSITION
from ski_addon.frames import rotation_about
from ski_addon.gravity import STANDARD_GRAVITY
from ski_addon.measures import measure_motion
from ski_addon.measures.measures import RATE, angular_speed
from tests.ski_runs import COARSE, planned, simulated

STEP = 0.002


@pytest.fixture(scope="module")
def recording():
    """Two turns of the paper's main case."""
    return simulated("paper_main", COARSE)


def measured(recording):
    """Its measures, on its own slope."""
    plan = planned("paper_main", COARSE)
    return measure_motion(recording, plan.model.skeleton, plan.terrain)


def changed(recording, **arrays):
    """The recording with other arrays."""
    return dataclasses.replace(recording, **arrays)


def test_a_run_of_the_paper_moves_as_a_skier_does(recording):
    found = measured(recording)
    assert found["clearance_min_m"] > 0.01 and found["snow_clearance_min_m"] > 0.0
    assert found["joint_violation_steps"] == 0
    assert 0.0 < found["edge_slip_max"] < 0.02
    assert 0.5 < found["outside_load_apex_min"] <= found["outside_load_apex_max"] < 0.9
    assert 0.0 < found["head_rate_p95_deg"] < 120.0
    assert len(found["jerk_p95"]) == 31 and all(jerk > 0.0 for jerk in found["jerk_p95"].values())
    assert found["clearances_m"][found["clearance_pair"]] == found["clearance_min_m"]
    assert json.loads(json.dumps(found)) == found


def test_turning_heads_are_measured_by_their_own_speed():
    frames = np.stack([rotation_about("z", 0.3 * k / RATE) for k in range(50)])
    assert angular_speed(frames, 1.0 / RATE) == pytest.approx(0.3, abs=1e-6)


def test_hands_in_the_chest_are_found(recording):
    skeleton = planned("paper_main", COARSE).model.skeleton
    qpos = recording.qpos.copy()
    for name, angle in (("upper_arm_y.L", -0.6), ("upper_arm_x.L", -0.9), ("forearm_y.L", -2.0)):
        qpos[500:520, skeleton.qpos_of(name)] = angle
    found = measured(changed(recording, qpos=qpos))
    assert found["clearance_min_m"] < 0.0
    assert ".L" in found["clearance_pair"]


def test_a_skier_lowered_into_the_snow_is_found(recording):
    qpos = recording.qpos.copy()
    qpos[700:, 2] -= 0.3
    found = measured(changed(recording, qpos=qpos))
    assert found["snow_clearance_min_m"] < -0.15


def test_skis_that_slide_aside_slip_by_as_much(recording):
    """Every ski is moved to its left by a twentieth of the way it has gone."""
    before = measured(recording)["edge_slip_max"]
    qpos, left = recording.qpos.copy(), np.cross(recording.surface_normal, recording.track_tangent)
    qpos[:, :3] += np.cumsum(0.05 * recording.speed[:, None] * STEP * left, axis=0)
    assert measured(changed(recording, qpos=qpos))["edge_slip_max"] == pytest.approx(0.05, abs=before + 0.005)


def test_skids_are_no_carving(recording):
    assert measured(changed(recording, steering=np.full_like(recording.steering, 0.3)))["edge_slip_max"] is None
    assert measured(changed(recording, edge_angle=np.zeros_like(recording.edge_angle)))["edge_slip_max"] is None


def test_loads_are_shares_and_body_weights(recording):
    weight = recording.header["mass"] * STANDARD_GRAVITY
    n = len(recording.time)
    share = np.where(recording.phase == LEFT, 0.7, 0.3)[:, None] * [[0.0, 1.0]]
    share[:, 0] = 1.0 - share[:, 1]
    total = np.ones(n)
    total[600:700] = 0.55  # 0.2 s
    total[900:930] = 0.75
    force = weight * (total[:, None] * share)[..., None] * recording.surface_normal[:, None]
    found = measured(changed(recording, snow_force=force))
    assert {LEFT, RIGHT, TRANSITION} == set(np.unique(recording.phase).tolist())
    assert found["outside_load_apex_min"] == pytest.approx(0.7, abs=1e-9)
    assert found["outside_load_apex_max"] == pytest.approx(0.7, abs=1e-9)
    assert found["unweighting_depth_bw"] == pytest.approx(0.45, abs=1e-9)
    assert found["unweighting_time_s"] == pytest.approx(0.2, abs=1e-9)


def test_angulation_is_the_outside_edge_beyond_the_lean(recording):
    lean = np.linspace(-0.5, 0.5, len(recording.time))
    edge = np.stack((1.1 * lean, 1.2 * lean), axis=1)
    found = measured(changed(recording, inclination=lean, edge_angle=edge))
    assert found["angulation_max_deg"] == pytest.approx(np.rad2deg(0.2 * 0.5), abs=1e-6)


def test_joints_past_their_ends_are_counted(recording):
    margin = np.full(len(recording.time), 0.1)
    margin[10:17] = -0.01
    assert measured(changed(recording, joint_margin=margin))["joint_violation_steps"] == 7


def test_a_run_that_just_began_has_no_measures(recording):
    short = {
        field.name: getattr(recording, field.name)[:20]
        for field in dataclasses.fields(recording)
        if field.name != "header"
    }
    assert measured(changed(recording, **short)) == {}
