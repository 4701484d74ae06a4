"""World poses -> local channels of bones, and back by the rules Blender evaluates them with."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ski_addon.animation.bone_map import BoneEntry, BoneMap
from ski_addon.animation.keyframes import BoneKeyframes, RestPose, bone_keyframes
from ski_addon.animation.poses import BodyPoses, sample_body_poses
from ski_addon.body import Skeleton, forward_kinematics
from ski_addon.body.rest import rest_configuration
from ski_addon.errors import MissingInputError, SpecError
from ski_addon.frames import matrix_from_quaternion, rotation_about
from ski_addon.spec import find_document

SHIPPED = find_document("giant_slalom").parents[1] / "bone_maps" / "skier.toml"
RANDOM = np.random.default_rng(2)


def transform(position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    out = np.zeros((*position.shape[:-1], 4, 4))
    out[..., :3, :3], out[..., :3, 3], out[..., 3, 3] = rotation, position, 1.0
    return out


@pytest.fixture(scope="module")
def rest(skeleton: Skeleton) -> RestPose:
    """Bones where the bodies are, turned at random, under a root bone."""
    position, rotation = forward_kinematics(skeleton, rest_configuration(skeleton)[None])
    body = transform(position[0], rotation[0])
    turn = np.array(
        [
            rotation_about("z", np.float64(a)) @ rotation_about("x", np.float64(b))
            for a, b in RANDOM.normal(size=(20, 2))
        ]
    )
    bones = body @ transform(np.zeros((20, 3)), turn)
    root = transform(np.array([0.3, 0.1, 0.0]), rotation_about("z", np.float64(0.7)))
    return RestPose(
        bones=("root", *skeleton.body_names),
        parent=np.array([-1, *(skeleton.parent + 1)]),
        bone_matrix=np.concatenate((root[None], bones)),
        body_matrix=dict(zip(skeleton.body_names, body, strict=True)),
    )


@pytest.fixture(scope="module")
def poses(recording: SimpleNamespace, skeleton: Skeleton) -> BodyPoses:
    return sample_body_poses(recording, skeleton, 24.0, 2)


def evaluate(keyframes: BoneKeyframes, rest: RestPose) -> dict[str, np.ndarray]:
    """Pose matrices (m, 4, 4) in armature space, as Blender makes them from local channels."""
    channels = {channel.bone: channel for channel in keyframes.channels}
    pose: list[np.ndarray] = []
    for index, bone in enumerate(rest.bones):
        basis = np.broadcast_to(np.eye(4), (len(keyframes.frame), 4, 4))
        if bone in channels:
            channel = channels[bone]
            location = np.zeros((len(keyframes.frame), 3)) if channel.location is None else channel.location
            basis = transform(location, matrix_from_quaternion(channel.rotation))
        if rest.parent[index] < 0:
            pose.append(rest.bone_matrix[index] @ basis)
        else:
            local = np.linalg.inv(rest.bone_matrix[rest.parent[index]]) @ rest.bone_matrix[index]
            pose.append(pose[rest.parent[index]] @ local @ basis)
    return dict(zip(rest.bones, pose, strict=True))


def expected(poses: BodyPoses, rest: RestPose, body: str) -> np.ndarray:
    offset = np.linalg.inv(rest.body_matrix[body]) @ rest.bone_matrix[rest.bones.index(body)]
    return poses.matrices()[:, poses.body_names.index(body)] @ offset


def test_every_bone_goes_with_its_body(poses: BodyPoses, rest: RestPose) -> None:
    bone_map = BoneMap.load(SHIPPED)
    pose = evaluate(bone_keyframes(poses, bone_map, rest), rest)
    for entry in bone_map.entries:
        np.testing.assert_allclose(pose[entry.bone], expected(poses, rest, entry.body), atol=2e-6, err_msg=entry.bone)


def test_an_armature_may_stand_anywhere(poses: BodyPoses, rest: RestPose) -> None:
    placed = transform(
        np.array([4.0, -2.0, 1.0]), rotation_about("x", np.float64(0.5)) @ rotation_about("z", np.float64(2.0))
    )
    keyframes = bone_keyframes(poses, BoneMap.load(SHIPPED), rest, np.linalg.inv(placed))
    pose = evaluate(keyframes, rest)
    np.testing.assert_allclose(placed @ pose["hand.R"], expected(poses, rest, "hand.R"), atol=2e-6)


def test_a_scaled_armature_still_gets_rotations(poses: BodyPoses, rest: RestPose) -> None:
    scaled = np.diag([2.0, 2.0, 2.0, 1.0])
    for channels in bone_keyframes(poses, BoneMap.load(SHIPPED), rest, np.linalg.inv(scaled)).channels:
        np.testing.assert_allclose(np.linalg.norm(channels.rotation, axis=1), 1.0, atol=1e-9)


def test_only_free_bones_have_locations(poses: BodyPoses, rest: RestPose) -> None:
    channels = bone_keyframes(poses, BoneMap.load(SHIPPED), rest).channels
    assert [channel.bone for channel in channels if channel.location is not None] == ["pelvis"]


def test_quaternions_never_jump(poses: BodyPoses, rest: RestPose) -> None:
    flipped = BodyPoses(
        poses.frame,
        poses.time,
        poses.position,
        poses.quaternion * np.where(RANDOM.random((*poses.quaternion.shape[:2], 1)) < 0.5, -1.0, 1.0),
        poses.body_names,
    )
    for channels in bone_keyframes(flipped, BoneMap.load(SHIPPED), rest).channels:
        assert np.max(np.linalg.norm(np.diff(channels.rotation, axis=0), axis=1)) < 0.2, channels.bone


def test_bones_in_between_that_are_not_mapped_rest(poses: BodyPoses, rest: RestPose) -> None:
    full = BoneMap.load(SHIPPED)
    sparse = BoneMap("sparse", tuple(entry for entry in full.entries if entry.bone not in ("abdomen", "forearm.L")))
    keyframes = bone_keyframes(poses, sparse, rest)
    assert "abdomen" not in {channel.bone for channel in keyframes.channels}
    pose = evaluate(keyframes, rest)
    for name in ("chest", "hand.L", "foot.R"):  # their rotations are still those of their bodies
        np.testing.assert_allclose(pose[name][:, :3, :3], expected(poses, rest, name)[:, :3, :3], atol=1e-9)


def test_an_unknown_bone_is_named(poses: BodyPoses, rest: RestPose) -> None:
    with pytest.raises(SpecError, match=r"bones\.tail is not a bone"):
        bone_keyframes(poses, BoneMap("bad", (BoneEntry("tail", "pelvis"),)), rest)


def test_an_unknown_body_is_named(poses: BodyPoses, rest: RestPose) -> None:
    with pytest.raises(SpecError, match=r'bones\.pelvis = "wing" is not one of'):
        bone_keyframes(poses, BoneMap("bad", (BoneEntry("pelvis", "wing"),)), rest)


def test_the_shipped_map_has_every_body_once(skeleton: Skeleton) -> None:
    bone_map = BoneMap.load(SHIPPED)
    assert sorted(entry.body for entry in bone_map.entries) == sorted(skeleton.body_names)
    assert len(set(bone_map.bones)) == len(bone_map.bones)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("", "bones is missing"),
        ("[bones]\n", "bones is missing"),
        ("[bones]\npelvis = 3\n", r"bones\.pelvis = 3 is not"),
        ('[bones]\npelvis = { body = "pelvis", size = 2 }\n', r"bones\.pelvis"),
        ("[bones\n", "is not a TOML document"),
    ],
)
def test_a_bad_map_says_what_is_wrong(tmp_path, text: str, named: str) -> None:
    path = tmp_path / "map.toml"
    path.write_text(text)
    with pytest.raises(SpecError, match=named):
        BoneMap.load(path)


def test_a_missing_map_is_named(tmp_path) -> None:
    with pytest.raises(MissingInputError, match=r"nothing\.toml"):
        BoneMap.load(tmp_path / "nothing.toml")
