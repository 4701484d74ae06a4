"""The job template of Open Job Description: simulate, bake, render, each once for every varied run.

Written for the base schema `jobtemplate-2023-09`; frames are a list of chunks there. With `job.chunking` the extension
TASK_CHUNKING is declared, and the farm makes the chunks itself.
https://github.com/OpenJobDescription/openjd-specifications/wiki/2023-09-Template-Schemas
"""

from __future__ import annotations

from typing import Any

from ..tasks.frame_list import frame_words
from .frame_chunks import split_frames
from .job import BAKE_SECONDS, LAUNCHES, FarmJob
from .render_options import render_arguments

INPUT, OUTPUT = "input", "output"
"""Folders of a bundle: what the tasks read, and what they write."""
NOTIFY_SECONDS = 60
"""Time between asking a task to stop and killing it [s]; within it a task leaves its files whole."""
ENVIRONMENT = {
    "SKI_ADDON_OPENJD": "1",  # progress as openjd_progress, failures as openjd_fail
    "OMP_NUM_THREADS": "1",  # the same sums in the same order, so the same bytes, on every worker
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
}


def job_template(job: FarmJob) -> dict[str, Any]:
    """Return the job template as plain JSON data."""
    template: dict[str, Any] = {"specificationVersion": "jobtemplate-2023-09"}
    if job.chunking:
        template["extensions"] = ["TASK_CHUNKING"]
    return {
        **template,
        "name": "{{Param.JobName}}",  # a name in a parameter is taken as it is, braces and all
        "parameterDefinitions": _parameters(job),
        "jobEnvironments": [{"name": "SkiAddon", "variables": dict(ENVIRONMENT)}],
        "steps": [_simulate_step(job), _bake_step(job), _render_step(job)],
    }


def parameter_values(job: FarmJob) -> dict[str, Any]:
    """Return the values of the parameters that are no paths, as `deadline bundle submit` reads them."""
    values = [(item["name"], item["default"]) for item in _parameters(job) if item["type"] != "PATH"]
    return {"parameterValues": [{"name": name, "value": value} for name, value in values]}


def _parameters(job: FarmJob) -> list[dict[str, Any]]:
    launch, program, _ = LAUNCHES[job.workers]
    parameters = [
        _parameter("JobName", "STRING", job.name, "Name of the job"),
        _parameter(launch, "STRING", program, f"What starts {launch} on the workers"),
        _folder("Input", INPUT, "IN", "Folder with the run document and its terrain"),
        _folder("Output", OUTPUT, "OUT", "Folder for recordings, .blend files and frames"),
    ]
    if job.chunking:
        parameters += [
            _parameter("Frames", "STRING", frame_words(job.frames), "Frames to render"),
            {**_parameter("ChunkSize", "INT", job.chunk, "Frames that one task renders"), "minValue": 1},
        ]
    return parameters


def _parameter(name: str, kind: str, default: str | int, description: str) -> dict[str, Any]:
    return {"name": name, "type": kind, "default": default, "description": description}


def _folder(name: str, default: str, flow: str, description: str) -> dict[str, Any]:
    return {**_parameter(name, "PATH", default, description), "objectType": "DIRECTORY", "dataFlow": flow}


def _simulate_step(job: FarmJob) -> dict[str, Any]:
    arguments = [job.command, f"{{{{Param.Input}}}}/{job.document}", "--output", f"{_run_folder(job)}/run"]
    if job.force:
        arguments.append("--force")
    for variation in job.variations:
        arguments += ["--set", f"{variation.key}={_task_value(variation.parameter)}"]
    return _step(job, "Simulate", arguments, job.simulate_seconds)


def _bake_step(job: FarmJob) -> dict[str, Any]:
    arguments = ["bake", f"{_run_folder(job)}/run", "--output", f"{_run_folder(job)}/skier.blend"]
    if job.ground:  # the recording names the file where the simulating worker had it
        arguments += ["--set", f"slope.grid_file={{{{Param.Input}}}}/{job.ground_path}"]
    return _step(job, "Bake", arguments, BAKE_SECONDS, after="Simulate")


def _render_step(job: FarmJob) -> dict[str, Any]:
    arguments = ["render", f"{_run_folder(job)}/skier.blend", "--output", f"{_run_folder(job)}/frames"]
    arguments += ["--frames", _task_value("Frames"), *render_arguments(job.render)]
    return _step(job, "Render", arguments, job.render_seconds, after="Bake", frames=_frames(job))


def _frames(job: FarmJob) -> dict[str, Any]:
    if not job.chunking:
        chunks = [frame_words(chunk) for chunk in split_frames(job.frames, job.chunk)]
        return {"name": "Frames", "type": "STRING", "range": chunks}
    how = {"defaultTaskCount": "{{Param.ChunkSize}}", "rangeConstraint": "CONTIGUOUS"}
    return {"name": "Frames", "type": "CHUNK[INT]", "range": "{{Param.Frames}}", "chunks": how}


def _step(
    job: FarmJob,
    name: str,
    arguments: list[str],
    seconds: int,
    *,
    after: str | None = None,
    frames: dict[str, Any] | None = None,
) -> dict[str, Any]:
    launch, _, before = LAUNCHES[job.workers]
    step: dict[str, Any] = {"name": name}
    if after:
        step["dependencies"] = [{"dependsOn": after}]
    if job.variations or frames:
        step["parameterSpace"] = _parameter_space(job, frames)
    if job.cores or job.memory:
        step["hostRequirements"] = {"amounts": _amounts(job)}
    run = {
        "command": f"{{{{Param.{launch}}}}}",
        "args": [*before, *arguments],
        "timeout": seconds,
        "cancelation": {"mode": "NOTIFY_THEN_TERMINATE", "notifyPeriodInSeconds": NOTIFY_SECONDS},
    }
    step["script"] = {"actions": {"onRun": run}}
    return step


def _parameter_space(job: FarmJob, frames: dict[str, Any] | None) -> dict[str, Any]:
    """Return the task parameters: every varied run, times the frames."""
    definitions: list[dict[str, Any]] = [
        {"name": variation.parameter, "type": variation.kind, "range": list(variation.values)}
        for variation in job.variations
    ]
    runs = [variation.parameter for variation in job.variations]
    product = [f"({', '.join(runs)})"] if job.pairs and len(runs) > 1 else runs
    if frames:
        definitions, product = [*definitions, frames], [*product, frames["name"]]
    return {"taskParameterDefinitions": definitions, "combination": " * ".join(product)}


def _amounts(job: FarmJob) -> list[dict[str, Any]]:
    amounts = [("amount.worker.vcpu", job.cores), ("amount.worker.memory", job.memory and 1024 * job.memory)]  # MiB
    return [{"name": name, "min": least} for name, least in amounts if least]


def _run_folder(job: FarmJob) -> str:
    """Return the folder of one run: a folder for each varied key, so that values stay readable and names short."""
    folders = [f"{variation.key}={_task_value(variation.parameter)}" for variation in job.variations]
    return "/".join(["{{Param.Output}}", *folders])


def _task_value(name: str) -> str:
    return f"{{{{Task.Param.{name}}}}}"
