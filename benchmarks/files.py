"""Recording files written and read, beside the same bytes raw: `python -m benchmarks --only files`.

The raw bytes go through the same disk, and the same memory of the system before it, in the same run. No ratio to the
calibration loop is judged here, for a disk is no processor.
"""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.measuring import ROOT, How, Measurement, in_turn
from ski_addon.simulation import Recording
from ski_addon.simulation.recording import array_names

SUBJECT = "files"
STEPS = 10_000


def recording_of_noise(steps: int = STEPS) -> Recording:
    """Return a recording of so many steps whose numbers nothing could squeeze."""
    from ski_addon.simulation.recording import COUNTS, SHAPES

    rng = np.random.default_rng(0)
    arrays = {
        name: np.zeros(steps, COUNTS[name]) if name in COUNTS else rng.standard_normal((steps, *SHAPES[name]))
        for name in array_names()
    }
    return Recording({"status": "finished", "time_step": 0.001}, **arrays)


def size(recording: Recording) -> int:
    """Return the bytes of all its arrays."""
    return sum(getattr(recording, name).nbytes for name in array_names())


def measurements(how: How) -> list[Measurement]:
    """Return the rows of writing and reading ten seconds, in megabytes of arrays a second."""
    recording = recording_of_noise()
    content = b"".join(np.ascontiguousarray(getattr(recording, name)).tobytes() for name in array_names())
    megabytes = size(recording) / 1e6
    place = ROOT / "build"
    place.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=place) as folder:
        file, raw = Path(folder) / "run.npz", Path(folder) / "raw"
        functions = {
            "write": lambda: recording.save(file),
            "write raw": lambda: raw.write_bytes(content),
            "read": lambda: Recording.load(file),
            "read raw": lambda: raw.read_bytes(),
        }
        samples = in_turn(functions, how.rounds(15, 7))
    rows = []
    for way in ("write", "read"):
        ratio = samples[way].wall_over(samples[f"{way} raw"])
        beside = {"peer": "raw bytes", "peer_ratio": ratio}
        rows.append(samples[way].rate_row(SUBJECT, way, "MB/s", megabytes, checked=False, **beside))
        raw_row = samples[f"{way} raw"].rate_row(SUBJECT, f"  peer: raw bytes, {way}", "MB/s", megabytes)
        rows.append(replace(raw_row, ratio=None, checked=False))
    return rows
