"""The command line: `python -m ski_addon` and, inside Blender, `blender --command ski`."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Sequence
from types import FrameType

from . import environment, interrupts
from .errors import Cancelled, SkiAddonError, one_line, show_path
from .parser import BadArguments, build_parser
from .talk import Talk


def main(argv: Sequence[str] | None = None, prog: str = "python -m ski_addon") -> int:
    """Run one command and return its exit code; every failure is exactly one line on stderr."""
    words = sys.argv[1:] if argv is None else list(argv)
    with interrupts.handled_by(_interrupt):
        try:
            arguments = build_parser(prog).parse_args(words)
            return arguments.command(arguments)
        except BadArguments as bad:
            _talk(words).fail(bad.line)
            return 2
        except SystemExit as stop:  # argparse: help, version
            return stop.code if isinstance(stop.code, int) else 2
        except SkiAddonError as error:
            return _fail(words, str(error), error.exit_code)
        except KeyboardInterrupt:
            return _fail(words, str(Cancelled()), Cancelled.exit_code)
        except BrokenPipeError:  # the reader of our output has gone: nothing left to say to it
            sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 - lives until exit
            return 0
        except OSError as error:
            return _fail(words, f"{show_path(error.filename or 'input or output')}: {error.strerror or error}", 3)
        except MemoryError:
            return _fail(words, "not enough memory: shorten the course", 3)
        except Exception as error:
            if environment.is_on(environment.TRACEBACK):
                traceback.print_exc()
            hint = f"(set {environment.TRACEBACK}=1 for details)"
            return _fail(words, f"unexpected {type(error).__name__}: {error} {hint}", 1)


def _fail(words: Sequence[str], message: str, exit_code: int) -> int:
    print(f"ski_addon: {one_line(message)}", file=sys.stderr)
    _talk(words).fail(message)
    return exit_code


def _talk(words: Sequence[str]) -> Talk:
    """Return how failures are told besides, also those of arguments that could not be read."""
    log = next((after for word, after in zip(words, words[1:], strict=False) if word == "--log"), "")
    log = next((word.partition("=")[2] for word in words if word.startswith("--log=")), log)
    openjd = "--openjd" in words or environment.is_on(environment.OPENJD)
    return Talk(json="--json" in words, openjd=openjd, log_file=log or os.environ.get(environment.LOG, ""))


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    """Make a polite kill clean up as Ctrl+C does."""
    raise KeyboardInterrupt
