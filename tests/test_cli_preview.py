"""The command `preview`, with stand-ins for Blender."""

from __future__ import annotations

import json

import pytest

from ski_addon import cli, results
from ski_addon.spec import RunSpec
from ski_addon.turning.motion import TurningMotion

SHORT = ("--set", "course.turn_count=2")


@pytest.fixture
def drawn(monkeypatch):
    """What was asked of Blender: (spec, motion, target)."""
    asked = []

    def stand_in(spec, motion, target):
        asked.append((spec, motion, target))
        target.write_text("BLENDER")

    monkeypatch.setattr(results, "check_blender", lambda needed_for: None)
    monkeypatch.setattr(results, "draw_preview", stand_in)
    return asked


@pytest.fixture
def run(capsys):
    def call(*arguments):
        code = cli.main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call


@pytest.mark.parametrize(
    ("given", "written"), [("out", "out/preview.blend"), ("a.blend", "a.blend"), ("out/b.blend", "out/b.blend")]
)
def test_file_or_folder(drawn, run, tmp_path, given, written):
    code, said, error = run("preview", "paper_main", *SHORT, "-o", tmp_path / given)
    assert (code, error) == (0, "")
    ((spec, motion, target),) = drawn
    assert target == tmp_path / written and f"wrote {target}" in said
    assert spec.course.turn_count == 2 and isinstance(motion, TurningMotion)


def test_a_picture_is_drawn_in_a_process_of_its_own_and_written_whole(drawn, run, tmp_path, monkeypatch):
    started = []

    def apart(arguments):
        started.append(arguments)
        spec = RunSpec.from_toml(arguments[1])
        assert spec.course.turn_count == 2 and spec.figure.kind == "snowboard"
        with open(arguments[3], "w") as file:
            file.write("PNG")

    monkeypatch.setattr(results.apart, "run_apart", apart)
    code, _, error = run(
        "preview", "paper_main", *SHORT, "--set", "figure.kind=snowboard", "-o", tmp_path / "new" / "x.png"
    )
    assert (code, error) == (0, "")
    assert [name for name, *_ in started] == ["preview"] and not drawn
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["x.png"]


def test_any_figure_of_any_run(drawn, run, tmp_path):
    for kind in ("alpine", "snowboard", "telemark", "bicycle"):
        code, *_ = run("preview", "giant_slalom", "--set", f"figure.kind={kind}", "-o", tmp_path)
        assert code == 0
    assert [spec.figure.kind for spec, *_ in drawn] == ["alpine", "snowboard", "telemark", "bicycle"]


def test_json_says_what_was_written(drawn, run, tmp_path):
    _, said, _ = run("preview", "paper_main", *SHORT, "-o", tmp_path, "--json")
    assert json.loads(said)["blend"] == str(tmp_path / "preview.blend")


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (("nowhere",), 3, "no such file or preset"),
        (("paper_main", "--set", "figure.kind=sledge"), 2, "figure.kind"),
        (("paper_main", "--set", "course.turn_radius=0"), 2, "course.turn_radius"),
    ],
)
def test_bad_input_is_one_line_and_leaves_nothing(drawn, run, tmp_path, arguments, code, words):
    exit_code, said, error = run("preview", *arguments, "-o", tmp_path / "new" / "x.png")
    assert (exit_code, said) == (code, "")
    assert words in error and error.count("\n") == 1
    assert not drawn and not (tmp_path / "new").exists()


def test_a_rhythm_that_cannot_go_on_is_kept_up_to_there_and_the_place_is_told(drawn, run, tmp_path):
    steep = ("--set", "rhythm.1.period=0.6", "--set", "rhythm.1.sharpness_deg=50")
    code, said, error = run("preview", "changing_heading", *steep, "-o", tmp_path, "--json")
    assert code == 2 and error.count("\n") == 1
    assert "at rhythm 1 (0." in error and "the motion up to there is in" in error
    ((_, motion, target),) = drawn
    assert motion.duration < 1.0 and target.exists()
    assert json.loads(said)["blend"] == str(target) and "rhythm 1" in json.loads(said)["error"]


def test_a_target_that_cannot_be_written_is_named(drawn, run, tmp_path):
    (tmp_path / "file").write_text("")
    code, _, error = run("preview", "paper_main", *SHORT, "-o", tmp_path / "file" / "x.blend")
    assert code == 3 and "file" in error and error.count("\n") == 1
