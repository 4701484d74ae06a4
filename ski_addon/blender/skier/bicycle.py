"""The bicycle: frame with saddle, fork with stem and bar, drive and pedals; drawn where its parts stand at rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...frames import Array, normalized
from .figure import Figure
from .saddle import saddle
from .shapes import Part, box, join
from .tubes import arc, spindle, tube
from .wheels import sprocket, wheel

CHAINRING_RADIUS, SPROCKET_RADIUS, CHAIN_LINE = 0.066, 0.036, -0.044
"""Pitch radii [m] of the two toothed wheels, and where the chain runs, to the left of the middle [m]."""
GRIP_RADIUS, GRIP_LENGTH = 0.0165, 0.125
PEDAL_WIDTH = 0.088
"""Width of a pedal across the bicycle [m]."""
_DROPOUT_HALF = 0.062


@dataclass(frozen=True)
class Points:
    """Where the bicycle of a figure has its joints at rest [m], each (3,): what its tubes run between.

    `rear` and `front` hubs, `bottom` bracket, `seat` (top of the saddle over the seat post), `bar` (its middle), `foot`
    and `axis`: a point on the steering axis at the height of the front hub, and the axis' direction upwards.
    """

    rear: Array
    front: Array
    bottom: Array
    seat: Array
    bar: Array
    foot: Array
    axis: Array
    wheel_radius: float
    bar_width: float

    @property
    def crown(self) -> Array:
        """Top of the fork's legs: just clear of the tyre."""
        return self.on_axis(self.wheel_radius + 0.045)

    @property
    def head(self) -> Array:
        """Top of the head tube."""
        top = (self.bar - self.foot) @ self.axis - 0.045
        return self.on_axis(max(top, self.wheel_radius + 0.14))

    def on_axis(self, length: float) -> Array:
        """Return the point of the steering axis `length` [m] above the height of the front hub."""
        return self.foot + length * self.axis


def bicycle_part(figure: Figure, body: str) -> Part:
    """Return the piece of the bicycle that is `body`, at rest and bound to it."""
    points = bicycle_points(figure)
    name = body.partition(".")[0]
    if name in ("wheel_rear", "wheel_front"):
        return wheel(points.wheel_radius, body, rear=name == "wheel_rear").moved(figure.place[body])
    if name == "pedal":
        return _pedal().moved(figure.place[body]).bound(body)
    draw = {"frame": _frame, "fork": _fork}
    part = draw[name](points) if name in draw else _crank(points, figure)
    return part.bound(body)


def _frame(points: Points) -> Part:
    """Return the two triangles of tubes, the saddle on its post and the chain."""
    p = points
    seat_top = p.seat - np.array([0.0, 0.0, 0.055])
    seat_axis = normalized(seat_top - p.bottom)
    seat_cluster = p.bottom + 0.72 * np.linalg.norm(seat_top - p.bottom) * seat_axis
    low = p.on_axis(p.wheel_radius + 0.062)
    tubes = [
        tube([low - 0.012 * p.axis, p.head + 0.004 * p.axis], 0.0235, "bicycle_frame_accent", 14),
        tube([seat_cluster - 0.03 * seat_axis, p.head - 0.030 * p.axis], (0.0165, 0.0195), "bicycle_frame", 12),
        tube([p.bottom, low + 0.020 * p.axis], (0.0215, 0.0225), "bicycle_frame", 12),
        tube([p.bottom, seat_cluster + 0.022 * seat_axis], 0.0175, "bicycle_frame", 12),
        tube([seat_cluster + 0.016 * seat_axis, seat_cluster + 0.030 * seat_axis], 0.0205, "bicycle_parts", 12),
        tube([seat_cluster, seat_top], 0.0135, "bicycle_parts", 10),
        spindle([(0.012, -0.040), (0.024, -0.039), (0.024, 0.039), (0.012, 0.040)], "bicycle_frame").moved(p.bottom),
        *_rings(p),
        *_stays(p, seat_cluster),
    ]
    chain = tube(_chain_line(p), 0.0042, "bicycle_metal", 4, closed=True)
    return join([*tubes, saddle().moved(p.seat), chain])


def _rings(p: Points) -> list[Part]:
    """Return the two bearing cups of the head tube."""
    low = p.on_axis(p.wheel_radius + 0.050)
    return [
        tube([low - 0.004 * p.axis, low + 0.008 * p.axis], 0.0265, "bicycle_parts", 14),
        tube([p.head, p.head + 0.010 * p.axis], 0.0260, "bicycle_parts", 14),
    ]


def _stays(p: Points, seat_cluster: Array) -> list[Part]:
    """Return the tubes from the rear hub to the bottom bracket and to the seat."""
    parts = []
    for side in (1.0, -1.0):
        hub = p.rear + np.array([0.0, side * _DROPOUT_HALF, 0.0])
        bottom = p.bottom + np.array([-0.01, side * 0.030, 0.0])
        middle = 0.45 * p.rear + 0.55 * p.bottom + np.array([0.0, side * 0.044, 0.0])
        parts.append(tube([bottom, middle, hub], (0.011, 0.0105, 0.008), "bicycle_frame", 10))
        top = seat_cluster + np.array([-0.006, side * 0.020, 0.0])
        bend = 0.35 * p.rear + 0.65 * seat_cluster + np.array([0.0, side * 0.040, 0.0])
        parts.append(tube([top, bend, hub], (0.0085, 0.0085, 0.0075), "bicycle_frame", 10))
        parts.append(box((0.040, 0.008, 0.034), "bicycle_parts", 0.3).moved(hub))
    return parts


def _chain_line(p: Points) -> Array:
    """Return the closed line of the chain round chainring and sprocket, in one plane on the right."""
    offset = p.rear - p.bottom
    distance = float(np.hypot(offset[0], offset[2]))
    back = float(np.arctan2(offset[2], offset[0]))
    lean = float(np.arccos((CHAINRING_RADIUS - SPROCKET_RADIUS) / distance))
    side = np.array([0.0, CHAIN_LINE, 0.0])
    front = arc(p.bottom + side, CHAINRING_RADIUS, back + lean, back + 2.0 * np.pi - lean, 24)
    rear = arc(p.rear + side, SPROCKET_RADIUS, back - lean, back + lean, 14)
    return np.concatenate((front, rear))


def _fork(points: Points) -> Part:
    """Return legs, crown, steerer, stem and the bar with its grips and levers."""
    p = points
    parts = []
    for side in (1.0, -1.0):
        across = np.array([0.0, side * 0.058, 0.0])
        top = p.crown + 0.010 * p.axis + np.array([0.0, side * 0.040, 0.0])
        shoulder = p.crown - 0.030 * p.axis + across
        low = p.on_axis(0.16) + across
        parts.append(tube([top, shoulder, low, p.front + across], (0.017, 0.0165, 0.013, 0.0095), "bicycle_frame", 12))
        parts.append(box((0.026, 0.008, 0.030), "bicycle_parts", 0.3).moved(p.front + across))
    crown = p.crown + 0.012 * p.axis
    parts.append(tube([crown + [0.0, 0.052, 0.0], crown - [0.0, 0.052, 0.0]], 0.021, "bicycle_frame", 12))
    stem_low = p.head + 0.010 * p.axis
    stem_top = p.on_axis(max(float((p.bar - p.foot) @ p.axis) + 0.004, float((stem_low - p.foot) @ p.axis) + 0.03))
    parts.append(tube([stem_low, stem_top + 0.012 * p.axis], 0.0185, "bicycle_parts", 12))
    parts.append(tube([stem_top - 0.010 * p.axis, p.bar], (0.0175, 0.0185), "bicycle_parts", 12))
    parts.append(tube([p.bar + [0.0, 0.024, 0.0], p.bar - [0.0, 0.024, 0.0]], 0.0225, "bicycle_parts", 12))
    return join([*parts, *_bar(p)])


def _bar(p: Points) -> list[Part]:
    """Return a straight bar, and on each side grip and brake lever."""
    half = 0.5 * p.bar_width
    ends = [p.bar + np.array([0.0, y, 0.0]) for y in (-half, half)]
    parts = [tube(ends, 0.0125, "bicycle_metal", 10)]
    for side in (1.0, -1.0):
        grip = p.bar + np.array([0.0, side * (half - 0.5 * GRIP_LENGTH), 0.0])
        profile = [
            *((0.010, -0.5), (0.0185, -0.49), (0.0185, -0.44), (GRIP_RADIUS, -0.42), (GRIP_RADIUS, 0.42)),
            *((0.0185, 0.44), (0.0185, 0.49), (0.010, 0.5)),
        ]
        parts.append(spindle([(r, GRIP_LENGTH * y) for r, y in profile], "grips").moved(grip))
        clamp = p.bar + np.array([0.0, side * (half - GRIP_LENGTH - 0.022), 0.0])
        parts.append(spindle([(0.020, -0.008), (0.020, 0.008)], "bicycle_parts").moved(clamp))
        knee = clamp + np.array([0.048, side * 0.012, -0.012])
        tip = clamp + np.array([0.062, side * 0.100, -0.022])
        parts.append(tube([clamp, knee, tip], (0.009, 0.0065, 0.005), "bicycle_parts", 8))
    return parts


def _crank(points: Points, figure: Figure) -> Part:
    """Return axle, chainring with its spider, and both arms out to the pedals."""
    p = points
    parts = [
        spindle([(0.011, -0.060), (0.0115, 0.060)], "bicycle_metal").moved(p.bottom),
        sprocket(CHAINRING_RADIUS, 32, hole=0.86).moved(p.bottom + np.array([0.0, CHAIN_LINE, 0.0])),
    ]
    for index in range(4):
        angle = np.pi * (0.25 + 0.5 * index)
        reach = 0.9 * CHAINRING_RADIUS * np.array([np.cos(angle), 0.0, np.sin(angle)])
        start = p.bottom + np.array([0.0, CHAIN_LINE - 0.003, 0.0])
        parts.append(tube([start, start + reach], (0.012, 0.007), "bicycle_parts", 8, flat=0.5))
    for side, y in (("L", 0.060), ("R", -0.060)):
        pedal = figure.place[f"pedal.{side}"]
        inner = p.bottom + np.array([0.0, y, 0.0])
        outer = np.array([pedal[0], 1.2 * y, pedal[2]])
        parts.append(tube([inner, outer], (0.0155, 0.0125), "bicycle_parts", 10))
        parts.append(spindle([(0.016, -0.010), (0.016, 0.010)], "bicycle_parts").moved(inner))
        parts.append(tube([outer, pedal], (0.0125, 0.0065), "bicycle_metal", 8))
    return join(parts)


def _pedal() -> Part:
    """Return a flat pedal that hangs on its axle: the sole stands at the axle's own height."""
    width, low = PEDAL_WIDTH, -0.0115
    parts = [spindle([(0.007, -0.5 * width - 0.004), (0.009, 0.5 * width)], "bicycle_metal", 10)]
    for y in (-0.46, 0.46):
        parts.append(box((0.094, 0.010, 0.020), "bicycle_parts", 0.3).moved((0.0, y * width, 0.0)))
    for x in (-0.042, 0.042):
        parts.append(box((0.012, width, 0.022), "bicycle_parts", 0.3).moved((x, 0.0, 0.0)))
    return join(parts).moved((0.0, 0.0, low))


def bicycle_points(figure: Figure) -> Points:
    """Return where the bicycle of `figure` has its joints at rest."""
    sizes, place = figure.sizes, figure.place
    rear, bottom = place["wheel_rear"], place["crank"]
    up = float(np.sin(sizes["seat_angle"]) * sizes["saddle_height"])
    return Points(
        rear=rear,
        front=place["wheel_front"],
        bottom=bottom,
        seat=bottom + np.array([-sizes["saddle_setback"], 0.0, up]),
        bar=rear + np.array([sizes["bar_forward"], 0.0, sizes["bar_height"] - sizes["wheel_radius"]]),
        foot=place["fork"],
        axis=figure.turn["fork"][:, 2],
        wheel_radius=sizes["wheel_radius"],
        bar_width=sizes["bar_width"] + GRIP_LENGTH,
    )
