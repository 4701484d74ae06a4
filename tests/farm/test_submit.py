"""The command `submit`: what it writes, and one line for what it cannot."""

from __future__ import annotations

import importlib.util
import json
import os

import numpy as np
import pytest

from ski_addon.crowd import find_crowd, read_crowd
from ski_addon.farm import flamenco
from ski_addon.spec import RunSpec, find_document
from tests.farm.conftest import read_template

pytestmark = pytest.mark.usefixtures("quick_plans")


def step(bundle, name):
    return next(step for step in read_template(bundle)["steps"] if step["name"] == name)


def run_of(bundle, name):
    return step(bundle, name)["script"]["actions"]["onRun"]


@pytest.fixture
def hill(tmp_path):
    """A run document on a grid of heights beside it, both with names that need quoting."""
    folder = tmp_path / 'it\'s "here"'
    folder.mkdir()
    np.save(folder / "my {{Param.Hill}} $(x).npy", -0.2 * np.arange(40.0)[:, None] + np.zeros(30))
    changes = {"slope.kind": "grid", "slope.grid_spacing": 2.0, "name": 'A "{{run}}"'}
    spec = RunSpec.from_toml(find_document("paper_main")).with_overrides(changes)
    document = folder / "run.toml"
    document.write_text(
        spec.to_toml().replace('grid_file = ""', 'grid_file = "my {{Param.Hill}} $(x).npy"'), encoding="utf-8"
    )
    return document


def test_bundle_of_a_preset(submit, tmp_path):
    bundle = tmp_path / "bundle"
    code, out, err = submit("paper_main", "-o", bundle)
    assert (code, err) == (0, "")
    assert f"wrote {bundle}, 1 run, frames 1-37, 6 tasks" in out  # 1.5 s
    files = sorted(path.relative_to(bundle).as_posix() for path in bundle.rglob("*") if path.is_file())
    assert files == ["input/spec.toml", "parameter_values.json", "template.json"]
    spec = RunSpec.from_toml(find_document("paper_main"))
    assert RunSpec.from_toml(bundle / "input" / "spec.toml") == spec


def test_steps_wait_for_each_other_and_can_be_stopped(submit, tmp_path):
    submit("paper_main", "-o", tmp_path, "--frames", "1-20", "--chunk", "8")
    template = read_template(tmp_path)
    assert [item["name"] for item in template["steps"]] == ["Simulate", "Bake", "Render"]
    assert [item.get("dependencies") for item in template["steps"]] == [
        None,
        [{"dependsOn": "Simulate"}],
        [{"dependsOn": "Bake"}],
    ]
    assert run_of(tmp_path, "Simulate")["args"] == [
        *("-m", "ski_addon", "simulate", "{{Param.Input}}/spec.toml", "--output", "{{Param.Output}}/run")
    ]
    assert run_of(tmp_path, "Render")["args"][-2:] == ["--frames", "{{Task.Param.Frames}}"]
    (frames,) = step(tmp_path, "Render")["parameterSpace"]["taskParameterDefinitions"]
    assert (frames["type"], frames["range"]) == ("STRING", ["1-8", "9-16", "17-20"])
    for name in ("Simulate", "Bake", "Render"):
        assert run_of(tmp_path, name)["timeout"] >= 900
        assert run_of(tmp_path, name)["cancelation"]["mode"] == "NOTIFY_THEN_TERMINATE"
        assert "hostRequirements" not in step(tmp_path, name)
    assert template["jobEnvironments"][0]["variables"]["SKI_ADDON_OPENJD"] == "1"
    assert "extensions" not in template


def test_paths_of_the_template_are_relative(submit, tmp_path, hill):
    submit(hill, "-o", tmp_path / "bundle", "--frames", "1")
    paths = [item for item in read_template(tmp_path / "bundle")["parameterDefinitions"] if item["type"] == "PATH"]
    assert [(item["default"], item["dataFlow"]) for item in paths] == [("input", "IN"), ("output", "OUT")]
    everything = "".join(path.read_text() for path in (tmp_path / "bundle").rglob("*.*ml"))
    everything += json.dumps(read_template(tmp_path / "bundle"))
    assert str(tmp_path) not in everything


def test_terrain_is_copied_under_a_plain_name(submit, tmp_path, hill):
    bundle = tmp_path / "bundle"
    assert submit(hill, "-o", bundle, "--frames", "1")[0] == 0
    (copy,) = (bundle / "input" / "terrain").iterdir()
    (original,) = hill.parent.glob("*.npy")
    assert copy.name == "my_Param.Hill_x_.npy"
    assert copy.read_bytes() == original.read_bytes()
    spec = RunSpec.from_toml(bundle / "input" / "spec.toml")
    assert spec.slope.grid_file == str(copy)
    assert run_of(bundle, "Bake")["args"][-2:] == ["--set", f"slope.grid_file={{{{Param.Input}}}}/terrain/{copy.name}"]
    values = json.loads((bundle / "parameter_values.json").read_text())["parameterValues"]
    assert {"name": "JobName", "value": 'A "{{run}}"'} in values


def test_shipped_terrain_is_named_not_copied(submit, tmp_path):
    submit("rolling_giant_slalom", "-o", tmp_path, "--frames", "1")
    assert not (tmp_path / "input" / "terrain").exists()
    assert RunSpec.from_toml(tmp_path / "input" / "spec.toml").slope.grid_file == "rolling_hill"


def test_terrain_by_a_link_becomes_a_file_of_the_bundle(submit, tmp_path, hill):
    (original,) = hill.parent.glob("*.npy")
    original.rename(tmp_path / "far.npy")
    original.symlink_to("../far.npy")
    submit(hill, "-o", tmp_path / "bundle", "--frames", "1")
    (copy,) = (tmp_path / "bundle" / "input" / "terrain").iterdir()
    assert not copy.is_symlink()
    assert copy.read_bytes() == (tmp_path / "far.npy").read_bytes()


def test_variations_are_task_parameters_and_folders(submit, tmp_path):
    code, out, _ = submit(
        *(
            "paper_main",
            "-o",
            tmp_path,
            "--vary",
            "course.turn_radius=10,30",
            "--vary",
            "technique.angulation=auto,-0.5",
        ),
    )
    assert code == 0
    assert "4 runs, frames 1-73, 40 tasks" in out  # of the longest, 3 s
    space = step(tmp_path, "Render")["parameterSpace"]
    assert space["combination"] == "course_turn_radius * technique_angulation * Frames"
    radius, angulation, _ = space["taskParameterDefinitions"]
    assert radius == {"name": "course_turn_radius", "type": "FLOAT", "range": [10, 30]}
    assert angulation == {"name": "technique_angulation", "type": "STRING", "range": ["auto", "-0.5"]}
    folder = (
        "{{Param.Output}}/course.turn_radius={{Task.Param.course_turn_radius}}"
        "/technique.angulation={{Task.Param.technique_angulation}}"
    )
    simulate = run_of(tmp_path, "Simulate")["args"]
    assert simulate[5] == f"{folder}/run"
    assert simulate[6:8] == ["--set", "course.turn_radius={{Task.Param.course_turn_radius}}"]
    assert run_of(tmp_path, "Bake")["args"][3:] == [f"{folder}/run", "--output", f"{folder}/skier.blend"]


def test_pairs_go_together(submit, tmp_path):
    vary = ["--vary", "course.turn_radius=10,20", "--vary", "simulation.seed=1-2", "--pairs"]
    assert "2 runs" in submit("paper_main", "-o", tmp_path, *vary)[1]
    assert step(tmp_path, "Simulate")["parameterSpace"]["combination"] == "(course_turn_radius, simulation_seed)"
    assert step(tmp_path, "Render")["parameterSpace"]["combination"] == "(course_turn_radius, simulation_seed) * Frames"


def test_chunking_is_an_extension_that_must_be_asked_for(submit, tmp_path):
    submit("paper_main", "-o", tmp_path, "--chunking", "--frames", "1-20", "--chunk", "8")
    template = read_template(tmp_path)
    assert template["extensions"] == ["TASK_CHUNKING"]
    (frames,) = step(tmp_path, "Render")["parameterSpace"]["taskParameterDefinitions"]
    assert (frames["type"], frames["chunks"]["rangeConstraint"]) == ("CHUNK[INT]", "CONTIGUOUS")
    defaults = {item["name"]: item["default"] for item in template["parameterDefinitions"]}
    assert (defaults["Frames"], defaults["ChunkSize"]) == ("1-20", 8)


def test_options_of_render_are_passed_on(submit, tmp_path):
    given = {"engine": "workbench", "size": "96x54", "motion-blur": "0.5", "denoise": "false"}
    options = [word for name, value in given.items() for word in ("--render", f"{name}={value}")]
    submit("paper_main", "-o", tmp_path, "--frames", "1", *options)
    arguments = run_of(tmp_path, "Render")["args"]
    wanted = ["--engine", "workbench", "--size", "96x54", "--motion-blur", "0.5", "--no-denoise"]
    assert arguments[arguments.index("--engine") :] == wanted


def test_needs_of_workers_are_asked_for(submit, tmp_path):
    submit("paper_main", "-o", tmp_path, "--cores", "4", "--memory", "16", "--workers", "blender")
    amounts = step(tmp_path, "Bake")["hostRequirements"]["amounts"]
    least = {item["name"]: item["min"] for item in amounts}
    assert least == {"amount.worker.vcpu": 4, "amount.worker.memory": 16384}
    assert run_of(tmp_path, "Bake")["command"] == "{{Param.Blender}}"
    assert run_of(tmp_path, "Bake")["args"][:3] == ["--command", "ski", "bake"]


def test_long_runs_have_longer_to_simulate(submit, tmp_path):
    submit("paper_main", "-o", tmp_path / "short")
    submit("paper_main", "-o", tmp_path / "long", "--set", "course.turn_count=300")
    assert run_of(tmp_path / "long", "Simulate")["timeout"] > 3 * run_of(tmp_path / "short", "Simulate")["timeout"]


def test_large_runs_are_forced_on_the_workers_too(submit, refused, tmp_path):
    large = [
        "paper_main",
        "-o",
        tmp_path / "bundle",
        "--frames",
        "1",
        "--set",
        "course.turn_duration=10",
        "--vary",
        "course.turn_count=2,500",
    ]
    code, line = refused(*large)
    assert code == 2
    assert "more than 8 GB or an hour" in line
    assert submit(*large, "--force")[0] == 0
    assert "--force" in run_of(tmp_path / "bundle", "Simulate")["args"]


def test_flamenco_bundle_has_job_type_and_job(submit, tmp_path, hill):
    bundle = tmp_path / "bundle"
    assert (
        submit(
            hill, "-o", bundle, "--engine", "flamenco", "--frames", "1-20,40", "--chunk", "7", "--render", "size=96x54"
        )[0]
        == 0
    )
    assert (bundle / flamenco.SCRIPT).read_text(encoding="utf-8") == flamenco.read_script()
    job = json.loads((bundle / "job.json").read_text(encoding="utf-8"))
    assert job["type"] == "ski-simulate-bake-render"
    settings = job["settings"]
    assert settings["spec"] == str(bundle / "input" / "spec.toml")
    assert (bundle / "input" / "terrain" / os.path.basename(settings["ground"])).is_file()
    assert (settings["engine"], settings["size"]) == ("cycles", "96x54")
    assert (settings["frames"], settings["chunk_size"], settings["workers"]) == ("1-20,40", 7, "blender")


def test_the_same_again_changes_nothing_and_another_job_is_refused(submit, refused, tmp_path):
    submit("paper_main", "-o", tmp_path)
    assert f"unchanged: {tmp_path}" in submit("paper_main", "-o", tmp_path)[1]
    code, line = refused("paper_main", "-o", tmp_path, "--chunk", "9")
    assert code == 3
    assert "it holds something else than this job: name an empty or a new folder" in line


def test_summary_for_machines(submit, tmp_path):
    code, out, err = submit("paper_main", "-o", tmp_path, "--json", "--vary", "simulation.seed=1-3", "--frames", "1-20")
    assert (code, err) == (0, "")
    assert json.loads(out) == {"bundle": str(tmp_path), "engine": "openjd", "runs": 3, "tasks": 12}


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["--frames", "10-1"], 2, '--frames = "10-1" is no range of frames: write the smaller frame first'),
        (["--frames", ""], 2, "--frames"),
        (["--chunk", "0"], 2, '--chunk = "0" is outside 1..1000000 frames'),
        (["--frames", "1-5000", "--chunk", "1"], 2, "--chunk = 1 makes 5000 chunks, allowed are 1024"),
        (
            ["--vary", "simulation.seed=0-99", "--vary", "skier.mass=50,60,70"],
            2,
            "--vary makes 300 runs, allowed are 256",
        ),
        (["--vary", "course.radius=10"], 2, "course.radius is not a key of a run"),
        (["--render", "engin=cycles"], 2, "--render engin is no option of render: did you mean engine?"),
        (["--render", "size"], 2, '--render size = "" is not one of its values: give pixels'),
        (["--render", "size=10x"], 2, '--render size = "10x" is not one of its values'),
        (["--render", "samples=0"], 2, "give a whole number"),
        (["--render", "samples=4", "--render", "samples=5"], 2, "--render samples is given twice"),
        (["--engine", "flamenco", "--render", "denoise=true"], 2, "--render denoise is not for flamenco"),
        (["--pairs"], 2, "--pairs needs two keys or more"),
        (["--cores", "0"], 2, '--cores = "0" is outside 1..1024'),
        (["--memory", "lots"], 2, '--memory = "lots" is outside'),
        (["--engine", "deadline"], 2, "--engine"),
        (["--engine", "flamenco", "--vary", "skier.mass=50,60"], 2, "--vary is not for flamenco"),
        (["--engine", "flamenco", "--chunking"], 2, "--chunking is not for flamenco"),
        (["--engine", "flamenco", "--run"], 2, "--run is not for flamenco"),
        (["--set", "bake.frame_start=-10"], 2, "bake.frame_start = -10 is outside frames of 0..1048574 on a farm"),
    ],
)
def test_bad_options_are_one_line(refused, tmp_path, arguments, code, message):
    bundle = tmp_path / "bundle"
    assert refused("paper_main", "-o", bundle, *arguments)[0] == code
    assert message in refused("paper_main", "-o", bundle, *arguments)[1]
    assert not bundle.exists()


def test_missing_terrain_is_named(refused, tmp_path, hill):
    next(hill.parent.glob("*.npy")).unlink()
    code, line = refused(hill, "-o", tmp_path / "bundle", "--frames", "1")
    assert code == 3
    assert ".npy: there is no such file" in line
    assert not (tmp_path / "bundle").exists()


def test_bundle_beside_the_source_is_refused(refused, hill):
    before = sorted(hill.parent.iterdir())
    code, line = refused(hill, "-o", hill.parent, "--frames", "1")
    assert code == 3
    assert "it holds something else than this job" in line
    assert sorted(hill.parent.iterdir()) == before


def test_running_needs_openjd(refused, tmp_path, monkeypatch):
    find = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "openjd" else find(name))
    code, line = refused("paper_main", "-o", tmp_path / "bundle", "--run")
    assert code == 3
    assert "openjd-cli is needed for --run: install it with: pip install openjd-cli" in line
    assert not (tmp_path / "bundle").exists()


def test_bundle_of_a_crowd_is_the_whole_crowd(submit, tmp_path):
    options = ("--frames", "1-20", "--set", "crowd.count=3", "--vary", "crowd.seed=1-2", "--vary", "spread.mass=0,0.1")
    code, out, err = submit("free_skiing", "--crowd", "-o", tmp_path, *options)
    assert (code, err) == (0, "")
    assert "4 runs, frames 1-20, 16 tasks" in out
    assert sorted(os.listdir(tmp_path / "input")) == ["crowd.toml", "run_1.toml", "run_2.toml"]
    crowd = read_crowd(tmp_path / "input" / "crowd.toml")
    assert crowd == read_crowd(find_crowd("free_skiing"), changes={"crowd.count": 3})
    assert run_of(tmp_path, "Simulate")["args"][2:4] == ["crowd", "{{Param.Input}}/crowd.toml"]
    seed, mass = step(tmp_path, "Bake")["parameterSpace"]["taskParameterDefinitions"]
    assert (seed["type"], seed["range"], mass["range"]) == ("INT", [1, 2], [0, 0.1])
    assert "unchanged" in submit("free_skiing", "--crowd", "-o", tmp_path, *options)[1]


def test_crowd_for_flamenco(submit, tmp_path):
    assert submit("free_skiing", "--crowd", "-o", tmp_path, "--engine", "flamenco", "--frames", "1-20")[0] == 0
    settings = json.loads((tmp_path / "job.json").read_text(encoding="utf-8"))["settings"]
    assert (settings["command"], settings["spec"]) == ("crowd", str(tmp_path / "input" / "crowd.toml"))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "--frames is needed for a crowd"),
        (
            ["--frames", "1", "--vary", "crowd.cuont=2,3"],
            "crowd.cuont is not a key of a crowd: did you mean crowd.count",
        ),
        (["--frames", "1", "--vary", "crowd.count=0,3"], "crowd.count = 0 is outside"),
    ],
)
def test_bad_crowds_are_one_line(refused, tmp_path, arguments, message):
    code, line = refused("free_skiing", "--crowd", "-o", tmp_path / "bundle", *arguments)
    assert code == 2
    assert message in line


def test_crowd_on_a_file_of_heights_is_refused(refused, tmp_path, hill):
    code, line = refused(hill, "--crowd", "-o", tmp_path / "bundle", "--frames", "1", "--set", "spread.offset=0")
    assert code == 2
    assert "slope.grid_file cannot be taken along by the job of a crowd" in line
