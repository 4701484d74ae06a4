"""How the skier's parts fit each other and how they bend: linear blend skinning in plain numpy."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.blender.skier.boots import boots
from ski_addon.blender.skier.build import body_part
from ski_addon.blender.skier.clothes import jacket, trousers
from ski_addon.blender.skier.figure import Figure, build_figure
from ski_addon.blender.skier.hands import gloves
from ski_addon.blender.skier.head import head, helmet_surface
from ski_addon.blender.skier.shapes import Part
from ski_addon.body import Skeleton, build_skeleton, forward_kinematics
from ski_addon.body.rest import rest_configuration
from ski_addon.spec import SkierSpec


@pytest.fixture(scope="module")
def skeleton() -> Skeleton:
    return build_skeleton(SkierSpec())


@pytest.fixture(scope="module")
def figure(skeleton: Skeleton) -> Figure:
    return build_figure(skeleton)


def skinned(part: Part, skeleton: Skeleton, angles: dict[str, float]) -> np.ndarray:
    """The vertices (n, 3) of `part` with hinges turned to `angles` [deg], blended linearly."""
    rest = rest_configuration(skeleton)
    bent = rest.copy()
    for name, angle in angles.items():
        bent[skeleton.qpos_of(name)] = np.radians(angle)
    (rest_place, bent_place), (rest_turn, bent_turn) = forward_kinematics(skeleton, np.stack((rest, bent)))
    out = np.zeros_like(part.vertices)
    for name, weight in part.weights.items():
        body = skeleton.body(name)
        turn = bent_turn[body] @ rest_turn[body].T
        out += weight[:, None] * ((part.vertices - rest_place[body]) @ turn.T + bent_place[body])
    return out


def girth(points: np.ndarray) -> float:
    """Length round a ring of points."""
    return float(np.linalg.norm(np.diff(np.vstack((points, points[:1])), axis=0), axis=1).sum())


def edge_lengths(part: Part, vertices: np.ndarray) -> np.ndarray:
    pairs = {(min(a, b), max(a, b)) for face in part.faces for a, b in zip(face, (*face[1:], face[0]), strict=True)}
    a, b = np.array(sorted(pairs)).T
    return np.linalg.norm(vertices[a] - vertices[b], axis=1)


def test_at_rest_nothing_moves(figure: Figure, skeleton: Skeleton) -> None:
    part = body_part(figure)
    np.testing.assert_allclose(skinned(part, skeleton, {}), part.vertices, atol=1e-12)


@pytest.mark.parametrize("bend", [30.0, 60.0, 100.0])
def test_a_knee_keeps_its_girth(figure: Figure, skeleton: Skeleton, bend: float) -> None:
    part = trousers(figure)
    knee = figure.place["shank.L"]
    height = part.vertices[:, 2]
    near = (np.abs(height - height[np.argmin(np.abs(height - knee[2]))]) < 1e-9) & (part.vertices[:, 1] > 0)
    moved = skinned(part, skeleton, {"shank_y.L": bend})
    assert girth(moved[near]) > 0.75 * girth(part.vertices[near])


@pytest.mark.parametrize(
    "angles",
    [
        {"thigh_y.L": -80.0, "thigh_y.R": -80.0, "shank_y.L": 90.0, "shank_y.R": 90.0},
        {"thigh_x.L": 25.0, "thigh_x.R": 10.0},
        {"abdomen_y": 30.0, "chest_y": 25.0, "abdomen_x": 15.0, "chest_z": 20.0},
        {"upper_arm_y.L": -70.0, "upper_arm_x.L": 40.0, "forearm_y.L": -90.0},
        {"head_y": -35.0, "head_z": 40.0},
    ],
    ids=["crouch", "straddle", "trunk", "arm", "head"],
)
def test_no_seam_tears(figure: Figure, skeleton: Skeleton, angles: dict[str, float]) -> None:
    """Edges stretch where a joint bends, but none becomes a gaping web."""
    part = body_part(figure)
    before, after = (edge_lengths(part, v) for v in (part.vertices, skinned(part, skeleton, angles)))
    assert np.max(after) < 0.16
    assert np.quantile(after / before, 0.99) < 2.5


def test_what_is_rigid_stays_rigid(figure: Figure, skeleton: Skeleton) -> None:
    angles = {"head_y": -30.0, "shank_y.L": 60.0, "foot_y.L": -20.0, "hand_y.L": 30.0, "forearm_y.L": -60.0}
    for part in (head(figure), gloves(figure)):
        after = edge_lengths(part, skinned(part, skeleton, angles))
        np.testing.assert_allclose(after, edge_lengths(part, part.vertices), atol=1e-12)


def test_the_boot_s_shell_stays_on_the_ski(figure: Figure, skeleton: Skeleton) -> None:
    """The cuff goes with the shank, the shell with the foot."""
    part = boots(figure)
    moved = skinned(part, skeleton, {"foot_y.L": -25.0})
    foot, shank = (part.weights[name] > 0.999 for name in ("foot.L", "shank.L"))
    assert foot.sum() > 100
    assert shank.sum() > 50
    np.testing.assert_allclose(edge_free(moved, shank), edge_free(part.vertices, shank), atol=1e-9)


def edge_free(vertices: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Places relative to the first chosen one: what does not change when nothing turns."""
    return vertices[chosen] - vertices[chosen][0]


def test_trousers_hide_the_boots_tops(figure: Figure) -> None:
    leg, boot = trousers(figure), boots(figure)
    hem = leg.vertices[leg.weights["shank.L"] > 0.9][:, 2].min()
    assert boot.vertices[:, 2].max() > hem
    left = boot.vertices[(boot.vertices[:, 1] > 0) & (boot.vertices[:, 2] > hem + 0.01)]
    ring = leg.vertices[(leg.vertices[:, 1] > 0) & (np.abs(leg.vertices[:, 2] - hem) < 0.02)]
    assert left[:, 0].max() < ring[:, 0].max()
    assert left[:, 1].max() < ring[:, 1].max()


def test_gauntlets_go_over_the_sleeves(figure: Figure) -> None:
    sleeve, glove = jacket(figure), gloves(figure)
    wrist = figure.place["hand.L"]
    low = sleeve.vertices[(sleeve.weights["forearm.L"] > 0.9)][:, 2].min()
    assert glove.vertices[:, 2].max() > low
    assert low > wrist[2] - 0.01


def test_the_collar_is_round_the_neck(figure: Figure) -> None:
    part = jacket(figure)
    collar = part.vertices[part.vertices[:, 2] > figure.z("head") + 0.01 * figure.h]
    neck = figure.place["head"]
    assert collar[:, 0].min() < neck[0] < collar[:, 0].max()
    assert np.all(np.linalg.norm(collar[:, :2] - neck[:2], axis=1) > 0.02 * figure.h)


def test_the_jacket_covers_the_trousers(figure: Figure) -> None:
    top, bottom = jacket(figure), trousers(figure)
    assert top.vertices[:, 2].min() < figure.z("thigh.L")
    waist = bottom.vertices[bottom.vertices[:, 2] > figure.z("abdomen") - 0.02 * figure.h]
    coat = top.vertices[np.abs(top.vertices[:, 2] - figure.z("abdomen")) < 0.03 * figure.h]
    assert np.abs(waist[:, 1]).max() < np.abs(coat[:, 1]).max()


def test_a_heavier_person_is_rounder() -> None:
    slim, stout = (jacket(build_figure(build_skeleton(SkierSpec(mass=m, height=1.75)))) for m in (60, 110))
    assert np.ptp(stout.vertices[:, 0]) > 1.1 * np.ptp(slim.vertices[:, 0])


def test_a_taller_person_is_taller_everywhere() -> None:
    small, tall = (build_figure(build_skeleton(SkierSpec(mass=22 * h * h, height=h))) for h in (1.4, 1.9))
    for make in (jacket, trousers, head, gloves, boots):
        assert np.ptp(make(tall).vertices[:, 2]) > np.ptp(make(small).vertices[:, 2])


@pytest.mark.parametrize("azimuth", np.radians([0.0, 45.0, 90.0, 180.0]))
def test_the_helmet_is_smooth_where_its_halves_meet(azimuth: float) -> None:
    middle = 0.5 * np.pi
    above, below = (helmet_surface(np.float64(azimuth), np.float64(middle + d)) for d in (-1e-6, 1e-6))
    np.testing.assert_allclose(above, below, atol=1e-6)


def test_the_goggles_are_in_front_of_the_face(figure: Figure) -> None:
    part = head(figure)
    lens = {i for face, name in zip(part.faces, part.materials, strict=True) if name == "goggles_lens" for i in face}
    skin = {i for face, name in zip(part.faces, part.materials, strict=True) if name == "skin" for i in face}
    eyes = part.vertices[sorted(lens)]
    face = part.vertices[sorted(skin)]
    level = (face[:, 2] > eyes[:, 2].min()) & (face[:, 2] < eyes[:, 2].max())
    assert eyes[:, 0].max() > face[level][:, 0].max()
    assert eyes[:, 2].mean() == pytest.approx(figure.z("head") + 0.06 * figure.h, abs=0.01 * figure.h)
