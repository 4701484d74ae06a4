"""Every failure a user can meet, as one base class whose subclasses carry the evidence and an exit code.

`str(error)` is always one line that names the thing, its value, what is allowed and what to do.
"""

from __future__ import annotations

import math
from pathlib import Path


def one_line(text: object, limit: int = 400) -> str:
    """Return `text` on one line, with runs of white space collapsed and at most `limit` characters."""
    line = " ".join(str(text).split())
    return line if len(line) <= limit else line[: limit - 3] + "..."


def show_value(value: object) -> str:
    """Return a short one-line form of a value for a message (strings quoted, at most 60 characters)."""
    if isinstance(value, str):
        return one_line(f'"{value}"', 60)
    try:
        return one_line(repr(value), 60)
    except ValueError:  # Python does not write out whole numbers of thousands of digits
        return "a huge number"
    except RecursionError:
        return "a deeply nested value"


def show_path(path: object) -> str:
    """Return a path for a message; of a very long one its end, so that the rest of the line is not cut off."""
    shown = str(path)
    return shown if len(shown) <= 200 else "..." + shown[-197:]


class SkiAddonError(Exception):
    """Base of all failures this library raises on purpose; `exit_code` is the command line's answer."""

    exit_code = 1

    def __init__(self, message: str) -> None:
        super().__init__(one_line(message))


class SpecError(SkiAddonError):
    """A run document is wrong: `field` has `value`, which is outside `allowed`; `hint` says what to do.

    Pass `problem` for another verb than "is outside" (for instance "is not one of"), and `value=None` when there is
    no value to show (an unknown or missing key).
    """

    exit_code = 2

    def __init__(
        self, field: str, value: object = None, allowed: str = "", hint: str = "", *, problem: str = "is outside"
    ) -> None:
        self.field = field
        self.value = value
        self.allowed = allowed
        self.hint = hint
        self.problem = problem
        self.source = ""
        shown = "" if value is None else f" = {show_value(value)}"
        message = " ".join(part for part in (f"{field}{shown}", problem, allowed) if part)
        super().__init__(f"{message}: {hint}" if hint else message)

    def in_source(self, source: str) -> SpecError:
        """Return the same error naming the document it was found in (for instance `run.toml line 7`)."""
        named = SpecError(self.field, self.value, self.allowed, self.hint, problem=self.problem)
        named.source = source
        named.args = (one_line(f"{show_path(source)}: {self.args[0]}"),)
        return named


class PlanInfeasible(SkiAddonError):  # noqa: N818 - the name says what happened
    """The asked track cannot be skied: `place` says where, `speed` [m/s] is one that would work there (or None)."""

    exit_code = 2

    def __init__(self, place: str, speed: float | None, reason: str) -> None:
        self.place = place
        self.speed = speed
        self.reason = reason
        remedy = "" if speed is None else f"; a speed of {math.floor(10 * speed) / 10:.1f} m/s there would work"
        super().__init__(f"the track cannot be skied at {place}: {reason}{remedy}")


class TerrainError(SkiAddonError):
    """Data make no ground: `what` (a grid, a file) has a `problem`, at `index` with `value` if it is at one place."""

    exit_code = 2

    def __init__(
        self, what: str, problem: str, hint: str, *, index: tuple[int, ...] = (), value: float | None = None
    ) -> None:
        self.what = what
        self.problem = problem
        self.hint = hint
        self.index = index
        self.value = value
        super().__init__(f"{show_path(what)}: {problem}: {hint}")


class MissingInputError(SkiAddonError):
    """An input file (or shipped preset) does not exist or cannot be read."""

    exit_code = 3

    def __init__(self, what: object, reason: str = "there is no such file") -> None:
        self.what = str(what)
        self.reason = reason
        super().__init__(f"cannot read {show_path(what)}: {reason}")


class RecordingError(SkiAddonError):
    """A recording cannot be read: truncated, not a recording, or of a version this one does not know."""

    exit_code = 3

    def __init__(self, path: str | Path, reason: str) -> None:
        self.path = Path(path)
        self.reason = reason
        super().__init__(f"cannot read the recording {show_path(path)}: {reason}")


class OutputError(SkiAddonError):
    """A result cannot be written where it was asked for."""

    exit_code = 3

    def __init__(self, path: str | Path, reason: str) -> None:
        self.path = Path(path)
        self.reason = reason
        super().__init__(f"cannot write {show_path(path)}: {reason}")


class MissingLibraryError(SkiAddonError):
    """A Python library this step needs is not installed or fails to import."""

    exit_code = 3

    def __init__(self, library: str, needed_for: str, remedy: str = "") -> None:
        self.library = library
        self.needed_for = needed_for
        super().__init__(f"{library} is needed for {needed_for}: {remedy or f'install it with: pip install {library}'}")


class BlenderMissingError(SkiAddonError):
    """Blender's Python module `bpy` is not there, so nothing can be baked or rendered."""

    exit_code = 4

    def __init__(self, needed_for: str = "baking", reason: str = "") -> None:
        self.needed_for = needed_for
        detail = f" ({reason})" if reason else ""
        super().__init__(
            f"Blender is needed for {needed_for}{detail}: run this inside Blender, or install the bpy wheel "
            "(bpy 4.5 for Python 3.11, bpy 5.2 for Python 3.13)"
        )


class SkierFell(SkiAddonError):  # noqa: N818 - the name says what happened
    """The skier fell: `what` touched or left what it must not, `where` [m along the track], `time` [s], and `why`."""

    exit_code = 5
    verb = "the skier fell"

    def __init__(self, what: str, where: float, time: float, why: str) -> None:
        self.what = what
        self.where = where
        self.time = time
        self.why = why
        super().__init__(f"{self.verb} at {time:.2f} s, {where:.1f} m along the track: {what}; {why}")


class SimulationDiverged(SkierFell):
    """The simulation left the range of numbers that mean anything."""

    verb = "the simulation diverged"


class RenderError(SkiAddonError):
    """Blender could not render a picture."""

    exit_code = 7


class Cancelled(SkiAddonError):  # noqa: N818 - not a fault
    """The user stopped the work (Esc, Ctrl+C)."""

    exit_code = 130

    def __init__(self, message: str = "interrupted: no half-written file is left") -> None:
        super().__init__(message)
