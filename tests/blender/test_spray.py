"""The emitter of snow: where it is, which way it looks, how strong it is; and tracks as curves."""

from __future__ import annotations

import numpy as np
import pytest

from tests.blender.blender_tools import curves, keys, make_recording, skeleton_of

RATE = 25.0


@pytest.fixture
def recording(core, extension):
    return make_recording(core, duration=3.0)  # a left turn, then a right one


@pytest.fixture
def spec(core, recording):
    return core("blender.bake").recorded_run(recording)


@pytest.fixture
def build(core, scene, recording, spec):
    """Builds the emitter; takes another recording."""

    def made(of=recording, frame_start=1):
        return core("blender.spray").build_spray(of, spec, scene.collection, RATE, frame_start)

    return made


def strengths(emitter) -> np.ndarray:
    return keys(curves(emitter.animation_data.action)[('["strength"]', 0)])


def frames_of(recording) -> np.ndarray:
    """Indices of the recording's steps at the frames."""
    return np.arange(0, len(recording.time), round(1000 / RATE))


def test_strength_is_keyed_on_every_frame_between_0_and_1(scene, build) -> None:
    emitter = build(frame_start=11)
    found = strengths(emitter)
    np.testing.assert_allclose(found[:, 0], 11 + np.arange(76))
    assert np.all((found[:, 1] >= 0.0) & (found[:, 1] <= 1.0)) and found[:, 1].max() > 0.2
    scene.frame_set(30)
    assert emitter["strength"] == pytest.approx(found[19, 1], abs=1e-5)


def test_it_lies_on_the_inner_edge_of_the_outside_ski(core, scene, build, recording) -> None:
    emitter, skeleton = build(), skeleton_of(core, recording)
    for frame, ski, side in ((20, "ski.R", 1.0), (58, "ski.L", -1.0)):
        scene.frame_set(frame)
        step = round((frame - 1) * 1000 / RATE)
        assert np.sign(recording.edge_angle[step, 0]) == side
        position, rotation = core("body").forward_kinematics(skeleton, recording.qpos[step : step + 1])
        body = skeleton.body(ski)
        wanted = position[0, body] + side * 0.5 * skeleton.ski_width * rotation[0, body, :, 1]
        np.testing.assert_allclose(emitter.matrix_world.translation, wanted, atol=1e-4)


def test_it_looks_out_of_the_turn_and_up(core, scene, build, recording) -> None:
    emitter, skeleton = build(), skeleton_of(core, recording)
    for frame, ski, side in ((20, "ski.R", 1.0), (58, "ski.L", -1.0)):
        scene.frame_set(frame)
        step = round((frame - 1) * 1000 / RATE)
        axes = np.array(emitter.matrix_world)[:3, :3]
        np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-5)
        normal = recording.surface_normal[step]
        _, rotation = core("body").forward_kinematics(skeleton, recording.qpos[step : step + 1])
        ahead = rotation[0, skeleton.body(ski), :, 0]
        left = np.cross(normal, ahead) / np.linalg.norm(np.cross(normal, ahead))
        assert axes[:, 2] @ normal == pytest.approx(np.sqrt(0.5), abs=1e-3)
        assert axes[:, 2] @ left == pytest.approx(-side * np.sqrt(0.5), abs=1e-3)
        assert axes[:, 0] @ ahead > 0.5
        face = emitter.data.polygons[0]
        assert tuple(face.normal) == (0.0, 0.0, 1.0)


def test_no_snow_flies_from_skis_in_the_air_or_at_rest(build, recording) -> None:
    recording.snow_force = 0.0 * recording.snow_force
    np.testing.assert_allclose(strengths(build(recording))[:, 1], 0.0)


def test_no_snow_flies_from_skis_that_stand(build, recording) -> None:
    recording.qpos = np.repeat(recording.qpos[700:701], len(recording.time), axis=0)
    np.testing.assert_allclose(strengths(build(recording))[:, 1], 0.0, atol=1e-9)


def shoved(core, recording, heading: float) -> np.ndarray:
    """States (n, nq) of a stiff skier on even ground who slides at 5 m/s in the direction of `heading` to the skis."""
    qpos = np.repeat(recording.qpos[:1], len(recording.time), axis=0)
    skeleton = skeleton_of(core, recording)
    _, rotation = core("body").forward_kinematics(skeleton, qpos[:1])
    ahead = rotation[0, skeleton.body("ski.R"), :, 0]
    normal = recording.surface_normal[0]
    ahead = ahead - (ahead @ normal) * normal
    ahead /= np.linalg.norm(ahead)
    way = np.cos(heading) * ahead + np.sin(heading) * np.cross(normal, ahead)
    qpos[:, :3] += 5.0 * recording.time[:, None] * way
    return qpos


def test_more_snow_flies_from_skis_that_slip_sideways_and_bear_more(core, build, recording) -> None:
    found = []
    for heading, load, edge in ((0.0, 1.0, 0.0), (0.0, 1.0, 0.8), (0.5, 1.0, 0.8), (1.57, 1.0, 0.8), (1.57, 2.0, 0.8)):
        changed = make_recording(core, duration=3.0)
        changed.qpos = shoved(core, recording, heading)
        changed.snow_force = load * changed.snow_force
        changed.edge_angle = np.full_like(changed.edge_angle, edge)
        found.append(strengths(build(changed))[5:-5, 1].mean())
    assert found[1] < 0.5 < found[3]
    assert np.all(np.diff(found) > 0.02)


def test_the_last_key_is_no_weaker_than_the_ones_before(core, build, recording) -> None:
    recording.qpos = shoved(core, recording, 1.57)
    recording.snow_force = np.repeat(recording.snow_force[:1], len(recording.time), axis=0)
    found = strengths(build(recording))[:, 1]
    np.testing.assert_allclose(found, found[10], rtol=0.01)


def test_the_user_s_particles_outlive_a_second_bake(scene, build, core) -> None:
    import bpy

    emitter = build()
    emitter.modifiers.new("Flakes", "PARTICLE_SYSTEM")
    emitter.name = "My spray"
    first = strengths(emitter)
    again = build(make_recording(core, duration=2.0))
    assert again == emitter and len(emitter.particle_systems) == 1
    assert len(strengths(again)) < len(first)
    assert len(bpy.data.actions) == 1


def test_the_emitter_itself_is_not_seen(build) -> None:
    emitter = build()
    assert not emitter.show_instancer_for_render and emitter.display_type == "WIRE"
    assert emitter.dimensions.y < 0.02


def test_particles_fly_where_it_looks(scene, build) -> None:
    import bpy

    emitter = build()
    emitter.modifiers.new("Flakes", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.frame_start, settings.frame_end, settings.count, settings.normal_factor = 1, 40, 400, 5.0
    for frame in range(1, 21):
        scene.frame_set(frame)
    flakes = emitter.evaluated_get(bpy.context.evaluated_depsgraph_get()).particle_systems[0].particles
    alive = np.array([flake.velocity for flake in flakes if flake.alive_state == "ALIVE"])
    assert len(alive) > 100
    assert alive.mean(axis=0) @ np.array(emitter.matrix_world)[:3, 2] > 0.0


def test_an_empty_recording_is_one_line(core, build, recording) -> None:
    for name in ("time", "qpos", "snow_force", "edge_angle", "surface_normal"):
        setattr(recording, name, getattr(recording, name)[:0])
    with pytest.raises(core("errors").SkiAddonError, match="the recording is empty"):
        build(recording)


def test_a_recording_of_one_step_has_one_key(build, recording) -> None:
    for name in ("time", "qpos", "snow_force", "edge_angle", "surface_normal"):
        setattr(recording, name, getattr(recording, name)[:1])
    assert strengths(build(recording)).tolist() == [[1.0, 0.0]]


@pytest.fixture
def tracks(core, scene, recording, spec):
    tools, terrain = core("blender.ski_tracks"), core("terrain").build_terrain(spec.slope)
    traces = tools.ski_traces(recording, skeleton_of(core, recording))
    return traces, terrain, tools.build_track_curves(traces, terrain, scene.collection)


def test_tracks_are_curves_on_the_ground(tracks) -> None:
    traces, terrain, made = tracks
    assert [obj.name for obj in made] == ["Ski track L curve", "Ski track R curve"]
    for trace, obj in zip(traces, made, strict=True):
        (spline,) = obj.data.splines
        points = np.array([point.co[:3] for point in spline.points])
        np.testing.assert_allclose(points[:, :2], trace.place[:, :2], atol=1e-4)
        np.testing.assert_allclose(points[:, 2], terrain.height(points[:, 0], points[:, 1]), atol=1e-3)


def test_a_curve_s_radius_is_half_the_track_s_width(tracks, core, scene) -> None:
    traces, terrain, made = tracks
    radius = np.array([point.radius for point in made[0].data.splines[0].points])
    assert radius.min() >= 0.6 * traces[0].half_width
    assert radius.max() < traces[0].half_width + traces[0].half_length
    x = np.linspace(0.0, 5.0, 51)
    way, across = np.stack((x, 0 * x, 0 * x), axis=1), np.tile((1.0, 0.0, 0.0), (51, 1))
    sideways = core("blender.ski_tracks").Trace("Skid", way, across, 0 * x, 0.05, 0.8)
    (skid,) = core("blender.ski_tracks").build_track_curves([sideways], terrain, scene.collection)
    assert skid.data.splines[0].points[25].radius == pytest.approx(0.85, abs=0.02)


def test_a_bevel_makes_a_tube(tracks) -> None:
    import bpy

    _, _, made = tracks
    made[0].data.bevel_depth = 1.0
    mesh = made[0].evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    assert len(mesh.polygons) > 100


def test_nothing_left_is_an_empty_curve(core, scene, tracks) -> None:
    traces, terrain, _ = tracks
    trace = traces[0]
    nothing = type(trace)("Ski track L", trace.place[:0], trace.left[:0], trace.edge[:0], 0.05, 0.8)
    (made,) = core("blender.ski_tracks").build_track_curves([nothing], terrain, scene.collection)
    assert len(made.data.splines) == 0


def test_a_marked_curve_goes_with_the_next_bake(core, scene, tracks, recording, spec) -> None:
    import bpy

    ground, (_, _, made) = core("blender.ground"), tracks
    for obj in made:
        obj[ground.MARK] = True
    collection = bpy.data.collections.new("Ground")
    for obj in made:
        collection.objects.link(obj)
    ground.update_ground(recording, spec, scene, collection)
    assert len(bpy.data.curves) == 0
