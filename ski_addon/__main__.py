"""`python -m ski_addon`."""

from __future__ import annotations

import sys

if __name__ == "__main__":
    try:
        from .cli import main

        sys.exit(main())
    except KeyboardInterrupt:  # before or after the command itself
        sys.stderr.write("ski_addon: interrupted: nothing was written\n")
        sys.exit(130)
