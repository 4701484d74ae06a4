"""Every example script runs as it says, and makes what it says; the page about them shows them as they are."""

from __future__ import annotations

import csv
import json
import re

import numpy as np
import pytest

import ski_addon
from ski_addon.errors import MissingInputError, SpecError
from ski_addon.simulation import Recording

from .running import EXAMPLES, run_example

PAGE = EXAMPLES.parent / "api.md"


def numbers(line):
    return [float(number) for number in re.findall(r"-?\d+\.?\d*", line)]


def test_simulate_only(tmp_path):
    said = run_example("simulate_only.py", tmp_path / "run.npz")
    recording = Recording.load(tmp_path / "run.npz")
    assert recording.status == "finished" and recording.header["mass"] == pytest.approx(75.0)
    duration, fastest = numbers(said[0])
    assert duration == pytest.approx(recording.duration, abs=0.05)
    assert fastest == pytest.approx(recording.speed.max(), abs=0.05)
    assert numbers(said[1]) == [round(float(np.rad2deg(np.abs(recording.inclination).max())))]
    assert numbers(said[2])[0] >= numbers(said[1])[0]


def test_sweep_radius(tmp_path):
    said = run_example("sweep_radius.py", tmp_path / "radii")
    rows = [numbers(line) for line in said[1:]]
    assert [row[0] for row in rows] == [10.0, 14.0, 20.0]
    assert [row[2] for row in rows] == sorted((row[2] for row in rows), reverse=True)  # wider turns need less lean
    with (tmp_path / "radii" / "sweep.csv").open() as stream:
        table = list(csv.DictReader(stream))
    assert [float(row["course.turn_radius"]) for row in table] == [10.0, 14.0, 20.0]
    names = [f"turn_radius={radius}" for radius in ("10.0", "14.0", "20.0")]
    made = [Recording.load(tmp_path / "radii" / name / "recording.npz") for name in names]
    assert [row[1] for row in rows] == pytest.approx([recording.speed.max() for recording in made], abs=0.05)


def test_many_skiers(tmp_path):
    said = run_example("many_skiers.py", tmp_path / "crowd")
    assert len(said) == 4 and all(line.endswith("finished") for line in said)
    crowd = json.loads((tmp_path / "crowd" / "crowd.json").read_text())
    made = [Recording.load(tmp_path / "crowd" / member["file"]) for member in crowd["members"]]
    assert len({recording.header["mass"] for recording in made}) == 4
    assert crowd["finished"] == 4


def test_the_page_shows_each_example_as_it_is():
    page = PAGE.read_text(encoding="utf-8")
    shown = dict(re.findall(r"<!-- (\S+\.py) -->\n```python\n(.*?)```", page, re.DOTALL))
    assert set(shown) == {path.name for path in EXAMPLES.glob("*.py")}
    for name, code in shown.items():
        assert code == (EXAMPLES / name).read_text(encoding="utf-8"), f"{name} on the page is not the file"


def test_the_page_tells_every_name_that_scripts_get():
    page = PAGE.read_text(encoding="utf-8")
    for name in ski_addon.__all__:
        assert f"`{name}" in page, name


def test_no_name_for_scripts_is_hidden_by_a_module_once_that_is_imported():
    modules = {path.stem for path in (EXAMPLES.parents[1] / "ski_addon").iterdir()}
    assert not modules & set(ski_addon.__all__)


def test_runs_are_found_by_name_and_by_path(tmp_path):
    run = ski_addon.load_run("giant_slalom", {"course.turn_radius": 17})
    (tmp_path / "mine.toml").write_text(run.to_toml())
    assert ski_addon.load_run(tmp_path / "mine.toml") == run and run.course.turn_radius == 17
    with pytest.raises(MissingInputError, match="giant_slalon"):
        ski_addon.load_run("giant_slalon")
    with pytest.raises(SpecError, match=r"course\.turn_radius = 1 is outside"):
        ski_addon.load_run("giant_slalom", {"course.turn_radius": 1})


def test_falls_are_raised_and_cancelling_is_heard():
    weak = {"course.turn_count": 2, "simulation.time_step": 0.004, "course.start_speed": 12, "skier.strength": 0.42}
    with pytest.raises(ski_addon.SkierFell, match="m along the track"):
        ski_addon.simulate(ski_addon.load_run("paper_main", {**weak, "technique.balance": "tracking"}))
    with pytest.raises(ski_addon.SkiAddonError, match="interrupted"):
        ski_addon.simulate(ski_addon.load_run("paper_main"), lambda fraction, text: False)


@pytest.mark.parametrize("call", [ski_addon.run_sweep, ski_addon.run_crowd])
def test_jobs_are_one_or_more(call, tmp_path):
    arguments = (ski_addon.RunSpec(), {}, tmp_path) if call is ski_addon.run_sweep else ("paper_main", tmp_path)
    with pytest.raises(SpecError, match="jobs = 0 is outside 1 or more"):
        call(*arguments, jobs=0)


def test_values_of_a_sweep_are_python_s(tmp_path):
    run = ski_addon.load_run("paper_main", {"course.turn_count": 1, "simulation.time_step": 0.004})
    rows = ski_addon.run_sweep(run, {"technique.inclination": [True], "technique.angulation": ["auto", -0.5]}, tmp_path)
    assert [row["values"]["technique.angulation"] for row in rows] == ["auto", "-0.5"]
    assert {row["values"]["technique.inclination"] for row in rows} == {"true"}
    with pytest.raises(SpecError, match="did you mean course.turn_radius"):
        ski_addon.run_sweep(run, {"course.turn_radus": [10]}, tmp_path)
    with pytest.raises(SpecError, match="course.turn_radius has no values"):
        ski_addon.run_sweep(run, {"course.turn_radius": []}, tmp_path)
