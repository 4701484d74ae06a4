"""The tuck: low against the air, balanced, and faster."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.body import build_skeleton, centre_of_mass, forward_kinematics
from ski_addon.planning import build_stance
from ski_addon.snow import Snow
from ski_addon.spec import SkierSpec, SnowSpec
from tests.ski_runs import planned

GLIDE = {"course.turn_count": 2, "course.turn_radius": 60, "course.start_speed": 15}


@pytest.fixture(scope="module")
def skeleton():
    return build_skeleton(SkierSpec(mass=80, height=1.8))


@pytest.mark.parametrize("tuck", [0.0, 0.5, 1.0])
def test_tuck_is_balanced_over_the_middle_of_the_skis_and_mirrors_itself(skeleton, tuck):
    stance = build_stance(skeleton, np.deg2rad(60), tuck)
    position, rotation = forward_kinematics(skeleton, stance.qpos[None])
    com = centre_of_mass(skeleton, position, rotation)[0]
    np.testing.assert_allclose(com[:2], 0.0, atol=1e-6)
    assert com[2] == pytest.approx(stance.height, abs=1e-12)
    for part in ("hand", "shank", "ski"):
        left, right = (position[0, skeleton.body(f"{part}.{side}")] for side in "LR")
        np.testing.assert_allclose(left * (1, -1, 1), right, atol=1e-9)


def test_tuck_is_low_with_level_back_and_hands_ahead(skeleton):
    places = {}
    for tuck in (0.0, 1.0):
        stance = build_stance(skeleton, np.deg2rad(60), tuck)
        position, rotation = forward_kinematics(skeleton, stance.qpos[None])
        places[tuck] = {name: position[0, skeleton.body(name)] for name in ("head", "hand.L", "chest")}
        places[tuck]["back"] = rotation[0, skeleton.body("chest"), :, 2]
        places[tuck]["eyes"] = rotation[0, skeleton.body("head"), :, 0]
    up, low = places[0.0], places[1.0]
    assert low["head"][2] < up["head"][2] - 0.15
    assert low["back"][2] < 0.4 < up["back"][2]
    assert low["hand.L"][0] > low["chest"][0] + 0.2 and abs(low["hand.L"][1]) < abs(up["hand.L"][1])
    assert low["eyes"][2] > -0.5, "the eyes look ahead, not at the skis"


def test_full_tuck_halves_the_drag():
    free, half, full = (Snow.of(SnowSpec(), SkierSpec(), tuck).drag_factor for tuck in (0.0, 0.5, 1.0))
    assert full == pytest.approx(0.5 * free) and half == pytest.approx(0.75 * free)


def test_tucked_skier_is_faster_and_within_joint_ranges():
    upright, tucked = (planned("giant_slalom", {**GLIDE, "technique.tuck": tuck}) for tuck in (0, 1))
    assert tucked.plan.speed[-1] > upright.plan.speed[-1] + 0.3
    hinges = tucked.plan.pose[:, tucked.model.actuated_qpos]
    assert np.all(hinges >= tucked.model.joint_lower) and np.all(hinges <= tucked.model.joint_upper)
