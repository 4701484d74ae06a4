"""Where a skier looks, and how the head turns there."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.body import BODY_NAMES, build_skeleton, forward_kinematics
from ski_addon.frames import normalized, quaternion_from_matrix, rotation_about
from ski_addon.planning.gaze import COMFORTABLE, turn_head
from ski_addon.spec import SkierSpec
from tests.ski_runs import planned

SKELETON = build_skeleton(SkierSpec())
HEAD, CHEST = BODY_NAMES.index("head"), BODY_NAMES.index("chest")


def bent(count=60, spread=0.35):
    """Skiers whose pelvis and trunk are turned and bent in many ways."""
    rng = np.random.default_rng(5)
    qpos = np.zeros((count, SKELETON.nq))
    turned = rotation_about("z", rng.uniform(-3.0, 3.0, count)) @ rotation_about(
        "y", rng.uniform(-spread, spread, count)
    )
    qpos[:, 3:7] = quaternion_from_matrix(turned @ rotation_about("x", rng.uniform(-spread, spread, count)))
    for hinge in ("abdomen_y", "abdomen_x", "chest_y", "chest_z"):
        qpos[:, SKELETON.qpos_of(hinge)] = rng.uniform(-0.1, 0.1, count)
    return qpos


def test_the_face_points_where_it_should_and_the_horizon_is_level():
    qpos = bent(spread=0.15)
    _, rotation = forward_kinematics(SKELETON, qpos)
    gaze = normalized(rotation[:, CHEST, :, 0] * [1.0, 1.0, 0.3] + [0.0, 0.0, -0.1])
    turn_head(SKELETON, qpos, gaze)
    _, rotation = forward_kinematics(SKELETON, qpos)
    assert np.sum(rotation[:, HEAD, :, 0] * gaze, axis=1) == pytest.approx(1.0, abs=0.002)
    assert rotation[:, HEAD, 2, 1] == pytest.approx(0.0, abs=0.02)  # its left is level


def test_no_neck_is_turned_further_than_is_comfortable():
    qpos = bent(spread=1.5)
    turn_head(SKELETON, qpos, normalized(np.random.default_rng(2).normal(size=(len(qpos), 3))))
    for hinge, most in COMFORTABLE.items():
        angle = np.abs(qpos[:, SKELETON.qpos_of(hinge)])
        assert np.all(angle < most) and angle.max() > 0.7 * most


def head_of(changes):
    """The world rotations (n, 3, 3) of the head in the plan of medium carving, and the plan."""
    plan = planned("medium_carving", {"course.turn_count": 4, **changes}).plan
    return forward_kinematics(SKELETON, plan.pose)[1][:, HEAD], plan


def test_the_head_turns_before_the_skis_do_and_rolls_less_than_the_body():
    head, plan = head_of({})
    heading, skis = (np.unwrap(np.arctan2(axis[:, 1], axis[:, 0])) for axis in (head[..., 0], plan.tangent))
    lags = np.arange(0, 400, 10)
    inner = slice(600, len(heading) - 600)
    agreement = [np.corrcoef(heading[inner], skis[600 + lag : len(skis) - 600 + lag])[0, 1] for lag in lags]
    assert 0.3 < lags[int(np.argmax(agreement))] * (plan.time[1] - plan.time[0]) < 1.5
    assert np.abs(np.arcsin(head[:, 2, 1])).max() < 0.6 * np.abs(plan.inclination).max()


def test_who_looks_further_ahead_leads_more():
    far, _ = head_of({"technique.look_ahead": 2.5})
    near, plan = head_of({"technique.look_ahead": 0.3})
    lead = [np.sum(np.cross(plan.tangent, head[..., 0])[:, 2] * np.sign(plan.curvature)) for head in (near, far)]
    assert lead[0] < lead[1]


def test_the_head_is_calm():
    head, plan = head_of({})
    cosine = 0.5 * (np.einsum("nij,nij->n", head[1:], head[:-1]) - 1.0)
    speed = np.arccos(np.clip(cosine, -1.0, 1.0)) / (plan.time[1] - plan.time[0])
    assert np.rad2deg(np.percentile(speed, 95.0)) < 60.0
