"""A run that goes on from a checkpoint ends with the bytes of one that was never stopped."""

from __future__ import annotations

import functools
import random
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from ski_addon import archive, environment
from ski_addon.pipeline import run_simulation, start_simulation
from ski_addon.simulation import Checkpoints
from ski_addon.state import take_state
from tests.ski_runs import COARSE, WEAK, planned

ROOT = Path(__file__).resolve().parents[2]
PUSHES = ({"body": "abdomen", "direction": "left", "force": 150.0, "start": 0.6, "duration": 0.4},)
SHORT = {**COARSE, "course.turn_count": 1, "course.transition_duration": 0.5}
CASES = {
    "on its plan": ("paper_main", SHORT),
    "by OSQP alone": ("paper_main", {**SHORT, "simulation.solver": "osqp"}),
    "weak, at its limits, then fallen": ("paper_main", WEAK),
    "pushed and steered back": ("paper_main", {**COARSE, "push": PUSHES}),
    "with skis nobody steers": ("paper_main", {**SHORT, "technique.controller": "open_loop"}),
}
LONG = ("slalom", "moguls", "bumps", "rolling_slalom", "steep", "giant_slalom_race", "uneven_slalom", "paper_r10")
"""Presets that replan, slide to a stop, jump, and change between solvers."""


@functools.cache
def _plan(label):
    from ski_addon.pipeline import make_plan
    from tests.ski_runs import preset

    name, changes = CASES[label]
    return make_plan(preset(name, {**changes, "push": list(PUSHES)} if "push" in changes else changes))


def finish(simulation):
    while simulation.advance(1000):
        pass
    return simulation


def content(simulation, folder):
    return simulation.recording().save(folder / "recording.npz").read_bytes()


def saved(plan, steps, path):
    """A checkpoint of `plan` after `steps`."""
    simulation, checkpoints = start_simulation(plan), Checkpoints(path, seconds=0.0)
    simulation.advance(steps)
    assert simulation.running and checkpoints.save(simulation)
    return simulation


def assert_goes_on(plan, moments, folder):
    """Assert that runs from checkpoints after `moments` steps end as one without; some begin on used simulations."""
    whole = content(finish(start_simulation(plan)), folder)
    for steps in moments:
        saved(plan, steps, folder / "checkpoint.npz")
        simulation = start_simulation(plan)
        simulation.advance(steps % 40)  # nothing of what it did before may be left
        assert Checkpoints(folder / "checkpoint.npz").load(simulation) and simulation.step_done == steps
        assert content(finish(simulation), folder) == whole, f"after {steps} steps"


@pytest.mark.parametrize("label", CASES)
def test_run_from_a_checkpoint_has_the_same_bytes(label, tmp_path):
    plan, chance = _plan(label), random.Random(label)
    total = finish(start_simulation(plan)).step_done
    assert_goes_on(plan, [255, *(chance.randrange(1, total) for _ in range(2))], tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", LONG)
def test_long_run_from_a_checkpoint_has_the_same_bytes(name, tmp_path):
    plan, chance = planned(name, {"simulation.time_step": 0.002}), random.Random(name)
    total = finish(start_simulation(plan)).step_done
    assert_goes_on(plan, [chance.randrange(1, total) for _ in range(8)], tmp_path)


IN_A_NEW_PROCESS = """
import sys
from ski_addon.pipeline import make_plan, start_simulation
from ski_addon.simulation import Checkpoints
from ski_addon.spec import RunSpec
simulation = start_simulation(make_plan(RunSpec.from_toml(sys.argv[1])))
assert Checkpoints(sys.argv[2]).load(simulation)
while simulation.advance(1000):
    pass
simulation.recording().save(sys.argv[3])
"""


def test_new_process_goes_on_with_the_same_bytes(tmp_path):
    plan = _plan("pushed and steered back")
    (tmp_path / "spec.toml").write_text(plan.spec.to_toml())
    saved(plan, 777, tmp_path / "checkpoint.npz")
    words = [tmp_path / name for name in ("spec.toml", "checkpoint.npz", "again.npz")]
    subprocess.run([sys.executable, "-c", IN_A_NEW_PROCESS, *map(str, words)], cwd=ROOT, check=True, timeout=120)
    assert (tmp_path / "again.npz").read_bytes() == content(finish(start_simulation(plan)), tmp_path)


def test_checkpoints_on_the_way_change_nothing_and_are_written(tmp_path):
    plan, written = _plan("on its plan"), []
    checkpoints = Checkpoints(tmp_path / "checkpoint.npz", seconds=0.0)
    save = checkpoints.save
    checkpoints.save = lambda simulation: written.append(simulation.step_done) or save(simulation)
    recording, seconds = run_simulation(plan, checkpoints=checkpoints)
    plain, _ = run_simulation(plan)
    assert len(written) >= 2 and len(seconds) == len(recording.time)
    assert recording.save(tmp_path / "a.npz").read_bytes() == plain.save(tmp_path / "b.npz").read_bytes()
    checkpoints.remove()
    assert not checkpoints.path.exists()


def test_cancelled_run_leaves_a_checkpoint_and_goes_on_from_it(tmp_path):
    plan, path, said = _plan("on its plan"), tmp_path / "checkpoint.npz", []
    first, _ = run_simulation(plan, lambda fraction, _text: fraction < 0.5, Checkpoints(path))
    assert first.status == "cancelled" and path.is_file()
    whole, _ = run_simulation(plan, checkpoints=Checkpoints(path, tell=said.append))
    assert said == [f"going on from {first.duration:.2f} s, where {path} was saved"]
    plain, _ = run_simulation(plan)
    assert whole.save(tmp_path / "a.npz").read_bytes() == plain.save(tmp_path / "b.npz").read_bytes()


def damaged(kind, path):
    """Spoil a checkpoint in some way."""
    whole = path.read_bytes()
    header, arrays = archive.read(path, "ski-addon-checkpoint", 1)
    if kind == "cut short":
        path.write_bytes(whole[: len(whole) // 2])
    elif kind == "empty":
        path.write_bytes(b"")
    elif kind == "one byte other":
        path.write_bytes(whole[:-90_000] + bytes([whole[-90_000] ^ 1]) + whole[-89_999:])
    elif kind == "of another version":
        archive.write(path, header | {"format_version": 99}, arrays)
    elif kind == "made by other libraries":
        versions = header["made_from"]["versions"] | {"numpy": "0.1"}
        archive.write(path, header | {"made_from": header["made_from"] | {"versions": versions}}, arrays)
    elif kind == "of another shape":
        archive.write(path, header, arrays | {"state.dynamics.qpos": np.zeros(3)})
    elif kind == "without its steps":
        archive.write(path, header, arrays | {"log.reals": arrays["log.reals"][1:]})
    elif kind == "of narrower steps":
        archive.write(path, header, arrays | {"log.reals": arrays["log.reals"][:, 1:]})
    elif kind == "without a header":
        archive.write(path, {"format": "ski-addon-checkpoint", "format_version": 1}, arrays)
    elif kind == "pickled":
        np.savez(path, header=np.array([{}], dtype=object))


@pytest.mark.parametrize(
    "kind",
    [
        *("cut short", "empty", "one byte other", "of another version", "made by other libraries", "of another shape"),
        *("without its steps", "of narrower steps", "without a header", "pickled"),
    ],
)
def test_checkpoint_that_cannot_be_used_is_one_line_and_a_new_beginning(kind, tmp_path):
    plan, path, said = _plan("on its plan"), tmp_path / "checkpoint.npz", []
    saved(plan, 300, path)
    damaged(kind, path)
    simulation = start_simulation(plan)
    before = take_state(simulation)
    assert not Checkpoints(path, tell=said.append).load(simulation)
    after = take_state(simulation)
    assert len(said) == 1 and said[0].startswith(f"begun anew, for {path} cannot be used: ")
    assert before.keys() == after.keys() and simulation.log.recorder.count == 0
    assert all(np.array_equal(value, after[name]) for name, value in before.items())


def test_checkpoint_of_another_run_is_left_aside(tmp_path):
    said = []
    saved(_plan("on its plan"), 300, tmp_path / "checkpoint.npz")
    simulation = start_simulation(_plan("by OSQP alone"))
    assert not Checkpoints(tmp_path / "checkpoint.npz", tell=said.append).load(simulation)
    assert "it was made from another spec" in said[0]


def test_nothing_in_a_checkpoint_is_pickled(tmp_path):
    saved(_plan("pushed and steered back"), 500, tmp_path / "checkpoint.npz")
    with zipfile.ZipFile(tmp_path / "checkpoint.npz") as members:
        assert members.testzip() is None
    with np.load(tmp_path / "checkpoint.npz", allow_pickle=False) as arrays:
        assert all(arrays[name].dtype.kind in "fiub" for name in arrays.files)


def test_disk_without_room_for_a_checkpoint_stops_nothing(tmp_path):
    said = []
    checkpoints = Checkpoints(tmp_path / "nowhere" / "checkpoint.npz", seconds=0.0, tell=said.append)
    recording, _ = run_simulation(_plan("on its plan"), checkpoints=checkpoints)
    assert recording.status == "finished" and said[0].startswith("no checkpoint: cannot write ")


def test_time_between_checkpoints_is_kept(tmp_path, monkeypatch):
    monkeypatch.setenv(environment.CHECKPOINT_SECONDS, "1000")
    checkpoints, simulation = Checkpoints(tmp_path / "checkpoint.npz"), start_simulation(_plan("on its plan"))
    simulation.advance(10)
    checkpoints.offer(simulation)
    assert not checkpoints.path.exists()
