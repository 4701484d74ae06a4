"""Numbers that say how a skier moved, for `summary.json`: docs/measures.md defines each of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..body import Skeleton
from ..body.kinematics import forward_kinematics
from ..course.track import TRANSITION
from ..gravity import STANDARD_GRAVITY
from ..simulation import Recording
from ..terrain import Terrain
from .nearness import Nearness, measure_nearness

RATE = 100.0
"""Moments a second at which motion is measured: a person's is far slower than the controller's steps."""
CARVING_EDGE, CARVING_STEERING = np.deg2rad(10.0), np.deg2rad(1.5)
"""A ski carves while it is tipped by more than the first, and planned to point along its way to within the second."""
UNWEIGHTED = 0.8
"""A skier whose load is below so much of the weight [body weights] is unweighted."""
APEX = 0.25
"""Share of a turn's time, in its middle, that counts as its apex."""


def measure_motion(recording: Recording, skeleton: Skeleton, terrain: Terrain) -> dict[str, Any]:
    """Return the motion measures of a recording as plain numbers; None where the run has nothing to measure.

    Lengths in metres, angles and rates in degrees and degrees a second where the key says so, loads in body weights.
    """
    every = max(round(1.0 / (RATE * float(recording.header["time_step"]))), 1)
    moments = slice(None, None, every)
    if len(recording.time[moments]) < 5:
        return {}
    step = every * float(recording.header["time_step"])
    position, rotation = forward_kinematics(skeleton, recording.qpos[moments])
    nearness = measure_nearness(skeleton, position, rotation, terrain)
    return {
        **_near(nearness),
        "joint_violation_steps": int(np.count_nonzero(recording.joint_margin < 0.0)),
        "edge_slip_max": _edge_slip(recording, skeleton, position, rotation, moments),
        "head_rate_p95_deg": float(np.rad2deg(_p95(angular_speed(rotation[:, skeleton.body("head")], step)))),
        "jerk_p95": _jerks(recording, skeleton, moments, step),
        **_loads(recording),
        "angulation_max_deg": _angulation(recording),
    }


def angular_speed(rotation: np.ndarray, step: float) -> np.ndarray:
    """Return the angular speed (n - 1,) [rad/s] of frames `rotation` (n, 3, 3), `step` [s] apart."""
    cosine = 0.5 * (np.einsum("nij,nij->n", rotation[1:], rotation[:-1]) - 1.0)
    return np.arccos(np.clip(cosine, -1.0, 1.0)) / step


def _near(nearness: Nearness) -> dict[str, Any]:
    closest, low = (
        min(nearness.pairs, key=nearness.pairs.__getitem__),
        min(nearness.snow, key=nearness.snow.__getitem__),
    )
    return {
        "clearance_min_m": nearness.pairs[closest],
        "clearance_pair": " - ".join(closest),
        "clearances_m": {" - ".join(pair): gap for pair, gap in nearness.pairs.items()},
        "snow_clearance_min_m": nearness.snow[low],
        "snow_clearance_body": low,
    }


def _edge_slip(
    recording: Recording, skeleton: Skeleton, position: np.ndarray, rotation: np.ndarray, moments: slice
) -> float | None:
    """Return how far carving skis slip across their own direction, for each metre travelled: the most of any metre."""
    most = None
    edge, steering = recording.edge_angle[moments], recording.steering[moments]
    normal = recording.surface_normal[moments]
    for ski, side in enumerate("LR"):
        body = skeleton.body(f"ski.{side}")
        moved = np.diff(position[:, body], axis=0)
        along = rotation[:-1, body, :, 0]
        across = np.cross(normal[:-1], along)
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        slip, way = np.abs(np.einsum("ni,ni->n", moved, across)), np.linalg.norm(moved, axis=1)
        carves = (np.abs(edge[:-1, ski]) > CARVING_EDGE) & (np.abs(steering[:-1]) < CARVING_STEERING)
        share = _most_by_metre(np.where(carves, slip, 0.0), way, carves)
        if share is not None:
            most = share if most is None else max(most, share)
    return most


def _most_by_metre(slip: np.ndarray, way: np.ndarray, carves: np.ndarray) -> float | None:
    """Return the largest sum of `slip` over stretches of a metre of `way` on which the ski carves throughout."""
    done, slipped = np.concatenate(([0.0], np.cumsum(way))), np.concatenate(([0.0], np.cumsum(slip)))
    others = np.concatenate(([0], np.cumsum(~carves)))
    end = np.searchsorted(done, done + 1.0)
    begin = np.flatnonzero(end < len(done))
    whole = begin[others[end[begin]] == others[begin]]
    if not len(whole):
        return None
    return float(np.max((slipped[end[whole]] - slipped[whole]) / (done[end[whole]] - done[whole])))


def _jerks(recording: Recording, skeleton: Skeleton, moments: slice, step: float) -> dict[str, float]:
    """Return the 95th percentile of each muscled hinge's jerk [rad/s^3]: the third difference of its angle."""
    names = [skeleton.joint_names[hinge] for hinge in skeleton.actuated]
    angles = recording.qpos[moments][:, skeleton.joint_qpos[skeleton.actuated]]
    jerk = np.abs(np.diff(angles, 3, axis=0)) / step**3
    return dict(zip(names, np.percentile(jerk, 95.0, axis=0).tolist(), strict=True))


def _loads(recording: Recording) -> dict[str, Any]:
    weight = float(recording.header["mass"]) * STANDARD_GRAVITY
    step = float(recording.header["time_step"])
    load = np.einsum("nsi,ni->ns", recording.snow_force, recording.surface_normal) / weight
    total, begun = load.sum(axis=1), recording.time > 0.5  # the first moments are the controller finding its feet
    low = total < UNWEIGHTED
    shares = _apex_shares(recording, load)
    return {
        "outside_load_apex_min": min(shares, default=None),
        "outside_load_apex_max": max(shares, default=None),
        "unweighting_depth_bw": float(max(1.0 - total[begun].min(initial=1.0), 0.0)),
        "unweighting_time_s": _longest(low & begun) * step,
    }


def _apex_shares(recording: Recording, load: np.ndarray) -> list[float]:
    """Return the outside ski's share of the load at each turn's apex."""
    shares = []
    for turn in np.unique(recording.turn):
        steps = np.flatnonzero((recording.turn == turn) & (recording.phase != TRANSITION))
        middle = steps[int((0.5 - 0.5 * APEX) * len(steps)) : int((0.5 + 0.5 * APEX) * len(steps))]
        total = load[middle].sum()
        if total <= 0.0:
            continue
        outside = 1 if recording.phase[middle[0]] > 0 else 0  # a left turn stands on the right ski
        shares.append(float(load[middle, outside].sum() / total))
    return shares


def _angulation(recording: Recording) -> float:
    """Return the most [degrees] by which the outside ski is tipped more than the body leans."""
    outside = np.where(recording.inclination > 0.0, 1, 0)
    edge = np.take_along_axis(recording.edge_angle, outside[:, None], axis=1)[:, 0]
    beyond = (edge - recording.inclination) * np.sign(recording.inclination)
    return float(np.rad2deg(beyond.max(initial=0.0)))


def _p95(values: np.ndarray) -> float:
    return float(np.percentile(values, 95.0))


def _longest(flags: np.ndarray) -> int:
    """Return the length of the longest run of true ones."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flags, [False])).astype(np.int8)))
    return int((edges[1::2] - edges[::2]).max(initial=0))
