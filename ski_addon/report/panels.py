"""The single plots of a report; each draws one side of a recording into the axes it is given."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.collections import LineCollection

from . import series
from .style import ALARM, INK, LEFT, QUIET, RIGHT, SPEED_MAP, THIRD, curve, draw_bands, finish

if TYPE_CHECKING:
    from ..simulation import Recording

LABELLED_JOINTS = 4


def draw_track(axes: Any, recording: Recording) -> Any:
    """Draw the track from above (fall line to the right), coloured by speed; returns what the colour bar needs."""
    position = recording.track_position[:, :2]
    keep = np.unique(np.linspace(0, len(position) - 1, min(len(position), 3000)).astype(int))
    points = position[keep][:, None, :]
    lines = LineCollection(
        list(np.concatenate((points[:-1], points[1:]), axis=1)), cmap=SPEED_MAP, linewidth=4, capstyle="round"
    )
    lines.set_array(recording.speed[keep][:-1])
    axes.add_collection(lines)
    axes.plot(*position[0], "o", color=INK, markersize=5)
    axes.annotate("start", position[0], xytext=(0, 8), textcoords="offset points", ha="center", fontsize=8.5)
    fell = recording.header["status"] != "finished"
    axes.plot(*position[-1], "X" if fell else "s", color=ALARM if fell else INK, markersize=9 if fell else 5)
    axes.annotate(
        recording.header["status"] if fell else "end",
        position[-1],
        xytext=(0, 8),
        textcoords="offset points",
        ha="center",
        fontsize=8.5,
    )
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.04, 0.25)
    axes.set_title("Track from above, downhill to the right", pad=8)
    axes.set_xlabel("m")
    axes.set_ylabel("m")
    axes.grid(color="#EEF1F4", linewidth=0.8)
    return lines


def draw_lean(axes: Any, recording: Recording) -> None:
    """Inclination and the edge angle of each ski, left positive."""
    draw_bands(axes, series.phase_bands(recording.time, recording.phase), named=True)
    edge = np.degrees(recording.edge_angle)
    curve(axes, recording.time, edge[:, 0], LEFT, "left ski's edging")
    curve(axes, recording.time, edge[:, 1], RIGHT, "right ski's edging", linestyle=(0, (4, 2)))
    curve(axes, recording.time, np.degrees(recording.inclination), INK, "inclination", linewidth=1.6)
    finish(axes, "Lean and edging, left is positive", "degrees")


def draw_ski_forces(axes: Any, recording: Recording) -> None:
    """Snow force on each ski, in body weights."""
    draw_bands(axes, series.phase_bands(recording.time, recording.phase), named=True)
    forces = series.ski_forces(recording)
    curve(axes, recording.time, forces[:, 0], LEFT, "left ski")
    curve(axes, recording.time, forces[:, 1], RIGHT, "right ski")
    axes.set_ylim(bottom=0)
    finish(axes, "Snow force on each ski", "body weights")


def draw_force_split(axes: Any, recording: Recording) -> None:
    """Resultant snow force along the normal and to the left [SG19 Fig. 15]."""
    draw_bands(axes, series.phase_bands(recording.time, recording.phase), named=True)
    split = series.force_split(recording)
    axes.axhline(0, color=QUIET, linewidth=0.8)
    curve(axes, recording.time, split.normal, THIRD, "along the surface normal")
    curve(axes, recording.time, split.left, LEFT, "sideways, left positive")
    lean = np.tan(recording.inclination)
    curve(axes, recording.time, lean, INK, "tangent of the inclination", linewidth=0.9, linestyle=(0, (4, 2)))
    finish(axes, "Resultant snow force (2019 paper, Fig. 15)", "body weights")


def draw_torques(axes: Any, recording: Recording) -> None:
    """Torque of each joint over its human limit; the hardest ones in colour and named."""
    draw_bands(axes, series.phase_bands(recording.time, recording.phase), named=True)
    joints = series.torque_by_joint(recording)
    for joint in joints[LABELLED_JOINTS:]:
        curve(axes, recording.time, joint.ratio, QUIET, linewidth=0.8)
    colors = (RIGHT, LEFT, THIRD, "#CC79A7")
    for rank, (joint, color) in enumerate(zip(joints, colors, strict=False)):
        curve(axes, recording.time, joint.ratio, color, f"{joint.name} {joint.peak:.0%}", zorder=4 - 0.1 * rank)
    axes.axhline(1.0, color=INK, linewidth=1.0, linestyle=(0, (2, 2)))
    where = {"xycoords": ("axes fraction", "data"), "xytext": (-2, 3), "textcoords": "offset points"}
    axes.annotate("human limit", (1, 1.0), ha="right", fontsize=8, **where)
    axes.set_ylim(0, max(1.12, 1.05 * _largest(np.array([joint.peak for joint in joints]))))
    finish(axes, "Joint torques over human limits", "ratio", columns=4)


def draw_errors(axes: Any, recording: Recording) -> None:
    """How far skis and centre of mass are from their reference."""
    draw_bands(axes, series.phase_bands(recording.time, recording.phase), named=True)
    curve(axes, recording.time, 1000 * recording.ski_error, RIGHT, f"skis, {_peak_mm(recording.ski_error)} at most")
    body = f"centre of mass, {_peak_mm(recording.com_error)} at most"
    curve(axes, recording.time, 1000 * recording.com_error, INK, body)
    axes.set_ylim(bottom=0)
    finish(axes, "Distance from the plan", "mm")


def draw_margins(axes: Any, recording: Recording) -> None:
    """How far the skier is from losing balance, and the load from the border of the bearing edges; pushes in red."""
    draw_bands(axes, series.phase_bands(recording.time, recording.phase), named=True)
    _draw_pushes(axes, recording)
    axes.axhline(0, color=INK, linewidth=1.0, linestyle=(0, (2, 2)))
    capture = f"capture margin, {_least_mm(recording.capture_margin)} at least"
    curve(axes, recording.time, 1000 * recording.capture_margin, INK, capture, linewidth=1.6)
    border = f"load from the edges' border, {_least_mm(recording.zmp_margin)} at least"
    curve(axes, recording.time, 1000 * recording.zmp_margin, THIRD, border)
    finish(axes, "Balance: what is left", "mm", columns=2)


def draw_offsets(axes: Any, recording: Recording) -> None:
    """Where skis and centre of mass are across the track, and the line the skis are steered along; pushes in red."""
    draw_bands(axes, series.phase_bands(recording.time, recording.phase), named=True)
    _draw_pushes(axes, recording)
    axes.axhline(0, color=QUIET, linewidth=0.8)
    curve(axes, recording.time, 1000 * recording.track_offset[:, 0], RIGHT, "skis")
    curve(axes, recording.time, 1000 * recording.track_offset[:, 1], INK, "centre of mass")
    steered = {"linewidth": 0.9, "linestyle": (0, (4, 2))}
    curve(axes, recording.time, 1000 * recording.steering_offset, LEFT, "steered line", **steered)
    _show_at_least(axes, 1.0)
    finish(axes, "Off the plan, left is positive", "mm")


def _draw_pushes(axes: Any, recording: Recording) -> None:
    """Shade the times at which something pushes the skier."""
    pushed = np.any(recording.push_force != 0.0, axis=1).astype(int)
    for band in series.phase_bands(recording.time, pushed):
        if band.phase:
            axes.axvspan(band.start, band.end, color=ALARM, alpha=0.15, linewidth=0, zorder=0.5)


def draw_skid(axes: Any, recording: Recording) -> None:
    """Angle by which the skis are turned out of the track to brake, left positive."""
    draw_bands(axes, series.phase_bands(recording.time, recording.phase), named=True)
    axes.axhline(0, color=QUIET, linewidth=0.8)
    angle = np.degrees(recording.steering)
    curve(axes, recording.time, angle, THIRD, f"skid, {_largest(np.abs(angle)):.3g} at most", linewidth=1.6)
    _show_at_least(axes, 1.0)
    finish(axes, "Skis against the track, left is positive", "degrees")


def draw_legs(axes: Any, recording: Recording) -> None:
    """Height of the body over the snow, which the legs make, and of the snow over a straight slope."""
    draw_bands(axes, series.phase_bands(recording.time, recording.phase), named=True)
    curve(axes, recording.time, series.body_height(recording), INK, "centre of mass over the snow", linewidth=1.6)
    bumps = {"linewidth": 0.9, "linestyle": (0, (4, 2))}
    curve(axes, recording.time, series.bump_height(recording), THIRD, "snow over a straight slope", **bumps)
    finish(axes, "What the legs do", "m")


def draw_speed(axes: Any, recording: Recording) -> None:
    """Speed along the track."""
    draw_bands(axes, series.phase_bands(recording.time, recording.phase), named=True)
    curve(axes, recording.time, recording.speed, THIRD, linewidth=1.6)
    low, high = -_largest(-recording.speed), _largest(recording.speed)
    room = max(0.5, 0.15 * (high - low))
    axes.set_ylim(max(0.0, low - room), high + room)
    finish(axes, "Speed", "m/s")


def _show_at_least(axes: Any, size: float) -> None:
    """Widen a plot about zero to `size` to both sides, so that rounding does not look like motion."""
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, -size), max(high, size))


def _least_mm(values: np.ndarray) -> str:
    return f"{-1000 * _largest(-values):.3g} mm"


def _peak_mm(error: np.ndarray) -> str:
    return f"{1000 * _largest(error):.3g} mm"


def _largest(values: np.ndarray) -> float:
    """Return the largest finite value: a run that diverged may end in others."""
    finite = values[np.isfinite(values)]
    return float(finite.max()) if finite.size else 0.0
