"""Armatures and meshes of the four figures."""

from __future__ import annotations

import numpy as np
import pytest

KINDS = ("alpine", "snowboard", "telemark", "bicycle")
SKIER_BONES = 21


@pytest.fixture(params=KINDS)
def model(core, request):
    spec = core("spec").RunSpec().with_overrides({"figure.kind": request.param})
    return core("turning.figures").build_figure(spec)


@pytest.fixture
def rig(core, scene, model):
    return core("blender.rig").build_figure_rig(model, scene)


def test_there_is_a_bone_for_every_body_where_it_is(rig, model) -> None:
    bones = rig.armature.data.bones
    assert set(bones.keys()) == {"root", *model.body_names}
    for name, place in zip(model.body_names, model.place, strict=True):
        np.testing.assert_allclose(bones[name].head_local, place, atol=1e-6)


def test_bones_hang_together_as_the_bodies_do(rig, model) -> None:
    for name, parent in zip(model.body_names, model.parent, strict=True):
        assert rig.armature.data.bones[name].parent.name == (model.body_names[parent] if parent >= 0 else "root")


def test_bodies_that_move_have_bones_that_can(rig, model) -> None:
    assert not any(rig.armature.data.bones[name].use_connect for name in model.free)


def test_a_wheel_s_bone_lies_along_its_axle(rig, model) -> None:
    for name in ("wheel_rear", "wheel_front", "crank"):
        if name in model.gear:
            bone = rig.armature.data.bones[name]
            np.testing.assert_allclose((bone.tail_local - bone.head_local).normalized(), (0, 1, 0), atol=1e-6)


def test_bones_have_shapes_and_collections(rig, model) -> None:
    assert all(bone.custom_shape is not None for bone in rig.armature.pose.bones)
    assert {bone.name for bone in rig.armature.data.collections["Equipment"].bones} == set(model.gear)


def test_at_rest_the_mesh_is_as_it_was_drawn(core, rig, model) -> None:
    import bpy

    bpy.context.view_layer.update()
    graph = bpy.context.evaluated_depsgraph_get()
    parts = core("blender.skier.build").figure_parts(core("blender.skier.figure").figure_of(model))
    assert set(rig.equipment) == set(model.gear)
    for obj, name in ((rig.body, "body"), *((mesh, key) for key, mesh in rig.equipment.items())):
        places = np.array([vertex.co for vertex in obj.evaluated_get(graph).data.vertices])
        np.testing.assert_allclose(places, parts[name].vertices, atol=2e-6)


def test_a_rig_is_found_again_from_its_armature(core, rig) -> None:
    found = core("blender.rig").find_rig(rig.armature)
    assert found.body == rig.body and found.equipment == rig.equipment


def test_the_alpine_figure_is_built_as_the_skier_of_a_recording(core, scene) -> None:
    spec = core("spec").RunSpec()
    model = core("turning.figures").build_figure(spec)
    figure = core("blender.rig").build_figure_rig(model, scene)
    skier = core("blender.rig").build_rig(core("body").build_skeleton(spec.skier), scene)
    assert len(figure.armature.data.bones) == SKIER_BONES
    for bone in figure.armature.data.bones:
        other = skier.armature.data.bones[bone.name]
        np.testing.assert_allclose(bone.matrix_local, other.matrix_local, atol=1e-6)
        assert bone.use_connect == other.use_connect
    assert set(figure.equipment) == set(skier.equipment)
    for mine, other in (
        (figure.body, skier.body),
        *((figure.equipment[k], skier.equipment[k]) for k in skier.equipment),
    ):
        np.testing.assert_allclose([v.co for v in mine.data.vertices], [v.co for v in other.data.vertices], atol=1e-6)
        assert mine.data.materials.keys() == other.data.materials.keys()
