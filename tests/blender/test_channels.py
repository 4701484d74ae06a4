"""Writing keys: values, frames, interpolation and groups, and which action is written into."""

from __future__ import annotations

import numpy as np
import pytest

from tests.blender.blender_tools import curves, keys


@pytest.fixture
def channels(core, scene):
    return core("blender.channels")


@pytest.fixture
def empty(scene):
    import bpy

    obj = bpy.data.objects.new("Thing", None)
    scene.collection.objects.link(obj)
    return obj


def write(channels, obj, frame, values, path="location", name="Run"):
    """Bake one property the way Bake does."""
    action, slot, channelbag = channels.bake_action(obj, name)
    channels.KeyWriter(channelbag, np.asarray(frame, dtype=float)).write(path, np.asarray(values, dtype=float), "Place")
    channels.assign_action(obj, action, slot)
    return action


def test_keys_have_the_frames_and_values_given(channels, empty) -> None:
    frame = np.array([1.0, 1.5, 2.0, 4.25])
    values = np.random.default_rng(3).normal(size=(4, 3))
    found = curves(write(channels, empty, frame, values))
    assert sorted(found) == [("location", 0), ("location", 1), ("location", 2)]
    for index in range(3):
        np.testing.assert_allclose(
            keys(found["location", index]), np.column_stack((frame, values[:, index])), atol=1e-6
        )
        assert found["location", index].group.name == "Place"


def test_blender_evaluates_them_linearly(channels, empty, scene) -> None:
    write(channels, empty, [1, 3], [[0.0, 0.0, 0.0], [1.0, 4.0, -2.0]])
    scene.frame_set(1, subframe=0.5)
    np.testing.assert_allclose(empty.location, (0.25, 1.0, -0.5), atol=1e-6)
    scene.frame_set(2)
    np.testing.assert_allclose(empty.location, (0.5, 2.0, -1.0), atol=1e-6)


def test_one_column_is_one_curve(channels, empty) -> None:
    empty["speed"] = 0.0
    found = curves(write(channels, empty, [1, 2], [3.0, 4.0], '["speed"]'))
    assert list(found) == [('["speed"]', 0)]


def test_quoted_names_are_written_as_they_are(channels, scene, core) -> None:
    """Bone names may hold quotes and backslashes."""
    import bpy

    name = 'a "b" \\ c'
    path = f'["{bpy.utils.escape_identifier(name)}"]'
    obj = bpy.data.objects.new("Thing", None)
    scene.collection.objects.link(obj)
    obj[name] = 1.0
    write(channels, obj, [1, 11], [0.0, 10.0], path)
    scene.frame_set(6)
    assert obj[name] == pytest.approx(5.0)


def test_an_own_action_is_used_again(channels, empty) -> None:
    import bpy

    first = write(channels, empty, [1, 2, 3], np.zeros((3, 3)))
    second = write(channels, empty, [1, 2], np.ones((2, 3)))
    assert first == second
    assert len(bpy.data.actions) == 1
    assert {len(curve.keyframe_points) for curve in curves(second).values()} == {2}


def test_an_own_action_that_is_protected_is_still_its_own(channels, empty) -> None:
    first = write(channels, empty, [1, 2], np.zeros((2, 3)))
    first.use_fake_user = True
    assert write(channels, empty, [1, 2], np.ones((2, 3))) == first


def test_an_action_with_another_slot_is_left_alone(channels, empty) -> None:
    first = write(channels, empty, [1, 2], np.zeros((2, 3)))
    first.slots.new(id_type="OBJECT", name="Another")
    assert write(channels, empty, [1, 2], np.ones((2, 3))) != first


def test_an_action_of_another_maker_is_left_alone(channels, empty) -> None:
    import bpy

    mine = bpy.data.actions.new("Mine")
    empty.animation_data_create().action = mine
    made = write(channels, empty, [1, 2], np.zeros((2, 3)))
    assert made != mine
    assert empty.animation_data.action == made
    assert not mine.layers


def test_two_objects_have_two_actions(channels, scene) -> None:
    import bpy

    actions = []
    for name in ("One", "Two"):
        obj = bpy.data.objects.new(name, None)
        scene.collection.objects.link(obj)
        actions.append(write(channels, obj, [1, 2], np.zeros((2, 3))))
    assert actions[0] != actions[1]
    assert [action.slots[0].name_display for action in actions] == ["One", "Two"]
