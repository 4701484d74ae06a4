"""What a command says, and where: results on stdout, progress where it does not disturb them."""

from __future__ import annotations

import contextlib
import json
import math
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TextIO

from .errors import one_line
from .progress import OpenJobProgress, ProgressDisplay

SUMMARY_LINES = (
    ("duration_s", "skied", "{:.2f} s"),
    ("speed_max", "fastest", "{:.1f} m/s"),
    ("inclination_max_deg", "most lean", "{:.0f} degrees"),
    ("edge_angle_max_deg", "most edging", "{:.0f} degrees"),
    ("snow_force_max_bw", "most snow force", "{:.2f} body weights"),
    ("torque_ratio_max", "hardest joint", "{:.0%} of its strength"),
    ("ski_error_max_m", "skis off the track", "{:.2g} m at most"),
    ("step_us_median", "a step took", "{:.0f} us"),
)
"""Keys of a summary shown on a screen, with their label and format."""


@dataclass(frozen=True)
class Talk:
    """How a command talks: with `json` only JSON goes to stdout, with `quiet` only failures are said.

    With `openjd`, progress, notes and failures are said as Open Job Description reads them: on stdout, or on stderr
    where stdout is to hold JSON. `log_file` is one that notes and failures are added
    to.
    """

    json: bool = False
    quiet: bool = False
    openjd: bool = False
    log_file: str = ""

    def say(self, line: str) -> None:
        """Say one line for a person."""
        if not (self.json or self.quiet):
            write_line(sys.stdout, line)

    def log(self, line: str) -> None:
        """Pass on one line of another program: on stderr where stdout is to hold JSON."""
        if not self.quiet:
            write_line(sys.stderr if self.json else sys.stdout, line)

    def give(self, result: object) -> None:
        """Give the machine-readable result."""
        if self.json:
            sys.stdout.write(json_text(result))
            sys.stdout.flush()

    def note(self, line: str) -> None:
        """Note one line for whoever looks after the work later: in the log, and in that of a farm."""
        if self.openjd:
            write_line(self._farm_stream(), line)
        self._log(line)

    def tell(self, line: str) -> None:
        """Say one line, to a person and to the log."""
        self.say(line)
        self._log(line)

    def fail(self, message: str) -> None:
        """Note a failure, which is said elsewhere, for a farm and in the log."""
        if self.openjd:
            write_line(self._farm_stream(), f"openjd_fail: {one_line(message)}")
        self._log(f"failed: {one_line(message)}")

    def progress(self) -> ProgressDisplay | OpenJobProgress:
        """Return a progress display: a bar on a terminal; plain lines on stdout, unless that is to hold JSON."""
        return OpenJobProgress(self._farm_stream()) if self.openjd else ProgressDisplay(self._progress_stream())

    def _farm_stream(self) -> TextIO:
        return sys.stderr if self.json else sys.stdout

    def _log(self, line: str) -> None:
        if not self.log_file:
            return
        moment = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
        # a log that cannot be written is no reason to lose the work
        with contextlib.suppress(OSError), open(self.log_file, "a", encoding="utf-8") as stream:
            stream.write(f"{moment} {line}\n")

    def _progress_stream(self) -> TextIO | None:
        if self.quiet:
            return None
        if sys.stderr.isatty():
            return sys.stderr
        return None if self.json else sys.stdout


def write_line(stream: TextIO, line: str) -> None:
    """Write a line; letters that the stream's encoding does not have are written as their codes."""
    encoding = getattr(stream, "encoding", None) or "utf-8"
    stream.write(line.encode(encoding, "backslashreplace").decode(encoding) + "\n")
    stream.flush()


def summary_lines(summary: Mapping[str, Any]) -> list[str]:
    """Return the lines of a summary that a person wants to see."""
    width = max(len(label) for _, label, _ in SUMMARY_LINES)
    known = [(label, form, summary.get(key)) for key, label, form in SUMMARY_LINES]
    lines = [f"  {label.ljust(width)}  {form.format(value)}" for label, form, value in known if value is not None]
    return [*lines, f"  {'gates'.ljust(width)}  {gate_words(summary)}"] if summary.get("gates") else lines


def gate_words(summary: Mapping[str, Any]) -> str:
    """Return how the gates of a course were passed: how many, how near to their poles, and which ones were missed."""
    reached = [value is not None for value in summary["gate_distances_m"]]
    missed = set(summary["gates_missed"])
    near = [value for k, value in enumerate(summary["gate_distances_m"], 1) if value is not None and k not in missed]
    words = f"{summary['gates_passed']} of {summary['gates']} passed"
    if near:
        words += f", {min(near):.2f} to {max(near):.2f} m from their poles"
    for label, found in (("missed", reached), ("not reached", [not value for value in reached])):
        numbers = [k for k in summary["gates_missed"] if found[k - 1]]
        words += f"; {label}: {_number_words(numbers)}" if numbers else ""
    return words


def _number_words(numbers: Sequence[int]) -> str:
    """Return ascending whole numbers in words; three and more in a row as a range."""
    groups: list[list[int]] = []
    for number in numbers:
        if groups and number == groups[-1][-1] + 1:
            groups[-1].append(number)
        else:
            groups.append([number])
    return ", ".join(f"{g[0]} to {g[-1]}" if len(g) > 2 else ", ".join(map(str, g)) for g in groups)


def json_text(value: object) -> str:
    """Return indented JSON with a newline at the end; numbers that JSON does not know become null."""
    return json.dumps(_plain(value), indent=2, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):  # numpy
        return _plain(value.tolist())
    if isinstance(value, Mapping):
        return {str(key): _plain(inner) for key, inner in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [_plain(inner) for inner in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value if isinstance(value, str | int | float | bool | None) else str(value)
