"""Folders that hold something already: what goes on, what is replaced, and what is refused."""

from __future__ import annotations

import pytest

from ski_addon import cli
from ski_addon.crowd import folder as folders
from ski_addon.crowd import read_crowd, write_crowd
from ski_addon.crowd.folder import check_folder, check_space
from ski_addon.errors import OutputError, SpecError
from tests.crowd.crowds import crowd_of

ELSEWHERE = "elsewhere.toml"


@pytest.fixture
def skied(tmp_path):
    """A folder that a crowd of three was simulated into, as far as its names tell."""
    write_crowd(crowd_of(3), tmp_path)
    for number in (1, 2, 3):
        (tmp_path / f"member_00{number}.npz").write_bytes(b"x" * 1000)
    return tmp_path


def test_an_empty_folder_will_do(tmp_path):
    check_folder(crowd_of(3), tmp_path, tmp_path / ELSEWHERE)


@pytest.mark.parametrize("changes", [{}, {"crowd.count": 2}, {"crowd.count": 9, "crowd.apart": 7, "crowd.linger": 0}])
def test_the_same_members_go_on(skied, changes):
    check_folder(crowd_of(3, changes), skied, skied / ELSEWHERE)


@pytest.mark.parametrize("changes", [{"crowd.seed": 1}, {"spread.height": 0.01}, {"crowd.tries": 2}])
def test_other_members_are_refused(skied, changes):
    with pytest.raises(SpecError, match="holds 3 recordings of another crowd: choose another folder, or add --force"):
        check_folder(crowd_of(3, changes), skied, skied / ELSEWHERE)


def test_recordings_of_nobody_knows_whom_are_refused(skied):
    (skied / "crowd.toml").write_text("not a crowd", encoding="utf-8")
    with pytest.raises(SpecError, match="3 recordings of another crowd"):
        check_folder(crowd_of(3), skied, skied / ELSEWHERE)


def test_the_document_itself_is_not_replaced(tmp_path):
    document = write_crowd(crowd_of(3), tmp_path)
    check_folder(read_crowd(document), tmp_path, document)
    with pytest.raises(SpecError, match=r"holds crowd\.toml, which would be replaced: choose another folder"):
        check_folder(crowd_of(4), tmp_path, document)


def test_a_disk_that_is_too_small_is_told_before(skied, monkeypatch):
    check_space(crowd_of(3), skied)
    monkeypatch.setattr(folders.shutil, "disk_usage", lambda _path: type("Usage", (), {"free": 1000})())
    with pytest.raises(OutputError, match=r"the crowd would take [\d.]+ MB of 1 kB there: ask for fewer skiers"):
        check_space(crowd_of(3), skied)


def test_the_command_refuses_and_force_replaces(skied, capsys):
    (skied / "other").mkdir()
    document = write_crowd(crowd_of(1, {"crowd.seed": 5}), skied / "other")
    order = ["crowd", str(document), "-o", str(skied), "--jobs=1", "--quiet"]
    assert cli.main(order) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and "3 recordings of another crowd" in err
    assert (skied / "member_001.npz").read_bytes() == b"x" * 1000 and not (skied / "crowd.json").exists()
    assert cli.main([*order, "--force"]) == 0
    assert len((skied / "member_001.npz").read_bytes()) > 1000 and read_crowd(skied / "crowd.toml").crowd.seed == 5
