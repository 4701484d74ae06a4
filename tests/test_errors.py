"""Failures are one line, carry their evidence and have the exit code of the design."""

from __future__ import annotations

import inspect

import pytest

from ski_addon import errors


@pytest.mark.parametrize(
    ("error", "exit_code", "words"),
    [
        (errors.SpecError("a.b", 1.0, "3..200 m", "give more"), 2, "a.b = 1.0 is outside 3..200 m: give more"),
        (errors.SpecError("a.b", problem="is missing"), 2, "a.b is missing"),
        (
            errors.PlanInfeasible("turn 2", 7.25, "56 degrees of lean"),
            2,
            "at turn 2: 56 degrees of lean; a speed of 7.2",
        ),
        (errors.PlanInfeasible("turn 2", None, "too steep"), 2, "at turn 2: too steep"),
        (errors.MissingInputError("x.toml"), 3, "cannot read x.toml: there is no such file"),
        (errors.RecordingError("r.npz", "it is truncated"), 3, "cannot read the recording r.npz: it is truncated"),
        (errors.OutputError("out", "it is a file"), 3, "cannot write out: it is a file"),
        (errors.MissingLibraryError("matplotlib", "the report"), 3, "pip install matplotlib"),
        (errors.BlenderMissingError(), 4, "Blender is needed for baking"),
        (
            errors.SkierFell("head on snow", 24.1, 3.2, "speed"),
            5,
            "fell at 3.20 s, 24.1 m along the track: head on snow",
        ),
        (errors.SimulationDiverged("q", 1, 2, "nan"), 5, "the simulation diverged at 2.00 s"),
        (errors.RenderError("no camera"), 7, "no camera"),
        (errors.Cancelled(), 130, "interrupted"),
    ],
)
def test_line_and_exit_code(error, exit_code, words):
    assert isinstance(error, errors.SkiAddonError)
    assert error.exit_code == exit_code
    assert words in str(error) and "\n" not in str(error)


def test_every_failure_of_the_library_has_an_exit_code_of_its_own_kind():
    kinds = [kind for _, kind in inspect.getmembers(errors, inspect.isclass) if kind.__module__ == errors.__name__]
    codes = {kind.exit_code for kind in kinds if kind is not errors.SkiAddonError}
    assert codes == {2, 3, 4, 5, 7, 130}


def test_evidence_is_kept():
    error = errors.SpecError("a.b", 1.0, "3..200 m", "give more")
    assert (error.field, error.value, error.allowed, error.hint) == ("a.b", 1.0, "3..200 m", "give more")
    named = error.in_source("run.toml line 3")
    assert (named.field, named.source) == ("a.b", "run.toml line 3")
    assert str(named) == "run.toml line 3: a.b = 1.0 is outside 3..200 m: give more"
    assert errors.PlanInfeasible("turn 2", 7.0, "lean").speed == 7.0


def test_long_or_broken_values_stay_on_one_short_line():
    error = errors.SpecError("a", "x\n" * 500, "1..2", "y")
    assert "\n" not in str(error) and len(str(error)) < 120
    assert len(errors.one_line("z" * 9999)) == 400


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (10**5000, "a huge number"),
        (-(16**9000), "a huge number"),
        (10**70, "1" + "0" * 56 + "..."),
        ("a\tb\n", '"a b "'),
        ({"x": [1, 2]}, "{'x': [1, 2]}"),
        (b"\xff", r"b'\xff'"),
    ],
    ids=("huge", "huge negative", "long", "text", "table", "bytes"),
)
def test_any_value_has_a_short_form(value, shown):
    assert errors.show_value(value) == shown


def test_deeply_nested_value_has_a_short_form():
    nested: list = []
    for _ in range(100_000):
        nested = [nested]
    assert errors.show_value(nested) == "a deeply nested value"


@pytest.mark.parametrize(
    "error",
    [
        lambda path: errors.MissingInputError(path, "what was wrong"),
        lambda path: errors.RecordingError(path, "what was wrong"),
        lambda path: errors.OutputError(path, "what was wrong"),
        lambda path: errors.SpecError("a.b", 1.0, "3..200 m", "what was wrong").in_source(path),
    ],
)
def test_very_long_path_does_not_cut_off_what_was_wrong(error):
    line = str(error("/deep" * 200 + "/file.toml"))
    assert line.endswith("what was wrong") and "deep/file.toml: " in line and len(line) < 400
    assert str(error("short.toml")).count("...") == 0
