"""Stick drawings of turning figures: every body as a few lines (left limbs blue, right ones orange)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..frames import matrix_from_quaternion
from ..report.style import INK, LEFT, QUIET, RIGHT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..animation.poses import BodyPoses
    from ..turning.figures import FigureModel

Line = tuple[np.ndarray, str]
MIDDLE, GEAR = INK, "#6f767f"


def figure_lines(figure: FigureModel, poses: BodyPoses, key: int) -> list[Line]:
    """Return the lines (k, 3) [m, world] of `figure` at key number `key`, each with its colour."""
    place = dict(zip(poses.body_names, poses.position[key], strict=True))
    turn = dict(zip(poses.body_names, matrix_from_quaternion(poses.quaternion[key]), strict=True))

    def at(body: str, *local: float) -> np.ndarray:
        return place[body] + turn[body] @ np.array(local)

    lines = _person(figure, place, at)
    return lines + _gear(figure, place, at)


def _person(figure: FigureModel, place: dict[str, np.ndarray], at: Any) -> list[Line]:
    h, lengths = figure.skeleton.height, figure.skeleton.lengths
    spine = [place["pelvis"], place["abdomen"], place["chest"], place["head"], at("head", 0.0, 0.0, 0.12 * h)]
    nose = [at("head", 0.0, 0.0, 0.07 * h), at("head", 0.07 * h, 0.0, 0.07 * h)]
    lines: list[Line] = [(np.array(spine), MIDDLE), (np.array(nose), MIDDLE)]
    for side, colour in (("L", LEFT), ("R", RIGHT)):
        arm = [place["chest"], *(place[f"{part}.{side}"] for part in ("upper_arm", "forearm", "hand"))]
        arm.append(at(f"hand.{side}", 0.0, 0.0, -0.8 * lengths["hand"]))
        leg = [place["pelvis"], *(place[f"{part}.{side}"] for part in ("thigh", "shank", "foot"))]
        low = 0.039 * h - figure.sizes["ankle_height"]
        sole = min(-0.02, low) if low < 0 else -0.039 * h
        foot = [place[f"foot.{side}"], at(f"foot.{side}", -0.04 * h, 0, sole), at(f"foot.{side}", 0.11 * h, 0, sole)]
        foot.append(place[f"foot.{side}"])
        lines += [(np.array(points), colour) for points in (arm, leg, foot)]
    return lines


def _gear(figure: FigureModel, place: dict[str, np.ndarray], at: Any) -> list[Line]:
    sizes, lines = figure.sizes, []
    for side, colour in (("L", LEFT), ("R", RIGHT)):
        if f"ski.{side}" in place:
            half = 0.5 * sizes["ski_length"]
            lines.append((np.array([at(f"ski.{side}", -half, 0, 0), at(f"ski.{side}", half, 0, 0)]), colour))
            lines.append((np.array([at(f"ski.{side}", 0, -0.1, 0), at(f"ski.{side}", 0, 0.1, 0)]), colour))
            tip = at(f"pole.{side}", 0.0, 0.0, -sizes["tip_distance"])
            lines.append((np.array([place[f"pole.{side}"], tip]), colour))
    if "board" in place:
        x, y = 0.5 * sizes["length"], 0.5 * sizes["width"]
        corners = [(-x, -y), (x, -y), (x, y), (-x, y), (-x, -y)]
        lines.append((np.array([at("board", *corner, 0.0) for corner in corners]), GEAR))
        lines.append((np.array([at("board", x, 0, 0), at("board", 1.08 * x, 0, 0.05)]), GEAR))
    return lines + (_bicycle(sizes, place, at) if "fork" in place else [])


def _bicycle(sizes: dict[str, float], place: dict[str, np.ndarray], at: Any) -> list[Line]:
    from ..turning.figures.bicycle_sizes import grip_places, saddle_place

    round_ = np.linspace(0.0, 2.0 * np.pi, 37)
    lines = []
    for wheel in ("wheel_rear", "wheel_front"):
        rim = sizes["wheel_radius"] * np.stack((np.cos(round_), 0 * round_, np.sin(round_)), axis=1)
        lines += [
            (np.array([at(wheel, *point) for point in rim]), GEAR),
            (np.array([place[wheel], at(wheel, *rim[0])]), GEAR),
        ]
    grips = [at("fork", *grip) for grip in grip_places(sizes)]
    bar = [grips[0], 0.5 * (grips[0] + grips[1]), grips[1]]
    stem = [place["wheel_front"], place["fork"], at("fork", 0, 0, 0.45), bar[1]]
    frame = [place["wheel_rear"], place["crank"], at("frame", *saddle_place(sizes)), place["wheel_rear"]]
    lines += [(np.array(points), GEAR) for points in (bar, stem, frame, [place["crank"], at("fork", 0, 0, 0.4)])]
    for side, colour in (("L", LEFT), ("R", RIGHT)):
        pedal = [at(f"pedal.{side}", -0.05, 0, 0), at(f"pedal.{side}", 0.05, 0, 0)]
        lines += [(np.array([place["crank"], place[f"pedal.{side}"]]), colour), (np.array(pedal), colour)]
    return lines


def draw_sheet(figure: Figure, model: FigureModel, poses: BodyPoses, titles: list[str], frames: np.ndarray) -> None:
    """Draw all keys of `poses` into a matplotlib figure: a column each, seen from the right and from behind in the
    key's frame (k, 3, 3).
    """
    axes = figure.subplots(2, len(titles), sharex=True, sharey=True, squeeze=False)
    for column, (title, frame) in enumerate(zip(titles, frames, strict=True)):
        origin = _stand(model, poses, column, frame[:, 2])
        for points, colour in figure_lines(model, poses, column):
            local = (points - origin) @ frame
            axes[0, column].plot(local[:, 0], local[:, 2], color=colour, lw=1.6, solid_capstyle="round")
            axes[1, column].plot(-local[:, 1], local[:, 2], color=colour, lw=1.6, solid_capstyle="round")
        axes[0, column].set_title(title)
    for axis in axes.flat:
        axis.axhline(0.0, color=QUIET, lw=0.8, zorder=0)
        axis.set_aspect("equal")
    axes[0, 0].set_ylabel("from the right, m")
    axes[1, 0].set_ylabel("from behind, m")


def _stand(figure: FigureModel, poses: BodyPoses, key: int, up: np.ndarray) -> np.ndarray:
    """Return the middle (3,) [m, world] of the skis, the board or the bicycle's wheels, on the ground."""
    names = [name for name in figure.gear if name.startswith(("ski", "board", "wheel"))]
    middle = poses.position[key, [poses.body_names.index(name) for name in names]].mean(axis=0)
    return middle - figure.sizes.get("wheel_radius", 0.0) * up
