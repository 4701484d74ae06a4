"""Thousands of tries over several processes, and a table of what they led to."""

from __future__ import annotations

import collections
import io
import resource
import shutil
import tempfile
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from ski_addon.pipeline import make_plan, start_simulation
from ski_addon.spec import RunSpec, find_document, preset_folder
from tests.fuzz import mutations, trying
from tests.fuzz.trying import BAD, Outcome, Stock

MEMORY = 6 * 2**30
"""Address space of a process [bytes]: who asks for more gets a MemoryError, which is a traceback."""
SHARES = {"run": 0.5, "document": 0.2, "recording": 0.15, "heights": 0.15}
"""How many of the tries are of what kind."""
_stock: Stock | None = None


def make_stock(folder: Path) -> Stock:
    """Make whole files of every kind, and the folder `out` that alone may be written into."""
    (folder / "out").mkdir()
    presets = preset_folder("runs").parent
    documents = {
        f"{path.parent.name}/{path.name}": path.read_bytes()
        for path in sorted(presets.glob("*/*.toml"))
        if path.parent.name != "courses"
    }
    spec = RunSpec.from_toml(find_document("paper_main")).with_overrides({"course.turn_count": 1})
    simulation = start_simulation(make_plan(spec))
    simulation.advance(60)
    simulation.recording("finished").save(folder / "whole.npz")
    recording = (folder / "whole.npz").read_bytes()
    (folder / "whole.npz").unlink()
    return Stock(folder, documents, recording, _heights(presets))


def _heights(presets: Path) -> dict[str, bytes]:
    grid = np.linspace(3.0, 0.0, 12)[:, None] + np.zeros(9)
    npy = io.BytesIO()
    np.save(npy, grid)
    table = "\n".join(" ".join(f"{value:.3f}" for value in row) for row in grid)
    ascii_grid = f"ncols 9\nnrows 12\nxllcorner 0\nyllcorner 0\ncellsize 2\nNODATA_value -9999\n{table}\n"
    return {
        "hill.npz": (presets / "terrain" / "rolling_hill.npz").read_bytes(),
        "grid.npy": npy.getvalue(),
        "grid.txt": table.encode(),
        "grid.asc": ascii_grid.encode(),
        "grid.png": mutations.png(9, 12),
    }


def one(task: tuple[str, int]) -> Outcome:
    """Make one try, in the process that `begin` has prepared."""
    kind, seed = task
    if kind == "run":
        return trying.try_run(seed)
    assert _stock is not None
    return {"document": trying.try_document, "recording": trying.try_recording, "heights": trying.try_heights}[kind](
        seed, _stock
    )


def begin(folder: Path | None = None) -> None:
    """Prepare this process: a folder of its own, and a bound on its memory."""
    global _stock
    if folder is None:
        folder = Path(tempfile.mkdtemp(prefix="ski_fuzz_"))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, resource.RLIM_INFINITY))
    _stock = make_stock(folder)


def tasks(runs: int, seed: int) -> list[tuple[str, int]]:
    """Return what is tried, the kinds in turn."""
    found = []
    for kind, share in SHARES.items():
        found += [(kind, seed + k) for k in range(round(runs * share))]
    return sorted(found, key=lambda task: task[1])


def in_processes(all_tasks: list[tuple[str, int]], jobs: int, told: Callable[[int], None]) -> Iterable[Outcome]:
    """Yield the outcome of each task, made by `jobs` processes."""
    with ProcessPoolExecutor(jobs, get_context("spawn"), initializer=begin) as pool:
        for done, outcome in enumerate(pool.map(one, all_tasks, chunksize=8), start=1):
            told(done)
            yield outcome


def strangers(folder: Path) -> list[str]:
    """Return what is in a stock's folder, or beside it, that nobody should have written."""
    inside = [path.name for path in folder.iterdir() if path.name != "out"]
    return inside + [path.name for path in folder.parent.glob("escaped*")]


def table(outcomes: Iterable[Outcome]) -> str:
    """Return how often each kind of try led to what."""
    counts: dict[str, collections.Counter[str]] = collections.defaultdict(collections.Counter)
    for outcome in outcomes:
        counts[outcome.kind.split()[0]][outcome.what] += 1
    columns = sorted({what for row in counts.values() for what in row} | set(BAD))
    lines = [f"{'':12}" + "".join(f"{column:>15}" for column in columns)]
    lines += [f"{kind:12}" + "".join(f"{row[column]:15}" for column in columns) for kind, row in counts.items()]
    return "\n".join(lines)


def clean_up() -> list[str]:
    """Remove the folders of processes that have ended; return what should not have been in them."""
    found = []
    for folder in Path(tempfile.gettempdir()).glob("ski_fuzz_*"):
        found += strangers(folder)
        shutil.rmtree(folder, ignore_errors=True)
    return found
