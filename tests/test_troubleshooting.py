"""The page of error messages: every message on it is made to appear, and no kind of failure is missing."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ski_addon import cli, errors
from ski_addon.errors import (
    BlenderMissingError,
    Cancelled,
    MissingLibraryError,
    RenderError,
    SimulationDiverged,
    SkierFell,
)

PAGE = Path(__file__).resolve().parents[1] / "docs" / "troubleshooting.md"
MESSAGES = re.findall(r"^### `(.*)`$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
CARVING = ("plan", "medium_carving")

COMMANDS = {
    "… is not a key of a run: did you mean …?": ("validate", "slalom", "--set", "course.turn_radus=1"),
    "… is outside …: give a number in that range": ("validate", "slalom", "--set", "course.turn_radius=1"),
    "… is not a number: give a number in …": ("validate", "slalom", "--set", "course.turn_radius=wide"),
    "… is not one of …: choose one of these": ("validate", "slalom", "--set", "course.first_turn=up"),
    "… is not valid TOML: …": ("validate", "{folder}/bad.toml"),
    "figure.kind = … has no whole physics, which is for alpine skiers: …": ("plan", "snowboard_carving"),
    "--vary … has no values: …": ("sweep", "slalom", "--vary", "course.turn_radius", "-o", "{folder}/out"),
    "--frames = … is no list of frames: …": ("submit", "slalom", "--frames", "one", "-o", "{folder}/out"),
    "the following arguments are required: …": ("run", "slalom"),
    "… invalid choice: …": ("frobnicate",),
    "the track cannot be skied at …: friction stops the skier there: …": (*CARVING, "--set", "slope.angle_deg=1"),
    "the track cannot be skied at …: at … m/s it needs … degrees of lean, more than "
    "technique.inclination_max_deg = …": (*(*CARVING, "--set", "technique.inclination_max_deg=20"),),
    "the track cannot be skied at …: only … of the skier's weight would stay on the snow, less than "
    "technique.load_min = …": (
        *("plan", "bumps", "--set", "technique.absorption=0", "--set", "technique.load_min=0.9"),
    ),
    "the track cannot be skied at …: … would bend … degrees past its range …": (
        *(*CARVING, "--set", "technique.angulation=-1", "--set", "technique.inclination_max_deg=60"),
        *("--set", "course.start_speed=14", "--set", "technique.knee_bend_deg=95"),
    ),
    "course.gate_offset = … makes a course that cannot be skied: …": (
        "plan",
        "slalom",
        "--set",
        "course.gate_distance=3",
    ),
    "slope.bump_height = … is more than a skier can take: …": (
        *("plan", "giant_slalom", "--set", "slope.kind=bumps", "--set", "slope.bump_height=3"),
    ),
    "cannot read …: there is no such file or preset: presets are …": ("validate", "nowhere"),
    "cannot read …: there is no such file": ("render", "{folder}/none.blend", "-o", "{folder}/frames"),
    "cannot read the recording …: it is truncated or not a recording …": ("report", "{folder}/bad.npz"),
    "cannot write …: …": ("simulate", "paper_main", "-o", "{folder}/bad.npz"),
    "cannot write …: it holds something else than this job: name an empty or a new folder": (
        *("submit", "paper_main", "--frames", "1-9", "-o", "{folder}"),
    ),
}
"""What appears after these commands."""
FAILURES = {
    "… is needed for …: install it with: pip install …": MissingLibraryError("matplotlib", "the report"),
    "Blender is needed for …: run this inside Blender, or install the bpy wheel …": BlenderMissingError(),
    "the skier fell at … s, … m along the track: …; …": SkierFell("the pelvis tipped over", 12.0, 3.4, "pushed"),
    "the simulation diverged at … s, …": SimulationDiverged("the state is no longer a number", 12.0, 3.4, "too far"),
    "… could not be rendered: …": RenderError("frame 7 could not be rendered: Blender wrote no picture"),
    "… cannot be rendered: its scene has no camera": RenderError("a.blend cannot be rendered: its scene has no camera"),
    "--device …: … use --device CPU": RenderError("--device X: there is no such device here: use --device CPU"),
    "interrupted: …": Cancelled(),
}
"""Messages that need a missing library, a fall or a stop: tests of those make them appear; here, their words."""


def pattern(message: str) -> str:
    """The regular expression for a message of the page."""
    return ".*".join(re.escape(part) for part in message.split("…"))


def test_the_page_and_the_commands_that_show_its_messages_are_the_same():
    assert len(MESSAGES) == len(set(MESSAGES)) >= 25
    assert set(MESSAGES) == COMMANDS.keys() | FAILURES.keys()


@pytest.mark.parametrize("message", COMMANDS)
def test_message_appears(message, tmp_path, capsys):
    (tmp_path / "bad.toml").write_text('name = "a\n')
    (tmp_path / "bad.npz").write_text("nothing")
    code = cli.main([argument.format(folder=tmp_path) for argument in COMMANDS[message]])
    said = capsys.readouterr().err.strip().splitlines()
    assert len(said) == 1 and re.search(pattern(message), said[0]), said
    assert code == (3 if "cannot read" in message or "cannot write" in message else 2)


@pytest.mark.parametrize("message", FAILURES)
def test_message_is_that_of_its_failure(message):
    assert re.search(pattern(message), str(FAILURES[message]))


def test_every_failure_of_rendering_has_its_words_on_the_page():
    source = "".join(path.read_text() for path in (PAGE.parents[1] / "ski_addon").rglob("*.py"))
    raised = [re.sub(r"{[^}]*}", "X", text) for text in re.findall(r"RenderError\(f?\"([^\"]*)\"", source)]
    shown = [pattern(message) for message, failure in FAILURES.items() if isinstance(failure, RenderError)]
    assert len(raised) >= 6
    for text in raised:
        assert any(re.search(form, text) for form in shown), text


def test_every_kind_of_failure_and_every_exit_code_is_on_the_page():
    page = PAGE.read_text(encoding="utf-8")
    codes = {kind.exit_code for kind in vars(errors).values() if isinstance(kind, type) and hasattr(kind, "exit_code")}
    for code in codes - {1}:  # 1 is the base class's own, which nothing raises
        assert f"(exit code {code})" in page, code
    assert RenderError.exit_code in codes
