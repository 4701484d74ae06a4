"""Pictures of a run: which moments they show, what is in the frame, and that they are written whole."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.blender.blender_tools import make_recording


@pytest.fixture
def recording(core, extension):
    return make_recording(core, duration=9.0)


def test_moments_are_even_and_within_the_run(core, recording) -> None:
    times = core("blender.views").turn_times(recording, 10)
    assert len(times) == 10
    assert 0.0 <= times[0] < times[-1] <= 9.0
    np.testing.assert_allclose(np.diff(times), np.diff(times)[0])
    assert times[-1] - times[0] == pytest.approx(2.0 * 1.5, abs=0.8)  # about two turns


def test_a_short_run_is_shown_whole(core, extension) -> None:
    times = core("blender.views").turn_times(make_recording(core, duration=1.0), 8)
    np.testing.assert_allclose(times[[0, -1]], [0.0, 1.0])


def test_moments_over_bumps_are_within_so_much_way(core, recording) -> None:
    times = core("blender.views").middle_times(recording, 9, 24.0)
    np.testing.assert_allclose(times[-1] - times[0], 24.0 / 6.0, atol=0.01)  # at 6 m/s
    np.testing.assert_allclose(0.5 * (times[0] + times[-1]), 4.5, atol=0.01)


def test_a_stop_is_shown_until_the_skier_stands(core, recording) -> None:
    clock = np.asarray(recording.time)
    recording.speed = np.maximum(6.0 - 3.0 * np.maximum(clock - 5.0, 0.0), 0.0)
    recording.arc_length = np.cumsum(recording.speed) * 0.001
    times = core("blender.views").stop_times(recording, 8)
    assert times[0] == pytest.approx(times[-1] - 3.0, abs=0.01)
    assert np.interp(times[-1], clock, recording.speed) < 0.3
    way = np.interp(times, clock, recording.arc_length)
    np.testing.assert_allclose(np.diff(way), np.diff(way).mean(), atol=0.02)


@pytest.mark.parametrize(
    ("changes", "stop", "beside"),
    [
        ({}, False, False),
        ({"course.kind": "gates"}, False, False),
        ({"course.kind": "bumps"}, False, True),
        ({}, True, False),
    ],
)
def test_bumps_are_seen_from_the_side_and_turns_from_below(core, recording, changes, stop, beside) -> None:
    spec = core("blender.bake").recorded_run(recording).with_overrides(changes)
    view = core("blender.views").choose_view(recording, spec, 8, stop=stop)
    assert (abs(view.azimuth_deg) > 60.0) == beside
    assert abs(view.azimuth_deg) < 90.0  # never from above
    assert np.all(np.diff(view.time) > 0.0)
    assert view.time[0] >= 0.0 and view.time[-1] <= 9.0


def test_the_way_is_that_of_the_shown_moments(core, recording) -> None:
    azimuth, descent = core("blender.views").way(recording, np.array([1.5, 4.5]))
    assert azimuth == pytest.approx(0.0, abs=0.1)
    assert descent == pytest.approx(10.0, abs=0.1)


def test_the_camera_s_triangle_holds_what_it_sees(core, extension) -> None:
    camera = np.array([30.0, -12.0, 4.0])
    seen = np.random.default_rng(1).uniform((-20, -8, -3), (20, 9, 2), (60, 3))
    outline = core("blender.strobe")._outline(camera, seen)
    inside = core("blender.scenery")._within_outline(seen[:, :2], outline)
    assert np.all(inside)
    assert not core("blender.scenery")._within_outline(np.array([[44.0, -22.0], [0.0, 60.0]]), outline).any()


def test_edge_changes_are_found(core, recording) -> None:
    starts = core("blender.turns").turn_starts(recording)
    np.testing.assert_allclose(recording.time[starts], np.arange(1, 6) * 1.5, atol=0.02)


def test_apexes_are_of_both_sides(core, recording) -> None:
    found = core("blender.turns").turn_apexes(recording)
    assert set(found) == {"left", "transition", "right"}
    assert recording.turn_phase[found["left"]] > 0.95
    assert recording.turn_phase[found["right"]] < -0.95
    assert abs(recording.turn_phase[found["transition"]]) < 0.05


@pytest.mark.parametrize(("azimuth", "height"), [(0.0, 10.0), (70.0, 40.0), (200.0, 5.0)])
def test_the_camera_has_everything_in_its_frame(core, scene, azimuth: float, height: float) -> None:
    import bpy
    from bpy_extras.object_utils import world_to_camera_view
    from mathutils import Vector

    camera_tools = core("blender.camera")
    scene.render.resolution_x, scene.render.resolution_y = 1600, 900
    points = np.random.default_rng(4).uniform((-20, -8, -3), (25, 9, 2), (60, 3))
    camera = camera_tools.build_framing_camera(
        points, camera_tools.direction_from(azimuth, height), scene, scene.collection, fill=0.9
    )
    bpy.context.view_layer.update()
    seen = np.array([world_to_camera_view(scene, camera, Vector(point)) for point in points])
    assert np.all(seen[:, 2] > 0)
    assert np.all(np.abs(seen[:, :2] - 0.5) <= 0.5 * 0.9 + 1e-4)
    assert np.max(np.abs(seen[:, :2] - 0.5)) == pytest.approx(0.45, abs=1e-3)


def test_grooves_lie_on_the_slope(core, recording) -> None:
    tracks, spec = core("blender.ski_tracks"), core("blender.bake").recorded_run(recording)
    skeleton = core("body").build_skeleton(spec.skier)
    terrain = core("terrain").build_terrain(spec.slope)
    for place, left, edge in tracks.ski_paths(recording, skeleton):
        groove = tracks.groove_vertices(place, left, edge, terrain, 0.035)
        above = groove[..., 2] - terrain.height(groove[..., 0], groove[..., 1])
        assert above.min() >= -0.02
        assert 0.003 < above.max() < 0.06
        assert np.all(np.linalg.norm(np.diff(groove[:, 2:4].mean(axis=1), axis=0), axis=1) < 0.5)


def test_a_picture_is_written_whole(core, scene, recording, tmp_path: Path) -> None:
    import bpy

    target = tmp_path / "strobe.png"
    spec = core("blender.bake").recorded_run(recording)
    core("blender.strobe").render_strobe(recording, spec, target, 8, size=(64, 36), samples=1)
    image = bpy.data.images.load(str(target))
    assert tuple(image.size) == (64, 36)
    pixels = np.array(image.pixels[:]).reshape(-1, 4)[:, :3]
    assert pixels.std() > 0.02  # not one colour
    assert len([obj for obj in bpy.context.scene.objects if "body instant" in obj.name]) == 8
    assert [path.name for path in tmp_path.iterdir()] == ["strobe.png"]


def test_a_picture_that_cannot_be_written_is_named(core, scene, recording, tmp_path: Path) -> None:
    spec = core("blender.bake").recorded_run(recording)
    with pytest.raises(core("errors").OutputError, match=r"strobe\.png"):
        core("blender.strobe").render_strobe(
            recording, spec, tmp_path / "missing" / "deep" / "strobe.png", 2, size=(16, 9), samples=1
        )


def test_six_close_ups(core, scene, recording, tmp_path: Path) -> None:
    spec = core("blender.bake").recorded_run(recording)
    written = core("blender.closeups").render_closeups(recording, spec, tmp_path, size=(16, 16), samples=1)
    assert sorted(path.stem for path in written) == [
        *("left_front", "left_side", "right_front", "right_side", "transition_front", "transition_side")
    ]
    assert all(path.stat().st_size > 0 for path in written)
