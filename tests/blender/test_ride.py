"""Instant motions as rides: where they leave tracks, when they are where, and the ground round them."""

from __future__ import annotations

import numpy as np
import pytest


@pytest.fixture
def spec(core):
    return core("spec").RunSpec().with_overrides({"course.turn_count": 2, "slope.angle_deg": 8.0})


@pytest.fixture
def ride(core, extension, spec):
    motion = core("turning.preview").preview_motion(spec)
    return core("blender.ride").instant_ride(core("turning.figures").build_figure(spec), spec, motion)


def test_tracks_are_where_the_skis_were(ride) -> None:
    assert [trace.name for trace in ride.traces] == ["Ski track L", "Ski track R"]
    time = np.linspace(0.5, ride.timeline.time[-1] - 0.5, 20)
    poses = ride.poses_at(time)
    for trace, ski in zip(ride.traces, ("ski.L", "ski.R"), strict=True):
        place = poses.position[:, poses.body_names.index(ski)]
        away = np.linalg.norm(trace.place[None] - place[:, None], axis=2).min(axis=1)
        assert away.max() < 0.08  # half the distance of its points, and a step


def test_edges_lean_as_the_skier_does(ride) -> None:
    phase = np.interp(np.linspace(0, 1, 50), np.linspace(0, 1, len(ride.timeline.time)), ride.timeline.turn_phase)
    for trace in ride.traces:
        edge = np.interp(np.linspace(0, 1, 50), np.linspace(0, 1, len(trace.edge)), trace.edge)
        full = np.abs(phase) > 0.9
        assert full.sum() > 3
        assert np.all(np.sign(edge[full]) == np.sign(phase[full]))


def test_a_stage_is_built_round_a_ride(core, scene, ride, spec) -> None:
    import bpy

    core("blender.stage").stage_ride(ride, spec, scene)
    assert {"Slope", "Ski track L", "Ski track R", "Firs"} <= set(bpy.data.objects.keys())
    assert bpy.data.objects["Slope"].data.materials[0].name == "Ski snow"


def test_gates_swing_where_an_instant_skier_passes(core, extension) -> None:
    spec = (
        core("spec")
        .RunSpec()
        .with_overrides(
            {"course.kind": "gates", "course.gate_count": 4, "course.gate_distance": 0.2, "slope.angle_deg": 15.0}
        )
    )
    motion = core("turning.preview").preview_motion(spec)
    ride = core("blender.ride").instant_ride(core("turning.figures").build_figure(spec), spec, motion)
    terrain = core("terrain").build_terrain(spec.slope)
    swings = core("blender.stage").swings_of(ride, spec, terrain)
    assert len(swings) == 4 and any(swing is not None for swing in swings)


def test_ground_in_the_user_s_scene_is_renewed_by_another_ride(core, scene, ride, spec) -> None:
    ground = core("blender.ground")
    collection = ground.renew_ground(ride, spec, scene, None)
    names = {obj.name for obj in collection.all_objects}
    assert ground.renew_ground(ride, spec, scene, collection) == collection
    assert {obj.name for obj in collection.all_objects} == names
    assert names == {"Slope", "Ski track L", "Ski track R"}
