"""A recording on foreign armatures: directions and twists of all parts, feet on skis, whatever the rest pose."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ski_addon.animation.bone_map import BoneMap
from ski_addon.animation.keyframes import RestPose, bone_keyframes
from ski_addon.animation.poses import BodyPoses, sample_body_poses
from ski_addon.animation.retarget import Retargeted, RetargetOptions, retarget
from ski_addon.animation.target import TargetRest, measure_target
from ski_addon.body import Skeleton
from ski_addon.body.rest import rest_frames
from ski_addon.errors import SpecError
from ski_addon.frames import matrix_from_quaternion, rotation_about
from ski_addon.spec import find_document
from tests.animation.foreign_armatures import JOINTS, angle_between, evaluate, in_a_pose, rest_of, turned
from tests.animation.foreign_armatures import with_right_side as both

MAPS = find_document("giant_slalom").parents[1] / "bone_maps"
LIMBS = {"thigh_l": "calf_l", "calf_l": "foot_l", "upperarm_l": "lowerarm_l", "lowerarm_l": "hand_l"}
LIMBS |= {bone[:-2] + "_r": end[:-2] + "_r" for bone, end in LIMBS.items()}
FORE, UP = np.array([0.0, -1.0, 0.0]), np.array([0.0, 0.0, 1.0])
ANGLES = RetargetOptions(legs="angles")


@pytest.fixture(scope="module")
def poses(recording: SimpleNamespace, skeleton: Skeleton) -> BodyPoses:
    return sample_body_poses(recording, skeleton, 24.0)


@pytest.fixture(scope="module")
def bone_map() -> BoneMap:
    return BoneMap.load(MAPS / "unreal_mannequin.toml").resolved(both())[0]


def body(poses: BodyPoses, name: str) -> np.ndarray:
    return matrix_from_quaternion(poses.quaternion[:, poses.body_names.index(name)])


def body_of(bone: str, bone_map: BoneMap) -> str:
    return next(entry.body for entry in bone_map.entries if entry.bone == bone)


def apart(pose: dict, bone: str, end: str) -> np.ndarray:
    return pose[bone][:, :3, 3] - pose[end][:, :3, 3]


def motion(pose: dict, rest: TargetRest, bone: str) -> np.ndarray:
    return pose[bone][:, :3, :3] @ rest.matrix[rest.bones.index(bone), :3, :3].T


def ankle_errors(poses: BodyPoses, skeleton: Skeleton, pose: dict, rest: TargetRest, made: Retargeted) -> np.ndarray:
    """How far the soles are above or below where the bases of the recorded skis are, along each ski's normal [m]."""
    out = []
    for side, foot in (("L", "foot_l"), ("R", "foot_r")):
        ski, turn = poses.position[:, poses.body_names.index(f"ski.{side}")], body(poses, f"ski.{side}")
        sole = pose[foot][:, :3, 3] - rest.head(foot)[2] * turn[..., 2]  # the rest stands on z = 0
        ahead = ski - sole
        np.testing.assert_allclose(np.sum(ahead * turn[..., 0], axis=1), made.size * skeleton.ankle_setback, atol=1e-3)
        out.append(np.sum(ahead * turn[..., 2], axis=1))
        out.append(np.sum(ahead * turn[..., 1], axis=1))
    return np.abs(out)


@pytest.mark.parametrize("joints", [both(), in_a_pose(both())], ids=["T-pose", "A-pose"])
@pytest.mark.parametrize("seed", [1, 2])
def test_every_part_points_as_recorded(poses, skeleton, bone_map, joints: dict, seed: int) -> None:
    rest = rest_of(joints, seed)
    pose = evaluate(retarget(poses, skeleton, bone_map, rest, options=ANGLES).keyframes, rest)
    for bone, end in LIMBS.items():
        wanted = body(poses, body_of(bone, bone_map))[..., 2]
        assert angle_between(apart(pose, bone, end), wanted).max() < 0.01, bone
    for bone in ("pelvis", "spine_03", "head"):
        recorded = body(poses, body_of(bone, bone_map))
        assert angle_between(motion(pose, rest, bone) @ UP, recorded[..., 2]).max() < 0.01, bone
        assert angle_between(motion(pose, rest, bone) @ FORE, recorded[..., 0]).max() < 0.01, bone
    for side in "lr":
        toe = rest.head(f"ball_{side}") - rest.head(f"foot_{side}")
        toe[2] = 0.0
        recorded = body(poses, f"foot.{side.upper()}")
        assert angle_between(motion(pose, rest, f"foot_{side}") @ toe, recorded[..., 0]).max() < 0.01
        assert angle_between(motion(pose, rest, f"foot_{side}") @ UP, recorded[..., 2]).max() < 0.01


def test_limbs_twist_as_recorded(poses, skeleton, bone_map) -> None:
    """In a T-pose the elbow's axis is upright and the palm looks down; in both legs the knee's axis lies sideways."""
    rest = rest_of(both())
    pose = evaluate(retarget(poses, skeleton, bone_map, rest, options=ANGLES).keyframes, rest)
    for bone, name, axis in (
        ("upperarm_l", "upper_arm.L", UP),
        ("lowerarm_l", "forearm.L", UP),
        ("hand_l", "hand.L", UP),
        ("upperarm_r", "upper_arm.R", -UP),
        ("hand_r", "hand.R", -UP),
        ("thigh_r", "thigh.R", np.array([1.0, 0.0, 0.0])),
        ("calf_l", "shank.L", np.array([1.0, 0.0, 0.0])),
    ):
        found = motion(pose, rest, bone) @ axis
        assert angle_between(found, body(poses, name)[..., 1]).max() < 5.0, bone  # the rest's limbs are not quite level


def test_feet_are_on_the_skis(poses, skeleton, bone_map) -> None:
    rest = rest_of(both())
    made = retarget(poses, skeleton, bone_map, rest)
    assert made.foot_error.max() < 1e-6
    pose = evaluate(made.keyframes, rest)
    assert ankle_errors(poses, skeleton, pose, rest, made).max() < 1e-3
    for bone, end in LIMBS.items():  # hips and knees give a little, nothing else does
        wanted = body(poses, body_of(bone, bone_map))[..., 2]
        most = 15.0 if bone[:4] in ("thig", "calf") else 0.01
        assert angle_between(apart(pose, bone, end), wanted).max() < most, bone


def test_soles_can_be_above_the_skis(poses, skeleton, bone_map) -> None:
    rest = rest_of(both())
    low = evaluate(retarget(poses, skeleton, bone_map, rest).keyframes, rest)
    high = evaluate(
        retarget(poses, skeleton, bone_map, rest, options=RetargetOptions(sole_height=0.05)).keyframes, rest
    )
    lifted = high["foot_l"][:, :3, 3] - low["foot_l"][:, :3, 3]
    np.testing.assert_allclose(lifted, 0.05 * body(poses, "ski.L")[..., 2], atol=1e-6)


def test_angles_can_be_kept_with_feet_right_in_the_mean(poses, skeleton, bone_map) -> None:
    made = retarget(poses, skeleton, bone_map, rest_of(both()), options=ANGLES)
    np.testing.assert_allclose(made.foot_error[:, 0], made.foot_error[:, 1], atol=1e-9)
    assert 0.0 < made.foot_error.max() < 0.15


@pytest.fixture(scope="module")
def own(skeleton: Skeleton) -> TargetRest:
    """The skier's own bodies as bones, rolled by chance, facing +x."""
    place, _ = rest_frames(skeleton)
    joints = {}
    for i, name in enumerate(skeleton.body_names):
        parent = skeleton.body_names[skeleton.parent[i]] if i else ""
        below = [j for j in np.flatnonzero(skeleton.parent == i) if not np.allclose(place[j], place[i])]
        tail = place[below[0]] if below else place[i] + [0.0, 0.0, 0.1]
        if name.startswith("pole"):
            tail = place[i] - rest_frames(skeleton)[1][i, :, 2]
        if name.startswith("foot"):
            tail = place[i] + [0.1, 0.0, 0.0]
        joints[name] = (parent, tuple(place[i]), tuple(tail))
    return rest_of(joints)


@pytest.mark.parametrize("scale", [1.0, 0.01, 30.0])
def test_the_skiers_own_bones_get_the_same_motion(poses, skeleton, own: TargetRest, scale: float) -> None:
    """An armature of the skier's measures, in other units and placed anywhere, moves just as the made one does."""
    bone_map = BoneMap.load(MAPS / "skier.toml")
    sole = skeleton.ankle_height - measure_target(bone_map, own).ankle_height
    assert sole == pytest.approx(0.0, abs=1e-9)
    place, turn = rest_frames(skeleton)
    bodies = {}
    for i, name in enumerate(skeleton.body_names):
        bodies[name] = np.eye(4)
        bodies[name][:3, :3], bodies[name][:3, 3] = turn[i], place[i]
    wanted = bone_keyframes(poses, bone_map, RestPose(own.bones, own.parent, own.matrix, bodies))
    sized = own.matrix.copy()
    sized[:, :3, 3] /= scale
    units = TargetRest(own.bones, own.parent, sized, own.tail / scale, own.turns)
    object_matrix = np.eye(4)
    object_matrix[:3, :3] = scale * rotation_about("x", 0.5) @ rotation_about("z", 2.0)
    object_matrix[:3, 3] = 3.0, -2.0, 1.0
    made = retarget(poses, skeleton, bone_map, units, object_matrix)
    assert made.size == pytest.approx(1.0)
    expected, found = evaluate(wanted, own), evaluate(made.keyframes, units)
    for bone in own.bones:
        world = object_matrix @ found[bone]
        np.testing.assert_allclose(world[:, :3, 3], expected[bone][:, :3, 3], atol=1e-4, err_msg=bone)
        np.testing.assert_allclose(world[:, :3, :3] / scale, expected[bone][:, :3, :3], atol=1e-4, err_msg=bone)


@pytest.mark.parametrize("root", ["bone", "object"])
@pytest.mark.parametrize("by", [np.eye(3), rotation_about("x", 0.5 * np.pi), rotation_about("z", 1.2)])
def test_root_motion_moves_the_figure_the_same_way(poses, skeleton, bone_map, root: str, by: np.ndarray) -> None:
    rest = turned(rest_of(both()), by)
    plain = evaluate(retarget(poses, skeleton, bone_map, rest).keyframes, rest)
    made = retarget(poses, skeleton, bone_map, rest, options=RetargetOptions(root=root))
    pose = evaluate(made.keyframes, rest)
    for bone in ("pelvis", "head", "hand_l", "ball_r"):
        found = pose[bone] if made.ground_motion is None else made.ground_motion @ pose[bone]
        np.testing.assert_allclose(found, plain[bone], atol=1e-6)
    locations = {c.bone: c.location for c in made.keyframes.channels if c.location is not None}
    assert np.ptp(locations["pelvis"], axis=0).max() < 0.6
    skis = poses.position[:, [poses.body_names.index(f"ski.{side}") for side in "LR"]].mean(axis=1)
    origin = pose["root"][:, :3, 3] if root == "bone" else made.ground_motion[:, :3, 3]
    assert np.linalg.norm(origin - skis, axis=1).max() < 0.1  # the rest's feet stand 5 cm before its origin
    assert set(locations) == ({"pelvis", "root"} if root == "bone" else {"pelvis"})


def test_short_legs_pull_the_pelvis_down(poses, skeleton, bone_map) -> None:
    """With straight legs of one stance width, only a moved pelvis reaches both skis."""
    straight = BodyPoses(poses.frame, poses.time, poses.position.copy(), poses.quaternion.copy(), poses.body_names)
    for part in ("thigh", "shank"):
        for side in "LR":
            i = poses.body_names.index(f"{part}.{side}")
            straight.quaternion[:, i] = poses.quaternion[:, poses.body_names.index("pelvis")]
    made = retarget(straight, skeleton, bone_map, rest_of(both()))
    assert made.foot_error.max() < 1e-5


def test_a_map_without_a_leg_is_refused(poses, skeleton, bone_map) -> None:
    legless = BoneMap("legless", tuple(entry for entry in bone_map.entries if entry.bone != "calf_r"))
    with pytest.raises(SpecError, match=r"Hero.*shank\.R.*has no bone for"):
        retarget(poses, skeleton, legless, rest_of(both()), name="Hero")


def test_a_rest_pose_that_lies_askew_is_refused(poses, skeleton, bone_map) -> None:
    with pytest.raises(SpecError, match="Hero.*legs along"):
        retarget(poses, skeleton, bone_map, turned(rest_of(both()), rotation_about("x", 0.7)), name="Hero")


def test_swapped_sides_are_refused(poses, skeleton, bone_map) -> None:
    swapped = {name: (p, (-h[0], *h[1:]), (-t[0], *t[1:])) for name, (p, h, t) in both(JOINTS).items()}
    with pytest.raises(SpecError, match="Hero.*left bones on its right"):
        retarget(poses, skeleton, bone_map, rest_of(swapped), name="Hero")


def test_a_map_without_a_root_cannot_carry_the_motion(poses, skeleton, bone_map) -> None:
    rootless = BoneMap("rootless", bone_map.entries)
    with pytest.raises(SpecError, match="Hero.*has no root bone"):
        retarget(poses, skeleton, rootless, rest_of(both()), options=RetargetOptions(root="bone"), name="Hero")


@pytest.mark.parametrize("changes", [{"root": "hips"}, {"legs": "ik"}, {"sole_height": -1.0}])
def test_unknown_options_are_refused(changes: dict) -> None:
    with pytest.raises(SpecError, match=next(iter(changes))):
        RetargetOptions(**changes)
