"""The overlay: where its lines and words are at any time, and that nothing is drawn without a window."""

from __future__ import annotations

import dataclasses
import logging
import time
from types import SimpleNamespace

import numpy as np
import pytest

from tests.synthetic_recording import synthetic_recording

NAMES = ("body", "body on the snow", "force left", "force right", "planned body", "planned height")


@pytest.fixture
def spec(core, extension):
    return core("spec").RunSpec().with_overrides({"slope.angle_deg": 10.0})


@pytest.fixture
def recording(spec):
    return synthetic_recording(spec)


@pytest.fixture
def data(core, recording, spec):
    return core("blender.overlay_data").build_overlay(recording, spec)


def sample(recording, name, when):
    """A recorded vector at a time, between steps."""
    values = getattr(recording, name)
    flat = values.reshape(len(values), -1)
    found = [np.interp(when, recording.time, column) for column in flat.T]
    return np.array(found).reshape(values.shape[1:])


@pytest.mark.parametrize("when", [0.0, 3.3, 7.1234, 11.99])
def test_body_stands_straight_over_the_snow(data, recording, when) -> None:
    ((top, foot),) = data.at(when).segments[data.named("body")]
    np.testing.assert_allclose(top, sample(recording, "com", when), atol=1e-3)
    np.testing.assert_allclose(foot[:2], top[:2], atol=1e-12)
    assert foot[2] == pytest.approx(-foot[0] * np.tan(np.radians(10.0)), abs=1e-6)
    cross = data.at(when).segments[data.named("body on the snow")]
    np.testing.assert_allclose(cross.mean(axis=1), [foot, foot], atol=1e-9)


@pytest.mark.parametrize("when", [0.4, 5.0, 9.87])
def test_arrows_start_at_the_skis_and_are_a_metre_per_body_weight(core, data, recording, spec, when) -> None:
    poses = core("animation.poses").body_poses_at(recording, core("body").build_skeleton(spec.skier), np.array([when]))
    weight = 9.81 * spec.skier.mass
    for ski, name in enumerate(("ski.L", "ski.R")):
        (start, tip), *sides = data.at(when).segments[data.named(("force left", "force right")[ski])]
        np.testing.assert_allclose(start, poses.position[0, poses.body_names.index(name)], atol=2e-3)
        np.testing.assert_allclose(tip - start, sample(recording, "snow_force", when)[ski] / weight, atol=0.02)
        for side in sides:
            np.testing.assert_allclose(side[0], tip, atol=1e-9)
            assert np.dot(side[1] - tip, tip - start) < 0.0
            assert np.linalg.norm(side[1] - tip) < 0.2


def test_no_force_is_an_arrow_of_no_length(core, recording, spec) -> None:
    flying = dataclasses.replace(recording, snow_force=np.zeros_like(recording.snow_force))
    data = core("blender.overlay_data").build_overlay(flying, spec)
    for start, end in data.at(2.0).segments[data.named("force left")]:
        np.testing.assert_allclose(end, start, atol=1e-12)


def test_plan_is_where_the_reference_was_at_the_same_progress(data, recording) -> None:
    ((top, foot),) = data.at(4.2).segments[data.named("planned height")]
    np.testing.assert_allclose(top, sample(recording, "com_reference", 4.2), atol=1e-3)
    np.testing.assert_allclose(foot, sample(recording, "track_position", 4.2), atol=1e-3)
    for line in data.at(4.2).segments[data.named("planned body")]:
        np.testing.assert_allclose(line.mean(axis=0), top, atol=1e-9)


def test_words_give_the_edge_angle_of_each_ski_beside_it(data, recording) -> None:
    moment = data.at(1.25)  # the middle of a left turn
    assert [label.words for label in moment.labels] == ["+33\N{DEGREE SIGN}", "+36\N{DEGREE SIGN}"]
    left, right = (label.place for label in moment.labels)
    for place, name in ((left, "force left"), (right, "force right")):
        ahead = (place - moment.segments[data.named(name)][0, 0]) @ sample(recording, "track_tangent", 1.25)
        assert 0.9 < ahead < 1.0  # before its tip
    assert left[1] > right[1]


def test_every_segment_has_a_name_and_a_colour(data) -> None:
    moment = data.at(0.0)
    parts = [data.named(name) for name in NAMES]
    assert parts[0].start == 0 and parts[-1].stop == len(moment.segments) == len(moment.colors)
    assert all(part.stop == following.start for part, following in zip(parts, parts[1:], strict=False))
    assert moment.colors.shape[1] == 4 and (moment.colors[:, 3] == 1.0).all()
    with pytest.raises(KeyError):
        data.named("nothing")


def test_before_and_after_the_run_its_ends_are_shown(data) -> None:
    np.testing.assert_array_equal(data.at(-5.0).segments, data.at(0.0).segments)
    np.testing.assert_array_equal(data.at(1e9).segments, data.at(12.0).segments)
    np.testing.assert_array_equal(data.at(float("nan")).segments, data.at(0.0).segments)


def test_clock_of_the_recording_may_start_anywhere(core, data, recording, spec) -> None:
    late = dataclasses.replace(recording, time=recording.time + 7.0)
    shifted = core("blender.overlay_data").build_overlay(late, spec)
    np.testing.assert_allclose(shifted.at(3.0).segments, data.at(3.0).segments, atol=1e-9)


def test_a_run_of_one_step_can_be_shown(core, recording, spec) -> None:
    names = [field.name for field in dataclasses.fields(recording) if field.name != "header"]
    one = dataclasses.replace(recording, **{name: getattr(recording, name)[:1] for name in names})
    assert np.isfinite(core("blender.overlay_data").build_overlay(one, spec).at(0.5).segments).all()


def test_empty_recording_is_refused(core, recording, spec) -> None:
    empty = dataclasses.replace(recording, time=np.zeros(0))
    with pytest.raises(core("animation.poses").EmptyRecordingError):
        core("blender.overlay_data").build_overlay(empty, spec)


def test_a_frame_is_looked_up_fast(data) -> None:
    start = time.process_time()
    for step in range(500):
        data.at(0.02 * step)
    assert (time.process_time() - start) / 500 < 0.001  # 0.03 ms on an idle computer


def test_nothing_is_shown_without_a_window(core, scene, recording, spec) -> None:
    import bpy

    overlay = core("blender.overlay")
    handlers = len(bpy.app.handlers.load_pre)
    assert overlay.show(recording, spec, np.eye(4), lambda frame: frame / 24.0) is False
    assert not overlay.is_shown()
    overlay.hide()
    assert len(bpy.app.handlers.load_pre) == handlers


@pytest.fixture
def view(core, scene, monkeypatch):
    """The overlay's module as if there were a window; `handlers` are those that 3D views would draw with."""
    overlay = core("blender.overlay")
    import bpy

    view = SimpleNamespace(overlay=overlay, handlers=[], timers=[], load_pre=[])
    space = SimpleNamespace(
        draw_handler_add=lambda *handler: view.handlers.append(handler) or handler,
        draw_handler_remove=lambda handler, _region: view.handlers.remove(handler),
    )
    persistent = bpy.app.handlers.persistent
    stand_in = SimpleNamespace(
        app=SimpleNamespace(
            background=False,
            timers=SimpleNamespace(register=lambda call, **_: view.timers.append(call)),
            handlers=SimpleNamespace(load_pre=view.load_pre, persistent=persistent),
        ),
        types=SimpleNamespace(SpaceView3D=space),
        context=bpy.context,
    )
    monkeypatch.setattr(overlay, "bpy", stand_in)
    yield view
    overlay.hide()


def test_showing_twice_shows_once_and_hiding_leaves_nothing(view, recording, spec) -> None:
    for _ in range(2):
        assert view.overlay.show(recording, spec, np.eye(4), lambda frame: frame / 24.0)
    assert [handler[3] for handler in view.handlers] == ["POST_VIEW", "POST_PIXEL"]
    assert len(view.load_pre) == 1 and view.overlay.is_shown()
    view.overlay.hide()
    view.overlay.hide()
    assert not view.handlers and not view.load_pre and not view.overlay.is_shown()


def test_another_file_ends_it(view, recording, spec) -> None:
    view.overlay.show(recording, spec, np.eye(4), lambda frame: frame / 24.0)
    view.load_pre[0]("other.blend")
    assert not view.handlers and not view.overlay.is_shown()


def test_handler_that_fails_says_so_once_and_goes_away(view, recording, spec, caplog) -> None:
    def broken(frame):
        raise ZeroDivisionError("no such frame")

    view.overlay.show(recording, spec, np.eye(4), broken)
    with caplog.at_level(logging.WARNING):
        for _ in range(3):
            for draw, arguments, *_ in view.handlers:
                draw(*arguments)
    assert len(caplog.messages) == 1 and "switched off" in caplog.messages[0]
    assert len(view.timers) == 1
    view.timers[0]()
    assert not view.handlers and not view.overlay.is_shown()


def test_failure_of_an_overlay_replaced_since_ends_nothing(view, recording, spec) -> None:
    view.overlay.show(recording, spec, np.eye(4), lambda frame: 1.0 / 0.0)
    draw, arguments, *_ = view.handlers[0]
    draw(*arguments)
    view.overlay.show(recording, spec, np.eye(4), lambda frame: frame / 24.0)
    view.timers[0]()
    assert len(view.handlers) == 2


def test_run_stands_where_the_matrix_puts_it(core, data) -> None:
    turned = np.array([[0.0, -1.0, 0.0, 5.0], [1.0, 0.0, 0.0, 6.0], [0.0, 0.0, 1.0, 7.0], [0.0, 0.0, 0.0, 1.0]])
    shown = core("blender.overlay")._Overlay(data, turned, lambda frame: (frame - 1) / 24.0)
    place = data.at(0.5).segments[0, 0]
    np.testing.assert_allclose(shown.to_world(place), [5.0 - place[1], 6.0 + place[0], 7.0 + place[2]])
    moment = shown.moment(13.0)
    np.testing.assert_array_equal(moment.segments, data.at(0.5).segments)
    assert shown.moment(13.0) is moment
    assert shown.moment(13.5) is not moment
