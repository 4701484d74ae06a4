"""The report as a picture: what is on it, and that it is written whole."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ski_addon.errors import OutputError, RecordingError
from ski_addon.report import save_report
from ski_addon.spec import RunSpec
from tests.synthetic_recording import synthetic_recording

pytest.importorskip("matplotlib")
from ski_addon.report import figure as report_figure
from ski_addon.report.style import TRANSITION


@pytest.fixture(scope="module")
def figure():
    return report_figure.draw_figure(synthetic_recording(RunSpec(name="Test run")))


def panel(figure, words):
    found = [axes for axes in figure.axes if words in axes.get_title(loc="left")]
    assert len(found) == 1, words
    return found[0]


def texts(artist):
    import matplotlib.text

    return [text.get_text() for text in artist.findobj(matplotlib.text.Text)]


def test_all_plots_and_the_name_of_the_run_are_there(figure):
    for words in (
        "Track from above",
        "Lean and edging",
        "Speed",
        "Snow force on each",
        "Fig. 15",
        "torques",
        "Distance",
        "against the track",
        "legs",
        "Balance",
        "Off the plan",
    ):
        panel(figure, words)
    assert "Test run" in texts(figure)
    assert any("6 turns of 15 m" in text for text in texts(figure))


def test_inclination_is_drawn_in_degrees_and_with_its_sign(figure):
    curves = {line.get_label(): line.get_ydata() for line in panel(figure, "Lean").lines}
    assert curves["inclination"].max() == pytest.approx(30.0, abs=0.1)
    assert curves["inclination"].min() == pytest.approx(-30.0, abs=0.1)
    assert curves["left ski's edging"].max() == pytest.approx(33.0, abs=0.1)


def test_transitions_are_shaded_in_every_plot_over_time(figure):
    recording = synthetic_recording()
    expected = 1 + np.count_nonzero((recording.phase[1:] == 0) & (recording.phase[:-1] != 0))
    for words in ("Lean", "Speed", "Snow force on each", "Fig. 15", "torques", "Distance"):
        shaded = [patch for patch in panel(figure, words).patches if patch.get_facecolor()[:3] == _rgb(TRANSITION)]
        assert len(shaded) == expected, words


def _rgb(color):
    from matplotlib.colors import to_rgb

    return to_rgb(color)


def test_track_is_drawn_to_scale_and_coloured_by_speed(figure):
    axes = panel(figure, "Track")
    (lines,) = axes.collections
    assert axes.get_aspect() == 1.0
    assert (lines.get_array().min(), lines.get_array().max()) == pytest.approx((8.0, 9.0), abs=0.01)


def test_errors_are_in_millimetres_with_their_peaks_named(figure):
    axes = panel(figure, "Distance")
    assert {"skis, 2 mm at most", "centre of mass, 1 mm at most"} <= set(texts(axes))
    assert max(line.get_ydata().max() for line in axes.lines) == pytest.approx(2.0, abs=0.01)


def test_hardest_joints_are_named_with_their_peak_and_the_limit_is_in_view(figure):
    axes = panel(figure, "torques")
    assert {"ankle 80%", "knee 75%", "human limit"} <= set(texts(axes))
    assert axes.get_ylim()[1] > 1.0


def test_fall_is_said_in_the_title_and_marked_on_the_track():
    fallen = report_figure.draw_figure(synthetic_recording(status="fell"))
    assert "Untitled run (fell at 11.99 s)" in texts(fallen)
    assert "fell" in texts(panel(fallen, "Track"))


def test_picture_is_written_whole_at_the_asked_size(tmp_path):
    save_report(synthetic_recording(duration=3.0), tmp_path / "report.png")
    raw = (tmp_path / "report.png").read_bytes()
    width, height = (int.from_bytes(raw[at : at + 4], "big") for at in (16, 20))
    assert (width, height) == tuple(int(inches * report_figure.DPI) for inches in report_figure.SIZE_INCHES)
    assert [path.name for path in tmp_path.iterdir()] == ["report.png"]


def test_run_that_fell_at_once_can_be_drawn(tmp_path):
    save_report(synthetic_recording(duration=0.01, status="fell"), tmp_path / "a.png")
    assert (tmp_path / "a.png").stat().st_size > 10000


def test_empty_recording_is_refused(tmp_path):
    empty = dataclasses.replace(synthetic_recording(), time=np.zeros(0))
    with pytest.raises(RecordingError, match="no steps"):
        save_report(empty, tmp_path / "a.png")


def test_picture_in_a_missing_folder_is_an_output_error(tmp_path):
    with pytest.raises(OutputError, match="No such file"):
        save_report(synthetic_recording(duration=1.0), tmp_path / "none" / "a.png")


def test_title_says_what_is_compared():
    compared = {"technique.controller": "open_loop", "technique.equations": "rigid_lean"}
    figure = report_figure.draw_figure(synthetic_recording(RunSpec().with_overrides(compared)))
    assert any(text.get_text().endswith("s between them, open loop, rigid lean") for text in figure.texts)


def test_report_without_gates_has_no_panel_for_them(figure):
    assert not any("Gates" in axes.get_title(loc="left") for axes in figure.axes)
    assert figure.get_size_inches().tolist() == list(report_figure.SIZE_INCHES)


def test_report_with_gates_is_taller_and_shows_them_twice():
    drawn = report_figure.draw_figure(synthetic_recording(gates=4))
    assert drawn.get_size_inches()[1] == report_figure.SIZE_INCHES[1] + report_figure.GATE_INCHES
    assert {"1", "2", "3", "4"} <= set(texts(panel(drawn, "Track")))
    assert "Gates: 4 of 4 passed, distance of the pole" in texts(panel(drawn, "Gates"))
    assert len(drawn.axes) == 13  # track, colour bar, gates, ten over time
    last = max(axes.get_position().y1 for axes in drawn.axes if axes.get_xlabel() == "s")
    assert last < panel(drawn, "Gates").get_position().y0, "time runs along the lowest plots only"


def test_plan_view_of_gates_says_how_much_wider_it_is_drawn():
    drawn = report_figure.draw_figure(synthetic_recording(gates=4))
    axes = panel(drawn, "Track")
    assert axes.get_aspect() == 2.0 and "drawn 2 times wider than it is" in axes.get_title(loc="left")


@pytest.mark.parametrize(
    ("course", "rows", "words"),
    [
        ({"kind": "gates", "gate_count": 12}, {}, "12 slalom gates"),
        ({"kind": "gates", "gate_setting": "list"}, {"gate": [{"x": 10, "y": 1}, {"x": 20, "y": -1}]}, "2 gates"),
        ({"kind": "path"}, {"point": [{"x": 10 * k, "y": k} for k in range(3)]}, "a drawn path of 3 points"),
        ({"kind": "bumps"}, {}, "over plane, straight"),
        ({"kind": "bumps", "turn_amplitude": 0.5}, {}, "over plane, turning 0.5 m beside the crests"),
    ],
)
def test_title_says_what_the_course_is(course, rows, words):
    figure = report_figure.draw_figure(synthetic_recording(RunSpec.from_dict({"course": course, **rows})))
    assert any(text.get_text().endswith(f"degrees: {words}") for text in figure.texts)
