"""The live preview: what it draws of a run, when it is worked out anew, and that it stays out of the file."""

from __future__ import annotations

import numpy as np
import pytest


@pytest.fixture
def live(core, scene):
    return core("blender.live")


def test_the_line_is_the_track_over_the_snow(core, ski, live) -> None:
    shown = live.preview_of(ski)
    spec = core("blender.properties").read_spec(ski)
    terrain = core("terrain").build_terrain(spec.slope)
    over = shown.line[:, 2] - terrain.height(shown.line[:, 0], shown.line[:, 1])
    assert len(shown.line) > 500 and not shown.problem
    assert over.min() > 0.0 and over.max() < 0.1
    track = core("pipeline").make_plan(spec).track
    ends = np.linalg.norm(shown.line[-1, :2] - track.position[:, :2], axis=1).min()
    assert ends < 0.5


def test_colours_go_with_the_speed(ski, live) -> None:
    shown = live.preview_of(ski)
    slow, fast = int(np.argmin(shown.motion.speed)), int(np.argmax(shown.motion.speed))
    np.testing.assert_allclose(shown.colour[slow], live.SPEED_COLOURS[0], atol=1e-6)
    np.testing.assert_allclose(shown.colour[fast], live.SPEED_COLOURS[-1], atol=1e-6)


def test_places_with_too_much_lean_are_red_and_named(ski, live) -> None:
    ski.technique.inclination_max_deg = np.radians(30.0)
    shown = live.preview_of(ski)
    red = (shown.colour == live.refused_colour()).all(axis=1)
    assert 0 < red.sum() < len(red)
    assert "degrees of lean, at most 30 are allowed" in shown.problem
    assert shown.problem_place is not None


def test_what_cannot_be_has_a_reason_and_keeps_the_last_line(ski, live) -> None:
    before = live.preview_of(ski)
    ski.course.kind, ski.course.gate_setting = "gates", "list"
    shown = live.preview_of(ski, before)
    assert "has no gates" in shown.problem
    assert len(shown.line) == len(before.line)
    assert len(set(map(tuple, shown.colour))) == 1  # grey


def test_nothing_is_worked_out_twice(ski, live) -> None:
    before = live.preview_of(ski)
    assert live.preview_of(ski, before) is before
    ski.snow.friction += 0.01
    assert live.preview_of(ski, before) is not before


def test_a_moved_gate_moves_the_line(ski, live) -> None:
    import bpy

    bpy.ops.ski.set_gates(discipline="slalom", count=8)
    before = live.preview_of(ski)
    assert [gate.number for gate in before.gates] == list(range(1, 9))
    gate = next(obj for obj in ski.gates.all_objects if obj.name == "Gate 4")
    gate.location.y += 0.6
    bpy.context.view_layer.update()
    after = live.preview_of(ski, before)
    assert after is not before
    size = min(len(before.line), len(after.line))
    assert np.abs(before.line[:size] - after.line[:size]).max() > 0.2


def test_the_line_goes_with_the_start(ski, live) -> None:
    import bpy

    before = live.preview_of(ski)
    ski.start.location = (3.0, 40.0, 5.0)
    bpy.context.view_layer.update()
    after = live.preview_of(ski, before)
    np.testing.assert_allclose(
        after.line - before.line, np.broadcast_to((3.0, 40.0, 5.0), before.line.shape), atol=1e-4
    )


@pytest.mark.parametrize("kind", ["alpine", "snowboard", "telemark", "bicycle"])
def test_the_figure_is_where_the_track_is(core, ski, live, kind) -> None:
    ski.figure.kind = kind
    shown = live.preview_of(ski)
    lines = live.figure_at(shown, 61.0, 24.0)
    moment = int(np.argmin(np.abs(shown.motion.time - 60.0 / 24.0)))
    points = np.concatenate([points for points, _ in lines])
    assert np.linalg.norm(points[:, :2] - shown.line[moment, :2], axis=1).min() < 0.6
    assert 1.0 < np.ptp(points[:, 2]) < 2.5


def test_listeners_hear_of_changes_but_not_of_held_ones(core, ski) -> None:
    changes, heard = core("blender.changes"), []
    listener = heard.append
    changes.listen(listener)
    try:
        ski.course.turn_radius = 17.0
        ski.course.turn_radius = 18.0
        assert len(heard) == 2
        core("blender.properties").write_spec(ski, core("blender.properties").preset_specs()["slalom"])
        assert len(heard) == 3
    finally:
        changes.unlisten(listener)


def test_nothing_of_it_is_in_the_file(core, ski, live, tmp_path) -> None:
    import bpy

    live.refresh()
    path = tmp_path / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=False)
    assert not bpy.data.texts
    live.STATE.preview = live.preview_of(ski)
    bpy.ops.wm.open_mainfile(filepath=str(path))
    assert live.STATE.preview is None
