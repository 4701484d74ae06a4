"""The command line: one parser for everything `python -m ski_addon` does."""

from __future__ import annotations

import argparse
import contextlib
import os
import signal
import sys
import traceback
from collections.abc import Iterator, Sequence
from types import FrameType
from typing import NoReturn, TypeAlias

from . import __version__, commands
from .errors import Cancelled, SkiAddonError, one_line, show_path

TRACEBACK_VARIABLE = "SKI_ADDON_TRACEBACK"
"""Environment variable that adds the traceback to an unexpected failure."""

OVERVIEW = """\
Make ski animation from physics: describe a run in a TOML file, let a skier ski it, and get keyframes.

  python -m ski_addon run giant_slalom -o out              simulate a shipped preset
  python -m ski_addon run my_run.toml -o out               simulate a run of your own
  python -m ski_addon run giant_slalom --set course.turn_radius=18 --part soft -o out
  python -m ski_addon bake out -o skier.blend              make keyframes of it (needs Blender's bpy)

All keys of a run document are explained in docs/run_spec.md."""

EXIT_CODES = """\
exit codes: 0 done, 2 bad arguments or run document, 3 missing input or unwritable output, 4 Blender is missing,
5 the skier fell or the simulation diverged, 7 a picture could not be rendered, 130 interrupted"""


class OneLineParser(argparse.ArgumentParser):
    """An argument parser whose failures are one line on stderr and exit code 2."""

    def error(self, message: str) -> NoReturn:
        """Say what is wrong with the arguments, and leave."""
        self.exit(2, f"{self.prog}: {one_line(message)} (see {self.prog} --help)\n")


def build_parser(prog: str = "python -m ski_addon") -> argparse.ArgumentParser:
    """Return the parser of all commands; the chosen command's function is in `arguments.command`."""
    parser = OneLineParser(
        prog=prog, description=OVERVIEW, epilog=EXIT_CODES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--version", action="version", version=f"Ski Addon {__version__}")
    subparsers = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for add in COMMANDS:
        add(subparsers)
    return parser


def main(argv: Sequence[str] | None = None, prog: str = "python -m ski_addon") -> int:
    """Run one command and return its exit code; every failure is exactly one line on stderr."""
    with _signals_as_interrupt():
        try:
            arguments = build_parser(prog).parse_args(argv)
            return arguments.command(arguments)
        except SystemExit as stop:  # argparse: help, version, bad arguments
            return stop.code if isinstance(stop.code, int) else 2
        except SkiAddonError as error:
            return _fail(str(error), error.exit_code)
        except KeyboardInterrupt:
            return _fail(str(Cancelled()), Cancelled.exit_code)
        except BrokenPipeError:  # the reader of our output has gone: nothing left to say to it
            sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 - lives until exit
            return 0
        except OSError as error:
            return _fail(f"{show_path(error.filename or 'input or output')}: {error.strerror or error}", 3)
        except MemoryError:
            return _fail("not enough memory: shorten the course", 3)
        except Exception as error:
            if os.environ.get(TRACEBACK_VARIABLE):
                traceback.print_exc()
            return _fail(f"unexpected {type(error).__name__}: {error} (set {TRACEBACK_VARIABLE}=1 for details)", 1)


def _fail(message: str, exit_code: int) -> int:
    print(f"ski_addon: {one_line(message)}", file=sys.stderr)
    return exit_code


@contextlib.contextmanager
def _signals_as_interrupt() -> Iterator[None]:
    """Make a polite kill clean up as Ctrl+C does (only the main thread may set signals)."""

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        raise KeyboardInterrupt

    try:
        previous = {number: signal.signal(number, interrupt) for number in (signal.SIGINT, signal.SIGTERM)}
    except ValueError:
        previous = {}
    try:
        yield
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)


_Subparsers: TypeAlias = "argparse._SubParsersAction[OneLineParser]"


def _command(subparsers: _Subparsers, name: str, summary: str, details: str = "") -> argparse.ArgumentParser:
    parser = subparsers.add_parser(
        name,
        help=summary,
        description=f"{summary[0].upper()}{summary[1:]}.{details and chr(10) + details}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.set_defaults(command=getattr(commands, f"{name}_command"), json=False, quiet=False, force=False)
    return parser


def _add_spec(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("spec", metavar="SPEC", help="run document (.toml), or the name of a preset in presets/runs")
    _add_changes(parser)


def _add_changes(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--set",
        dest="changes",
        metavar="KEY=VALUE",
        action="append",
        default=[],
        help="change one key of the run, for instance course.turn_radius=18 or technique.angulation=auto; repeatable",
    )
    parser.add_argument(
        "--part",
        dest="parts",
        metavar="PART",
        action="append",
        default=[],
        help="lay a skier, snow or style over the run: a file, or a name in presets/skiers, snow, styles; repeatable",
    )


def _add_output(parser: argparse.ArgumentParser, metavar: str, text: str, *, required: bool = False) -> None:
    parser.add_argument("-o", "--output", metavar=metavar, required=required, help=text)


def _add_talk(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print the summary as JSON on stdout, and nothing else")
    parser.add_argument("--quiet", action="store_true", help="print no progress and no summary")


def _add_force(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--force", action="store_true", help="start even if the run would take more than 8 GB or an hour of skiing"
    )


def _add_run(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "run",
        "plan, simulate and report a run",
        "Writes spec.toml, recording.npz, summary.json and (with matplotlib) report.png into the folder.",
    )
    _add_spec(parser)
    _add_output(parser, "DIR", "folder for the results", required=True)
    _add_talk(parser)
    _add_force(parser)


def _add_plan(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers, "plan", "plan a run without simulating it", "Says whether the track can be skied, and how fast."
    )
    _add_spec(parser)
    _add_output(parser, "DIR|FILE.json", "also write the planned numbers as JSON (plan.json in a folder)")
    _add_talk(parser)


def _add_simulate(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers, "simulate", "simulate a run", "Writes spec.toml, recording.npz and summary.json into the folder."
    )
    _add_spec(parser)
    _add_output(parser, "DIR", "folder for the results", required=True)
    _add_talk(parser)
    _add_force(parser)


def _add_bake(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "bake",
        "make a .blend file with the skier as keyframes",
        "Needs Blender's Python module bpy. The file opens in plain Blender.",
    )
    parser.add_argument(
        "source", metavar="RECORDING|DIR|SPEC", help="recording.npz, the folder it is in, or a run to simulate first"
    )
    _add_changes(parser)
    _add_output(parser, "FILE.blend", "file to write (skier.blend beside the recording if not given)")
    _add_talk(parser)
    _add_force(parser)


def _add_report(subparsers: _Subparsers) -> None:
    parser = _command(subparsers, "report", "draw the plots of a recording", "Needs matplotlib.")
    parser.add_argument("source", metavar="RECORDING|DIR", help="recording.npz, or the folder it is in")
    _add_output(parser, "FILE.png", "picture to write (report.png beside the recording if not given)")


def _add_render(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "render",
        "render one picture of a recording, with the skier at several instants",
        "Needs Blender's Python module bpy.",
    )
    parser.add_argument("source", metavar="RECORDING|DIR", help="recording.npz, or the folder it is in")
    _add_output(parser, "FILE.png", "picture to write (strobe.png beside the recording if not given)")
    parser.add_argument("--stop", action="store_true", help="show the end of the run, where the skier stops")


def _add_preview(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "preview",
        "animate the figure of a run at once, without simulating it",
        "The figure of any kind (skier, snowboarder, telemark skier, cyclist) as keyframes in preview.blend, or, for\n"
        "FILE.png, in one picture at several instants. Needs Blender's Python module bpy.",
    )
    _add_spec(parser)
    _add_output(parser, "DIR|FILE.blend|FILE.png", "file to write (preview.blend in a folder)", required=True)
    _add_talk(parser)


def _add_validate(subparsers: _Subparsers) -> None:
    parser = _command(subparsers, "validate", "check run documents without running them")
    parser.add_argument("specs", metavar="SPEC", nargs="+", help="run documents (.toml) or names of presets")
    _add_changes(parser)
    parser.add_argument("--json", action="store_true", help="print the findings as JSON on stdout")


def _add_robustness(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "robustness",
        "push the skier of a run in many ways and say what he survives",
        "Every combination of the options below is a run of its own, up to 5 s after the push's end. A course of\n"
        "linked turns is made long enough. Writes robustness.json, robustness.csv and (with matplotlib)\n"
        "robustness.png.",
    )
    _add_spec(parser)
    _add_output(parser, "DIR", "folder for the results", required=True)
    for name, metavar, text in (
        ("forces", "N,N,...", "sizes of the push (50,100,150,200)"),
        ("bodies", "NAME,...", "bodies to push (head,ski.R,abdomen,shank.L)"),
        ("directions", "NAME,...", "left, right, forward, back, up, down (the first four)"),
        ("speeds", "M/S,...", "start speeds of the run (5,9)"),
        ("moments", "NAME,...", "turn = at its apex, transition = between two (both)"),
        ("duration", "SECONDS", "how long a push acts (0.5)"),
        ("jobs", "COUNT", "processes that run at the same time (as many as there are processors)"),
    ):
        parser.add_argument(f"--{name}", metavar=metavar, help=text)
    parser.add_argument(
        "--bisect", action="store_true", help="for each row also find the largest force survived, up to 500 N by 25 N"
    )
    _add_talk(parser)


def _add_crowd(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "crowd",
        "simulate many skiers who differ and stay apart",
        "CROWD is a crowd document, a preset in presets/crowds, or one run that all ski, each in his own way. Start\n"
        "times are chosen so that the planned ways stay apart; then everybody is simulated, in parallel processes.\n"
        "Writes member_001.npz and so on, each as soon as it is finished, crowd.json, and crowd.toml with its runs.\n"
        "Stop it with Ctrl+C whenever you like: the same command goes on with those who are missing.\n\n"
        "  python -m ski_addon crowd pursuit_race -o out/race                    a shipped crowd\n"
        "  python -m ski_addon crowd medium_carving --count 8 --apart 4 -o out   eight on one run\n"
        "  python -m ski_addon crowd free_skiing --set spread.offset=15 --set simulation.time_step=0.002 -o out\n\n"
        "--set takes keys of the crowd (crowd.delay_max, spread.height, ...) and of the runs in it; see docs/crowd.md.",
    )
    parser.add_argument("spec", metavar="CROWD", help="crowd or run document (.toml), or the name of a preset")
    _add_changes(parser)
    _add_output(parser, "DIR", "folder for the results", required=True)
    for name, metavar, text in (
        ("count", "COUNT", "how many ski"),
        ("seed", "SEED", "seed of everything in which they differ"),
        ("interval", "SECONDS", "time from one start to the next; 0 = all want to start at once"),
        ("apart", "METRES", "least distance between any two; who would come nearer starts later"),
        ("jobs", "COUNT", "processes that run at the same time (as many as there are processors)"),
    ):
        parser.add_argument(f"--{name}", metavar=metavar, help=text)
    _add_talk(parser)
    _add_force(parser)


def _add_submit(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "submit",
        "write a bundle that simulates, bakes and renders a run on a render farm",
        "The bundle is a folder with everything the farm needs: for Open Job Description (and AWS Deadline Cloud) a\n"
        "job template, for Flamenco a job type and a job; see docs/farm.md.\n\n"
        "  python -m ski_addon submit giant_slalom -o out/bundle --run           run it on this computer\n"
        "  python -m ski_addon submit giant_slalom -o out/bundle --frames 1-48 --chunk 8\n"
        "  python -m ski_addon submit giant_slalom -o out/sweep --vary course.turn_radius=16,18,20",
    )
    _add_spec(parser)
    _add_output(parser, "BUNDLE", "folder for the bundle: a new or an empty one", required=True)
    parser.add_argument("--engine", choices=("openjd", "flamenco"), default="openjd", help="the farm (openjd)")
    parser.add_argument(
        "--frames", metavar="A-B", help="frames to render, as 1-48 or 1-10,20-30 (all that are planned)"
    )
    parser.add_argument("--chunk", metavar="COUNT", default="10", help="frames that one task renders (10)")
    parser.add_argument(
        "--render",
        metavar="OPTION=VALUE",
        action="append",
        default=[],
        help="option of render: engine, device, samples, size, motion-blur or denoise; repeatable",
    )
    parser.add_argument(
        "--vary",
        metavar="KEY=VALUE,...",
        action="append",
        default=[],
        help="make a run for each value of a key, and of several keys for each combination; repeatable",
    )
    for name, text in (
        ("crowd", "SPEC is a crowd document or a preset in presets/crowds, as of the command crowd"),
        ("pairs", "take the values of all --vary together: the first ones, the second ones and so on"),
        ("chunking", "let the farm make the chunks, by Open Job Description's extension TASK_CHUNKING"),
        ("run", "run the bundle here, by openjd (pip install openjd-cli)"),
    ):
        parser.add_argument(f"--{name}", action="store_true", help=text)
    parser.add_argument(
        "--workers",
        choices=("python", "blender"),
        help="workers have Python with ski_addon and bpy, or Blender with the extension (python; for flamenco blender)",
    )
    parser.add_argument("--cores", metavar="COUNT", help="least number of processor cores of a worker")
    parser.add_argument("--memory", metavar="GB", help="least memory of a worker")
    _add_talk(parser)
    _add_force(parser)


def _add_gallery(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "gallery",
        "draw the figures of the 1993 paper",
        "Turns by phase control and paths through obstacles, made anew from the paper's questions. Needs matplotlib.",
    )
    parser.add_argument("pictures", metavar="PICTURE", nargs="*", help="which ones, for instance figure_06 (all)")
    _add_output(parser, "DIR", "folder for the pictures", required=True)
    _add_talk(parser)


def _add_demo(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "demo",
        "simulate, bake and picture the giant-slalom preset",
        "Writes what run writes, and skier.blend and strobe.png. Needs Blender's Python module bpy.",
    )
    _add_output(parser, "DIR", "folder for the results", required=True)
    _add_talk(parser)


COMMANDS = (
    *(_add_run, _add_plan, _add_preview, _add_simulate, _add_bake, _add_report, _add_render, _add_validate),
    *(_add_crowd, _add_robustness, _add_submit, _add_gallery, _add_demo),
)
"""What adds each command to the parser, in the order of the help."""
