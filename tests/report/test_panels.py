"""Every plot draws what the recording says: the drawn data is read back from its axes."""

from __future__ import annotations

import dataclasses
import warnings

import numpy as np
import pytest

from ski_addon.errors import RecordingError
from ski_addon.spec import RunSpec
from tests.synthetic_recording import HINGES, synthetic_recording

pytest.importorskip("matplotlib")
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from ski_addon.report import figure as report_figure
from ski_addon.report import panels, series, style

OVER_TIME = (
    panels.draw_lean,
    panels.draw_speed,
    panels.draw_ski_forces,
    panels.draw_force_split,
    panels.draw_torques,
    panels.draw_errors,
    panels.draw_margins,
    panels.draw_offsets,
    panels.draw_skid,
    panels.draw_legs,
)


@pytest.fixture(scope="module")
def recording():
    """12 s of turns with noise on every channel, so that no two channels are alike."""
    rng = np.random.default_rng(5)
    base = synthetic_recording(RunSpec().with_overrides({"skier.mass": 83}))
    noisy = {
        name: getattr(base, name) + scale * rng.normal(size=getattr(base, name).shape)
        for name, scale in (("speed", 0.3), ("inclination", 0.02), ("edge_angle", 0.03), ("snow_force", 20.0))
    }
    positive = {
        name: np.abs(getattr(base, name) + scale * rng.normal(size=getattr(base, name).shape))
        for name, scale in (("torque_ratio", 0.05), ("ski_error", 3e-4), ("com_error", 3e-4))
    }
    return dataclasses.replace(base, **noisy, **positive)


def drawn(draw, recording):
    """Axes into which one plot was drawn."""
    axes = Figure().add_subplot()
    draw(axes, recording)
    return axes


def curves(axes) -> dict[str, np.ndarray]:
    """Label -> values of the curves that have one value for each moment."""
    return {line.get_label(): np.asarray(line.get_ydata()) for line in axes.lines if len(line.get_ydata()) > 2}


def shaded(axes) -> list[tuple[float, float]]:
    """Start and end of each shaded stretch, in order."""
    boxes = [patch.get_extents().transformed(axes.transData.inverted()) for patch in axes.patches]
    return sorted((box.x0, box.x1) for box in boxes)


@pytest.mark.parametrize("draw", OVER_TIME)
def test_time_runs_along_every_plot(recording, draw):
    for line in drawn(draw, recording).lines:
        if len(line.get_xdata()) > 2:
            np.testing.assert_array_equal(line.get_xdata(), recording.time)


@pytest.mark.parametrize("draw", OVER_TIME)
def test_transitions_are_shaded_exactly_where_the_phase_is_zero(recording, draw):
    axes = drawn(draw, recording)
    stretches = shaded(axes)
    inside = np.zeros(len(recording.time), dtype=bool)
    for start, end in stretches:
        inside |= (recording.time >= start - 1e-9) & (recording.time < end - 1e-9)
    inside[-1] = recording.phase[-1] == 0  # the last moment has no width
    np.testing.assert_array_equal(inside, recording.phase == 0)
    assert all(patch.get_facecolor()[:3] == to_rgb(style.TRANSITION) for patch in axes.patches)


@pytest.mark.parametrize("draw", OVER_TIME)
def test_turns_are_named_by_their_side_in_their_middle(recording, draw):
    bands = [band for band in series.phase_bands(recording.time, recording.phase) if band.phase]
    named = [note for note in drawn(draw, recording).texts if note.get_text() in ("left", "right")]
    assert [note.get_text() for note in named] == ["left" if band.phase > 0 else "right" for band in bands]
    for note, band in zip(named, bands, strict=True):
        assert band.start < note.xy[0] < band.end
        middle = recording.inclination[np.searchsorted(recording.time, note.xy[0])]
        assert (middle > 0) == (note.get_text() == "left")


def test_speed_is_the_recorded_one_and_in_view(recording):
    axes = drawn(panels.draw_speed, recording)
    (values,) = curves(axes).values()
    np.testing.assert_array_equal(values, recording.speed)
    low, high = axes.get_ylim()
    assert 0.0 <= low < recording.speed.min() and high > recording.speed.max()


def test_even_speed_is_drawn_with_room_around_it(recording):
    low, high = drawn(
        panels.draw_speed, dataclasses.replace(recording, speed=np.full_like(recording.time, 7.0))
    ).get_ylim()
    assert (low, high) == (6.5, 7.5)
    crawl = dataclasses.replace(recording, speed=np.full_like(recording.time, 0.1))
    assert drawn(panels.draw_speed, crawl).get_ylim()[0] == 0.0


def test_lean_and_edging_are_the_recorded_angles_in_degrees(recording):
    found = curves(drawn(panels.draw_lean, recording))
    assert set(found) == {"inclination", "left ski's edging", "right ski's edging"}
    np.testing.assert_allclose(found["inclination"], np.degrees(recording.inclination))
    np.testing.assert_allclose(found["left ski's edging"], np.degrees(recording.edge_angle[:, 0]))
    np.testing.assert_allclose(found["right ski's edging"], np.degrees(recording.edge_angle[:, 1]))


def test_force_of_each_ski_is_in_weights_of_this_skier(recording):
    axes = drawn(panels.draw_ski_forces, recording)
    found = curves(axes)
    for ski, label in enumerate(("left ski", "right ski")):
        size = np.sqrt((recording.snow_force[:, ski] ** 2).sum(axis=1))
        np.testing.assert_allclose(found[label], size / (83 * 9.81))
    assert axes.get_ylim()[0] == 0.0 and axes.get_ylabel() == "body weights"


def test_resultant_force_is_split_along_normal_and_left_beside_the_lean_that_balances_it(recording):
    found = curves(drawn(panels.draw_force_split, recording))
    total = recording.snow_force.sum(axis=1) / (83 * 9.81)
    normal = np.einsum("ij,ij->i", total, recording.surface_normal)
    np.testing.assert_allclose(found["along the surface normal"], normal, atol=1e-12)
    left = np.cross(recording.surface_normal, recording.track_tangent)
    np.testing.assert_allclose(found["sideways, left positive"], np.einsum("ij,ij->i", total, left), atol=1e-12)
    np.testing.assert_allclose(found["tangent of the inclination"], np.tan(recording.inclination))


def test_every_joint_is_drawn_and_the_four_hardest_are_named(recording):
    axes = drawn(panels.draw_torques, recording)
    joints = series.torque_by_joint(recording)
    found = curves(axes)
    named = {label: values for label, values in found.items() if not label.startswith("_")}
    assert list(named) == [f"{joint.name} {joint.peak:.0%}" for joint in joints[: panels.LABELLED_JOINTS]]
    for joint, values in zip(joints, named.values(), strict=False):
        np.testing.assert_array_equal(values, joint.ratio)
        assert f"{values.max():.0%}" == f"{joint.peak:.0%}"
    assert len([line for line in axes.lines if len(line.get_ydata()) > 2]) == len(series.JOINT_GROUPS)
    assert axes.get_ylim()[1] >= 1.12


def test_joint_past_its_limit_stays_in_view(recording):
    ratio = recording.torque_ratio.copy()
    ratio[100, HINGES.index("shank_y.L")] = 2.4
    axes = drawn(panels.draw_torques, dataclasses.replace(recording, torque_ratio=ratio))
    assert axes.get_ylim()[1] > 2.4 and "knee 240%" in curves(axes)


def test_errors_are_the_recorded_ones_in_millimetres(recording):
    axes = drawn(panels.draw_errors, recording)
    found = {label.partition(",")[0]: values for label, values in curves(axes).items()}
    np.testing.assert_allclose(found["skis"], 1000 * recording.ski_error)
    np.testing.assert_allclose(found["centre of mass"], 1000 * recording.com_error)
    assert axes.get_ylabel() == "mm" and axes.get_ylim()[0] == 0.0


def test_margins_are_the_recorded_ones_with_their_least_in_the_legend(recording):
    low = recording.capture_margin.copy()
    low[200] = -0.0375
    axes = drawn(panels.draw_margins, dataclasses.replace(recording, capture_margin=low))
    found = curves(axes)
    np.testing.assert_allclose(found["capture margin, -37.5 mm at least"], 1000 * low)
    np.testing.assert_allclose(found["load from the edges' border, 10 mm at least"], 1000 * recording.zmp_margin)
    assert axes.get_ylim()[0] < -37.5 and axes.get_ylabel() == "mm"


def test_offsets_are_the_recorded_ones(recording):
    found = curves(drawn(panels.draw_offsets, recording))
    np.testing.assert_allclose(found["skis"], 1000 * recording.track_offset[:, 0])
    np.testing.assert_allclose(found["centre of mass"], 1000 * recording.track_offset[:, 1])
    np.testing.assert_allclose(found["steered line"], 1000 * recording.steering_offset)


def test_skid_is_the_recorded_angle_in_degrees(recording):
    found = curves(drawn(panels.draw_skid, recording))
    np.testing.assert_allclose(found["skid, 12 at most"], np.degrees(recording.steering))


@pytest.mark.parametrize(("draw", "name"), [(panels.draw_skid, "steering"), (panels.draw_offsets, "track_offset")])
def test_rounding_is_not_blown_up_to_motion(recording, draw, name):
    tiny = dataclasses.replace(
        recording, steering_offset=0 * recording.time, **{name: 1e-15 * getattr(recording, name)}
    )
    low, high = drawn(draw, tiny).get_ylim()
    assert low <= -1.0 and high >= 1.0


def test_legs_are_seen_in_the_height_over_the_snow_and_bumps_over_a_straight_slope(recording):
    """A bump of 0.3 m that the legs take up: the snow rises, the body over it comes down."""
    bump = 0.3 * np.exp(-(((recording.time - 6.0) / 0.5) ** 2))[:, None] * recording.surface_normal
    over = dataclasses.replace(recording, track_position=recording.track_position + bump)
    found = curves(drawn(panels.draw_legs, over))
    level = curves(drawn(panels.draw_legs, recording))
    np.testing.assert_allclose(level["snow over a straight slope"], 0.0, atol=1e-9)
    np.testing.assert_allclose(level["centre of mass over the snow"], 0.7 + 0.1 * np.sin(0.4 * np.pi * recording.time))
    height = found["snow over a straight slope"]
    assert height.max() == pytest.approx(0.3, abs=1e-6) and recording.time[height.argmax()] == pytest.approx(6.0)
    body = found["centre of mass over the snow"]
    np.testing.assert_allclose(body + height, level["centre of mass over the snow"], atol=1e-9)


@pytest.mark.parametrize("draw", [panels.draw_margins, panels.draw_offsets])
def test_pushes_are_shaded_while_they_last(recording, draw):
    push = np.zeros((len(recording.time), 3))
    push[300:350, 1] = 150.0
    push[700:720, 2] = -20.0
    axes = drawn(draw, dataclasses.replace(recording, push_force=push))
    red = [patch for patch in axes.patches if patch.get_facecolor()[:3] == to_rgb(style.ALARM)]
    boxes = [patch.get_extents().transformed(axes.transData.inverted()) for patch in red]
    assert sorted((round(box.x0, 3), round(box.x1, 3)) for box in boxes) == [(3.0, 3.5), (7.0, 7.2)]


def test_track_is_drawn_through_its_places_with_speed_as_colour(recording):
    axes = Figure().add_subplot()
    lines = panels.draw_track(axes, recording)
    segments = np.array(lines.get_segments())
    np.testing.assert_array_equal(segments[:, 0], recording.track_position[:-1, :2])
    np.testing.assert_array_equal(segments[:, 1], recording.track_position[1:, :2])
    np.testing.assert_array_equal(lines.get_array(), recording.speed[:-1])
    start, end = axes.lines
    np.testing.assert_array_equal(np.ravel(start.get_data()), recording.track_position[0, :2])
    np.testing.assert_array_equal(np.ravel(end.get_data()), recording.track_position[-1, :2])


def test_long_track_is_thinned_and_keeps_its_ends(recording):
    many = np.linspace(0.0, 500.0, 50_000)
    long = dataclasses.replace(
        recording, track_position=np.stack((many, 0 * many, 0 * many), axis=1), speed=5.0 + many / 500
    )
    lines = panels.draw_track(Figure().add_subplot(), long)
    segments = np.array(lines.get_segments())
    assert len(segments) < 3000
    assert (segments[0, 0, 0], segments[-1, 1, 0]) == (0.0, 500.0)
    np.testing.assert_array_equal(segments[1:, 0], segments[:-1, 1])  # no gaps


def test_long_recording_is_thinned_but_its_peaks_stay(recording):
    long = synthetic_recording(duration=400.0)
    error = np.zeros_like(long.time)
    error[31_234] = 0.07
    axes = drawn(panels.draw_errors, dataclasses.replace(long, ski_error=error))
    values = curves(axes)["skis, 70 mm at most"]
    assert len(values) <= 4000 < len(error) and values.max() == pytest.approx(70.0)


@pytest.mark.parametrize("count", [1, 2])
def test_recording_of_one_or_two_steps_is_drawn(count):
    short = synthetic_recording(duration=0.01 * count - 0.005, status="fell")
    assert len(short.time) == count
    figure = report_figure.draw_figure(short)
    figure.canvas.draw()
    assert f"fell at {short.time[-1]:.2f} s" in " ".join(text.get_text() for text in figure.texts)


@pytest.mark.parametrize("status", ["fell", "diverged", "cancelled", "finished"])
def test_end_of_a_run_is_marked_by_how_it_ended(status):
    run = synthetic_recording(duration=4.0, status=status)
    axes = Figure().add_subplot()
    panels.draw_track(axes, run)
    notes = {note.get_text() for note in axes.texts}
    assert notes == {"start", "end" if status == "finished" else status}
    assert axes.lines[-1].get_marker() == ("s" if status == "finished" else "X")


def test_numbers_that_are_none_do_not_stop_a_report():
    """A run that diverged may hold them in its last step."""
    run = synthetic_recording(duration=2.0, status="diverged")
    broken = {}
    for name in ("speed", "inclination", "ski_error", "com_error"):
        broken[name] = getattr(run, name).copy()
        broken[name][-1] = np.nan
    figure = report_figure.draw_figure(dataclasses.replace(run, **broken))
    figure.canvas.draw()
    legends = [axes.get_legend() for axes in figure.axes if axes.get_legend()]
    assert "skis, 2 mm at most" in [text.get_text() for legend in legends for text in legend.get_texts()]


def test_nothing_is_drawn_of_an_empty_recording():
    empty = dataclasses.replace(synthetic_recording(duration=0.01), time=np.zeros(0))
    with pytest.raises(RecordingError, match="it holds no steps to draw"):
        report_figure.draw_figure(empty)


def test_drawing_leaves_matplotlib_as_it_was(recording):
    import matplotlib

    before = dict(matplotlib.rcParams)
    report_figure.draw_figure(recording)
    assert dict(matplotlib.rcParams) == before


@pytest.mark.parametrize("name", ["$\\frac{$ \\alpha_b^c", "Läufe 雪\ntwo", ""])
def test_any_name_of_a_run_can_stand_in_the_title(tmp_path, name):
    figure = report_figure.draw_figure(synthetic_recording(RunSpec(name=name), duration=1.0))
    assert " ".join(name.split()) in [text.get_text() for text in figure.texts]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        report_figure.save_figure(figure, tmp_path / "a.png")
    assert (tmp_path / "a.png").stat().st_size > 10_000
