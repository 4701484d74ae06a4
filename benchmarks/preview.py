"""How long previews take: `python -m benchmarks.preview [--rounds N] [--json FILE]`.

Medians of 10 s of motion: one figure along a track that is there already, its poses at 24 frames a second, one figure
by phase control, and a thousand figures by phase control that all differ in frequency, sharpness, heading and speed.
Wall times of one thread, with the calibration loop of `benchmarks.step` in the same run.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measuring import RUNS, How, Measurement, calibration, in_turn, spent
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

SUBJECT = "preview"
TRACKS = ("giant_slalom", "slalom", "rolling_slalom", "moguls", "snowboard_carving", "telemark_turns", "bicycle_slalom")
DURATION, COUNT, FPS = 10.0, 1000, 24.0
SLOPE = Pace(9.66, 1.70, friction=0.071, friction_per_speed=0.004, drag=0.005)
"""Ten degrees of usual snow."""


def median(function: Callable[[], Any], rounds: int) -> float:
    """Return the median time of a call [ms]."""
    return 1e3 * float(np.median([spent(function)[1].wall for _ in range(rounds)]))


@dataclass(frozen=True)
class AlongTrack:
    """Work on a shipped run whose track is given: its motion, its figure's poses, and how much of it is 10 s."""

    move: Callable[[], Any]
    pose: Callable[[], Any]
    share: float


def along_track(name: str) -> AlongTrack:
    """Return what there is to time of a shipped run."""
    spec = as_planned(RunSpec.from_toml(RUNS / f"{name}.toml"))
    terrain = build_terrain(spec.slope)
    track = build_track(spec, terrain)
    motion, figure = preview_track(spec, track, terrain), build_figure(spec)
    return AlongTrack(
        lambda: preview_track(spec, track, terrain),
        lambda: figure_poses(figure, spec, motion, FPS),
        DURATION / motion.duration,
    )


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


def measurements(how: How) -> list[Measurement]:
    """Return the rows of previews with poses; figures by phase control have no poses yet."""
    rows = []
    for name in TRACKS[: how.rounds(len(TRACKS), 1)]:
        run = along_track(name)
        found = in_turn({"motion": run.move, "poses": run.pose}, how.rounds(9, 7))
        label = name.replace("_", " ")
        rows += [samples.row(SUBJECT, f"{label}: {part}", "ms", run.share) for part, samples in found.items()]
    swing_many(2, 0.05)
    found = in_turn({"one figure by rhythm": lambda: swing_many(1, 0.01)}, how.rounds(9, 7))
    if not how.quick:
        found |= in_turn({f"{COUNT} figures by rhythm": lambda: swing_many(COUNT, 0.02)}, 4)
    return rows + [samples.row(SUBJECT, name, "ms") for name, samples in found.items()]


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
        run = along_track(name)
        moved, posed = (run.share * median(work, arguments.rounds) for work in (run.move, run.pose))
        found |= {f"track_{name}_ms": moved, f"poses_{name}_ms": posed}
        print(f"one figure along {name:<19}{moved:5.1f} ms for 10 s, and {posed:4.1f} ms for its poses")
    found["rhythm_ms"] = median(lambda: swing_many(1, 0.01), arguments.rounds)
    print(f"one figure by phase control      {found['rhythm_ms']:8.1f} ms for 10 s")
    found["thousand_ms"] = median(lambda: swing_many(COUNT, 0.02), max(arguments.rounds // 2, 3))
    steered, _ = swing_many(COUNT, 0.02)
    rode = int(np.sum(steered.ended == 0))
    print(f"{COUNT} figures by phase control   {found['thousand_ms']:8.1f} ms for 10 s, {rode} of them to the end")
    if arguments.json:
        arguments.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
