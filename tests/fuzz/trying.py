"""One try each: what a random run or a damaged file led to, as one word, and more if it should not have."""

from __future__ import annotations

import random
import signal
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ski_addon.errors import SkiAddonError, SkierFell
from ski_addon.pipeline import make_plan, start_simulation
from ski_addon.simulation import Recording
from ski_addon.spec import RunSpec, estimate
from ski_addon.spec.sections import SlopeSpec
from ski_addon.terrain import build_terrain

from . import mutations
from .random_specs import random_spec

SECONDS = 60
"""A try that takes longer hangs."""
SKIED = 0.25
"""Time that a random run is skied [s]."""
LONG = 90.0
"""Runs that last longer [s] are previewed and estimated, but not planned: ten thousand are to be tried."""
SHAPES = ("(10**12,)", "(1000000000000,)", "(-1,)", "(2147483647, 37)", "()", "(0,)", "'x'", "(1e9,)")
"""What an array in a damaged file says of its size."""
BAD = ("traceback", "hang", "mumble")
"""Outcomes that are faults of ours."""


@dataclass(frozen=True)
class Outcome:
    """What try number `seed` led to: "finished", "refused", one of `BAD`, ...; `detail` for a person."""

    kind: str
    seed: int
    what: str
    detail: str = ""


class Hang(BaseException):
    """The alarm; not an Exception, so that nothing on the way catches it."""


def attempt(kind: str, seed: int, act: Callable[[], str]) -> Outcome:
    """Call `act` with an alarm set, and return what it says or how it failed."""

    def ring(*_: object) -> None:
        raise Hang

    before = signal.signal(signal.SIGALRM, ring)
    signal.alarm(SECONDS)
    try:
        return Outcome(kind, seed, act())
    except SkierFell as error:
        return _told(kind, seed, "fell", error)
    except SkiAddonError as error:
        return _told(kind, seed, "refused", error)
    except Hang:
        return Outcome(kind, seed, "hang", f"longer than {SECONDS} s")
    except BaseException:
        return Outcome(kind, seed, "traceback", traceback.format_exc())
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def _told(kind: str, seed: int, what: str, error: Exception) -> Outcome:
    text = str(error)
    return Outcome(kind, seed, what if text.strip() and "\n" not in text else "mumble", text)


def try_run(seed: int) -> Outcome:
    """A random run: its document goes round, and it is planned and skied for a moment."""
    return attempt("run", seed, lambda: _ski(seed))


def _ski(seed: int) -> str:
    spec = random_spec(seed)
    if spec is None:
        return "contradictory"
    again = RunSpec.from_text(spec.to_toml())
    if again != spec or again.content_hash() != spec.content_hash():
        raise AssertionError("the run document does not go round")
    if estimate(spec).too_large or estimate(spec).simulated_seconds > LONG:
        return "too long"
    if spec.figure.kind != "alpine":
        from ski_addon.turning.preview import preview_motion

        preview_motion(spec)
        return "previewed"
    simulation = start_simulation(make_plan(spec))
    simulation.advance(int(SKIED / simulation.time_step))
    recording = simulation.recording()
    if simulation.fall is not None:
        return "fell"
    if not all(map(_finite, (recording.qpos, recording.tau, recording.snow_force))):
        raise AssertionError("the recording has numbers that are none")
    return "finished"


def _finite(values: Any) -> bool:
    import numpy as np

    return bool(np.isfinite(values).all())


@dataclass(frozen=True)
class Stock:
    """Whole files of every kind that is read, to be damaged; and a `folder` to put damaged ones into."""

    folder: Path
    documents: dict[str, bytes]
    recording: bytes
    heights: dict[str, bytes]


def try_document(seed: int, stock: Stock) -> Outcome:
    """A damaged run document, crowd, preset part or bone map."""
    chance = random.Random(seed)
    name = chance.choice(sorted(stock.documents))
    path = stock.folder / "out" / "damaged.toml"
    path.write_bytes(mutations.mutated(stock.documents[name], chance))

    def act() -> str:
        if name.startswith("crowds/"):
            from ski_addon.crowd import read_crowd

            read_crowd(path)
        elif name.startswith("bone_maps/"):
            from ski_addon.animation.bone_map import BoneMap

            BoneMap.load(path)
        elif name.startswith("runs/"):
            RunSpec.from_toml(path)
        else:
            RunSpec().with_part(path)
        return "read"

    return attempt(f"document {name}", seed, act)


def try_recording(seed: int, stock: Stock) -> Outcome:
    """A damaged recording."""
    chance = random.Random(seed)
    path = stock.folder / "out" / "damaged.npz"
    names = mutations.members(stock.recording)
    how = chance.randrange(6)
    if how == 0:
        content = mutations.with_member(stock.recording, chance.choice(names), mutations.pickled_npy(victim(stock)))
    elif how == 1:
        shape = chance.choice(
            ("(10**12,)", "(1000000000000,)", "(-1,)", "(2147483647, 37)", "()", "(0,)", "'x'", "(1e9,)")
        )
        content = mutations.with_member(stock.recording, chance.choice(names), mutations.huge_npy(shape))
    elif how == 2:
        inside = mutations.mutated(b"\x93NUMPY" + bytes(chance.randrange(256) for _ in range(90)), chance)
        content = mutations.with_member(stock.recording, chance.choice(names), inside)
    elif how == 3:
        content = mutations.with_member(stock.recording, "../../escaped.npy", mutations.huge_npy("(1,)"))
    else:
        content = mutations.mutated(stock.recording, chance)
    path.write_bytes(content)

    def act() -> str:
        Recording.load(path)
        return "read"

    return attempt("recording", seed, act)


def try_heights(seed: int, stock: Stock) -> Outcome:
    """Damaged heights: grids as .npz, .npy, text and pictures."""
    chance = random.Random(seed)
    name = chance.choice(sorted(stock.heights))
    path = stock.folder / "out" / f"damaged{Path(name).suffix}"
    if name.endswith(".png") and chance.random() < 0.3:
        size = chance.choice(((0, 5), (70000, 70000), (2**31 - 1, 2**31 - 1), (5, 0)))
        path.write_bytes(mutations.png(*size, data=b"\x00" * 40))
    elif name.endswith(".npz") and chance.random() < 0.3:
        content = (
            mutations.pickled_npy(victim(stock)) if chance.random() < 0.5 else mutations.huge_npy("(99999, 99999)")
        )
        path.write_bytes(
            mutations.with_member(stock.heights[name], chance.choice(mutations.members(stock.heights[name])), content)
        )
    else:
        path.write_bytes(mutations.mutated(stock.heights[name], chance))

    def act() -> str:
        build_terrain(SlopeSpec(kind="grid", grid_file=str(path)))
        return "read"

    return attempt(f"heights {Path(name).suffix}", seed, act)


def victim(stock: Stock) -> Path:
    """The file that a pickle would write."""
    return stock.folder / "code_was_run"
