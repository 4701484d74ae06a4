"""The task of rendering frames of a .blend file, each a picture of its own.

Frames that are there, whole, and made from the same file with the same settings are kept. So a killed task goes on
where it was, and any number of workers can render parts of one film into one folder, in any order.
"""

from __future__ import annotations

import argparse
import dataclasses
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from .. import atomic, interrupts, results
from ..errors import RenderError, SpecError
from ..talk import Talk
from . import keys
from .frame_list import frame_words, read_frames
from .picture import PictureError, flaw, marked
from .task import made_by

FRAME_OPTIONS = ("frames", "engine", "device", "samples", "size", "motion_blur", "denoise")
"""Options of `render` that are for .blend files."""
ENGINES = ("cycles", "workbench")
DEVICES = ("CPU", "CUDA", "OPTIX", "HIP", "METAL", "ONEAPI")
MOST_SAMPLES, LARGEST = 65536, 16384


class Film(Protocol):
    """A .blend file that is open for rendering: it has the frames `first` to `last`."""

    first: int
    last: int

    def render(self, frame: int, target: Path) -> None:
        """Write the picture of `frame` to `target`; raises `RenderError`."""


@dataclass(frozen=True)
class RenderSettings:
    """How frames are rendered; None is as in the file.

    `frames` in ascending order (None: all of the file's); `engine` of `ENGINES`; `device` of `DEVICES`, for Cycles;
    `samples` a pixel; `size` (width, height) [pixels]; `motion_blur` shutter time [frames], 0: none; `denoise`.
    """

    frames: tuple[int, ...] | None = None
    engine: str = "cycles"
    device: str = "CPU"
    samples: int | None = None
    size: tuple[int, int] | None = None
    motion_blur: float | None = None
    denoise: bool | None = None

    @property
    def inputs(self) -> dict[str, Any]:
        """What decides how a frame looks."""
        return {name: value for name, value in dataclasses.asdict(self).items() if name != "frames"}


def read_settings(arguments: argparse.Namespace) -> RenderSettings:
    """Return the settings that were written after `--frames` and so on; raises `SpecError` naming the option."""
    frames = None if arguments.frames is None else tuple(read_frames(arguments.frames))
    engine = arguments.engine or "cycles"
    for option in ("device", "motion_blur", "denoise"):
        if engine != "cycles" and getattr(arguments, option) not in (None, False):
            hint = "leave it out, or use --engine cycles"
            raise SpecError(f"--{option.replace('_', '-')}", hint=hint, problem=f"is not for {engine}")
    return RenderSettings(
        frames=frames,
        engine=engine,
        device=arguments.device or "CPU",
        samples=_whole("--samples", arguments.samples, MOST_SAMPLES),
        size=_size(arguments.size),
        motion_blur=_shutter(arguments.motion_blur),
        denoise=arguments.denoise,
    )


def render_into(
    blend: Path, folder: Path, settings: RenderSettings, talk: Talk, *, redo: bool = False
) -> dict[str, Any]:
    """Render the frames of `blend` that are not in `folder` yet; return what was done.

    Frames that the file does not have are left out. Raises `MissingInputError`, `RenderError`, `OutputError`.
    """
    versions = keys.versions("bpy")
    key = keys.digest(["render", settings.inputs, made_by(blend), versions])
    talk.note(f"render {blend}: key {key[:16]}, seed 0, {keys.one_line_of(versions)}")
    talk.note(f"render {blend}: on {keys.one_line_of(keys.host())}")
    wanted = list(settings.frames or ())
    missing = _missing(wanted, folder, key, talk, redo=redo)
    if missing or settings.frames is None:
        film = results.open_frames(blend, settings)
        if settings.frames is None:
            wanted = list(range(film.first, film.last + 1))
            missing = _missing(wanted, folder, key, talk, redo=redo)
        wanted = _within(film, wanted, blend, talk)
        missing = sorted(set(missing) & set(wanted))
        _render(film, missing, folder, key, talk)
    _tell(folder, wanted, missing, talk)
    return {"folder": str(folder), "key": key, "rendered": missing, "kept": len(wanted) - len(missing)}


def _tell(folder: Path, wanted: list[int], rendered: list[int], talk: Talk) -> None:
    words = frame_words(wanted) or "none"
    if rendered:
        talk.tell(f"{folder}: rendered {len(rendered)} of frames {words}")
    else:
        talk.tell(f"{folder}: frames {words} are up to date")


def frame_path(folder: Path, frame: int) -> Path:
    """Return the file of a frame."""
    return folder / f"frame_{frame:04d}.png"


def frame_key(key: str, frame: int) -> str:
    """Return the key of a frame rendered under `key`."""
    return keys.digest([key, frame])


def _missing(frames: list[int], folder: Path, key: str, talk: Talk, *, redo: bool) -> list[int]:
    """Return the frames that must be rendered; say of those that are there, but not right, why."""
    missing = []
    for frame in frames:
        path = frame_path(folder, frame)
        wrong = "is missing" if redo else flaw(path, frame_key(key, frame))
        if wrong:
            missing.append(frame)
            if path.exists() and not redo:
                talk.tell(f"{path.name} {wrong}: rendered again")
    return missing


def _within(film: Film, frames: list[int], blend: Path, talk: Talk) -> list[int]:
    """Return the frames that the file has; a farm's last part may ask for more."""
    inside = [frame for frame in frames if film.first <= frame <= film.last]
    if outside := [frame for frame in frames if frame not in inside]:
        said = f"{blend.name} has frames {film.first} to {film.last}"
        talk.say(f"{said}: {frame_words(outside)} left out")
    return inside


def _render(film: Film, frames: list[int], folder: Path, key: str, talk: Talk) -> None:
    with talk.progress() as progress, interrupts.at_once(lambda: _stop(folder, talk)):
        for done, frame in enumerate(frames):
            progress(done / len(frames), f"rendering frame {frame}, {done} of {len(frames)} done")
            target = frame_path(folder, frame)
            with atomic.atomic_path(target) as temporary:
                film.render(frame, temporary)
                try:
                    temporary.write_bytes(marked(temporary.read_bytes(), frame_key(key, frame)))
                except PictureError as error:
                    raise RenderError(f"{target} could not be rendered: {error}") from error
            progress((done + 1) / len(frames), f"rendering frame {frame}, {done + 1} of {len(frames)} done")


def _stop(folder: Path, talk: Talk) -> None:
    """Tidy up when an interrupt comes in the middle of a frame."""
    atomic.remove_own(folder, ".frame_")
    talk.fail("interrupted: finished frames are kept")


def _whole(option: str, text: str | None, most: int) -> int | None:
    if text is None:
        return None
    if not text.isdecimal() or not 1 <= int(text) <= most:
        raise SpecError(option, text, f"1..{most}", "give a whole number in that range")
    return int(text)


def _size(text: str | None) -> tuple[int, int] | None:
    if text is None:
        return None
    found = re.fullmatch(r"(\d{1,6})x(\d{1,6})", text)
    if not found or not all(4 <= int(side) <= LARGEST for side in found.groups()):
        raise SpecError("--size", text, f"4x4..{LARGEST}x{LARGEST}", "write for instance 1920x1080")
    return int(found[1]), int(found[2])


def _shutter(text: str | None) -> float | None:
    if text is None:
        return None
    try:
        shutter = float(text)
    except ValueError:
        shutter = -1.0
    if not 0.0 <= shutter <= 2.0:
        raise SpecError("--motion-blur", text, "0..2 frames", "give the time the shutter is open; 0 is no blur")
    return shutter
