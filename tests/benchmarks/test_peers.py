"""Peers: where they are looked for, and what a broken one says."""

from __future__ import annotations

import pytest

from benchmarks.measuring import How
from benchmarks.peers import OTHERS, STAGES, STEP, VARIABLE, PeerError, Peers, figure, find_peers, parse
from benchmarks.step import STAGES as STEP_STAGES
from benchmarks.step_rounds import Beside

LINE = '{"res": {"eiquadprog/6d": {"total": {"med_us": 200.0, "p99_us": 300.0, "n": 1900}}}}'


def folder_of(tmp_path, script: str) -> Peers:
    path = tmp_path / "run"
    path.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
    path.chmod(0o755)
    return Peers(tmp_path)


def test_missing_folder_is_no_peers(tmp_path):
    assert find_peers({VARIABLE: str(tmp_path / "none")}) is None
    assert find_peers({VARIABLE: str(tmp_path)}) is None


def test_folder_is_named_by_the_variable(tmp_path):
    folder_of(tmp_path, "true")
    found = find_peers({VARIABLE: str(tmp_path)})
    assert found is not None and found.folder == tmp_path


def test_figures_are_read_from_the_last_line(tmp_path):
    found = folder_of(tmp_path, f"echo warming up\necho '{LINE}'").run("tsid")
    assert figure(found, STEP).median == 200.0 and figure(found, STEP).p99 == 300.0


@pytest.mark.parametrize("text", ["", "\n", "{", "[1, 2]", "3", "null", '{"res": 3}', '{"result": {}}', "Traceback"])
def test_broken_line_is_one_clear_line(text):
    with pytest.raises(PeerError) as caught:
        parse("tsid", text)
    assert str(caught.value).startswith("peer tsid: ") and len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize("found", [{}, {"eiquadprog/6d": 3}, {"eiquadprog/6d": {"total": {"med_us": "x"}}}])
def test_missing_figure_names_its_place(found):
    with pytest.raises(PeerError, match="no time at eiquadprog/6d > total"):
        figure(found, STEP)


def test_peer_that_fails_says_its_last_line(tmp_path):
    with pytest.raises(PeerError, match=r"peer tsid: it ended with code 3 \(no such solver\)"):
        folder_of(tmp_path, "echo one >&2\necho 'no such solver' >&2\nexit 3").run("tsid")


def test_peer_that_cannot_run_is_one_line(tmp_path):
    with pytest.raises(PeerError, match="peer tsid: it did not run"):
        Peers(tmp_path).run("tsid")


def test_broken_peer_is_noted_once_and_not_run_again(tmp_path):
    how = How(peers=folder_of(tmp_path, f'echo ran $1 >> {tmp_path}/ran\n[ "$1" = tsid ] && echo "{{" || exit 1'))
    beside = Beside(how)
    for _ in range(2):
        beside.run(STEP, *OTHERS)
    scripts = list(dict.fromkeys(entry.script for entry in (STEP, *OTHERS)))
    assert (tmp_path / "ran").read_text().split() == [word for script in scripts for word in ("ran", script)]
    assert len(how.notes) == len(scripts)
    assert beside.figure(STEP) is None and beside.ratio(STEP, [1.0]) is None
    assert beside.p99_ratio(STEP, 1.0) is None


def test_ratio_is_ours_by_the_peers_before_and_after(tmp_path):
    beside = Beside(How(peers=folder_of(tmp_path, f"echo '{LINE}'")))
    for _ in range(3):
        beside.run(STEP)
    assert beside.ratio(STEP, [100.0, 300.0]) == pytest.approx(1.0)
    assert beside.figure(STEP).n == 3 * 1900
    assert beside.ratio(STEP, [100.0]) == pytest.approx(0.5)  # not in turn: by the mean
    assert beside.p99_ratio(STEP, 150.0) == pytest.approx(0.5)


def test_peers_of_stages_stand_beside_stages_that_there_are():
    assert set(STAGES) <= {stage for stage, _, _ in STEP_STAGES}


def test_every_figure_is_of_a_script_that_is_run():
    assert {entry.script for entry in STAGES.values()} <= {entry.script for entry in (STEP, *OTHERS)}
