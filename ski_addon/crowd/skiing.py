"""Skiing one member: planned and simulated in this process, its recording written whole, what it took measured."""

from __future__ import annotations

import json
import os
import time
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import archive
from ..errors import Cancelled, RecordingError
from .members import Member
from .tracks import Way, way_of

FINISHED = "finished"
CHUNK_SECONDS = 0.1
"""Simulated time between two looks at whether to stop [s]."""


@dataclass(frozen=True)
class Outcome:
    """What became of a member that was skied, or found already skied (`kept`).

    `status` as in a recording, with `detail` of a fall; the `way` that was skied; simulated and waiting time [s];
    size of its recording [bytes]; the process, and the most memory it has had so far [bytes] (None: not known).
    """

    index: int
    status: str
    detail: str
    way: Way
    simulated_s: float
    wall_s: float
    recording_bytes: int
    kept: bool
    process: int
    memory_bytes: int | None


def recording_name(index: int) -> str:
    """Return the name of the file of the member `index` (from 0)."""
    return f"member_{index + 1:03d}.npz"


def recordings_in(folder: Path) -> list[Path]:
    """Return the recordings of members in `folder`, of whatever crowd."""
    return sorted(folder.glob("member_[0-9]*.npz"))


def ski_member(member: Member, folder: Path, stop: Callable[[], bool] = lambda: False) -> Outcome:
    """Simulate `member` to its end and write its recording into `folder`; one that is there already is kept.

    Raises `Cancelled`, with nothing written, when `stop` says so, and `OutputError`.
    """
    from ..pipeline import make_plan, start_simulation

    target = folder / recording_name(member.index)
    kept = kept_outcome(member, folder)
    if kept is not None:
        return kept
    begin = time.perf_counter()
    if stop():
        raise Cancelled
    simulation = start_simulation(make_plan(member.spec))
    chunk = max(int(CHUNK_SECONDS / simulation.time_step), 1)
    while simulation.advance(chunk):
        if stop():
            raise Cancelled
    recording = simulation.recording()
    recording.save(target)
    return Outcome(
        index=member.index,
        status=recording.status,
        detail=_detail(recording.header),
        way=way_of(recording.time, recording.com, float(recording.time[-1])),
        simulated_s=recording.duration,
        wall_s=time.perf_counter() - begin,
        recording_bytes=target.stat().st_size,
        kept=False,
        process=os.getpid(),
        memory_bytes=peak_memory(),
    )


def kept_outcome(member: Member, folder: Path) -> Outcome | None:
    """Return what became of `member` in an earlier run, or None if there is no whole recording of just that member.

    All bytes are checked, but only the places are kept.
    """
    path = folder / recording_name(member.index)
    try:
        return _read_kept(member, path)
    except (*archive.DAMAGE, KeyError, TypeError, zipfile.BadZipFile):
        return None


def check_whole(path: Path) -> None:
    """Raise `RecordingError` unless the file of a recording is there and all its bytes are as they were written."""
    try:
        with zipfile.ZipFile(path) as members:
            damaged = members.testzip()
    except FileNotFoundError:
        raise RecordingError(path, "there is no such file; simulate the crowd again") from None
    except (*archive.DAMAGE, zipfile.BadZipFile) as problem:
        raise RecordingError(path, f"it is damaged ({problem}); simulate the crowd again") from None
    if damaged:
        raise RecordingError(path, f"{Path(damaged).stem} in it is damaged; simulate the crowd again")


def _read_kept(member: Member, path: Path) -> Outcome | None:
    from ..simulation.recording import array_names
    from ..simulation.versions import library_versions

    with zipfile.ZipFile(path) as members:
        header = json.loads(archive.read_member(members, "header").tobytes())
        if header["spec_hash"] != member.spec.content_hash() or header["versions"] != library_versions():
            return None
        moments, place = archive.read_member(members, "time"), archive.read_member(members, "com")
        whole = set(members.namelist()) >= {f"{name}.npy" for name in array_names()}
    if not len(moments) or not whole or header["status"] == "cancelled":
        return None
    with zipfile.ZipFile(path) as members:
        if members.testzip():
            return None
    return Outcome(
        index=member.index,
        status=str(header["status"]),
        detail=_detail(header),
        way=way_of(moments, place, float(moments[-1])),
        simulated_s=float(moments[-1] + header["time_step"]),
        wall_s=0.0,
        recording_bytes=path.stat().st_size,
        kept=True,
        process=os.getpid(),
        memory_bytes=None,
    )


def peak_memory() -> int | None:
    """Return the most memory this process has held at once [bytes], or None where the system does not tell.

    Linux's own count comes first: that of getrusage begins with the size of the process that started this one.
    """
    try:
        for line in Path("/proc/self/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024
    except (OSError, ValueError):
        pass
    try:
        import resource
        import sys
    except ImportError:  # Windows
        return None
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return int(most) if sys.platform == "darwin" else int(most) * 1024


def clean_up(folder: Path) -> None:
    """Remove the unfinished files that killed processes left in the folder of a crowd."""
    for path in folder.glob(".member_*.tmp.npz"):
        path.unlink(missing_ok=True)


def _detail(header: dict[str, Any]) -> str:
    said = header.get("status_detail") or {}
    return f"{said['what']} at {said['time']:.2f} s; {said['why']}" if said else ""
