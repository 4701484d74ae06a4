"""What the figures' tests measure: slip, gaps at hands and feet, joint angles, turns between frames."""

from __future__ import annotations

import numpy as np

from ski_addon.frames import matrix_from_quaternion

HINGED = {
    "abdomen": "pelvis",
    "chest": "abdomen",
    "head": "chest",
    **{f"upper_arm.{s}": "chest" for s in "LR"},
    **{f"forearm.{s}": f"upper_arm.{s}" for s in "LR"},
    **{f"hand.{s}": f"forearm.{s}" for s in "LR"},
    **{f"thigh.{s}": "pelvis" for s in "LR"},
    **{f"shank.{s}": f"thigh.{s}" for s in "LR"},
    **{f"foot.{s}": f"shank.{s}" for s in "LR"},
}


def place(poses, body):
    """Places (m, 3) of a body."""
    return poses.position[:, poses.body_names.index(body)]


def turn(poses, body):
    """Rotations (m, 3, 3) of a body."""
    return matrix_from_quaternion(poses.quaternion[:, poses.body_names.index(body)])


def point(poses, body, local):
    """World places (m, 3) of a point of a body."""
    return place(poses, body) + turn(poses, body) @ np.asarray(local, dtype=float)


def slip_per_metre(places, ahead, up):
    """Sideways way over all the way, of a track (m, 3) under gear that points `ahead` (m, 3) over ground with `up`."""
    step = np.diff(places, axis=0)
    left = np.cross(up[1:] + up[:-1], ahead[1:] + ahead[:-1])
    left /= np.linalg.norm(left, axis=1, keepdims=True)
    return np.abs((step * left).sum(axis=1)).sum() / np.linalg.norm(step, axis=1).sum()


def joint_angles(poses, body):
    """Angles (m, 3) [deg] y, x, z of a body against its parent, in the order of the skeleton's hinges Ry Rx Rz."""
    local = np.swapaxes(turn(poses, HINGED[body]), 1, 2) @ turn(poses, body)
    x = np.arcsin(np.clip(-local[:, 1, 2], -1, 1))
    y = np.arctan2(local[:, 0, 2], local[:, 2, 2])
    z = np.arctan2(local[:, 1, 0], local[:, 1, 1])
    return np.rad2deg(np.stack((y, x, z), axis=1))


def turns_between_frames(poses):
    """Angles (m - 1, b) [deg] by which each body turns from key to key."""
    dot = np.abs(np.sum(poses.quaternion[1:] * poses.quaternion[:-1], axis=-1))
    return np.rad2deg(2 * np.arccos(np.clip(dot, 0, 1)))


def limb_gaps(figure, poses):
    """Largest distance [m] between any person's body and where its parent holds it; the figure's bones only turn."""
    worst = 0.0
    for name in figure.person[1:]:
        index = figure.body(name)
        parent = figure.body_names[figure.parent[index]]
        offset = figure.turn[figure.parent[index]].T @ (figure.place[index] - figure.place[figure.parent[index]])
        worst = max(worst, np.abs(place(poses, name) - point(poses, parent, offset)).max())
    return worst
