"""The report for Blender: drawn for any recording, at any size, without matplotlib, and fast."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
import time

import numpy as np
import pytest

from ski_addon.errors import OutputError, RecordingError
from ski_addon.report.plots import draw_report, planned_speed, sampled_gates
from ski_addon.report.png import save_png
from ski_addon.simulation import recorded_gates
from ski_addon.spec import RunSpec
from tests.synthetic_recording import synthetic_recording

SMALL = (800, 600)


def colours(pixels):
    """The colours of a picture as numbers 0xRRGGBB, rounded to 8 bits."""
    return np.round(255 * pixels[..., :3]).astype(int) @ [1 << 16, 1 << 8, 1]


def part(pixels, row, column):
    """One of the six plots, with what stands around it."""
    height, width = pixels.shape[:2]
    top = int(height * (0.12 + 0.293 * row))
    return pixels[top : top + int(0.293 * height), column * width // 2 : (column + 1) * width // 2]


def test_size_is_the_one_asked_for_and_colours_are_numbers():
    for size in ((1600, 1200), SMALL, (400, 900)):
        pixels = draw_report(synthetic_recording(duration=3.0), size)
        assert pixels.shape == (size[1], size[0], 4) and pixels.dtype == np.float32
        assert np.isfinite(pixels).all() and pixels.min() >= 0.0 and pixels.max() <= 1.0
        assert (pixels[..., 3] == 1.0).all()
    assert draw_report(synthetic_recording(duration=1.0), (1, 100000)).shape == (8192, 200, 4)


def test_every_plot_has_curves_in_the_colours_of_the_house():
    pixels = draw_report(synthetic_recording(gates=4), SMALL)
    left, right, third, ink = (int(color, 16) for color in ("0072B2", "D55E00", "009E73", "22303C"))
    shown = (((0, 0), {third}), ((0, 1), {ink}), ((1, 0), {left}), ((1, 1), {left, right}), ((2, 0), {ink, right}))
    for place, expected in (*shown, ((2, 1), {left, right})):
        found = colours(part(pixels, *place))
        for color in expected:
            parts = np.array([color >> 16, (color >> 8) & 255, color & 255])
            near = np.abs(np.stack((found >> 16, (found >> 8) & 255, found & 255), axis=-1) - parts).max(axis=-1) < 40
            assert near.sum() > 20, (place, hex(color))


def test_the_same_recording_gives_the_same_picture():
    one, other = (draw_report(synthetic_recording(gates=2), SMALL) for _ in range(2))
    np.testing.assert_array_equal(one, other)


def test_other_values_change_only_their_plot():
    recording = synthetic_recording()
    pushed = dataclasses.replace(recording, track_offset=0.5 * recording.track_offset**2)
    changed = (draw_report(recording, SMALL) != draw_report(pushed, SMALL)).any(axis=2)
    assert part(changed, 2, 0).any()
    assert not any(part(changed, row, column).any() for row, column in ((0, 0), (0, 1), (1, 0), (1, 1), (2, 1)))


def test_values_that_are_no_numbers_and_short_runs_are_drawn():
    draw_report(synthetic_recording(duration=0.01, status="fell"), SMALL)
    recording = synthetic_recording(status="diverged", gates=3)
    speed, force = recording.speed.copy(), recording.snow_force.copy()
    speed[-3:], force[-2:] = np.nan, np.inf
    assert np.isfinite(draw_report(dataclasses.replace(recording, speed=speed, snow_force=force), SMALL)).all()


def test_gates_not_reached_or_missed_are_drawn():
    assert np.isfinite(draw_report(synthetic_recording(duration=3.0, gates=5), SMALL)).all()


def test_long_names_and_strange_letters_are_drawn():
    name = "A very long name of a run that does not fit beside the numbers 世界 é, nor would it if it were shorter"
    assert np.isfinite(draw_report(synthetic_recording(RunSpec(name=name)), SMALL)).all()


def test_empty_recording_is_refused():
    with pytest.raises(RecordingError, match="no steps"):
        draw_report(dataclasses.replace(synthetic_recording(), time=np.zeros(0)))


def test_planned_speed_is_that_of_the_reference_by_planned_time():
    recording = synthetic_recording()
    expected = np.linalg.norm(np.gradient(recording.com_reference, recording.time, axis=0), axis=1)
    np.testing.assert_allclose(planned_speed(recording), expected, rtol=1e-9)
    slower = dataclasses.replace(recording, progress=0.5 * recording.time)  # half the plan in the same time
    np.testing.assert_allclose(planned_speed(slower), 2.0 * expected, rtol=1e-9)


def test_planned_speed_where_the_skier_stands_is_kept():
    recording = synthetic_recording()
    progress = np.minimum(recording.time, 6.0)
    assert np.isfinite(planned_speed(dataclasses.replace(recording, progress=progress))).all()
    assert np.isnan(planned_speed(dataclasses.replace(recording, progress=0.0 * progress))).all()


def test_gates_are_measured_as_in_the_summary():
    recording = synthetic_recording(gates=4)
    sampled, whole = sampled_gates(recording), recorded_gates(recording)
    np.testing.assert_array_equal(sampled.passed, whole.passed)
    np.testing.assert_allclose(sampled.clearance, whole.clearance, atol=0.002)
    assert sampled_gates(synthetic_recording()) is None


def test_a_minute_of_skiing_is_drawn_within_seconds():
    recording = synthetic_recording(duration=60.0, gates=20)
    dense = np.linspace(0.0, len(recording.time) - 1.0, 60000).astype(int)
    names = [field.name for field in dataclasses.fields(recording) if field.name != "header"]
    many = dataclasses.replace(recording, **{name: getattr(recording, name)[dense] for name in names})
    many = dataclasses.replace(many, time=np.linspace(0.0, 59.99, 60000))
    draw_report(many, SMALL)
    start = time.process_time()
    draw_report(many)
    assert time.process_time() - start < 3.0  # 0.8 s on an idle computer


def test_no_matplotlib_and_no_pillow_are_asked_for():
    code = "import sys; sys.modules['matplotlib'] = sys.modules['PIL'] = None\n"
    code += (
        "from ski_addon.report.plots import draw_report\nfrom tests.synthetic_recording import synthetic_recording\n"
    )
    code += "print(draw_report(synthetic_recording(duration=1.0), (400, 300)).shape)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert done.stdout.strip() == "(300, 400, 4)", done.stderr[-2000:]


def test_png_holds_the_picture(tmp_path):
    image = pytest.importorskip("matplotlib.image")
    pixels = draw_report(synthetic_recording(duration=4.0, gates=2), SMALL)
    save_png(pixels, tmp_path / "a.png")
    read = image.imread(tmp_path / "a.png")
    assert read.shape[:2] == (600, 800)
    assert np.abs(read[..., :3] - pixels[..., :3]).max() < 0.1
    np.testing.assert_array_equal(read[0, 0, :3], 1.0)


def test_png_of_few_colours_is_exact(tmp_path):
    image = pytest.importorskip("matplotlib.image")
    pixels = np.zeros((5, 7, 3))
    pixels[2, 3], pixels[4, 6] = (1.0, 0.4, 0.2), (0.2, 0.6, 1.0)
    save_png(pixels, tmp_path / "a.png")
    np.testing.assert_allclose(image.imread(tmp_path / "a.png")[..., :3], pixels, atol=1e-6)


def test_png_in_a_missing_folder_is_an_output_error(tmp_path):
    with pytest.raises(OutputError, match="No such file"):
        save_png(np.zeros((2, 2, 4)), tmp_path / "none" / "a.png")


def test_command_says_in_one_line_what_is_missing(tmp_path, capsys):
    from ski_addon.report.__main__ import main

    assert main([str(tmp_path / "none.npz"), str(tmp_path / "a.png")]) != 0
    assert len(capsys.readouterr().err.splitlines()) == 1
