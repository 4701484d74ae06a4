"""Crowds in Blender: simulated in processes or here, stopped and gone on with, baked each at its own start."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.blender.blender_tools import Context, Event, bone_matrices, curves, keys

COUNT = 2


@pytest.fixture
def ski(core, scene, tmp_path):
    """The settings of a skier with a crowd of two on a short run, in a saved file."""
    import bpy

    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "crowd.blend"))
    settings = core("blender.skiers").add_skier(bpy.context.scene, preset="paper_main").ski
    settings.course.turn_count, settings.course.entry = 3, "straight"
    settings.course.turn_duration, settings.course.transition_duration = 0.3, 0.4
    settings.simulation.time_step = 0.004
    settings.crowd.count, settings.crowd.start_interval, settings.crowd.apart = COUNT, 1.0, 3.0
    settings.spread.offset = 2.0
    return settings


@pytest.fixture
def here(core, monkeypatch):
    """No process can be started: everything is computed in this one."""
    monkeypatch.setattr(core("blender.crowds"), "can_start", lambda: False)


@pytest.fixture
def simulated(ski, here):
    import bpy

    assert bpy.ops.ski.crowd() == {"FINISHED"}
    return ski


def skied(core, ski) -> Any:
    return core("crowd.skied").read_skied(core("blender.crowds").found_folder(ski))


def recordings(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.glob("member_*.npz"))}


def test_settings_ask_for_the_crowd_that_a_document_does(core, ski) -> None:
    crowds = core("blender.crowds")
    import bpy

    ski.spread.women_word, ski.spread.women = False, 0.4
    crowd = crowds.read_crowd_spec(ski, bpy.context.scene)
    assert (crowd.crowd.count, crowd.crowd.apart, crowd.spread.women, crowd.spread.offset) == (COUNT, 3.0, 0.4, 2.0)
    assert crowd.spread.knee_bend_deg == pytest.approx(4.0) and crowd.runs[0].spec.bake.fps == 24.0
    changed = crowd.with_values({"crowd.count": 7, "spread.women": "keep", "spread.height": 0.1})
    crowds.write_crowd_spec(ski, changed)
    assert crowds.read_crowd_spec(ski, bpy.context.scene) == changed


def test_it_says_how_it_went_and_where_the_recordings_are(core, simulated, tmp_path) -> None:
    assert simulated.crowd_folder.startswith("//ski_cache")
    folder = core("blender.crowds").found_folder(simulated)
    assert folder.parent == tmp_path / "ski_cache" and len(recordings(folder)) == COUNT
    assert simulated.crowd_text.startswith(f"{COUNT} of {COUNT} skied to the end\nNever nearer than ")
    assert not simulated.crowd_failed


def test_processes_give_the_same_recordings(core, simulated, monkeypatch) -> None:
    import bpy

    crowds = core("blender.crowds")
    folder = crowds.found_folder(simulated)
    first = recordings(folder)
    monkeypatch.undo()
    if not crowds.can_start():
        pytest.skip("no process of its own can be started here")
    for name in first:
        (folder / name).unlink()
    started = []
    kind = crowds.CrowdProcess
    monkeypatch.setattr(crowds, "CrowdProcess", lambda *given: started.append(given) or kind(*given))
    assert bpy.ops.ski.crowd() == {"FINISHED"}
    assert started and recordings(folder) == first


def test_members_are_baked_at_their_starts_and_places(core, simulated) -> None:
    import bpy

    simulated.bake.frame_start = 10
    simulated.start.location = (5.0, 2.0, 1.0)
    assert bpy.ops.ski.bake_crowd() == {"FINISHED"}
    crowd, scene = skied(core, simulated), bpy.context.scene
    collection = simulated.crowd_collection
    assert collection.name == "Crowd" and len(collection.children) == COUNT
    for member, home in zip(crowd.members, collection.children, strict=True):
        armature = next(obj for obj in home.objects if obj.type == "ARMATURE")
        assert armature.name == f"Skier {member.number:03d}"
        first = 10 + round(member.start * 24)
        action = armature.animation_data.action
        assert keys(curves(action)['pose.bones["pelvis"].location', 0])[0, 0] == first
        recording = core("simulation.recording").Recording.load(member.path)
        scene.frame_set(first + 12)
        moment = int(np.searchsorted(recording.time, 0.5))
        place = bone_matrices(core, armature, recording)["pelvis"][:3, 3]
        assert place == pytest.approx(recording.qpos[moment, :3] + (5.0, 2.0 + member.offset, 1.0), abs=0.02)
    assert scene.frame_start == 10 and scene.frame_end > 10 + 24


def test_members_are_shown_only_while_they_ski(core, simulated) -> None:
    import bpy

    assert bpy.ops.ski.bake_crowd() == {"FINISHED"}
    crowd, scene = skied(core, simulated), bpy.context.scene
    home = simulated.crowd_collection.children[1]
    meshes = [obj for obj in home.objects if obj.type == "MESH"]
    first = 1 + round(crowd.members[1].start * 24)
    assert first > 1 and meshes
    for frame, hidden in ((1, True), (first - 1, True), (first, False), (first + 20, False), (100000, True)):
        scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        shown = [obj.evaluated_get(graph) for obj in meshes]
        assert {obj.hide_render for obj in shown} == {obj.hide_viewport for obj in shown} == {hidden}, frame


def test_baking_again_replaces_the_crowd_and_nothing_else(core, simulated) -> None:
    import bpy

    assert bpy.ops.ski.bake_crowd() == {"FINISHED"}
    mine = bpy.data.objects.new("mine", None)
    simulated.crowd_collection.objects.link(mine)
    before = len(bpy.data.objects), len(bpy.data.actions), len(bpy.data.meshes)
    assert bpy.ops.ski.bake_crowd() == {"FINISHED"}
    assert (len(bpy.data.objects), len(bpy.data.actions), len(bpy.data.meshes)) == before
    assert mine.name in simulated.crowd_collection.objects and len(simulated.crowd_collection.children) == COUNT
    assert [obj.name for obj in bpy.context.scene.objects].count("Slope") == 1


def test_a_damaged_recording_is_named_and_the_baked_crowd_stays(core, simulated) -> None:
    import bpy

    assert bpy.ops.ski.bake_crowd() == {"FINISHED"}
    before = [home.name for home in simulated.crowd_collection.children]
    path = core("blender.crowds").found_folder(simulated) / "member_002.npz"
    path.write_bytes(path.read_bytes()[:-5000])
    with pytest.raises(RuntimeError, match=r"member_002\.npz.*damaged.*simulate the crowd again"):
        bpy.ops.ski.bake_crowd()
    assert [home.name for home in simulated.crowd_collection.children] == before
    assert bpy.ops.ski.crowd() == {"FINISHED"} and "(1 kept)" in simulated.crowd_text
    assert bpy.ops.ski.bake_crowd() == {"FINISHED"}


def test_gates_stand_on_every_course_once(core, scene) -> None:
    import bpy

    spec = core("spec").RunSpec.from_toml(core("spec").find_document("slalom"))
    spec = spec.with_overrides({"course.gate_count": 3})
    terrain = core("terrain").build_terrain(spec.slope)
    collection = bpy.data.collections.new("Gates")
    built = core("blender.gates").build_gates(spec, terrain, collection)
    left = [gate[0].location.y for gate in built]
    stage = core("blender.stage").Stage(terrain, built, [])
    core("blender.crowd_files")._stand_gates([(spec, 5.0), (spec, -4.0), (spec, 5.0)], stage, bpy.context.scene)
    assert sorted(obj.location.y for obj in collection.objects) == pytest.approx(
        sorted([y + 5.0 for y in left] + [y - 4.0 for y in left])
    )


def test_without_a_simulated_crowd_there_is_nothing_to_bake(ski) -> None:
    import bpy

    with pytest.raises(RuntimeError, match="was not simulated, or its recordings are gone: press Simulate Crowd"):
        bpy.ops.ski.bake_crowd()


def test_what_is_wrong_with_a_crowd_is_said(ski, here) -> None:
    import bpy

    ski.spread.offset = 0.0
    ski.course.kind = "gates"
    ski.spread.offset = 5.0
    with pytest.raises(RuntimeError, match=r"spread\.offset = 5\.0 moves lines away from the gates"):
        bpy.ops.ski.crowd()


# -- with a window, which a stand-in is -------------------------------------------------


class Operator:
    """Stands for the running operator: Blender makes those itself."""

    def __init__(self, kind: type, context: Any) -> None:
        self._kind, self.reports = kind, []
        jobs = import_module(kind.__module__.replace("operators.crowd", "ski_addon.blender.jobs"))
        self._runner = jobs.JobRunner(kind._begin(self, context), context, busy=True)

    def report(self, level: set, text: str) -> None:
        self.reports.append((level, text))

    def __getattr__(self, name: str) -> Any:
        found = self._kind.__dict__[name]
        return found.fget(self) if isinstance(found, property) else found.__get__(self)


@pytest.fixture
def started(core, extension, ski):
    import bpy

    kind = import_module(f"{extension}.operators.crowd").SKI_OT_crowd
    context = Context(bpy.context.scene)
    context.view_layer, context.object = bpy.context.view_layer, ski.id_data
    yield Operator(kind, context), context
    core("blender.jobs").RUNNING.text = ""


def test_escape_keeps_who_is_done_and_the_rest_follows(core, ski, here, started, monkeypatch) -> None:
    import bpy

    monkeypatch.setattr(core("blender.jobs"), "SLICE_SECONDS", 0.0)
    operator, context = started
    for _ in range(1000):
        assert operator.modal(context, Event("TIMER")) == {"RUNNING_MODAL"}
        if list(operator._folder.glob("member_*.npz")):
            break
    assert operator.modal(context, Event("MOUSEMOVE")) == {"PASS_THROUGH"}
    assert operator.modal(context, Event("ESC", "PRESS")) == {"FINISHED"}
    assert context.window_manager.open == [] and core("blender.jobs").RUNNING.text == ""
    assert ski.crowd_failed and f"1 of {COUNT} skied to the end" in ski.crowd_text
    assert bpy.ops.ski.crowd() == {"FINISHED"}
    assert f"{COUNT} of {COUNT} skied to the end (1 kept)" in ski.crowd_text


def test_escape_stops_the_processes(core, ski, started) -> None:
    if not core("blender.crowds").can_start():
        pytest.skip("no process of its own can be started here")
    operator, context = started
    assert operator.modal(context, Event("TIMER")) == {"RUNNING_MODAL"}
    assert operator.modal(context, Event("ESC", "PRESS")) in ({"FINISHED"}, {"CANCELLED"})
    assert context.window_manager.open == [] and core("blender.jobs").RUNNING.text == ""
    assert not [path.name for path in operator._folder.iterdir() if ".tmp" in path.name]


def test_a_crowd_is_baked_into_a_file(core, simulated, tmp_path) -> None:
    import bpy

    folder = core("blender.crowds").found_folder(simulated)
    target = core("blender.crowd_files").bake_crowd_file(folder, tmp_path / "all.blend")
    bpy.ops.wm.open_mainfile(filepath=str(target))
    assert {"Skier 001", "Skier 002"} <= set(bpy.data.objects.keys())
    assert bpy.context.scene.camera is not None and bpy.data.collections["Crowd"].children
