"""What a run of the paper's cases must reach."""

from __future__ import annotations

from typing import Any

BOUNDS: dict[str, float] = {
    "ski_error_max_m": 5e-3,
    "ski_error_rms_m": 2e-3,
    "com_error_max_m": 5e-3,
    "torque_ratio_max": 1.0,
    "root_residual_max": 0.05,
    "unconverged_steps": 0,
}
"""Largest values allowed, by key of the summary."""


def violations(summary: dict[str, Any], factor: float = 1.0) -> list[str]:
    """What a summary misses, in words; tracking bounds (the keys in metres) are multiplied by `factor`."""
    out = [] if summary["status"] == "finished" else [f"status {summary['status']}: {summary['status_detail']}"]
    for key, bound in BOUNDS.items():
        allowed = bound * factor if key.endswith("_m") else bound
        if not summary[key] <= allowed:
            out.append(f"{key} = {summary[key]:.4g} > {allowed:g}")
    if not summary["joint_margin_min_deg"] >= 0.0:
        out.append(f"joint_margin_min_deg = {summary['joint_margin_min_deg']:.3g} < 0")
    return out
