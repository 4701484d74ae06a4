"""The Flamenco job type, run in a JavaScript engine with what the Manager gives it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import quickjs

from ski_addon.farm import flamenco
from ski_addon.farm.job import FarmJob
from ski_addon.spec.presets import preset_folder

GLOBALS = Path(__file__).with_name("flamenco_globals.js").read_text(encoding="utf-8")
SETTINGS = {"spec": "/shots/run.toml", "frames": "1-25", "output": "/shots/out", "fps": 24}
RUN, BLEND, FRAMES = "/shots/out/run", "/shots/out/skier.blend", "/shots/out/frames"


@pytest.fixture
def engine():
    context = quickjs.Context()
    context.set_time_limit(20)
    context.eval(GLOBALS)
    context.eval(flamenco.read_script())
    return context


@pytest.fixture
def compile_job(engine):
    def compiled(**changes):
        settings = json.dumps({**SETTINGS, **changes})
        return json.loads(engine.eval(f"JSON.stringify(compiled({settings}))"))

    return compiled


def by_name(job):
    return {task["name"]: task for task in job["tasks"]}


def commands_of(task):
    return [(command["parameters"]["exe"], command["parameters"]["args"]) for command in task["commands"]]


def frames_of(arguments):
    return arguments[arguments.index("--frames") + 1]


def test_tasks_come_in_order_and_wait_for_what_they_read(compile_job):
    tasks = by_name(compile_job())
    renders = ["render-1-10", "render-11-20", "render-21-25"]
    assert list(tasks) == ["simulate", "bake", *renders, "video"]
    assert tasks["simulate"]["dependencies"] == []
    assert tasks["bake"]["dependencies"] == ["simulate"]
    assert [tasks[name]["dependencies"] for name in renders] == [["bake"]] * 3
    assert tasks["video"]["dependencies"] == renders
    assert [task["type"] for task in tasks.values()] == ["misc", *["blender"] * 4, "ffmpeg"]


def test_workers_with_blender_run_its_command(compile_job):
    tasks = by_name(compile_job())
    ski = ["--command", "ski"]
    assert commands_of(tasks["simulate"]) == [("{blender}", [*ski, "simulate", "/shots/run.toml", "--output", RUN])]
    assert commands_of(tasks["bake"]) == [("{blender}", [*ski, "bake", RUN, "--output", BLEND])]
    render = [*ski, "render", BLEND, "--output", FRAMES, "--frames", "11-20"]
    render += ["--engine", "cycles", "--device", "CPU"]
    assert commands_of(tasks["render-11-20"]) == [("{blender}", render)]
    assert {command["name"] for name in tasks if name != "video" for command in tasks[name]["commands"]} == {"exec"}


def test_workers_with_python_run_the_module(compile_job):
    tasks = by_name(compile_job(workers="python", python="/opt/ski/bin/python"))
    run = ["-m", "ski_addon", "simulate", "/shots/run.toml", "--output", RUN]
    assert commands_of(tasks["simulate"]) == [("/opt/ski/bin/python", run)]


def test_video_has_the_frames_at_their_rate(compile_job):
    (command,) = by_name(compile_job(fps=23.976))["video"]["commands"]
    assert command["name"] == "frames-to-video"
    assert command["parameters"]["fps"] == 23.976
    assert command["parameters"]["inputGlob"] == f"{FRAMES}/*.png"
    assert command["parameters"]["outputFile"] == "/shots/out/skier.mp4"
    assert "video" not in by_name(compile_job(video=False))


def test_ground_is_given_where_it_is_read(compile_job):
    ground = ["--set", "slope.grid_file=/shots/a hill.npz"]
    tasks = by_name(compile_job(ground="/shots/a hill.npz"))
    assert [commands_of(tasks[name])[0][1][-2:] for name in ("simulate", "bake")] == [ground, ground]


def test_frames_are_rendered_as_the_settings_say(compile_job):
    changes = {"engine": "workbench", "device": "OPTIX", "samples": 16, "size": "960x540", "frames": "1"}
    ((_, arguments),) = commands_of(by_name(compile_job(**changes))["render-1"])
    assert arguments[arguments.index("--engine") :] == [
        *("--engine", "workbench", "--samples", "16", "--size", "960x540")
    ]


def test_crowds_and_large_runs_have_their_commands(compile_job):
    ((_, arguments),) = commands_of(by_name(compile_job(command="crowd", force=True))["simulate"])
    assert arguments[2:] == ["crowd", "/shots/run.toml", "--output", RUN, "--force"]


def test_place_of_the_output_may_name_the_time(compile_job):
    job = compile_job(output="/shots/{timestamp}")
    assert job["settings"]["output"] == "/shots/2026-01-02_030405"
    assert commands_of(by_name(job)["bake"])[0][1][3] == "/shots/2026-01-02_030405/run"


@pytest.mark.parametrize(
    ("frames", "size", "chunks"),
    [
        ("7", 10, {"render-7": ["7-7"]}),
        ("1-2", 10, {"render-1,2": ["1-2"]}),
        ("1-3", 1, {"render-1": ["1-1"], "render-2": ["2-2"], "render-3": ["3-3"]}),
        ("1-5", 5, {"render-1-5": ["1-5"]}),
        ("1-6", 5, {"render-1-5": ["1-5"], "render-6": ["6-6"]}),
        ("1..3, 7", 10, {"render-1-3,7": ["1-3", "7-7"]}),
        ("5,4,9,10", 3, {"render-4,5,9": ["4-5", "9-9"], "render-10": ["10-10"]}),
        ("1-3,2-4", 10, {"render-1-4": ["1-4"]}),
        ("0-1", 10, {"render-0,1": ["0-1"]}),
    ],
)
def test_chunks_become_ranges_of_render(compile_job, frames, size, chunks):
    tasks = by_name(compile_job(frames=frames, chunk_size=size, video=False))
    found = {
        name: [frames_of(args) for _, args in commands_of(task)] for name, task in tasks.items() if "render" in name
    }
    assert found == chunks


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"frames": "10-1"}, 'frames = "10-1": "10-1" ends before it starts'),
        ({"frames": "1-5,9-7"}, '"9-7" ends before it starts'),
        ({"frames": "-5"}, '"-5" is not a range of frames'),
        ({"frames": "1-2-3"}, '"1-2-3" is not a range of frames'),
        ({"frames": "1,,2"}, '"" is not a range of frames'),
        ({"frames": "all"}, '"all" is not a range of frames'),
        ({"frames": "1.5"}, '"1.5" is not a range of frames'),
        ({"frames": " "}, "frames is missing"),
        ({"spec": ""}, "spec is missing: Run document"),
        ({"output": None}, "output is missing"),
        ({"chunk_size": 0}, "chunk_size = 0 is not a whole number of 1 or more"),
        ({"chunk_size": 2.5}, "chunk_size = 2.5 is not"),
        ({"size": "large"}, 'size = "large" is not a size in pixels'),
        ({"workers": "perl"}, 'workers = "perl" is neither'),
        ({"fps": 0}, "fps = 0 is not a frame rate"),
    ],
)
def test_bad_settings_are_one_line(compile_job, changes, message):
    with pytest.raises(quickjs.JSException) as caught:
        compile_job(**changes)
    assert message in str(caught.value).splitlines()[0]


def test_settings_are_what_blender_and_manager_know(engine):
    job_type = json.loads(engine.eval("JSON.stringify(JOB_TYPE)"))
    assert job_type["label"]
    for setting in job_type["settings"]:
        assert setting["type"] in ("string", "int32", "float", "bool")
        assert setting.get("visible", "visible") in ("visible", "hidden", "submission", "web")
        assert setting.get("visible") == "hidden" or setting["description"]
        if "eval" in setting:
            compile(setting["eval"], setting["key"], "eval")
        if "choices" in setting:
            assert setting["default"] in setting["choices"]
    evaluated = {setting["key"] for setting in job_type["settings"] if "eval" in setting}
    assert evaluated == {"frames", "output", "size", "fps"}


def test_job_for_the_api_is_one_the_script_takes(engine, tmp_path):
    frames = (*range(1, 22), 25, 28, 31, 34)
    job = FarmJob("Run", {}, frames, chunk=10, ground=tmp_path / "x.npz", ground_name="x.npz", fps=30.0)
    submitted = flamenco.submitted_job(job, tmp_path)
    assert submitted["settings"]["frames"] == "1-21,25,28,31,34"  # its frameChunker knows no steps
    keys = json.loads(engine.eval("JSON.stringify(JOB_TYPE.settings.map((setting) => setting.key))"))
    assert set(submitted["settings"]) == set(keys) - {"output_root"}
    assert flamenco.SCRIPT.removesuffix(".js").replace("_", "-") == flamenco.JOB_TYPE
    settings = json.dumps(submitted["settings"])
    tasks = by_name(json.loads(engine.eval(f"JSON.stringify(compiled({settings}))")))
    assert len(tasks) == 6
    assert commands_of(tasks["simulate"])[0][1][3] == str(tmp_path / "input" / "spec.toml")


def test_script_is_shipped_as_a_file():
    assert (preset_folder("farm") / flamenco.SCRIPT).is_file()
