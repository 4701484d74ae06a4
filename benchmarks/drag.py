"""A gate dragged: `python -m benchmarks.drag` prints how long the preview of 15 gates takes, beside the whole preview.

Measured without drawing: the seventh gate goes aside by 0.8 m in forty steps, as under a mouse, and back.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from benchmarks.measuring import CALIBRATION_ROUNDS, How, Measurement, Samples, Spent, calibration, in_turn, spent
from ski_addon.course import course_gates
from ski_addon.spec import RunSpec, find_document
from ski_addon.terrain import Terrain, build_terrain
from ski_addon.turning.preview import preview_course
from ski_addon.turning.quick import quick_gates

SUBJECT = "drag"
COURSES = ("slalom", "giant_slalom_race", "rolling_giant_slalom")
GATES, DRAGGED, ASIDE, STEPS = 15, 6, 0.8, 40


def listed(name: str) -> tuple[RunSpec, Terrain]:
    """Return a preset with its first gates as rows, as gates that stand in a scene are, and its terrain."""
    spec = RunSpec.from_toml(find_document(name)).with_overrides({"course.gate_count": GATES})
    terrain = build_terrain(spec.slope)
    gates = course_gates(spec, terrain)
    if gates is None:
        raise ValueError(f"{name} has no gates")
    down = gates.position[:, 0] / math.cos(terrain.mean_angle)
    rows = [{"x": float(x), "y": float(y)} for x, y in zip(down, gates.position[:, 1], strict=True)]
    document = spec.to_dict()
    document["course"]["gate_setting"] = "list"
    return RunSpec.from_dict({**document, "gate": rows}), terrain


def moved(spec: RunSpec, aside: float) -> RunSpec:
    """Return `spec` with one gate moved to the left by `aside` [m]."""
    return spec.with_overrides({f"gate.{DRAGGED + 1}.y": spec.gate[DRAGGED].y + aside})


def steps_of(spec: RunSpec) -> list[RunSpec]:
    """Return the documents of a gate that goes aside and back."""
    return [moved(spec, float(aside)) for aside in ASIDE * np.sin(np.linspace(0.0, np.pi, STEPS))]


def dragged(steps: list[RunSpec], terrain: Terrain) -> list[Spent]:
    """Return what each step of a drag takes, from the line of the step before."""
    before, series = quick_gates(steps[0], terrain), []
    for step in steps:
        before, took = spent(partial(quick_gates, step, terrain, before))
        series.append(took)
    return series


def apart(step: RunSpec, terrain: Terrain) -> float:
    """Return the largest distance [m] of the quick way from the exact one."""
    exact = preview_course(step, terrain).motion.position[:, :2]
    quick_way = quick_gates(step, terrain).preview.motion.position[:, :2]
    inside = exact[exact[:, 0] < quick_way[-1, 0]][::10]
    return float(np.linalg.norm(inside[:, None] - quick_way[None], axis=2).min(axis=1).max())


def measurements(how: How) -> list[Measurement]:
    """Return the rows of a drag; its peer is the whole preview, which a drag used to wait for."""
    rows = []
    for name in COURSES[: how.rounds(len(COURSES), 1)]:
        spec, terrain = listed(name)
        steps, samples = steps_of(spec), Samples()
        for _ in range(how.rounds(3, 2)):
            before = calibration(CALIBRATION_ROUNDS)
            series = dragged(steps, terrain)
            samples.add_spent(series, 0.5 * (before + calibration(CALIBRATION_ROUNDS)))
        whole = in_turn({"whole": partial(preview_course, steps[0], terrain)}, 3)["whole"]
        ratio = samples.ratio / whole.ratio
        label = name.replace("_", " ")
        rows.append(samples.row(SUBJECT, label, "ms", peer="whole preview", peer_ratio=ratio))
    return rows


def main() -> None:
    """Print the table."""
    print("| course | dragging: median [ms] | longest [ms] | whole preview [ms] | ratio | apart [m] |")
    print("|---|---|---|---|---|---|")
    for name in COURSES:
        spec, terrain = listed(name)
        steps = steps_of(spec)
        seconds = [took.wall for took in dragged(steps, terrain)]
        whole = [spent(partial(preview_course, step, terrain))[1].wall for step in steps[::8]]
        gap = max(apart(step, terrain) for step in steps[::8])
        median, all_of_it = 1e3 * float(np.median(seconds)), 1e3 * float(np.median(whole))
        ratio = all_of_it / median
        print(f"| {name} | {median:.1f} | {1e3 * max(seconds):.1f} | {all_of_it:.0f} | {ratio:.1f} | {gap:.3f} |")


if __name__ == "__main__":
    main()
