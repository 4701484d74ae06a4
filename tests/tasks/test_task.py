"""Keys and receipts: what is finished, and why something is not."""

from __future__ import annotations

import json

import numpy as np
import pytest

from ski_addon.errors import MissingInputError
from ski_addon.spec import RunSpec
from ski_addon.talk import Talk
from ski_addon.tasks import Task, spec_inputs
from ski_addon.tasks.keys import versions
from ski_addon.tasks.task import made_by, read_receipt

QUIET = Talk(quiet=True)


def task(folder, **inputs):
    return Task("make", folder / "a.bin", {"size": 1} | inputs, {"ski_addon": "0"}, seed=4)


@pytest.fixture
def done(tmp_path):
    """A folder with a finished task."""
    (tmp_path / "a.bin").write_bytes(b"one")
    (tmp_path / "b.txt").write_text("two")
    task(tmp_path).finish(("a.bin", "b.txt"), QUIET, status="finished")
    return tmp_path


def test_finished_task_has_a_receipt_that_says_by_what_and_where(done):
    receipt = json.loads((done / "a.task.json").read_text())
    assert task(done).unfinished(("a.bin", "b.txt")) == ""
    assert receipt["key"] == task(done).key and receipt["seed"] == 4 and receipt["status"] == "finished"
    assert receipt["versions"] == {"ski_addon": "0"} and set(receipt["host"]) == {"name", "system", "machine"}


@pytest.mark.parametrize(
    ("spoil", "why"),
    [
        (lambda folder: (folder / "a.bin").write_bytes(b"on"), "a.bin is not as it was written"),
        (lambda folder: (folder / "b.txt").write_text("tow"), "b.txt is not as it was written"),
        (lambda folder: (folder / "b.txt").unlink(), "b.txt is gone"),
        (lambda folder: (folder / "a.task.json").unlink(), "there is no receipt of a.bin"),
        (lambda folder: (folder / "a.task.json").write_text("{"), "there is no receipt of a.bin"),
        (lambda folder: (folder / "a.task.json").write_text("[]"), "there is no receipt of a.bin"),
        (lambda folder: (folder / "a.task.json").write_text("[" * 100_000), "there is no receipt of a.bin"),
        (lambda folder: (folder / "a.task.json").write_bytes(b"\xff\xfe"), "there is no receipt of a.bin"),
    ],
)
def test_file_that_was_touched_makes_a_task_unfinished(done, spoil, why):
    spoil(done)
    assert task(done).unfinished(("a.bin", "b.txt")) == why


def test_other_inputs_and_other_files_are_other_work(done, tmp_path):
    assert task(done, size=2).unfinished(("a.bin",)) == "a.bin was made from something else"
    assert task(done).unfinished(("a.bin", "c.txt")) == "c.txt was not made"
    assert task(tmp_path / "new").unfinished(("a.bin",)) == "not made yet"


def test_key_depends_on_everything_that_decides():
    def key(command="make", inputs=1, version="0"):
        from pathlib import Path

        return Task(command, Path("a.bin"), {"size": inputs}, {"ski_addon": version}).key

    assert len({key(), key("other"), key(inputs=2), key(version="1")}) == 4 and key() == key()


def test_file_is_known_by_the_task_that_made_it_until_it_is_changed(done):
    assert made_by(done / "a.bin") == task(done).key
    (done / "a.bin").write_bytes(b"other")
    assert made_by(done / "a.bin") != task(done).key
    with pytest.raises(MissingInputError):
        made_by(done / "none.bin")
    assert read_receipt(done / "none.bin") is None


def test_ground_counts_by_its_heights_wherever_it_lies(tmp_path):
    heights = np.zeros((40, 40)) - np.arange(40.0)[:, None]
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        np.save(tmp_path / name / "ground.npy", heights)

    def inputs(name):
        changes = {"slope.kind": "grid", "slope.grid_file": str(tmp_path / name / "ground.npy")}
        return spec_inputs(RunSpec().with_overrides(changes))

    assert inputs("one") == inputs("two")
    np.save(tmp_path / "two" / "ground.npy", heights * 1.01)
    assert inputs("one") != inputs("two")


def test_versions_of_what_is_not_there_are_empty():
    found = versions("numpy", "no_such_library")
    assert found["numpy"] == np.__version__ and found["no_such_library"] == "" and found["python"]
