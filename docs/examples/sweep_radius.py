"""How fast and how far does one lean in turns of several radii? Simulate them all, and print a table.

    python sweep_radius.py out/radii

Stop it and start it again: runs that are finished are kept.
"""

from __future__ import annotations

import sys

import ski_addon

RADII = (10.0, 14.0, 20.0)


def main(folder: str, jobs: int = 2) -> None:
    """Simulate the turns of each radius into `folder`, `jobs` at a time."""
    run = ski_addon.load_run("paper_main", {"course.turn_count": 2})
    print("radius     speed     lean")
    for row in ski_addon.run_sweep(run, {"course.turn_radius": RADII}, folder, jobs):
        radius = float(row["values"]["course.turn_radius"])
        if row["status"] == "finished":
            print(f"{radius:4.0f} m  {row['speed_max']:4.1f} m/s  {row['inclination_max_deg']:3.0f} deg")
        else:
            print(f"{radius:4.0f} m  {row['status']}: {row['detail']}")


if __name__ == "__main__":  # processes that share the work import this file
    main(*sys.argv[1:])
