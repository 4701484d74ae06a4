"""Bundles on the disk: whole, plain files, and nothing outside."""

from __future__ import annotations

import os

import pytest

from ski_addon.errors import MissingInputError, OutputError
from ski_addon.farm.bundle import write_bundle

TEXTS = {"template.json": "{}", "input/spec.toml": "name = 'é'\n"}


def contents(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture
def ground(tmp_path):
    path = tmp_path / "hill.npz"
    path.write_bytes(b"heights")
    return path


def test_bundle_holds_what_was_given_and_nothing_else(tmp_path, ground):
    folder = tmp_path / "deep" / "bundle"
    assert write_bundle(folder, TEXTS, {"input/terrain/hill.npz": ground})
    assert contents(folder) == {
        "template.json": b"{}",
        "input/spec.toml": "name = 'é'\n".encode(),
        "input/terrain/hill.npz": b"heights",
    }
    assert sorted(os.listdir(folder)) == ["input", "template.json"]


def test_the_same_again_is_left_alone(tmp_path, ground):
    folder = tmp_path / "bundle"
    write_bundle(folder, TEXTS, {"input/terrain/hill.npz": ground})
    (folder / "output" / "run").mkdir(parents=True)
    (folder / "output" / "run" / "recording.npz").write_bytes(b"skied")
    before = (folder / "template.json").stat()
    assert not write_bundle(folder, TEXTS, {"input/terrain/hill.npz": ground}, kept="output")
    assert (folder / "template.json").stat().st_mtime_ns == before.st_mtime_ns
    assert sorted(os.listdir(folder)) == ["input", "output", "template.json"]


def _change_a_file(folder):
    (folder / "template.json").write_text("[]")


def _remove_a_file(folder):
    (folder / "input" / "spec.toml").unlink()


def _add_a_file(folder):
    (folder / "input" / "more").write_text("")


def _add_a_folder(folder):
    (folder / "empty").mkdir()


def _link_a_file(folder):
    (folder / "template.json").rename(folder.parent / "elsewhere")
    (folder / "template.json").symlink_to(folder.parent / "elsewhere")


def _link_a_folder(folder):
    (folder / "input").rename(folder.parent / "elsewhere")
    (folder / "input").symlink_to(folder.parent / "elsewhere")


@pytest.mark.parametrize(
    "change", [_change_a_file, _remove_a_file, _add_a_file, _add_a_folder, _link_a_file, _link_a_folder]
)
def test_anything_else_is_refused_and_kept(tmp_path, change):
    folder = tmp_path / "bundle"
    write_bundle(folder, TEXTS, {})
    change(folder)
    before = contents(tmp_path)
    with pytest.raises(OutputError, match="it holds something else than this job"):
        write_bundle(folder, TEXTS, {}, kept="output")
    assert contents(tmp_path) == before
    assert not [name for name in os.listdir(folder) if name.startswith(".")]


def test_a_bundle_within_a_bundle_is_refused(tmp_path):
    write_bundle(tmp_path / "bundle", TEXTS, {})
    with pytest.raises(OutputError, match="it lies within the bundle"):
        write_bundle(tmp_path / "bundle" / "input" / "more", TEXTS, {})
    assert contents(tmp_path / "bundle").keys() == TEXTS.keys()


def test_links_are_copied_as_plain_files(tmp_path, ground):
    link = tmp_path / "link.npz"
    link.symlink_to(ground)
    write_bundle(tmp_path / "bundle", TEXTS, {"input/terrain/link.npz": link})
    copy = tmp_path / "bundle" / "input" / "terrain" / "link.npz"
    assert not copy.is_symlink()
    assert copy.read_bytes() == b"heights"


@pytest.mark.parametrize("kind", ["missing", "folder", "pipe", "dangling"])
def test_what_is_no_file_is_not_copied(tmp_path, kind):
    source = tmp_path / "ground.npz"
    if kind == "folder":
        source.mkdir()
    elif kind == "pipe":
        os.mkfifo(source)
    elif kind == "dangling":
        source.symlink_to(tmp_path / "nowhere")
    with pytest.raises(MissingInputError, match=r"ground\.npz"):
        write_bundle(tmp_path / "bundle", TEXTS, {"input/ground.npz": source})
    assert not (tmp_path / "bundle").exists()


def test_a_file_in_the_way_is_kept(tmp_path):
    (tmp_path / "bundle").write_text("mine")
    with pytest.raises(OutputError, match="it is a file, not a folder"):
        write_bundle(tmp_path / "bundle", TEXTS, {})
    assert (tmp_path / "bundle").read_text() == "mine"
