"""A gate dragged: `python -m benchmarks.drag` prints how long the preview of 15 gates takes, beside the whole preview.

Measured without drawing: the seventh gate goes aside by 0.8 m in forty steps, as under a mouse, and back.
"""

from __future__ import annotations

import math
import time

import numpy as np

from ski_addon.course import course_gates
from ski_addon.spec import RunSpec, find_document
from ski_addon.terrain import Terrain, build_terrain
from ski_addon.turning.preview import preview_course
from ski_addon.turning.quick import quick_gates

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


def main() -> None:
    """Print the table."""
    print("| course | dragging: median [ms] | longest [ms] | whole preview [ms] | ratio | apart [m] |")
    print("|---|---|---|---|---|---|")
    for name in COURSES:
        spec, terrain = listed(name)
        there = ASIDE * np.sin(np.linspace(0.0, np.pi, STEPS))
        steps = [moved(spec, float(aside)) for aside in there]
        before, seconds, whole, apart = quick_gates(spec, terrain), [], [], []
        for step in steps:
            begin = time.perf_counter()
            before = quick_gates(step, terrain, before)
            seconds.append(time.perf_counter() - begin)
        for step in steps[::8]:
            begin = time.perf_counter()
            exact = preview_course(step, terrain).motion.position[:, :2]
            whole.append(time.perf_counter() - begin)
            quick_way = quick_gates(step, terrain).preview.motion.position[:, :2]
            inside = exact[exact[:, 0] < quick_way[-1, 0]][::10]
            gaps = np.linalg.norm(inside[:, None] - quick_way[None], axis=2).min(axis=1)
            apart.append(float(gaps.max()))
        median, all_of_it = 1e3 * float(np.median(seconds)), 1e3 * float(np.median(whole))
        ratio = all_of_it / median
        print(
            f"| {name} | {median:.1f} | {1e3 * max(seconds):.1f} | {all_of_it:.0f} | {ratio:.1f} | {max(apart):.3f} |"
        )


if __name__ == "__main__":
    main()
