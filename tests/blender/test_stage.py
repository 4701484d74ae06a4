"""What stands round a run: slope, tracks, trees, mountains, light, and a camera that follows."""

from __future__ import annotations

import numpy as np
import pytest

from tests.blender.blender_tools import make_recording, skeleton_of


@pytest.fixture
def recording(core, extension):
    return make_recording(core, duration=4.0)


@pytest.fixture
def spec(core, recording):
    return core("blender.bake").recorded_run(recording)


@pytest.fixture
def terrain(core, spec):
    return core("terrain").build_terrain(spec.slope)


def places(obj) -> np.ndarray:
    values = np.empty(3 * len(obj.data.vertices), dtype=np.float32)
    obj.data.vertices.foreach_get("co", values)
    return values.reshape(-1, 3).astype(float)


def test_the_slope_is_the_terrain(core, scene, recording, terrain) -> None:
    slope = core("blender.slope").build_slope(terrain, recording.track_position, scene.collection)
    vertices = places(slope)
    np.testing.assert_allclose(vertices[:, 2], terrain.height(vertices[:, 0], vertices[:, 1]), rtol=1e-5, atol=1e-3)
    assert all(polygon.normal.z > 0.5 for polygon in slope.data.polygons)
    assert [material.name for material in slope.data.materials] == ["Ski snow"]


def test_the_slope_of_known_ground_ends_with_it_in_the_user_s_scene(core, scene) -> None:
    grid = core("terrain").HeightGrid(-0.2 * np.arange(60.0)[:, None] + np.zeros((1, 20)), 1.0, (0.0, -10.0))
    track = np.column_stack((np.linspace(5.0, 55.0, 100), np.zeros(100), np.zeros(100)))
    slope = core("blender.slope").build_slope
    near, wide = places(slope(grid, track, scene.collection, far=())), places(slope(grid, track, scene.collection))
    assert np.all(grid.contains(near[:, 0], near[:, 1]))
    np.testing.assert_allclose([near[:, 0].max(), near[:, 1].min()], [59.0, -10.0], atol=1e-5)
    assert wide[:, 0].max() > 2000.0  # a picture's goes to the horizon


def test_the_slope_reaches_round_the_whole_track(core, scene, recording, terrain) -> None:
    slope = places(core("blender.slope").build_slope(terrain, recording.track_position, scene.collection, far=()))
    track = recording.track_position
    for axis in (0, 1):
        assert slope[:, axis].min() < track[:, axis].min() - 20
        assert slope[:, axis].max() > track[:, axis].max() + 20
    assert np.ptp(slope[:, 1]) < 200  # the user's scene is not filled to the horizon


def test_tracks_follow_the_skis(core, scene, recording, terrain) -> None:
    skeleton = skeleton_of(core, recording)
    tracks = core("blender.ski_tracks").build_ski_tracks(recording, skeleton, terrain, scene.collection)
    position, _ = core("body").forward_kinematics(skeleton, recording.qpos[::500])
    for track, name in zip(tracks, ("ski.L", "ski.R"), strict=True):
        middle = places(track).reshape(-1, 6, 3)[:, 2:4].mean(axis=1)
        for ski in position[:, skeleton.body(name)]:
            assert np.min(np.linalg.norm(middle[:, :2] - ski[:2], axis=1)) < 0.15


def test_tracks_look_up(core, scene, recording, terrain) -> None:
    tracks = core("blender.ski_tracks").build_ski_tracks(
        recording, skeleton_of(core, recording), terrain, scene.collection
    )
    for track in tracks:
        assert np.mean([polygon.normal.z > 0.2 for polygon in track.data.polygons]) > 0.98


@pytest.mark.parametrize(("slip_deg", "width"), [(0.0, 0.1), (2.0, 0.1), (30.0, 0.9), (90.0, 1.7)])
def test_a_skidding_ski_leaves_a_band_as_wide_as_it_lies_across(core, scene, terrain, slip_deg, width) -> None:
    x = np.linspace(0.0, 5.0, 51)
    way = np.stack((x, 0.0 * x, terrain.height(x, 0.0 * x)), axis=1)
    slip, normal = np.radians(slip_deg), terrain.normal(0.0, 0.0)
    ahead = np.cross([0.0, 1.0, 0.0], normal)
    left = np.tile(np.cos(slip) * np.array([0.0, 1.0, 0.0]) - np.sin(slip) * ahead, (51, 1))
    groove = core("blender.ski_tracks").groove_vertices(way, left, 0.0 * x, terrain, 0.035, 0.85)
    floor = np.linalg.norm(groove[:, 3] - groove[:, 2], axis=1)
    np.testing.assert_allclose(floor, width, atol=0.09)
    above = groove[..., 2] - terrain.height(groove[..., 0], groove[..., 1])
    assert -0.02 < above.min() < 0.0 < above.max() < 0.06


def test_a_ski_that_comes_to_rest_leaves_no_more_track(core, recording) -> None:
    tools, skeleton = core("blender.ski_tracks"), skeleton_of(core, recording)
    recording.qpos = np.array(recording.qpos)
    recording.qpos[3000:] = recording.qpos[3000]  # the skis stand while the skier's place goes on
    (place, left, edge), _ = tools.ski_paths(recording, skeleton)
    assert len(place) == len(left) == len(edge) < 185
    assert np.all(np.linalg.norm(np.diff(place, axis=0), axis=1) > 0.04)


def test_the_same_tracks_come_out_every_time(core, scene, recording, terrain) -> None:
    tools, skeleton = core("blender.ski_tracks"), skeleton_of(core, recording)
    one, two = (tools.build_ski_tracks(recording, skeleton, terrain, scene.collection) for _ in range(2))
    np.testing.assert_array_equal(places(one[0]), places(two[0]))


def test_trees_keep_off_the_track_and_stand_on_the_ground(core, scene, recording, terrain) -> None:
    scenery = core("blender.scenery")
    trees = scenery.build_trees(terrain, recording.track_position, scene.collection)
    places_of_firs = places(trees).reshape(-1, len(scenery._fir().vertices), 3)
    assert len(places_of_firs) > 10 and len(scene.collection.objects) == 1
    path = recording.track_position[::20, :2]
    for fir in places_of_firs:
        middle = 0.5 * (fir.min(axis=0) + fir.max(axis=0))[:2]
        assert np.min(np.linalg.norm(path - middle, axis=1)) > scenery.TREE_CORRIDOR[0] - 1.5
        ground = float(terrain.height(middle[0], middle[1]))
        assert ground - 1.2 < fir[:, 2].min() < ground and 3.5 < np.ptp(fir[:, 2]) < 11.0


def test_trees_keep_out_of_the_camera_s_way(core, scene, recording, terrain) -> None:
    scenery = core("blender.scenery")
    outline = np.array([[10.0, 60.0], [0.0, 5.0], [30.0, 5.0]])
    feet = []
    for clear in (None, outline):
        trees = scenery.build_trees(terrain, recording.track_position, scene.collection, clear=clear)
        firs = places(trees).reshape(-1, len(scenery._fir().vertices), 3)
        feet.append(0.5 * (firs.min(axis=1) + firs.max(axis=1))[:, :2])
    all_feet, kept = ({tuple(np.round(foot, 2)) for foot in some} for some in feet)
    gone = np.array(sorted(all_feet - kept))
    assert kept < all_feet
    assert np.all(np.abs(gone - [15.0, 30.0]) < [20.0, 35.0])
    middle = outline.mean(axis=0)
    assert not any(np.linalg.norm(np.array(foot) - middle) < 5.0 for foot in kept)


def test_mountains_are_far_and_round_about(core, scene) -> None:
    centre = np.array([100.0, 5.0, -20.0])
    mountains = core("blender.scenery").build_mountains(centre, scene.collection)
    offset = places(mountains) - centre
    assert np.min(np.hypot(offset[:, 0], offset[:, 1])) > 1500
    azimuth = np.degrees(np.arctan2(offset[:, 1], offset[:, 0]))
    assert np.all(np.histogram(azimuth, bins=12, range=(-180, 180))[0] > 0)
    assert offset[:, 2].max() > 200


@pytest.mark.parametrize(("azimuth", "height"), [(0.0, 24.0), (120.0, 10.0), (250.0, 60.0)])
def test_the_sun_stands_where_it_is_asked_to(core, scene, azimuth: float, height: float) -> None:
    import bpy

    sun = core("blender.light").build_sun(scene.collection, azimuth, height)
    bpy.context.view_layer.update()
    towards = np.array(sun.matrix_world)[:3, 2]
    np.testing.assert_allclose(towards, core("blender.camera").direction_from(azimuth, height), atol=1e-6)


def test_the_sky_is_darker_blue_overhead(core, scene) -> None:
    world = core("blender.light").build_sky(scene)
    assert scene.world == world
    ramp = next(node for node in world.node_tree.nodes if node.type == "VALTORGB").color_ramp
    colours = [tuple(element.color)[:3] for element in ramp.elements]
    assert [element.position for element in ramp.elements] == sorted(element.position for element in ramp.elements)
    assert colours[0][0] > colours[-1][0]
    assert colours[-1][2] > 2 * colours[-1][0]


def test_the_camera_follows_the_skier(core, scene, recording) -> None:
    import bpy
    from bpy_extras.object_utils import world_to_camera_view

    armature = core("blender.bake").bake_recording(recording, scene).armature
    camera = core("blender.camera").build_follow_camera(armature, scene, scene.collection)
    assert scene.camera == camera
    for frame in (1, 40, 90):
        scene.frame_set(frame)
        evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
        pelvis = evaluated.matrix_world @ evaluated.pose.bones["pelvis"].head
        seen = world_to_camera_view(scene, camera, pelvis)
        assert seen.z == pytest.approx(np.linalg.norm(core("blender.camera").FOLLOW_OFFSET), abs=0.01)
        np.testing.assert_allclose(seen.xy, (0.5, 0.5), atol=0.01)


def test_a_stage_has_its_collections(core, scene, recording, spec) -> None:
    core("blender.stage").build_stage(recording, spec, scene)
    assert [collection.name for collection in scene.collection.children] == [
        *("Slope", "Ski tracks", "Scenery", "Light")
    ]
    assert scene.view_settings.view_transform == "AgX"


def test_an_empty_file_is_never_opened_over_a_user_s(core, scene, monkeypatch) -> None:
    stage = core("blender.stage")

    class App:
        background = False

    class Bpy:
        app = App

    monkeypatch.setattr(stage, "bpy", Bpy)
    with pytest.raises(RuntimeError, match="in background"):
        stage.empty_file()


def test_the_ground_is_renewed_and_the_user_s_things_stay(core, scene, recording, spec) -> None:
    import bpy

    update = core("blender.ground").update_ground
    ground = update(recording, spec, scene, None)
    mine = bpy.data.objects.new("Gate", None)
    ground.objects.link(mine)
    names = sorted(obj.name for obj in ground.objects)
    meshes = len(bpy.data.meshes)
    assert update(recording, spec, scene, ground) == ground
    assert sorted(obj.name for obj in ground.objects) == names
    assert len(bpy.data.meshes) == meshes


def test_a_steeper_run_gets_a_steeper_ground(core, scene) -> None:
    update, bake = core("blender.ground").update_ground, core("blender.bake")
    ground = None
    falls = []
    for angle in (5.0, 20.0):
        recording = make_recording(core, duration=1.0, **{"slope.angle_deg": angle})
        ground = update(recording, bake.recorded_run(recording), scene, ground)
        vertices = places(next(obj for obj in ground.objects if obj.name.startswith("Slope")))
        falls.append(-np.polyfit(vertices[:, 0], vertices[:, 2], 1)[0])
    np.testing.assert_allclose(falls, np.tan(np.radians([5.0, 20.0])), rtol=1e-4)
