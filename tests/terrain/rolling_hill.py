"""Makes the shipped ground `presets/terrain/rolling_hill.npz`: `python -m tests.terrain.rolling_hill`.

A hill of 600 m x 120 m whose steepness varies smoothly by five degrees: waves of 25 to 60 m in all directions, added up
at random and scaled so that the steepest place along the fall line is five degrees steeper or flatter than the mean.
It has no slope of its own: `slope.angle_deg` puts it on one.
"""

from __future__ import annotations

import io
import math
import zipfile
from pathlib import Path

import numpy as np

PATH = Path(__file__).resolve().parents[2] / "presets" / "terrain" / "rolling_hill.npz"
LENGTH, WIDTH, SPACING, START = 600.0, 120.0, 2.0, 10.0
SHORTEST, LONGEST, STEEPNESS = 25.0, 60.0, math.radians(5.0)
WAVES, SEED = 14, 2019
STEP = 1e-3
"""Heights are whole millimetres, which pack well."""


def rolling_hill() -> np.ndarray:
    """The heights (301, 61) [m]."""
    rng = np.random.default_rng(SEED)
    x, y = np.meshgrid(np.arange(0.0, LENGTH + 1.0, SPACING), np.arange(0.0, WIDTH + 1.0, SPACING), indexing="ij")
    length = np.exp(rng.uniform(math.log(SHORTEST), math.log(LONGEST), WAVES))
    heading, phase = rng.uniform(0.0, 2.0 * math.pi, (2, WAVES))
    z, slope = np.zeros_like(x), np.zeros_like(x)
    for wave, angle, shift in zip(2.0 * math.pi / length, heading, phase, strict=True):
        argument = wave * (x * math.cos(angle) + y * math.sin(angle)) + shift
        z += np.sin(argument) / wave  # every wave as steep as the others
        slope += math.cos(angle) * np.cos(argument)
    z *= math.tan(STEEPNESS) / np.max(np.abs(slope))
    return z


def packed(heights: np.ndarray) -> bytes:
    """The bytes of the archive, the same at every call."""
    arrays = {
        "height": np.round(heights / STEP).astype(np.int16) * np.float32(STEP),
        "spacing": np.array([SPACING, SPACING]),
        "origin": np.array([-START, -0.5 * WIDTH]),
    }
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, array in arrays.items():
            part = io.BytesIO()
            np.lib.format.write_array(part, array, version=(1, 0))
            archive.writestr(
                zipfile.ZipInfo(f"{name}.npy", (2019, 1, 1, 0, 0, 0)), part.getvalue(), zipfile.ZIP_DEFLATED
            )
    return made.getvalue()


if __name__ == "__main__":
    PATH.write_bytes(packed(rolling_hill()))
