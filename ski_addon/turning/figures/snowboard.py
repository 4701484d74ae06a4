"""The snowboarder: sideways on a board that the ankles tilt, turned into the curve, arms ahead [VP93 sec. 7]."""

from __future__ import annotations

import numpy as np

from ...spec import FigureSpec
from .footing import Footing, edge_angle, stand_on, tilt_for_curvature
from .model import FigureModel
from .person import Frames, Limbs, Trunk, person_frames, sockets, solve_arms, solve_legs, trunk_at_origin
from .sampling import Moments, Run
from .standing import Legs, lean_line, place_pelvis, spring_legs
from .vectors import Array, turn_yxz

KNEE, WAIST, TWIST = float(np.deg2rad(62.0)), 0.6, 0.7
"""Usual knee bend [rad], bend of the waist per bend of the knees, and twist per tilt of the board."""
OPEN = np.deg2rad([12.0, 26.0, 40.0, 78.0])
"""How far pelvis, abdomen, chest and head are turned from straight across towards the nose."""
PITCH, LEAN, YAW = np.array([0.4, 0.75, 1.0, 0.34]), np.array([0.85, 0.55, 0.25, 0.0]), np.array([0.3, 0.6, 1.0, 0.5])
"""Shares of the waist's bend, of the body's lean and of the twist, for pelvis, abdomen, chest and head."""
HANDS = ((0.275, 0.03, -0.21), (-0.27, 0.15, -0.2))
"""Front and rear hand from the shoulders' middle: towards the nose, to the toes' side, up; in statures."""
LEG_TWIST = float(np.deg2rad(18.0))


def snowboard_frames(model: FigureModel, figure: FigureSpec, run: Run, time: Array) -> Frames:
    """Return {body: (place (m, 3), turn (m, 3, 3))} of a snowboarder at `time` (m,) [s]."""
    skeleton = model.skeleton
    moments = run.at(time)
    turning = tilt_for_curvature(run, moments.curvature, figure.tilt)
    tilt = edge_angle(moments, turning)[:, None]
    board = stand_on(run, moments.distance[:, None], np.zeros(1), tilt, model.sizes["length"], model.sizes["width"])
    foot, ankle = _feet(model, board)
    legs = _legs(model, figure, moments)
    twist = TWIST if figure.twist == "auto" else float(figure.twist)
    trunk = _trunk(model, figure, moments, twist * turning, legs)
    length = legs.length
    trunk = trunk.moved(place_pelvis(skeleton, trunk, moments.place, lean_line(moments), ankle, foot, length))
    ahead = tilt_for_curvature(run, run.curvature(time + figure.arms_lead), figure.tilt)
    arms = _arms(model, moments, trunk, twist * ahead)
    limbs = solve_legs(skeleton, sockets(skeleton, trunk, "thigh"), ankle, foot, LEG_TWIST)
    frames = person_frames(skeleton, trunk, arms, limbs)
    frames["board"] = board.place[:, 0], board.turn[:, 0]
    return frames


def _side(model: FigureModel) -> float:
    """Return 1 for a regular stance, whose rider faces right, and -1 for goofy."""
    return -1.0 if model.sizes["goofy"] else 1.0


def _feet(model: FigureModel, board: Footing) -> tuple[Array, Array]:
    """Return rotations (m, 2, 3, 3) of left and right foot, and ankles (m, 2, 3) [m, world], fixed on the board."""
    sizes, side = model.sizes, _side(model)
    front = 0 if side > 0 else 1
    local_turn, local_ankle = np.empty((2, 3, 3)), np.empty((2, 3))
    for i in range(2):
        angle = sizes["angle_front"] if i == front else sizes["angle_rear"]
        local_turn[i] = turn_yxz(0.0, 0.0, side * (angle - 0.5 * np.pi))
        place = np.array([0.5 * sizes["stance"] * (1.0 if i == front else -1.0), 0.0, 0.0])
        local_ankle[i] = place + local_turn[i] @ [-sizes["ankle_setback"], 0.0, sizes["ankle_height"]]
    turn = board.turn[:, 0]
    return turn[:, None] @ local_turn, board.place + local_ankle @ np.swapaxes(turn, -1, -2)


def _legs(model: FigureModel, figure: FigureSpec, moments: Moments) -> Legs:
    """Return the spring of the legs, measured from the middle of the hips to that of the ankles: they stand astride."""
    knee = KNEE if figure.knee_bend_deg == "auto" else float(np.deg2rad(figure.knee_bend_deg))
    legs = spring_legs(model.skeleton, figure, moments, knee)
    astride = 0.5 * model.sizes["stance"] - model.skeleton.hip_half_width
    return Legs(np.sqrt(np.maximum(np.square(legs.length) - astride**2, 0.01)), legs.knee)


def _trunk(model: FigureModel, figure: FigureSpec, moments: Moments, twist: Array, legs: Legs) -> Trunk:
    waist = WAIST if figure.waist_bend == "auto" else float(figure.waist_bend)
    yaw = _side(model) * (OPEN - 0.5 * np.pi) + twist[:, None] * YAW
    pitch = (waist * legs.knee)[:, None] * PITCH
    return trunk_at_origin(model.skeleton, moments.body, moments.lean[:, None] * LEAN, yaw, pitch)


def _arms(model: FigureModel, moments: Moments, trunk: Trunk, twist: Array) -> Limbs:
    """Return the arms, spread over nose and tail; `twist` (m,) [rad] is that of the upper body a little later."""
    skeleton, side = model.skeleton, _side(model)
    frame = moments.body @ turn_yxz(0.0, -0.45 * moments.lean) @ turn_yxz(0.0, 0.0, twist)
    local = skeleton.height * np.array(HANDS) * [1.0, -side, 1.0]
    local = local if side > 0 else local[::-1]
    shoulder = sockets(skeleton, trunk, "upper_arm")
    grip = shoulder.mean(axis=1)[:, None] + local @ np.swapaxes(frame, -1, -2)
    elbow = np.broadcast_to(np.array([0.0, 0.5 * side, -0.85]) @ np.swapaxes(frame, -1, -2), grip[:, 0].shape)
    return solve_arms(skeleton, shoulder, grip, np.repeat(elbow[:, None], 2, axis=1), np.zeros(grip.shape[:2]))
