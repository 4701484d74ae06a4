"""`python -m ski_addon`."""

from __future__ import annotations

import os
import sys


def _leave(exit_code: int) -> None:
    """End the process; at once if Blender's module was loaded, since some of its versions hang when torn down."""
    if "bpy" in sys.modules:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(exit_code)
    sys.exit(exit_code)


if __name__ == "__main__":
    try:
        from .cli import main

        _leave(main())
    except KeyboardInterrupt:  # before or after the command itself
        sys.stderr.write("ski_addon: interrupted: no half-written file is left\n")
        sys.exit(130)
