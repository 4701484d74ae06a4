"""How long previews take: `python -m benchmarks.preview [--rounds N] [--json FILE]`.

Medians of 10 s of motion: one figure along a track that is there already, its poses at 24 frames a second, one figure
by phase control, and a thousand figures by phase control that all differ in frequency, sharpness, heading and speed.
Wall times of one thread, with the calibration loop of `benchmarks.step` in the same run.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from benchmarks.step import calibration
from ski_addon.course import build_track
from ski_addon.planning import as_planned
from ski_addon.spec import RunSpec
from ski_addon.terrain import build_terrain
from ski_addon.turning.body import TurningBody
from ski_addon.turning.figures import build_figure, figure_poses
from ski_addon.turning.many import motions_on_slope
from ski_addon.turning.pace import Pace
from ski_addon.turning.preview import preview_track
from ski_addon.turning.steering import Start, Steered, Targets, steer

PRESETS = Path(__file__).resolve().parents[1] / "presets" / "runs"
TRACKS = ("giant_slalom", "slalom", "rolling_slalom", "moguls", "snowboard_carving", "telemark_turns", "bicycle_slalom")
DURATION, COUNT, FPS = 10.0, 1000, 24.0
SLOPE = Pace(9.66, 1.70, friction=0.071, friction_per_speed=0.004, drag=0.005)
"""Ten degrees of usual snow."""


def median(function: Callable[[], Any], rounds: int) -> float:
    """Return the median time of a call [ms]."""
    times = []
    for _ in range(rounds):
        begin = perf_counter()
        function()
        times.append(perf_counter() - begin)
    return 1e3 * float(np.median(times))


def along_track(name: str, rounds: int) -> tuple[float, float]:
    """Return the times [ms] of 10 s of preview of a shipped run, whose track is given, and of its figure's poses."""
    spec = as_planned(RunSpec.from_toml(PRESETS / f"{name}.toml"))
    terrain = build_terrain(spec.slope)
    track = build_track(spec, terrain)
    motion, figure = preview_track(spec, track, terrain), build_figure(spec)
    share = DURATION / motion.duration
    moved = median(lambda: preview_track(spec, track, terrain), rounds)
    posed = median(lambda: figure_poses(figure, spec, motion, FPS), rounds)
    return share * moved, share * posed


def swings(count: int, step: float, seed: int = 1) -> tuple[Targets, Start]:
    """Return targets and starts of `count` bodies, all different; their headings change on the way."""
    rng = np.random.default_rng(seed)
    moments = round(DURATION / step) + 1
    shape, part = (moments, count), np.linspace(0.0, 1.0, moments)[:, None]
    period = rng.uniform(1.6, 3.0, count) + rng.uniform(0.0, 1.0, count) * part
    sharpness = rng.uniform(0.1, 0.4, count) + 0.0 * part
    heading = rng.uniform(-0.3, 0.3, count) * np.sin(np.pi * part)
    targets = Targets(step, np.broadcast_to(2.0 * np.pi / period, shape), np.broadcast_to(sharpness, shape), heading)
    return targets, Start(rng.uniform(6.0, 11.0, count))


def swing_many(count: int, step: float) -> tuple[Steered, Any]:
    """Steer `count` bodies down the slope and return all that a `TurningMotion` has of each."""
    targets, start = swings(count, step)
    run = steer(TurningBody(), targets, start, SLOPE)
    return run, motions_on_slope(TurningBody(), run, SLOPE)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=9, help="how often each is measured")
    parser.add_argument("--json", type=Path, help="also write the numbers to this file")
    arguments = parser.parse_args()
    swing_many(2, 0.05)
    found = {"calibration_us": 1e6 * calibration()}
    print(f"calibration loop                 {found['calibration_us']:8.1f} us")
    for name in TRACKS:
        moved, posed = along_track(name, arguments.rounds)
        found |= {f"track_{name}_ms": moved, f"poses_{name}_ms": posed}
        print(f"one figure along {name:<19}{moved:5.1f} ms for 10 s, and {posed:4.1f} ms for its poses")
    found["rhythm_ms"] = median(lambda: swing_many(1, 0.01), arguments.rounds)
    print(f"one figure by phase control      {found['rhythm_ms']:8.1f} ms for 10 s")
    found["thousand_ms"] = median(lambda: swing_many(COUNT, 0.02), max(arguments.rounds // 2, 3))
    run, _ = swing_many(COUNT, 0.02)
    rode = int(np.sum(run.ended == 0))
    print(f"{COUNT} figures by phase control   {found['thousand_ms']:8.1f} ms for 10 s, {rode} of them to the end")
    if arguments.json:
        arguments.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
