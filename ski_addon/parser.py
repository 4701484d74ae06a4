"""The parser of the command line: every command with its options, and help that teaches."""

from __future__ import annotations

import argparse
import sys
from typing import NoReturn, TypeAlias

from . import __version__, commands, environment
from .errors import one_line
from .tasks.rendering import DEVICES, ENGINES

OVERVIEW = """\
Make ski animation from physics: describe a run in a TOML file, let a skier ski it, and get keyframes.

  %(prog)s run giant_slalom -o out              simulate a shipped preset
  %(prog)s run my_run.toml -o out               simulate a run of your own
  %(prog)s run giant_slalom --set course.turn_radius=18 --part soft -o out
  %(prog)s bake out -o skier.blend              make keyframes of it (needs Blender's bpy)
  %(prog)s render skier.blend -o frames         render its frames

Every command explains itself with --help. All keys of a run document are explained in docs/run_spec.md.
Finished work is never done twice, and work that was killed goes on where it was: give the same command again."""

EXIT_CODES = {
    0: "done, or up to date",
    2: "wrong arguments, a wrong run document, or a track that cannot be skied: where, and what would work",
    3: "an input is missing or unreadable, or the output cannot be written",
    4: "Blender is missing",
    5: "the skier fell, or the simulation diverged: what, where, when and why",
    7: "a picture could not be rendered",
    130: "interrupted with Ctrl+C or a polite kill; what is finished is kept",
}
"""What the exit codes mean; any unexpected failure is 1."""


class BadArguments(SystemExit):
    """Arguments that cannot be read; `line` says why."""

    def __init__(self, line: str) -> None:
        super().__init__(2)
        self.line = line


class OneLineParser(argparse.ArgumentParser):
    """An argument parser whose failures are one line on stderr and exit code 2."""

    def error(self, message: str) -> NoReturn:
        """Say what is wrong with the arguments, and leave."""
        line = f"{self.prog}: {one_line(message)} (see {self.prog} --help)"
        sys.stderr.write(line + "\n")
        raise BadArguments(line)


def build_parser(prog: str = "python -m ski_addon") -> argparse.ArgumentParser:
    """Return the parser of all commands; the chosen command's function is in `arguments.command`."""
    parser = OneLineParser(
        prog=prog, description=OVERVIEW, epilog=_epilog(), formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--version", action="version", version=f"Ski Addon {__version__}")
    subparsers = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for add in COMMANDS:
        add(subparsers)
    return parser


def _epilog() -> str:
    codes = [f"  {code:<5}{meaning}" for code, meaning in EXIT_CODES.items()]
    width = max(map(len, environment.VARIABLES)) + 2
    variables = [f"  {name.ljust(width)}{meaning}" for name, meaning in environment.VARIABLES.items()]
    return "\n".join(["exit codes:", *codes, "", "environment:", *variables])


_Subparsers: TypeAlias = "argparse._SubParsersAction[OneLineParser]"


def _command(subparsers: _Subparsers, name: str, summary: str, details: str = "") -> argparse.ArgumentParser:
    parser = subparsers.add_parser(
        name,
        help=summary,
        description=f"{summary[0].upper()}{summary[1:]}.{details and chr(10) + details}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.set_defaults(command=getattr(commands, f"{name}_command"), json=False, quiet=False, force=False, redo=False)
    parser.set_defaults(openjd=False, log=None)
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
    parser.add_argument("--json", action="store_true", help="print the result as JSON on stdout, and nothing else")
    parser.add_argument("--quiet", action="store_true", help="print no progress and no summary")
    parser.add_argument(
        "--openjd", action="store_true", help="say progress and failures in the lines of Open Job Description"
    )
    parser.add_argument("--log", metavar="FILE", help="add what is done to a log: key, versions, seed, host, failures")


def _add_task(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--redo", action="store_true", help="do it again, even if what is there is up to date")


def _add_force(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--force", action="store_true", help="start even if the run would take more than 8 GB or an hour of skiing"
    )


def _add_run(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "run",
        "plan, simulate and report a run",
        "Writes spec.toml, recording.npz, summary.json and (with matplotlib) report.png into the folder.\n\n"
        "  %(prog)s giant_slalom -o out\n"
        "  %(prog)s my_run.toml --set snow.friction=0.05 --part racer -o out",
    )
    _add_spec(parser)
    _add_output(parser, "DIR", "folder for the results", required=True)
    _add_talk(parser)
    _add_task(parser)
    _add_force(parser)


def _add_plan(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "plan",
        "plan a run without simulating it",
        "Says whether the track can be skied, and how fast; a second or two.\n\n"
        "  %(prog)s my_run.toml\n"
        "  %(prog)s giant_slalom --set course.turn_radius=12 --json",
    )
    _add_spec(parser)
    _add_output(parser, "DIR|FILE.json", "also write the planned numbers as JSON (plan.json in a folder)")
    _add_talk(parser)


def _add_simulate(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "simulate",
        "simulate a run",
        "Writes spec.toml, recording.npz and summary.json into the folder. On the way a checkpoint is kept: a run\n"
        "that was killed goes on from it, and its recording has the same bytes as one that was not.\n\n"
        "  %(prog)s giant_slalom -o out\n"
        "  %(prog)s giant_slalom -o out                  again: up to date\n"
        "  %(prog)s out/spec.toml -o copy                the same recording, byte for byte",
    )
    _add_spec(parser)
    _add_output(parser, "DIR", "folder for the results", required=True)
    _add_talk(parser)
    _add_task(parser)
    _add_force(parser)


def _add_bake(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "bake",
        "make a .blend file with the skier as keyframes",
        "Needs Blender's Python module bpy, or Blender. The file opens in plain Blender.\n\n"
        "  %(prog)s out                                  out/skier.blend\n"
        "  %(prog)s out --set bake.fps=30 -o film.blend\n"
        "  %(prog)s giant_slalom -o skier.blend          simulated first",
    )
    parser.add_argument(
        "source",
        metavar="RECORDING|DIR|SPEC",
        help="recording.npz, the folder of a run or of a crowd, or a run to simulate first",
    )
    _add_changes(parser)
    _add_output(parser, "FILE.blend", "file to write (skier.blend beside the recording if not given)")
    _add_talk(parser)
    _add_task(parser)
    _add_force(parser)


def _add_report(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "report",
        "draw the plots of a recording",
        "Needs matplotlib.\n\n  %(prog)s out          out/report.png",
    )
    parser.add_argument("source", metavar="RECORDING|DIR", help="recording.npz, or the folder it is in")
    _add_output(parser, "FILE.png", "picture to write (report.png beside the recording if not given)")
    _add_talk(parser)
    _add_task(parser)


def _add_render(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "render",
        "render the frames of a .blend file, or one picture of a recording",
        "Of a .blend file: each frame as DIR/frame_0001.png and so on. Frames that are there, whole, and made from\n"
        "the same file with the same settings are kept; so a killed task goes on, and workers can share a film.\n"
        "Of a recording: one picture with the skier at several instants; of a crowd, when most are on the slope.\n"
        "Needs Blender's Python module bpy, or Blender.\n\n"
        "  %(prog)s skier.blend -o frames                all frames, by Cycles on the processor\n"
        "  %(prog)s skier.blend -o frames --frames 1-50 --engine workbench --size 960x540\n"
        "  %(prog)s skier.blend -o frames --samples 128 --motion-blur 0.5 --device OPTIX\n"
        "  %(prog)s out                                  out/strobe.png",
    )
    parser.add_argument(
        "source",
        metavar="FILE.blend|RECORDING|DIR",
        help="what bake wrote; or recording.npz, or the folder of a run or of a crowd",
    )
    _add_output(parser, "DIR|FILE.png", "folder of the frames (frames beside the file), or picture to write")
    frames = parser.add_argument_group("frames of a .blend file")
    frames.add_argument("--frames", metavar="A-B", help="which: 1-250, or 1-9,20, or 1-100:5 (all of the file)")
    frames.add_argument("--engine", choices=ENGINES, help="what renders (cycles); workbench is quick and plain")
    frames.add_argument("--device", choices=DEVICES, type=str.upper, help="on what Cycles renders (CPU)")
    frames.add_argument("--samples", metavar="COUNT", help="samples a pixel (as in the file)")
    frames.add_argument("--size", metavar="WxH", help="size of the pictures in pixels (as in the file)")
    frames.add_argument(
        "--motion-blur",
        metavar="FRAMES",
        nargs="?",
        const="0.5",
        help="time the shutter is open, by Cycles: 0.5 if no number is given, 0 for none (as in the file)",
    )
    frames.add_argument(
        "--denoise", action=argparse.BooleanOptionalAction, help="smooth the grain of few samples (as in the file)"
    )
    picture = parser.add_argument_group("picture of a recording")
    picture.add_argument("--stop", action="store_true", help="show the end of the run, where the skier stops")
    _add_talk(parser)
    _add_task(parser)


def _add_preview(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "preview",
        "animate the figure of a run at once, without simulating it",
        "The figure of any kind (skier, snowboarder, telemark skier, cyclist) as keyframes in preview.blend, or, for\n"
        "FILE.png, in one picture at several instants. Needs Blender's Python module bpy, or Blender.\n\n"
        "  %(prog)s snowboard_carving -o out",
    )
    _add_spec(parser)
    _add_output(parser, "DIR|FILE.blend|FILE.png", "file to write (preview.blend in a folder)", required=True)
    _add_talk(parser)


def _add_validate(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "validate",
        "check run documents without running them",
        "One line for each, and the exit code of the first that is wrong.\n\n"
        "  %(prog)s my_run.toml other.toml\n"
        "  %(prog)s giant_slalom --set course.turn_radius=500",
    )
    parser.add_argument("specs", metavar="SPEC", nargs="+", help="run documents (.toml) or names of presets")
    _add_changes(parser)
    _add_talk(parser)


def _add_robustness(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "robustness",
        "push the skier of a run in many ways and say what he survives",
        "Every combination of the options below is a run of its own, up to 5 s after the push's end. A course of\n"
        "linked turns is made long enough. Writes robustness.json, robustness.csv and (with matplotlib)\n"
        "robustness.png.\n\n"
        "  %(prog)s paper_main -o out/pushes\n"
        "  %(prog)s paper_main --forces 100,200 --bodies abdomen --speeds 9 -o out/pushes",
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


def _add_sweep(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "sweep",
        "simulate a run for every combination of some values",
        "Each combination is a task as simulate, in a folder of its own named by its values; those that are finished\n"
        "are kept, so that a sweep can be stopped, and values can be added. A run that falls or cannot be skied is a\n"
        "row of the table like any other. Writes sweep.json and sweep.csv besides.\n\n"
        "  %(prog)s giant_slalom --vary course.turn_radius=14,18,22 -o out/radius\n"
        "  %(prog)s my_run.toml --vary snow.friction=0.02,0.06 --vary skier.mass=60,80,100 --jobs 4 -o out/table",
    )
    _add_spec(parser)
    parser.add_argument(
        "--vary",
        metavar="KEY=VALUE,...",
        action="append",
        required=True,
        help="values of one key, whole numbers also as 1-5 (parted by ; if they hold commas themselves); repeatable:"
        " every combination is skied",
    )
    _add_output(parser, "DIR", "folder for the results", required=True)
    parser.add_argument("--jobs", metavar="COUNT", help="processes at the same time (as many as there are processors)")
    parser.add_argument("--report", action="store_true", help="draw a report.png of each run, too")
    _add_talk(parser)
    _add_task(parser)
    _add_force(parser)


def _add_crowd(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "crowd",
        "simulate many skiers who differ and stay apart",
        "CROWD is a crowd document, a preset in presets/crowds, or one run that all ski, each in his own way. Start\n"
        "times are chosen so that the planned ways stay apart; then everybody is simulated, in parallel processes.\n"
        "Writes member_001.npz and so on, each as soon as it is finished, crowd.json, and crowd.toml with its runs.\n"
        "Stop it with Ctrl+C whenever you like: the same command goes on with those who are missing.\n"
        "--set takes keys of the crowd (crowd.delay_max, spread.height, ...) and of its runs; see docs/crowd.md.\n\n"
        "  %(prog)s pursuit_race -o out/race                    a shipped crowd\n"
        "  %(prog)s medium_carving --count 8 --apart 4 -o out   eight on one run\n"
        "  %(prog)s free_skiing --set spread.offset=15 --set simulation.time_step=0.002 -o out",
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
        "  %(prog)s giant_slalom -o out/bundle --run           run it on this computer\n"
        "  %(prog)s giant_slalom -o out/bundle --frames 1-48 --chunk 8\n"
        "  %(prog)s giant_slalom -o out/sweep --vary course.turn_radius=16,18,20",
    )
    _add_spec(parser)
    _add_output(parser, "BUNDLE", "folder for the bundle: a new or an empty one", required=True)
    parser.add_argument("--engine", choices=("openjd", "flamenco"), default="openjd", help="the farm (openjd)")
    parser.add_argument(
        "--frames", metavar="A-B", help="frames to render: 1-250, or 1-9,20, or 1-100:5 (all that are planned)"
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
        help="make a run for each value of a key, written as for sweep, and of several keys for each combination;"
        " repeatable",
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
        "Turns by phase control and paths through obstacles, made from the paper's questions. Needs matplotlib.\n\n"
        "  %(prog)s figure_06 -o out",
    )
    parser.add_argument("pictures", metavar="PICTURE", nargs="*", help="which ones, for instance figure_06 (all)")
    _add_output(parser, "DIR", "folder for the pictures", required=True)
    _add_talk(parser)


def _add_demo(subparsers: _Subparsers) -> None:
    parser = _command(
        subparsers,
        "demo",
        "simulate, bake and picture the giant-slalom preset",
        "Writes what run writes, and skier.blend and strobe.png. Needs Blender's Python module bpy.\n\n"
        "  %(prog)s -o out/demo",
    )
    _add_output(parser, "DIR", "folder for the results", required=True)
    _add_talk(parser)
    _add_task(parser)


COMMANDS = (
    *(_add_run, _add_plan, _add_preview, _add_simulate, _add_bake, _add_report, _add_render, _add_validate),
    *(_add_crowd, _add_sweep, _add_robustness, _add_submit, _add_gallery, _add_demo),
)
"""What adds each command to the parser, in the order of the help."""
