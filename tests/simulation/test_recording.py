"""Recordings on disk: the way there and back, and every way in which a file can be wrong."""

from __future__ import annotations

import errno
import io
import json
import random
import zipfile

import numpy as np
import pytest

from ski_addon import archive
from ski_addon.errors import OutputError, RecordingError
from ski_addon.simulation import Recording
from ski_addon.simulation.recorder import COUNTS, SHAPES, Recorder
from ski_addon.simulation.recording import array_names
from ski_addon.spec import RunSpec
from tests.ski_runs import simulated

TINY = {"course.turn_count": 1, "course.turn_duration": 0.1, "simulation.time_step": 0.002}


@pytest.fixture
def recording() -> Recording:
    return simulated("paper_main", TINY)


@pytest.fixture
def saved(recording, tmp_path):
    return recording.save(tmp_path / "run.npz")


def members(path) -> dict[str, bytes]:
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def rewrite(path, contents: dict[str, bytes]) -> None:
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in contents.items():
            archive.writestr(name, content)


def npy(array, **options) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, array, **options)
    return buffer.getvalue()


def refusal(path) -> str:
    with pytest.raises(RecordingError) as caught:
        Recording.load(path)
    message = str(caught.value)
    assert "\n" not in message and path.name in message and caught.value.exit_code == 3
    return message


# -- there and back -----------------------------------------------------------------


def test_round_trip(recording, saved):
    loaded = Recording.load(saved)
    assert loaded.header == recording.header
    for name in array_names():
        before, after = getattr(recording, name), getattr(loaded, name)
        np.testing.assert_array_equal(after, before)
        assert after.dtype == before.dtype and not after.flags.writeable, name


def test_saving_again_gives_the_same_bytes(recording, saved, tmp_path):
    again = Recording.load(saved).save(tmp_path / "again.npz")
    assert again.read_bytes() == saved.read_bytes()


def test_a_run_can_be_read_with_numpy_alone(recording, saved):
    with np.load(saved, allow_pickle=False) as archive:
        np.testing.assert_array_equal(archive["qpos"], recording.qpos)
        assert set(archive.files) == {*array_names(), "header"}
        header = json.loads(archive["header"].tobytes())
    assert header["format"] == "ski-addon-recording" and header["status"] == "finished"


def test_header_holds_what_is_needed_to_make_the_run_again(recording):
    header = recording.header
    spec = RunSpec.from_text(header["spec"])
    assert spec.content_hash() == header["spec_hash"]
    assert len(header["body_names"]) == 20 and len(header["joint_names"]) == 35
    assert len(header["actuated_joint_names"]) == recording.tau.shape[1] == 31
    assert set(header["versions"]) >= {"ski_addon", "numpy", "scipy", "osqp", "mujoco", "python"}
    assert (header["seed"], header["time_step"], header["mass"]) == (0, 0.002, pytest.approx(50.0))
    assert header["gravity"] == [0.0, 0.0, -9.81] and len(header["model_hash"]) == 16


def test_shapes_are_those_of_the_format(recording):
    count = len(recording.time)
    for name, shape in SHAPES.items():
        assert getattr(recording, name).shape == (count, *shape)
        assert getattr(recording, name).dtype == np.float64
    for name, kind in COUNTS.items():
        assert getattr(recording, name).shape == (count,) and getattr(recording, name).dtype == kind
    assert sorted([*SHAPES, *COUNTS]) == sorted(array_names())


def test_duration_counts_every_step(recording):
    assert recording.duration == pytest.approx(len(recording.time) * 0.002)


def test_recorder_grows_past_what_was_expected():
    recorder = Recorder(expected=1, numbers=("speed",), arrays=("snow_force",))
    for step in range(200):
        recorder.add((0.5 * step,), (np.full((2, 3), float(step)),), tuple(step % 100 for _ in COUNTS))
    assert recorder.count == 200
    np.testing.assert_array_equal(recorder.column("speed"), 0.5 * np.arange(200))
    np.testing.assert_array_equal(recorder.column("snow_force")[:, 1, 2], np.arange(200.0))
    np.testing.assert_array_equal(recorder.column("turn"), np.arange(200) % 100)
    with pytest.raises(ValueError, match="zip"):
        recorder.add((0.0, 1.0), (np.zeros((2, 3)),), tuple(0 for _ in COUNTS))


def test_columns_are_filled_in_for_many_steps_at_once():
    recorder = Recorder(expected=8, numbers=("time",))
    for step in range(6):
        recorder.add((float(step),), (), tuple(0 for _ in COUNTS))
    recorder.fill(2, {"com": np.arange(12.0).reshape(4, 3), "turn": np.array([4, 5, 6, 7])})
    np.testing.assert_array_equal(recorder.rows("com", 4), [[6.0, 7.0, 8.0], [9.0, 10.0, 11.0]])
    np.testing.assert_array_equal(recorder.column("com")[:2], 0.0)
    np.testing.assert_array_equal(recorder.column("turn"), [0, 0, 4, 5, 6, 7])
    np.testing.assert_array_equal(recorder.column("time"), np.arange(6.0))


# -- files that are no recordings ---------------------------------------------------


def test_no_file(tmp_path):
    assert "there is no such file" in refusal(tmp_path / "none.npz")


def test_folder(tmp_path):
    assert "there is no such file" in refusal(tmp_path)


@pytest.mark.parametrize("content", [b"", b"not a recording", b"PK\x03\x04 but not for long", b"\x00" * 5000])
def test_other_file(tmp_path, content):
    path = tmp_path / "other.npz"
    path.write_bytes(content)
    assert "truncated or not a recording" in refusal(path)


def test_truncated_file_of_any_length(saved):
    whole = saved.read_bytes()
    for length in [*range(0, 300, 37), *range(300, len(whole), len(whole) // 40), len(whole) - 1]:
        saved.write_bytes(whole[:length])
        assert "truncated" in refusal(saved)


def test_pickles_are_never_opened(saved):
    contents = members(saved)
    contents["qpos.npy"] = npy(np.array([print, "anything"], dtype=object), allow_pickle=True)
    rewrite(saved, contents)
    assert "truncated or not a recording" in refusal(saved)


@pytest.mark.parametrize("name", ["qpos", "header", "solver_status"])
def test_missing_array_is_named(saved, name):
    contents = members(saved)
    del contents[f"{name}.npy"]
    rewrite(saved, contents)
    message = refusal(saved)
    assert name in message and "lacks" in message


def test_array_of_other_length_is_named(saved, recording):
    contents = members(saved)
    contents["tau.npy"] = npy(recording.tau[:-1])
    rewrite(saved, contents)
    assert "tau" in refusal(saved)


def test_array_of_other_width_is_named(saved, recording):
    contents = members(saved)
    contents["qpos.npy"] = npy(recording.qpos[:, :10])
    rewrite(saved, contents)
    assert "qpos" in refusal(saved)


def test_array_of_words_is_named(saved, recording):
    contents = members(saved)
    contents["speed.npy"] = npy(np.array(["fast"] * len(recording.time)))
    rewrite(saved, contents)
    assert "speed" in refusal(saved)


@pytest.mark.parametrize(
    ("header", "words"),
    [
        ({"format": "something else", "format_version": 2}, "not a recording of a ski run"),
        ({}, "not a recording of a ski run"),
        ([1, 2], "not a recording of a ski run"),
        ({"format": "ski-addon-recording", "format_version": 99}, "format version 99"),
    ],
)
def test_header_of_something_else(saved, header, words):
    contents = members(saved)
    contents["header.npy"] = npy(np.frombuffer(json.dumps(header).encode(), dtype=np.uint8))
    rewrite(saved, contents)
    assert words in refusal(saved)


def test_header_that_is_not_json(saved):
    contents = members(saved)
    contents["header.npy"] = npy(np.frombuffer(b"\xff\xfe{", dtype=np.uint8))
    rewrite(saved, contents)
    assert "truncated or not a recording" in refusal(saved)


def test_file_that_would_fill_the_memory_is_not_opened(saved, monkeypatch):
    monkeypatch.setattr(archive, "LARGEST_BYTES", 10_000)
    assert "unpack" in refusal(saved)


def test_flipped_bits_in_the_numbers_are_noticed(saved):
    """Every array carries a checksum."""
    whole, place = saved.read_bytes(), random.Random(0)
    begin = whole.find(b"qpos.npy") + 200
    for _ in range(20):
        damaged = bytearray(whole)
        damaged[begin + place.randrange(10_000)] ^= 1 << place.randrange(8)
        saved.write_bytes(damaged)
        refusal(saved)


def test_any_damage_is_one_line(saved):
    """Other errors than RecordingError would be tracebacks."""
    whole, place = saved.read_bytes(), random.Random(1)
    directory = whole.find(b"PK\x01\x02")
    for _ in range(300):
        damaged = bytearray(whole)
        damaged[place.randrange(directory, len(whole))] = place.randrange(256)
        saved.write_bytes(damaged)
        try:
            Recording.load(saved)
        except RecordingError as error:
            assert "\n" not in str(error)


# -- folders that cannot be written ----------------------------------------------------


def test_output_folder_that_is_not_there(recording, tmp_path):
    with pytest.raises(OutputError, match="No such file or directory") as caught:
        recording.save(tmp_path / "nowhere" / "run.npz")
    assert "\n" not in str(caught.value) and caught.value.exit_code == 3
    assert list(tmp_path.iterdir()) == []


def test_output_folder_that_is_a_file(recording, tmp_path):
    (tmp_path / "file").write_text("mine")
    with pytest.raises(OutputError):
        recording.save(tmp_path / "file" / "run.npz")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
    assert (tmp_path / "file").read_text() == "mine"


def test_output_that_is_a_folder(recording, tmp_path):
    with pytest.raises(OutputError, match="it is a folder"):
        recording.save(tmp_path)


def test_disk_that_fills_up_leaves_the_old_file_and_nothing_else(recording, saved, tmp_path, monkeypatch):
    before, write = saved.read_bytes(), archive._write_member

    def full(archive, name, array):
        if name == "tau":
            raise OSError(errno.ENOSPC, "No space left on device")
        write(archive, name, array)

    monkeypatch.setattr(archive, "_write_member", full)
    with pytest.raises(OutputError, match="No space left on device"):
        recording.save(saved)
    assert saved.read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["run.npz"]


def test_interrupted_saving_leaves_nothing(recording, tmp_path, monkeypatch):
    def interrupt(archive, name, array):
        raise KeyboardInterrupt

    monkeypatch.setattr(archive, "_write_member", interrupt)
    with pytest.raises(KeyboardInterrupt):
        recording.save(tmp_path / "run.npz")
    assert list(tmp_path.iterdir()) == []
