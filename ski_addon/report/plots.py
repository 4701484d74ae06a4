"""The report of a run for Blender's Image Editor: what matters to an animator, drawn with numpy alone.

`report/figure.py` draws more plots, with matplotlib; the numbers behind both come from `report/series.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..body.skeleton import build_skeleton
from ..course.gates import Gates
from ..errors import RecordingError
from ..frames import Array
from ..simulation.clearance import GatePassing, measure_gates
from ..spec import RunSpec
from . import series
from .canvas import Box, Canvas, width_of
from .chart import SOFT, Chart, Entry, value_range
from .gate_panels import MISSED
from .headline import headline
from .style import ALARM, INK, LEFT, QUIET, RIGHT, THIRD

if TYPE_CHECKING:
    from ..simulation import Recording

SIZE = (1600, 1200)
"""Width and height of the picture [pixels]."""
SMALLEST, LARGEST = 200, 8192
_GATE_RATE = 200.0
"""States in a second that gates are measured at: 10 cm of way apart at 20 m/s, on skis far longer than that."""
_LEFT, _RIGHT, _TOP, _BOTTOM, _COLUMN_GAP, _ROW_GAP = 74.0, 36.0, 186.0, 52.0, 122.0, 106.0
"""Room around and between the plots [pixels of a picture 1600 by 1200]."""


def draw_report(recording: Recording, size: tuple[int, int] = SIZE) -> Array:
    """Return the report as pixels (height, width, 4) float32, sRGB and opacity from 0 to 1, top row first.

    `size` is width and height [pixels], 200 to 8192 each (others are brought there); letters and lines grow with it.
    Raises `RecordingError` if the recording holds no steps.
    """
    if not len(recording.time):
        raise RecordingError("given", "it holds no steps to draw")
    width, height = (int(np.clip(pixels, SMALLEST, LARGEST)) for pixels in size)
    canvas = Canvas(width, height)
    scale = min(width / SIZE[0], height / SIZE[1])
    passing = sampled_gates(recording)
    _write_head(canvas, recording, passing, scale)
    boxes = _boxes(width, height, scale)
    for draw, box in zip((_speed, _lean, _edges, _forces, _offsets), boxes, strict=False):
        draw(canvas, box, recording, scale)
    if passing is None:
        _legs(canvas, boxes[-1], recording, scale)
    else:
        _gates(canvas, boxes[-1], passing, scale)
    return canvas.pixels()


def sampled_gates(recording: Recording) -> GatePassing | None:
    """Return how the gates were passed, measured at 200 states a second, or None for a course without gates."""
    gates = Gates.from_lists(recording.header.get("gates", {}))
    if not len(gates):
        return None
    skier = RunSpec.from_text(recording.header["spec"], "the run document in the recording").skier
    count = len(recording.time)
    rate = (count - 1) / max(float(recording.time[-1] - recording.time[0]), 1e-9)
    chosen = np.unique(np.append(np.arange(0, count, max(1, int(rate / _GATE_RATE))), count - 1))
    return measure_gates(build_skeleton(skier), recording.qpos[chosen], gates)


def planned_speed(recording: Recording) -> Array:
    """Return the speed of the planned centre of mass (n,) [m/s], where the skier was in the plan at each step."""
    progress = recording.progress
    moved = np.concatenate(([True], np.diff(progress) > 1e-9))
    if np.count_nonzero(moved) < 3:
        return np.full(len(progress), np.nan)
    at = progress[moved]
    speed = np.linalg.norm(np.gradient(recording.com_reference[moved], at, axis=0), axis=1)
    return np.interp(progress, at, speed)


def _boxes(width: int, height: int, scale: float) -> list[Box]:
    """Return where the six plots are, row by row."""
    column = 0.5 * (width - scale * (_LEFT + _RIGHT + _COLUMN_GAP))
    row = (height - scale * (_TOP + _BOTTOM + 2.0 * _ROW_GAP)) / 3.0
    out = []
    for i in range(6):
        left = scale * _LEFT + (i % 2) * (column + scale * _COLUMN_GAP)
        top = scale * _TOP + (i // 2) * (row + scale * _ROW_GAP)
        out.append((np.round(left), np.round(top), np.round(left + column), np.round(top + row)))
    return out


def _write_head(canvas: Canvas, recording: Recording, passing: GatePassing | None, scale: float) -> None:
    """Write name and facts, and to the right the numbers that say how the run went."""
    name, facts = headline(recording)
    left, right = _LEFT * scale, canvas.width - _RIGHT * scale
    numbers = _numbers(recording, passing)
    place = right
    for value, meaning in reversed(numbers):
        wide = max(width_of(value, 17.0 * scale), width_of(meaning, 8.5 * scale))
        canvas.text((place - wide, 62.0 * scale), value, 17.0 * scale, INK, bold=True)
        canvas.text((place - wide, 84.0 * scale), meaning, 8.5 * scale, SOFT)
        place -= wide + 30.0 * scale
    fitting = min(24.0, 24.0 * (place - left) / max(width_of(name, 24.0 * scale), 1.0))
    ended = recording.header["status"] == "finished"
    canvas.text((left, 62.0 * scale), name, fitting * scale, INK if ended else ALARM, bold=True)
    canvas.text((left, 110.0 * scale), f"{facts}.  Grey: transition between turns", 9.5 * scale, SOFT)


def _numbers(recording: Recording, passing: GatePassing | None) -> list[tuple[str, str]]:
    """Return the values of the head with what they mean."""
    lean, edge = (_largest(np.degrees(np.abs(angle))) for angle in (recording.inclination, recording.edge_angle))
    force = _largest(series.ski_forces(recording).sum(axis=1))
    out = [
        (f"{float(recording.time[-1] - recording.time[0]):.1f} s", "time"),
        (f"{float(recording.arc_length[-1]):.0f} m", "way"),
        (f"{_largest(recording.speed):.1f} m/s", "fastest"),
        (f"{lean:.0f}°", "most lean"),
        (f"{edge:.0f}°", "most edging"),
        (f"{force:.2f}", "most body weights"),
    ]
    if passing is not None:
        out.append((f"{int(passing.passed.sum())}/{len(passing.gates)}", "gates passed"))
    return out


def _over_time(canvas: Canvas, box: Box, recording: Recording, y: tuple[float, float], scale: float) -> Chart:
    """Return a plot over time with its turns marked."""
    chart = Chart(canvas, box, (float(recording.time[0]), float(recording.time[-1])), y, scale)
    chart.bands(series.phase_bands(recording.time, recording.phase))
    return chart


def _speed(canvas: Canvas, box: Box, recording: Recording, scale: float) -> None:
    planned = planned_speed(recording)
    low, high = value_range(recording.speed, planned, margin=0.12, least=1.0)
    chart = _over_time(canvas, box, recording, (max(0.0, low), high), scale)
    chart.axes("Speed", "m/s", x_unit="s")
    chart.band(recording.time, recording.speed, planned, THIRD)
    chart.curve(recording.time, planned, INK, width=1.4, dashed=True)
    chart.curve(recording.time, recording.speed, THIRD, width=2.2)
    chart.legend([Entry("skied", THIRD), Entry("planned", INK, dashed=True)])


def _lean(canvas: Canvas, box: Box, recording: Recording, scale: float) -> None:
    lean = np.degrees(recording.inclination)
    chart = _over_time(canvas, box, recording, value_range(lean, least=10.0), scale)
    chart.axes("Inclination, left is positive", "degrees", x_unit="s")
    chart.band(recording.time, np.zeros_like(lean), lean, INK, opacity=0.08)
    chart.curve(recording.time, lean, INK, width=2.2)


def _edges(canvas: Canvas, box: Box, recording: Recording, scale: float) -> None:
    edge, planned = np.degrees(recording.edge_angle), np.degrees(recording.edge_angle_reference)
    chart = _over_time(canvas, box, recording, value_range(edge, planned, least=10.0), scale)
    chart.axes("Edge angles, left is positive", "degrees", x_unit="s")
    chart.curve(recording.time, planned.mean(axis=1), QUIET, width=1.6)
    chart.curve(recording.time, edge[:, 0], LEFT, width=2.2)
    chart.curve(recording.time, edge[:, 1], RIGHT, width=2.2, dashed=True)
    chart.legend([Entry("left ski", LEFT), Entry("right ski", RIGHT, dashed=True), Entry("planned", QUIET)])


def _forces(canvas: Canvas, box: Box, recording: Recording, scale: float) -> None:
    force = series.ski_forces(recording)
    both = force.sum(axis=1)
    chart = _over_time(canvas, box, recording, value_range(both, floor=0.0, least=0.5), scale)
    chart.axes("Snow force", "body weights", x_unit="s")
    chart.band(recording.time, np.zeros_like(both), both, INK, opacity=0.07)
    chart.curve(recording.time, both, QUIET, width=1.2)
    chart.curve(recording.time, force[:, 0], LEFT)
    chart.curve(recording.time, force[:, 1], RIGHT)
    chart.legend([Entry("left ski", LEFT), Entry("right ski", RIGHT), Entry("both", QUIET)])


def _offsets(canvas: Canvas, box: Box, recording: Recording, scale: float) -> None:
    offset = 1000.0 * recording.track_offset
    steered = 1000.0 * recording.steering_offset
    chart = _over_time(canvas, box, recording, value_range(offset, steered, least=2.0), scale)
    chart.axes("Distance from the track, left is positive", "mm", x_unit="s")
    chart.curve(recording.time, steered, LEFT, width=1.4, dashed=True)
    chart.curve(recording.time, offset[:, 0], RIGHT)
    chart.curve(recording.time, offset[:, 1], INK)
    chart.legend([Entry("skis", RIGHT), Entry("body", INK), Entry("steered", LEFT, dashed=True)])


def _legs(canvas: Canvas, box: Box, recording: Recording, scale: float) -> None:
    height = series.body_height(recording)
    chart = _over_time(canvas, box, recording, value_range(height, least=0.1), scale)
    chart.axes("Centre of mass over the snow", "m", x_unit="s")
    chart.curve(recording.time, height, INK, width=2.2)


def _gates(canvas: Canvas, box: Box, passing: GatePassing, scale: float) -> None:
    """Draw how much was free beside each pole, how far it was from the middle of the skis and what was asked."""
    count = len(passing.gates)
    free = np.where(passing.passed, passing.clearance, np.nan)
    top = value_range(free, passing.distance, passing.gates.distance, np.zeros(1), margin=0.15)[1]
    chart = Chart(canvas, box, (0.4, count + 0.6), (0.0, top), scale)
    numbers = np.arange(1, count + 1)
    chart.axes("Gates: distance of the pole", "m (bars: free space)", x_ticks=numbers[:: -(-count // 26)])
    for gate, passed in enumerate(passing.passed.tolist()):
        color = LEFT if passing.gates.side[gate] > 0 else RIGHT
        asked = float(passing.gates.distance[gate])
        line = chart.place(np.array([gate + 0.62, gate + 1.38]), asked)
        canvas.lines([line], 1.6 * scale, INK)
        if passed:
            chart.bar(gate + 1.0, 0.3, 0.0, float(free[gate]), color, 0.3)
            chart.dot(gate + 1.0, float(passing.distance[gate]), color)
        else:
            chart.dot(gate + 1.0, 0.0, MISSED, crossed=True)
    chart.legend([Entry("left turn", LEFT), Entry("right turn", RIGHT), Entry("asked", INK)])


def _largest(values: Array) -> float:
    """Return the largest finite value: a run that diverged may end in others."""
    finite = values[np.isfinite(values)]
    return float(finite.max()) if finite.size else 0.0
