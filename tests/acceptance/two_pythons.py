"""Workers with another Python: `python -m tests.acceptance.two_pythons PYTHON [PRESET ...]`.

Simulates presets with this Python and with the other one, each with its own NumPy, and says how far the recordings are
apart. Exits with 1 where that is more than `TOLERANCE`.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
PRESETS = ("paper_main", "giant_slalom", "slalom")
TOLERANCE = {"qpos": 1e-6, "com": 1e-6, "speed": 1e-6, "edge_angle": 1e-6, "tau": 0.01, "snow_force": 0.01}
"""Most difference of what is recorded under these names: m or rad, m, m/s, rad, N m, N. About a hundred times what the
presets lose along their runs, and nothing that can be seen.
"""


def simulate(python: str, preset: str, folder: Path) -> Path:
    """Simulate a preset with a Python; return the recording."""
    command = [python, "-m", "ski_addon", "simulate", preset, "-o", str(folder), "--quiet"]
    subprocess.run(command, cwd=ROOT, check=True, timeout=600)
    return folder / "recording.npz"


def differences(one: Path, other: Path) -> dict[str, float]:
    """Return the largest difference of two recordings under each name of `TOLERANCE`."""
    with np.load(one, allow_pickle=False) as a, np.load(other, allow_pickle=False) as b:
        if a["time"].shape != b["time"].shape:
            raise ValueError(f"{len(a['time'])} and {len(b['time'])} steps")
        return {name: float(np.abs(a[name] - b[name]).max()) for name in TOLERANCE}


def main(python: str, presets: tuple[str, ...]) -> int:
    """Compare all `presets`; print a line for each."""
    bad = 0
    for preset in presets:
        with tempfile.TemporaryDirectory() as name:
            pair = [simulate(each, preset, Path(name, str(k))) for k, each in enumerate((sys.executable, python))]
            found = differences(pair[0], pair[1])
        wrong = [key for key, value in found.items() if not value <= TOLERANCE[key]]
        bad += bool(wrong)
        numbers = ", ".join(f"{key} {value:.1e}" for key, value in found.items())
        print(f"{preset}: {numbers}{'; too much: ' + ', '.join(wrong) if wrong else ''}", flush=True)
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], tuple(sys.argv[2:]) or PRESETS))
