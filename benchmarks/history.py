"""The history: ratios to the calibration loop, an entry a line in `benchmarks/history.jsonl`, so that a change shows.

An entry is `date`, `commit` (short), `cpu`, `python`, `numpy`, `quick` (fewer rounds), `ratios` by key and a `note`.
What is measured is compared with the last one from the same kind of processor, or, without one, with the last of all.
"""

from __future__ import annotations

import datetime
import json
import platform
import re
import subprocess
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measuring import ROOT, WORSE, WORSE_ELSEWHERE, Measurement
from ski_addon.atomic import write_text

FILE = ROOT / "benchmarks" / "history.jsonl"


class HistoryError(Exception):
    """The history cannot be read; the text is one line that says where and what to do."""


@dataclass(frozen=True)
class Entry:
    """What was measured once: where, with what, and the ratios to the calibration loop by key."""

    date: str
    commit: str
    cpu: str
    python: str
    numpy: str
    quick: bool
    ratios: dict[str, float]
    note: str = ""

    @property
    def title(self) -> str:
        """One line that names the entry."""
        return f"{self.date}, {self.commit}, {self.cpu}, Python {self.python}, numpy {self.numpy}"

    @property
    def limit(self) -> float:
        """By how much a ratio measured here and now may exceed this entry's."""
        alike = self.cpu == cpu() and self.python.split(".")[:2] == platform.python_version().split(".")[:2]
        return WORSE if alike else WORSE_ELSEWHERE


def read(path: Path = FILE) -> list[Entry]:
    """Return all entries, oldest first; raises `HistoryError`. A file that is not there has none."""
    if not path.exists():
        return []
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as problem:
        raise HistoryError(f"{path}: it cannot be read ({getattr(problem, 'strerror', None) or problem})") from None
    entries = []
    for index, text in enumerate(lines, 1):
        if text.strip():
            try:
                entries.append(_entry(json.loads(text)))
            except (ValueError, TypeError, AttributeError) as problem:
                reason = " ".join(str(problem).split())[:80]
                hint = "mend or remove that line"
                raise HistoryError(f"{path}, line {index}: it is no entry of a history ({reason}); {hint}") from None
    return entries


def _entry(document: dict[str, Any]) -> Entry:
    entry = Entry(**document)
    return Entry(**{**asdict(entry), "ratios": {str(key): float(value) for key, value in entry.ratios.items()}})


def record(rows: Sequence[Measurement], quick: bool, path: Path = FILE, note: str = "") -> Entry:
    """Append an entry of `rows` to the history and return it.

    Raises `HistoryError` for a history that is damaged, `OutputError` where it cannot be written: it stays as it was.
    """
    read(path)
    entry = Entry(
        datetime.date.today().isoformat(),
        commit(),
        cpu(),
        platform.python_version(),
        np.__version__,
        quick,
        {row.key: float(f"{row.ratio:.4g}") for row in rows if row.ratio is not None},
        note,
    )
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    write_text(path, "\n".join([*lines, json.dumps(asdict(entry), ensure_ascii=False)]) + "\n")
    return entry


def last(entries: Sequence[Entry], processor: str) -> Entry | None:
    """Return the last entry of a kind of processor, or else the last of all, or None."""
    same = [entry for entry in entries if entry.cpu == processor]
    found = same or list(entries)
    return found[-1] if found else None


def worse(rows: Sequence[Measurement], before: Entry | None) -> list[tuple[Measurement, float]]:
    """Return the rows that are worse than those of `before`, each with the factor."""
    if before is None:
        return []
    ratios, limit = before.ratios, before.limit
    return [(row, row.change(ratios[row.key]) or 0.0) for row in rows if row.worse(ratios.get(row.key), limit)]


def better_of(rows: Sequence[Measurement], again: Sequence[Measurement]) -> list[Measurement]:
    """Return `rows` with those that were measured again at a lower ratio replaced."""
    new = {row.key: row for row in again}
    return [_lower(row, new.get(row.key)) for row in rows]


def _lower(row: Measurement, other: Measurement | None) -> Measurement:
    if other is None or other.ratio is None or row.ratio is None:
        return row
    return other if other.ratio < row.ratio else row


def commit() -> str:
    """Return the short hash of what is checked out, with a + if files differ from it; "unknown" without git."""
    try:
        command = ["git", "-C", str(ROOT), "rev-parse", "--short", "HEAD"]
        short = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
        changed = subprocess.run(["git", "-C", str(ROOT), "diff", "--quiet", "HEAD"], check=False).returncode != 0
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return short + ("+" if changed else "")


def cpu() -> str:
    """Return the kind of processor, not whose it is."""
    info = Path("/proc/cpuinfo")
    found = cpu_kind(info.read_text()) if info.exists() else ""
    return found or platform.processor() or platform.machine()


def cpu_kind(info: str) -> str:
    """Return the name, family, model and width of vectors in the text of /proc/cpuinfo; "" where there is no name.

    The name alone is that of many generations, and what the loop of matrix products takes depends on the vectors.
    """
    fields = {
        key: re.search(rf"^{key}\s*:\s*(.+)$", info, re.MULTILINE) for key in ("model name", "cpu family", "model")
    }
    name, family, model = (found.group(1).strip() if found else "" for found in fields.values())
    wide = ", AVX-512" if re.search(r"^flags\s*:.*\bavx512f\b", info, re.MULTILINE) else ""
    return f"{name} (family {family}, model {model}{wide})" if name and family and model else name
