"""`python -m ski_addon.report RECORDING PICTURE`: the report that the extension shows, as a PNG file."""

from __future__ import annotations

import argparse
import sys

from ..errors import SkiAddonError
from ..simulation import Recording
from .plots import SIZE, draw_report
from .png import save_png


def main(words: list[str] | None = None) -> int:
    """Draw the report that `words` (default: the command line) ask for; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m ski_addon.report", description="draw the report of a recording")
    parser.add_argument("recording", help="recording.npz of a run")
    parser.add_argument("picture", help="PNG file to write")
    parser.add_argument("--size", nargs=2, type=int, default=SIZE, metavar=("WIDTH", "HEIGHT"), help="in pixels")
    arguments = parser.parse_args(words)
    try:
        save_png(draw_report(Recording.load(arguments.recording), tuple(arguments.size)), arguments.picture)
    except SkiAddonError as error:
        sys.stderr.write(f"{error}\n")
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
