"""Capsules of the skier, and how near they come to each other and to the snow."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.body import build_skeleton
from ski_addon.body.kinematics import forward_kinematics
from ski_addon.measures.capsules import POLE_RADIUS, segment_distances, skier_capsules
from ski_addon.measures.nearness import body_pairs, measure_nearness
from ski_addon.spec import SkierSpec, SlopeSpec
from ski_addon.terrain import build_terrain

SKELETON = build_skeleton(SkierSpec())
NAMES = SKELETON.body_names


def standing(**angles):
    """One upright skier at the origin, arms hanging but for hinges (degrees) as they are named, "." written "_of_"."""
    qpos = np.zeros((1, SKELETON.nq))
    qpos[0, 3] = 1.0
    for name, degrees in angles.items():
        qpos[0, SKELETON.qpos_of(name.replace("_of_", "."))] = np.deg2rad(degrees)
    return qpos


def nearness(qpos, height=5.0):
    """What is measured of a skier whose pelvis is `height` over flat snow."""
    qpos = qpos.copy()
    qpos[:, 2] += height
    return measure_nearness(SKELETON, *forward_kinematics(SKELETON, qpos), build_terrain(SlopeSpec(angle_deg=0.0)))


def test_distances_of_lines_are_those_of_their_nearest_points():
    rng = np.random.default_rng(3)
    ends = rng.normal(size=(4, 200, 3))
    ends[1, :20] = ends[0, :20]  # a point
    ends[3, 10:30] = ends[2, 10:30]
    ends[3, 30:50] = ends[2, 30:50] + 0.7 * (ends[1, 30:50] - ends[0, 30:50])  # parallel
    share = np.linspace(0.0, 1.0, 201)[:, None, None]
    first, second = ends[0] + share * (ends[1] - ends[0]), ends[2] + share * (ends[3] - ends[2])
    sampled = np.min([np.linalg.norm(first - place, axis=-1).min(axis=0) for place in second], axis=0)
    exact = segment_distances(*ends)
    assert np.all(exact <= sampled + 1e-12) and np.all(sampled - exact < 0.02)


def test_lines_that_cross_touch():
    p, q, r, s = (np.array(place, dtype=float) for place in ((-1, 0, 0), (1, 0, 0), (0.5, -1, 0), (0.5, 2, 0)))
    assert segment_distances(p, q, r, s) == pytest.approx(0.0, abs=1e-12)


def test_pairs_are_arms_and_poles_against_all_but_what_they_hang_on():
    pairs = {frozenset((NAMES[a], NAMES[b])) for a, b in body_pairs(SKELETON)}
    assert len(pairs) == len(body_pairs(SKELETON))
    for pair in (
        ("hand.L", "thigh.R"),
        ("pole.L", "pole.R"),
        ("pole.R", "ski.L"),
        ("forearm.L", "chest"),
        ("hand.R", "head"),
    ):
        assert frozenset(pair) in pairs
    for pair in (("hand.L", "pole.L"), ("forearm.L", "pole.L"), ("chest", "upper_arm.L"), ("thigh.L", "shank.L")):
        assert frozenset(pair) not in pairs
    mirror = {"L": "R", "R": "L"}
    swapped = {frozenset(f"{n[:-1]}{mirror[n[-1]]}" if "." in n else n for n in pair) for pair in pairs}
    assert swapped == pairs


def test_a_hand_led_to_the_face_meets_it_and_one_held_out_does_not():
    away = nearness(standing(upper_arm_x_of_L=90))
    bent = nearness(standing(upper_arm_y_of_L=-100, forearm_y_of_L=-130, upper_arm_x_of_L=-25))
    assert away.pairs["hand.L", "head"] > 0.3
    assert bent.pairs["hand.L", "head"] < 0.1
    assert away.pairs["hand.L", "chest"] > 0.3


def test_distances_do_not_depend_on_where_the_skier_is_and_are_the_same_mirrored():
    qpos = standing(upper_arm_y_of_L=-40, forearm_y_of_L=-50, upper_arm_y_of_R=-40, forearm_y_of_R=-50)
    here, moved = nearness(qpos), qpos.copy()
    moved[0, :7] = [30.0, -12.0, 4.0, np.cos(0.6), 0.0, 0.0, np.sin(0.6)]
    there = nearness(moved)
    for pair, gap in here.pairs.items():
        assert there.pairs[pair] == pytest.approx(gap, abs=1e-9)
    assert here.pairs["hand.L", "head"] == pytest.approx(here.pairs["hand.R", "head"], abs=1e-12)


def test_heights_are_from_the_surface_to_the_snow():
    low = nearness(standing(), height=0.0)
    ankle = forward_kinematics(SKELETON, standing())[0][0, SKELETON.body("foot.L"), 2]
    assert low.snow["foot.L"] == pytest.approx(ankle - 0.02 * SKELETON.height - 0.040 * SKELETON.height)
    assert "ski.L" not in low.snow
    lifted = nearness(standing(), height=2.0)
    assert lifted.snow["foot.L"] == pytest.approx(low.snow["foot.L"] + 2.0)


def test_a_pole_reaches_from_the_hand_to_its_tip():
    capsules = skier_capsules(SKELETON)
    (pole,) = capsules.of([SKELETON.body("pole.L")])
    position, rotation = forward_kinematics(SKELETON, standing())
    first, last = capsules.ends(position, rotation)
    assert np.linalg.norm(last[0, pole] - first[0, pole]) == pytest.approx(SKELETON.pole_length)
    assert first[0, pole] == pytest.approx(position[0, SKELETON.body("pole.L")])
    assert capsules.radius[pole] == POLE_RADIUS
    assert set(capsules.body) == set(range(len(NAMES)))
