"""Which pictures there are, and how one becomes a file."""

from __future__ import annotations

import difflib
import importlib
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import atomic
from ..errors import SpecError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI = 100


@dataclass(frozen=True)
class Picture:
    """One picture: `title` says what the paper shows there; `module` of this package and `function` in it draw it, into
    a figure of `size` (width, height) [inches], at `DPI` dots an inch.
    """

    title: str
    module: str
    function: str
    size: tuple[float, float] = (10.0, 5.0)

    @property
    def draw(self) -> Callable[[Figure], None]:
        """The function that draws into an empty matplotlib figure."""
        drawer: Callable[[Any], None] = getattr(importlib.import_module(f".{self.module}", __package__), self.function)
        return drawer


PICTURES: dict[str, Picture] = {
    "figure_06": Picture("Three ellipses and their tracks", "swings", "draw_three_ellipses", (10.0, 5.6)),
    "figure_07": Picture("Controlling ellipses", "ellipses", "draw_controlling_ellipses", (10.0, 5.0)),
    "figure_08": Picture("A change of direction by a short turn", "swings", "draw_direction_change", (10.0, 5.0)),
    "figure_10": Picture("Four tracks by phase control", "tracks", "draw_four_tracks", (10.0, 9.0)),
    "figure_16": Picture("Paths between trees", "paths", "draw_trees", (11.0, 2.3)),
    "figure_17": Picture("Slalom turns found by planning", "paths", "draw_gates", (11.0, 1.95)),
    "figure_18": Picture("Round the corner of a street", "paths", "draw_corner", (5.6, 7.0)),
    "photo_5": Picture("Past potholes", "paths", "draw_potholes", (11.0, 2.5)),
    "section_7_alpine": Picture("An alpine skier through a swing", "poses", "draw_alpine", (11.0, 4.0)),
    "section_7_telemark": Picture("A telemark skier through a swing", "poses", "draw_telemark", (11.0, 4.0)),
    "section_7_snowboard": Picture("A snowboarder through a swing", "poses", "draw_snowboard", (11.0, 4.0)),
    "section_7_bicycle": Picture("A cyclist through a swing", "poses", "draw_bicycle", (11.0, 4.0)),
}
"""Name of the file without its suffix -> picture, in the paper's order."""


def find_pictures(names: Sequence[str]) -> dict[str, Picture]:
    """Return the pictures of these names, or all if there are none; an unknown name raises `SpecError`."""
    for name in names:
        if name not in PICTURES:
            padded = re.sub(r"^figure_?(\d)$", r"figure_0\1", name[:100])
            nearest = difflib.get_close_matches(padded, PICTURES, n=1, cutoff=0.0)[0]
            raise SpecError(name, problem="is not a picture of the gallery", hint=f"did you mean {nearest}?")
    return {name: PICTURES[name] for name in (names or PICTURES)}


def draw_picture(picture: Picture) -> Figure:
    """Return a picture as a matplotlib figure (drawn without a display)."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from ..report.style import RC

    with matplotlib.rc_context(RC):
        figure = Figure(figsize=picture.size, dpi=DPI, facecolor="white", layout="constrained")
        FigureCanvasAgg(figure)
        picture.draw(figure)
    return figure


def save_picture(picture: Picture, target: Path) -> None:
    """Draw a picture and write it as one file; a PNG has few colours, and is small."""
    import matplotlib

    from ..report.style import RC

    figure = draw_picture(picture)
    with atomic.atomic_path(target) as temporary, matplotlib.rc_context(RC):
        figure.savefig(temporary, dpi=DPI)
        if target.suffix == ".png":
            _in_few_colours(temporary)


def _in_few_colours(path: Path) -> None:
    """Make a PNG one of 64 colours."""
    from PIL import Image  # matplotlib writes its pictures with it

    with Image.open(path) as image:
        small = image.convert("RGB").quantize(64)
    small.save(path, optimize=True)
