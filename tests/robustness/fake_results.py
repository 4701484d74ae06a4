"""Results of pushed runs without running any."""

from __future__ import annotations

from ski_addon.robustness import Case, PushTable, Row, RunResult

TABLE = PushTable(
    forces=(50.0, 100.0, 150.0), bodies=("head", "ski.R"), directions=("left", "back"), speeds=(5.0,), moments=("turn",)
)


def result(
    case: Case, status: str = "recovered", recovery: float | None = 1.25, bound: float | None = 200.0
) -> RunResult:
    return RunResult(
        case=case,
        status=status,
        detail="the head came down; no reason" if status == "fell" else "",
        start_s=3.0,
        speed_at_push=5.2,
        recovery_s=recovery if status == "recovered" else None,
        ski_offset_max_m=0.01 * case.force,
        com_offset_max_m=0.02,
        torque_ratio_max=0.5,
        joint_margin_min_deg=3.0,
        root_residual_max=0.01,
        bound_n=bound,
    )


def table_results() -> list[RunResult]:
    """Head to the left: back, up, fell; all others are back after 1.25 s, and pushes of the ski have no bound."""
    hard = dict(zip(TABLE.forces, ("recovered", "survived", "fell"), strict=True))
    head_left = Row(5.0, "turn", "head", "left")
    return [
        result(
            case,
            hard[case.force] if case.row == head_left else "recovered",
            bound=200.0 if case.row == head_left else None,
        )
        for case in TABLE.cases
    ]
