"""Simulate a run and look at its numbers: no Blender, no files but one.

python simulate_only.py out/run.npz
"""

from __future__ import annotations

import sys

import numpy as np

import ski_addon


def main(target: str) -> None:
    """Simulate three turns on hard snow, say how they went, and keep the recording at `target`."""
    run = ski_addon.load_run("medium_carving", {"course.turn_count": 3, "snow.hardness": 5e8, "skier.mass": 75})
    recording = ski_addon.simulate(run)
    summary = ski_addon.summarise(recording)
    print(f"{summary['duration_s']:.1f} s, up to {summary['speed_max']:.1f} m/s")
    print(f"leans up to {summary['inclination_max_deg']:.0f} degrees")

    # every array of a recording has a row for each step; qpos is what MuJoCo calls so
    outside = np.where(recording.inclination > 0.0, 1, 0)  # a skier who leans to the left stands on the right ski
    edge = np.take_along_axis(recording.edge_angle, outside[:, None], axis=1)
    print(f"the outside ski is tipped by up to {np.rad2deg(np.abs(edge).max()):.0f} degrees")
    recording.save(target)


if __name__ == "__main__":
    main(*sys.argv[1:])
