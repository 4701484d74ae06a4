"""Measures of a bicycle that fits its rider, and where its parts are at rest.

Frames at rest, x forward, y left, z up unless told otherwise:
`frame` in the rear axle; `fork` (with stem and bar) z up along the steering axis, x ahead at right angles to it, in the
point of the axis that is nearest to the front axle, which lies `fork_offset` ahead along x; `wheel_rear`, `wheel_front`
in their axles, y along them; `crank` in the bottom bracket, y along its axle, the left arm along +x and the right one
along -x; `pedal.L`, `pedal.R` in the middle of the pedal's axle; they stay level.
"""

from __future__ import annotations

import numpy as np

from ...body import Skeleton
from ...frames import rotation_about
from .vectors import distance_at

BODIES: dict[str, str | None] = {
    "frame": None,
    "fork": "frame",
    "wheel_rear": "frame",
    "wheel_front": "fork",
    "crank": "frame",
    "pedal.L": "crank",
    "pedal.R": "crank",
}
"""Bodies that are ridden, and the body each hangs on."""
HEAD_ANGLE, SEAT_ANGLE = np.deg2rad(72.0), np.deg2rad(73.0)
"""Angles of steering axis and seat tube from the horizontal."""
KNEE_AT_BOTTOM, TOES_DOWN = np.deg2rad(32.0), np.deg2rad(12.0)
"""Bend of the knee, and pitch of the foot, with the pedal at the bottom of the seat tube's line."""
TRUNK, ARMS, ELBOW = np.deg2rad(38.0), np.deg2rad(48.0), np.deg2rad(28.0)
"""Lean of the trunk from upright, angle of the arms below the horizontal, and bend of the elbows, on the bicycle."""
HIP_ABOVE_SADDLE = 0.05
"""Height of the hip joints over the saddle, in statures."""


def bicycle_sizes(skeleton: Skeleton) -> dict[str, float]:
    """Return the measures [m] (angles [rad]); places are in the frame's axes, x and z from the rear axle.

    `wheel_radius`, `wheelbase`, `head_angle`, `fork_offset`, `trail`; `bottom_bracket_forward`, `bottom_bracket_height`
    over the ground, `seat_angle`, `saddle_height` from bottom bracket to saddle along the seat tube,
    `saddle_setback` behind the bottom bracket; `crank_length`, `pedal_width` between the pedals' middles;
    `bar_forward`, `bar_height` over the ground of the grips with the bar straight, `bar_reach` from saddle to grips,
    `bar_width` between the grips; `ankle_height` over the sole, `ball_forward` of the foot's ball from the ankle,
    `hip_height` of the hip joints over the saddle.
    """
    h = skeleton.height
    radius, offset = 0.19 * h, 0.026 * h
    sizes = {
        "wheel_radius": radius,
        "wheelbase": 0.575 * h,
        "head_angle": float(HEAD_ANGLE),
        "fork_offset": offset,
        "trail": float((radius * np.cos(HEAD_ANGLE) - offset) / np.sin(HEAD_ANGLE)),
        "bottom_bracket_height": 0.155 * h,
        "bottom_bracket_forward": float(np.sqrt((0.24 * h) ** 2 - (radius - 0.155 * h) ** 2)),
        "seat_angle": float(SEAT_ANGLE),
        "crank_length": float(np.clip(0.0955 * h, 0.13, 0.185)),
        "pedal_width": 0.15 * h,
        "ankle_height": 0.039 * h + 0.015,
        "ball_forward": 0.075 * h,
        "hip_height": HIP_ABOVE_SADDLE * h,
        "bar_width": 0.3 * h,
    }
    sizes["saddle_height"] = _saddle_height(skeleton, sizes)
    sizes["saddle_setback"] = float(sizes["saddle_height"] * np.cos(SEAT_ANGLE))
    grips = _grips(skeleton, sizes)
    saddle = saddle_place(sizes)
    sizes |= {"bar_forward": float(grips[0]), "bar_height": float(grips[1] + radius)}
    sizes["bar_reach"] = float(grips[0] - saddle[0])
    return sizes


def saddle_place(sizes: dict[str, float]) -> np.ndarray:
    """Return the place (3,) [m] of the saddle's top in the frame's axes."""
    forward = sizes["bottom_bracket_forward"] - sizes["saddle_setback"]
    up = sizes["bottom_bracket_height"] - sizes["wheel_radius"] + sizes["saddle_height"] * np.sin(sizes["seat_angle"])
    return np.array([forward, 0.0, up])


def fork_place(sizes: dict[str, float]) -> np.ndarray:
    """Return the place (3,) [m] of the fork's frame in the frame's axes, with the bicycle level."""
    back = sizes["fork_offset"]
    return np.array([sizes["wheelbase"] - back * np.sin(sizes["head_angle"]), 0.0, -back * np.cos(sizes["head_angle"])])


def grip_places(sizes: dict[str, float]) -> np.ndarray:
    """Return the places (2, 3) [m] of the left and the right grip in the fork's axes."""
    bar = np.array([sizes["bar_forward"], 0.0, sizes["bar_height"] - sizes["wheel_radius"]])
    middle = fork_turn(sizes).T @ (bar - fork_place(sizes))
    half = np.array([0.0, 0.5 * sizes["bar_width"], 0.0])
    return np.stack((middle + half, middle - half))


def fork_turn(sizes: dict[str, float]) -> np.ndarray:
    """Return the rotation (3, 3) of the fork's frame against the frame's, with the bar straight."""
    return rotation_about("y", sizes["head_angle"] - 0.5 * np.pi)


def rest(sizes: dict[str, float]) -> tuple[np.ndarray, np.ndarray]:
    """Return place (7, 3) and turn (7, 3, 3) of the bicycle's bodies at rest, its saddle below the pelvis."""
    rear = np.array([-saddle_place(sizes)[0], 0.0, sizes["wheel_radius"]])
    crank = [sizes["bottom_bracket_forward"], 0.0, sizes["bottom_bracket_height"] - sizes["wheel_radius"]]
    front = [sizes["wheelbase"], 0.0, 0.0]
    arm, half = sizes["crank_length"], 0.5 * sizes["pedal_width"]
    places = [np.zeros(3), fork_place(sizes), np.zeros(3), np.array(front), np.array(crank)]
    places += [np.add(crank, [arm, half, 0.0]), np.add(crank, [-arm, -half, 0.0])]
    turns = np.repeat(np.eye(3)[None], len(BODIES), axis=0)
    turns[list(BODIES).index("fork")] = fork_turn(sizes)
    return rear + np.array(places), turns


def _saddle_height(skeleton: Skeleton, sizes: dict[str, float]) -> float:
    """Return the height along the seat tube at which the knee is bent as wanted with the pedal at the bottom."""
    up = np.array([-np.cos(SEAT_ANGLE), np.sin(SEAT_ANGLE)])  # x, z
    ball = np.array([sizes["ball_forward"], -sizes["ankle_height"]])
    cosine, sine = np.cos(TOES_DOWN), np.sin(TOES_DOWN)
    ankle = -sizes["crank_length"] * up - np.array(
        [cosine * ball[0] + sine * ball[1], cosine * ball[1] - sine * ball[0]]
    )
    leg = distance_at(skeleton.lengths["thigh"], skeleton.lengths["shank"], KNEE_AT_BOTTOM)
    across = 0.5 * sizes["pedal_width"] - skeleton.hip_half_width
    start = np.array([0.0, sizes["hip_height"]]) - ankle
    middle = float(up @ start)
    return float(-middle + np.sqrt(middle**2 - start @ start + leg**2 - across**2))


def _grips(skeleton: Skeleton, sizes: dict[str, float]) -> np.ndarray:
    """Return the place (x, z) [m] of the grips, which arms bent a little reach from a trunk that leans forward."""
    h, lengths = skeleton.height, skeleton.lengths
    trunk = (0.0267 + 0.0533 + 0.1467) * h + lengths["abdomen"]  # hip joints to shoulders
    saddle = saddle_place(sizes)
    shoulder = np.array([saddle[0], saddle[2] + sizes["hip_height"]]) + trunk * np.array([np.sin(TRUNK), np.cos(TRUNK)])
    arm = float(distance_at(lengths["upper_arm"], lengths["forearm"] + 0.5 * lengths["hand"], ELBOW))
    across = 0.5 * sizes["bar_width"] - lengths["shoulder_half_width"]
    reach = np.sqrt(arm**2 - across**2)
    return shoulder + reach * np.array([np.cos(ARMS), -np.sin(ARMS)])
