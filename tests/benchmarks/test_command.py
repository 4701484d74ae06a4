"""The command: choice of subjects, skipping, files, retries and exit codes, on made-up measurements."""

from __future__ import annotations

import json
import sys
from types import ModuleType

import pytest

from benchmarks import __main__ as command
from benchmarks import subjects
from benchmarks.measuring import How, Measurement, NotMeasuredError


@pytest.fixture
def ratios(monkeypatch):
    """Two made-up subjects; the ratios of `fast`, one a time it is measured, are taken from this list."""
    wanted: list[float] = []

    def fast(how: How) -> list[Measurement]:
        ratio = wanted.pop(0) if len(wanted) > 1 else wanted[0]
        return [Measurement("fast", "all of it", "us", 1.0, 2.0, 3, ratio)]

    def absent(how: How) -> list[Measurement]:
        raise NotMeasuredError("there is no snow here")

    for name, function in (("fast", fast), ("absent", absent)):
        module = ModuleType(f"made_up_{name}")
        module.measurements = function
        monkeypatch.setitem(sys.modules, module.__name__, module)
    table = {"fast": "made_up_fast", "absent": "made_up_absent"}
    for name in list(subjects.SUBJECTS):
        monkeypatch.delitem(subjects.SUBJECTS, name)
    subjects.SUBJECTS.update(table)
    yield wanted
    for name in table:
        subjects.SUBJECTS.pop(name, None)


def run(*arguments: object) -> int:
    return command.main([str(argument) for argument in arguments])


def test_what_cannot_be_measured_leaves_a_line(ratios, tmp_path, capsys):
    ratios.append(10.0)
    assert run("--no-peers", "--history", tmp_path / "none.jsonl") == 0
    said = capsys.readouterr().out
    assert "all of it" in said and "absent was not measured: there is no snow here" in said
    assert "there is no history" in said


def test_json_holds_all_numbers(ratios, tmp_path):
    ratios.append(10.0)
    run("--only", "fast", "--quick", "--json", tmp_path / "all.json", "--history", tmp_path / "none.jsonl")
    written = json.loads((tmp_path / "all.json").read_text(encoding="utf-8"))
    assert written["quick"] is True and written["measurements"][0]["ratio"] == 10.0


def test_check_passes_without_a_history(ratios, tmp_path):
    ratios.append(10.0)
    assert run("--only", "fast", "--check", "--history", tmp_path / "none.jsonl") == 0


def test_check_fails_on_what_stays_worse(ratios, tmp_path, capsys):
    history = tmp_path / "history.jsonl"
    ratios[:] = [10.0]
    run("--only", "fast", "--record", "--history", history)
    ratios[:] = [16.0]
    assert run("--only", "fast", "--check", "--history", history) == 1
    said = capsys.readouterr().out
    assert "WORSE: fast/all of it takes 1.60 times" in said and "1.60!" in said


def test_check_passes_when_a_try_is_good(ratios, tmp_path, capsys):
    history = tmp_path / "history.jsonl"
    ratios[:] = [10.0]
    run("--only", "fast", "--record", "--history", history)
    ratios[:] = [30.0, 20.0, 16.0, 14.0, 99.0]
    assert run("--only", "fast", "--check", "--history", history) == 0
    assert "WORSE" not in capsys.readouterr().out
    assert ratios == [99.0]  # three tries more, and no fourth


def test_worse_without_check_is_shown_and_no_failure(ratios, tmp_path, capsys):
    history = tmp_path / "history.jsonl"
    ratios[:] = [10.0]
    run("--only", "fast", "--record", "--history", history)
    ratios[:] = [30.0]
    assert run("--only", "fast", "--history", history) == 0
    assert "3.00!" in capsys.readouterr().out


def test_damaged_history_is_one_line_and_nothing_is_measured(ratios, tmp_path, capsys):
    history = tmp_path / "history.jsonl"
    history.write_text("no JSON\n", encoding="utf-8")
    assert run("--history", history) == 2
    caught = capsys.readouterr()
    assert caught.out == "" and len(caught.err.splitlines()) == 1 and "line 1" in caught.err


def test_unknown_subject_is_one_line(ratios, capsys):
    assert run("--only", "fast,snow") == 2
    assert capsys.readouterr().err.strip() == "there is no subject 'snow'; there are fast, absent"


def test_peers_that_are_asked_for_and_missing_are_noted(ratios, tmp_path, monkeypatch, capsys):
    ratios.append(10.0)
    monkeypatch.setattr(command, "find_peers", lambda: None)
    run("--only", "fast", "--peers", "--history", tmp_path / "none.jsonl")
    assert "there is no folder of them; SKI_ADDON_PEERS may name one" in capsys.readouterr().out


def test_peers_that_are_missing_are_no_failure_and_not_noted_where_no_step_is_measured(
    ratios, tmp_path, monkeypatch, capsys
):
    ratios.append(10.0)
    monkeypatch.setattr(command, "find_peers", lambda: None)
    assert run("--only", "fast", "--history", tmp_path / "none.jsonl") == 0
    assert "there is no folder" not in capsys.readouterr().out


@pytest.mark.parametrize("option", ["--json", "--history"])
@pytest.mark.parametrize("name", ["", "no/such/folder/file"])
def test_file_that_cannot_be_written_is_one_line_before_anything_is_measured(ratios, tmp_path, capsys, option, name):
    assert run("--only", "fast", "--record", "--history", tmp_path / "h.jsonl", option, tmp_path / name) == 2
    caught = capsys.readouterr()
    assert caught.out == "" and len(caught.err.splitlines()) == 1 and str(tmp_path) in caught.err
    assert list(tmp_path.iterdir()) == []


def test_history_of_another_processor_is_said_and_allows_more(ratios, tmp_path, monkeypatch, capsys):
    history = tmp_path / "history.jsonl"
    ratios[:] = [10.0]
    monkeypatch.setattr(command.history, "cpu", lambda: "Another CPU")
    run("--only", "fast", "--record", "--history", history)
    monkeypatch.setattr(command.history, "cpu", lambda: "Some CPU")
    ratios[:] = [29.0]
    assert run("--only", "fast", "--check", "--history", history) == 0
    said = capsys.readouterr().out
    assert "this processor is another: Some CPU; here 3 times is a failure" in said and "2.90!" not in said
    ratios[:] = [31.0]
    assert run("--only", "fast", "--check", "--history", history) == 1
