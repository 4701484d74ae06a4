"""Numbers that say how a run went."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..gravity import STANDARD_GRAVITY
from .clearance import gate_summary, recorded_gates
from .recording import Recording


def summarise(recording: Recording, step_seconds: list[float] | None = None) -> dict[str, Any]:
    """Return the run's summary: the keys of `summary.json`.

    `track_offset_max_m` is of the skis; `capture_margin_min_m` and `zmp_margin_min_m` are the least distances from
    losing balance and from the border of the bearing edges. Lengths are in metres, angles in degrees where the key
    says so, forces in body weights; `torque_ratio_max` is of the human limit; `step_us_*` are wall microseconds a step,
    None when not measured. Gate courses have the keys of `gate_summary`, too.
    """
    weight = float(recording.header["mass"]) * STANDARD_GRAVITY
    total = np.linalg.norm(recording.snow_force.sum(axis=1), axis=1)
    timing = np.asarray(step_seconds or [], dtype=float) * 1e6
    gates = recorded_gates(recording)
    worst = int(np.argmax(recording.torque_ratio.max(axis=0))) if len(recording.time) else 0
    return {
        "status": recording.status,
        "status_detail": recording.header["status_detail"],
        "duration_s": recording.duration,
        "steps": len(recording.time),
        "track_length_m": _last(recording.arc_length),
        "ski_error_max_m": _largest(recording.ski_error),
        "ski_error_rms_m": _rms(recording.ski_error),
        "com_error_max_m": _largest(recording.com_error),
        "com_error_rms_m": _rms(recording.com_error),
        "track_offset_max_m": _largest(recording.track_offset[:, 0]),
        "capture_margin_min_m": _least(recording.capture_margin),
        "zmp_margin_min_m": _least(recording.zmp_margin),
        "torque_ratio_max": _largest(recording.torque_ratio),
        "torque_ratio_joint": recording.header["actuated_joint_names"][worst],
        "joint_margin_min_deg": float(np.rad2deg(np.min(recording.joint_margin, initial=np.pi))),
        "root_residual_max": _largest(recording.root_residual),
        "unconverged_steps": int(np.count_nonzero(recording.solver_status)),
        "solver_iterations_max": int(np.max(recording.solver_iterations, initial=0)),
        "solver_retries": int(np.count_nonzero(recording.solver_attempts > 1)),
        "inclination_max_deg": float(np.rad2deg(_largest(recording.inclination))),
        "edge_angle_max_deg": float(np.rad2deg(_largest(recording.edge_angle))),
        "snow_force_max_bw": _largest(total) / weight,
        "speed_max": _largest(recording.speed),
        "speed_end": _last(recording.speed),
        **(gate_summary(gates) if gates else {}),
        "step_us_median": float(np.median(timing)) if len(timing) else None,
        "step_us_p99": float(np.percentile(timing, 99)) if len(timing) else None,
        "spec_hash": recording.header["spec_hash"],
        "model_hash": recording.header["model_hash"],
        "versions": recording.header["versions"],
    }


def _largest(values: np.ndarray) -> float:
    return float(np.max(np.abs(values), initial=0.0))


def _least(values: np.ndarray) -> float:
    return float(values.min()) if len(values) else 0.0


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values)))) if values.size else 0.0


def _last(values: np.ndarray) -> float:
    return float(values[-1]) if len(values) else 0.0
