"""Many skiers on one slope, each with a body, a speed and a line of his own, who stay apart.

    python many_skiers.py out/crowd

Writes member_001.npz and so on, and crowd.json; `ski bake out/crowd` makes crowd.blend of them.
"""

from __future__ import annotations

import sys

import ski_addon


def main(folder: str, count: int = 4, jobs: int = 2) -> None:
    """Let `count` skiers ski two turns into `folder`, `jobs` of them at a time."""
    changes = {"crowd.count": count, "crowd.seed": 7, "spread.height": 0.1, "course.turn_count": 2}
    summary = ski_addon.run_crowd("medium_carving", folder, changes, jobs)
    for member in summary["members"]:
        body = f"{member['height_m']:.2f} m, {member['mass_kg']:.0f} kg"
        print(f"skier {member['member']} ({body}) starts at {member['start_s']:.1f} s: {member['status']}")


if __name__ == "__main__":  # processes that share the work import this file
    main(*sys.argv[1:])
