"""A run document names a file of heights beside it; the spec knows it from anywhere."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from ski_addon.errors import MissingInputError
from ski_addon.spec import RunSpec, find_ground

RUN = """\
[slope]
angle_deg = 0
kind = "grid"
grid_file = {file}

[course]
kind = "turns"
turn_count = 6
turn_duration = 1.2
transition_duration = 1.5
turn_radius = 15
"""


@pytest.fixture
def read(tmp_path):
    def read_run(written):
        path = tmp_path / "runs" / "run.toml"
        path.parent.mkdir(exist_ok=True)
        path.write_text(RUN.format(file=f'"{written}"'))
        return RunSpec.from_toml(path).slope.grid_file

    return read_run


def test_a_file_is_beside_its_document(read, tmp_path):
    assert read("hill.npz") == str(tmp_path / "runs" / "hill.npz")
    assert read("../grounds/hill") == str(tmp_path / "grounds" / "hill")


def test_whole_paths_and_shipped_grounds_stay_as_they_are(read):
    assert read("/data/hill.npz") == "/data/hill.npz"
    assert read("rolling_hill") == "rolling_hill"
    assert read("") == ""


def test_a_document_is_found_from_another_folder(read, tmp_path, monkeypatch):
    (tmp_path / "runs").mkdir()
    (tmp_path / "runs" / "run.toml").write_text(RUN.format(file='"hill.npz"'))
    monkeypatch.chdir(tmp_path)
    assert RunSpec.from_toml("runs/run.toml").slope.grid_file == str(tmp_path / "runs" / "hill.npz")


def test_a_spec_written_down_is_the_same_anywhere(read, tmp_path):
    spec = RunSpec.from_text(RUN.format(file=f'"{read("hill.npz")}"'))
    (tmp_path / "copy.toml").write_text(spec.to_toml())
    assert RunSpec.from_toml(tmp_path / "copy.toml") == spec


def test_a_changed_key_is_in_the_present_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    changed = RunSpec().with_overrides({"slope.grid_file": "hill.npz"})
    assert changed.slope.grid_file == os.path.join(os.getcwd(), "hill.npz")
    assert RunSpec().with_overrides({"slope.grid_file": "rolling_hill"}).slope.grid_file == "rolling_hill"
    assert changed.with_overrides({"slope.angle_deg": 5}).slope.grid_file == changed.slope.grid_file


def test_a_part_has_its_file_beside_it(tmp_path):
    part = tmp_path / "parts" / "hill.toml"
    part.parent.mkdir()
    part.write_text('[slope]\nkind = "grid"\ngrid_file = "hill.npy"\n')
    assert RunSpec().with_part(part).slope.grid_file == str(tmp_path / "parts" / "hill.npy")


def test_shipped_grounds_are_found_by_name():
    assert find_ground("rolling_hill").is_file()
    assert find_ground("hill.npz") == Path("hill.npz")
    with pytest.raises(MissingInputError, match="there is no such ground"):
        find_ground("rolling")
