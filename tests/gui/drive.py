"""Runs inside a real Blender: does the main job in the Ski tab with the mouse, and says what happened.

Started by test_window.py with `blender --enable-event-simulate --python drive.py -- FOLDER`. Writes FOLDER/result.json;
asks for a screenshot by a file FOLDER/NAME.shot and goes on when that file is gone.
"""

from __future__ import annotations

import importlib
import json
import math
import os
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bpy

FOLDER = Path(sys.argv[sys.argv.index("--") + 1])
Steps = Iterator[float]  # each value is a pause in seconds, in which Blender handles events and draws
_result: dict[str, Any] = {"steps": []}

bpy.context.preferences.view.show_splash = False  # it would cover the sidebar


def note(step: str, **facts: Any) -> None:
    """Add a step to the result."""
    _result["steps"].append(step)
    _result.update(facts)


def until(condition: Callable[[], bool], what: str, seconds: float = 60.0) -> Steps:
    """Wait until something holds."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(f"waited {seconds:.0f} s for {what}")
        yield 0.2


def screenshot(name: str) -> Steps:
    """Ask for a screenshot and wait until it is taken."""
    yield 1.0  # let it be drawn
    request = FOLDER / f"{name}.shot"
    request.touch()
    yield from until(lambda: not request.exists(), f"the screenshot {name}")


def window() -> bpy.types.Window:
    """Blender's only window."""
    return bpy.context.window_manager.windows[0]


def sidebar() -> tuple[bpy.types.Area, bpy.types.Region]:
    """The 3D view and its sidebar."""
    area = next(area for area in window().screen.areas if area.type == "VIEW_3D")
    return area, next(region for region in area.regions if region.type == "UI")


def move_to(x: int, y: int) -> None:
    """Move the simulated mouse."""
    window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)


def command_under_mouse() -> str:
    """The Python command of the button under the mouse, empty where there is none."""
    area, region = sidebar()
    manager = bpy.context.window_manager
    manager.clipboard = ""
    with bpy.context.temp_override(window=window(), area=area, region=region):
        if bpy.ops.ui.copy_python_command_button.poll():
            bpy.ops.ui.copy_python_command_button()
    return manager.clipboard


def wheel(kind: str, times: int) -> Steps:
    """Turn the wheel over the sidebar."""
    _, region = sidebar()
    x, y = region.x + region.width // 2, region.y + region.height // 2
    move_to(x, y)
    yield 0.1
    for _ in range(times):
        window().event_simulate(type=kind, value="PRESS", x=x, y=y)
        yield 0.03
    yield 0.3


def press(x: int, y: int, kind: str = "LEFTMOUSE") -> Steps:
    """Press and release a mouse button."""
    move_to(x, y)
    yield 0.2
    window().event_simulate(type=kind, value="PRESS", x=x, y=y)
    yield 0.2
    window().event_simulate(type=kind, value="RELEASE", x=x, y=y)
    yield 0.3


def key(kind: str, x: int, y: int, *, ctrl: bool = False) -> Steps:
    """Press and release a key over a place."""
    window().event_simulate(type=kind, value="PRESS", x=x, y=y, ctrl=ctrl)
    yield 0.2
    window().event_simulate(type=kind, value="RELEASE", x=x, y=y, ctrl=ctrl)
    yield 0.4


def click(command: str) -> Steps:
    """Find the sidebar's button of an operator (with some of its arguments) by moving the mouse, and click it.

    What is not in sight is scrolled to.
    """
    _, region = sidebar()
    x = region.x + region.width // 2
    yield from wheel("WHEELUPMOUSE", 40)
    for _ in range(4):
        for y in range(region.y + region.height - 10, region.y, -9):
            move_to(x, y)
            yield 0.06
            found = command_under_mouse()
            operator, _, arguments = command.partition("(")
            if found.startswith(f"bpy.ops.{operator}(") and arguments in found:
                yield from press(x, y)
                return
        yield from wheel("WHEELDOWNMOUSE", 12)
    yield from screenshot("no_button")
    raise LookupError(f"no button in the Ski tab calls {command}")


def main_region() -> bpy.types.Region:
    """The 3D view itself."""
    area, _ = sidebar()
    return next(region for region in area.regions if region.type == "WINDOW")


def middle() -> tuple[int, int]:
    """A place in the 3D view away from the sidebar."""
    region = main_region()
    return region.x + region.width // 3, region.y + region.height // 2


def on_screen(place: Any) -> tuple[int, int]:
    """Where a place of the world is in the window."""
    from bpy_extras.view3d_utils import location_3d_to_region_2d
    from mathutils import Vector

    area, _ = sidebar()
    region = main_region()
    spot = location_3d_to_region_2d(region, area.spaces.active.region_3d, Vector(place))
    return int(region.x + spot.x), int(region.y + spot.y)


def modal(name: str) -> bool:
    """Whether an operator is running in the window."""
    return any(operator.bl_idname == name for operator in window().modal_operators)


def running() -> bool:
    """Whether the simulation is running in the window."""
    return modal("SKI_OT_simulate")


def skier() -> bpy.types.Object:
    """The skier in the tab, looked up anew: undo makes other objects of it."""
    return bpy.context.scene.ski_skier


def library(name: str) -> Any:
    """A module of the installed extension."""
    return importlib.import_module(f"bl_ext.user_default.ski_addon.ski_addon.{name}")


def look_from(place: tuple[float, float, float], distance: float, pitch: float, turn: float) -> Steps:
    """Look at a place of the world from a distance [m], down by an angle and round the vertical [degrees]."""
    from mathutils import Euler, Vector

    area, _ = sidebar()
    view = area.spaces.active.region_3d
    view.view_perspective = "PERSP"
    view.view_rotation = Euler((math.radians(90.0 - pitch), 0.0, math.radians(turn))).to_quaternion()
    view.view_location, view.view_distance = Vector(place), distance
    yield 0.8


def main_job() -> Steps:
    """What a user does: from factory settings to a playing run; gates by mouse; Esc; undo; a course that cannot be."""
    yield 2.0
    area, region = sidebar()
    area.spaces.active.show_region_ui = True
    area.spaces.active.clip_end = 1000.0
    for obj in list(bpy.data.objects):  # the cube would stand in the way
        bpy.data.objects.remove(obj)
    yield 1.5
    region.active_panel_category = "Ski"
    area.tag_redraw()
    yield from screenshot("1_tab")
    yield from from_nothing_to_playing()
    yield from stopping_and_undoing()
    yield from gates_by_mouse()
    yield from impossible()


def from_nothing_to_playing() -> Steps:
    """Add Skier, Simulate, Bake, Play: four clicks."""
    begin = time.monotonic()
    yield from click("ski.add_skier")
    yield from until(lambda: skier() is not None, "the skier")
    yield from until(lambda: library("blender.live").STATE.preview is not None, "the preview", 20)
    yield from look_from((30.0, 0.0, -5.0), 75.0, 28.0, -90.0)
    yield from screenshot("2_skier")
    yield from choose_preset("SKI_MT_runs_presets", "M")
    note("preset", preset=skier().ski.preset)
    yield from click("ski.simulate")
    yield from until(running, "the simulation's start", 20)
    yield 1.5
    yield from screenshot("4_simulating")
    started = time.monotonic()
    yield from until(lambda: not running(), "the simulation's end", 240)
    note(
        "simulate",
        simulation_seconds=time.monotonic() - started + 2.5,
        simulated=skier().ski.simulation_text,
        simulation_failed=skier().ski.simulation_failed,
    )
    yield from click("ski.bake(")
    yield from until(lambda: bool(skier().ski.bake_text), "the bake", 30)
    scene = bpy.context.scene
    note(
        "bake",
        action=skier().animation_data.action.name,
        frames=[scene.frame_start, scene.frame_end],
        bones=len(skier().pose.bones),
    )
    with bpy.context.temp_override(window=window(), area=area_of_view()):
        bpy.ops.screen.animation_play()
    yield 3.0
    played = scene.frame_current
    with bpy.context.temp_override(window=window(), area=area_of_view()):
        bpy.ops.screen.animation_cancel(restore_frame=False)
    note("play", frame_reached=played, seconds=time.monotonic() - begin)
    scene.frame_set((scene.frame_start + scene.frame_end) // 2)
    place = skier().matrix_world @ skier().pose.bones["pelvis"].head
    yield from look_from(tuple(place), 6.0, 12.0, -60.0)
    bpy.ops.ski.toggle_overlay()
    yield from screenshot("5_baked")
    note("overlay", overlay=library("blender.overlay").is_shown())
    bpy.ops.ski.toggle_overlay()


def area_of_view() -> bpy.types.Area:
    """The 3D view's area."""
    return sidebar()[0]


def choose_preset(menu: str, letter: str) -> Steps:
    """Open a menu of presets and press the letter that is underlined in an entry."""
    x, y = middle()
    move_to(x, y)
    yield 0.3
    before = skier().ski.preset
    bpy.ops.wm.call_menu(name=menu)
    yield from screenshot("3_presets")
    yield from key(letter, x, y)
    yield from until(lambda: skier().ski.preset != before, "the preset", 10)


def stopping_and_undoing() -> Steps:
    """Esc in the middle of a simulation; Ctrl-Z takes the bake away, then the skier."""
    before = skier().ski.simulation_text
    yield from click("ski.simulate")
    yield from until(running, "the simulation's second start", 20)
    yield 2.0
    asked = time.monotonic()
    window().event_simulate(type="ESC", value="PRESS", x=middle()[0], y=middle()[1])
    yield from until(lambda: not running(), "Esc", 20)
    note("stop", stopped=skier().ski.simulation_text, finished=before, esc_seconds=time.monotonic() - asked)
    yield from screenshot("6_stopped")
    move_to(*middle())
    yield 0.3
    for _ in range(12):
        if not [obj for obj in bpy.data.objects if obj.name == "Slope"]:
            break
        yield from key("Z", *middle(), ctrl=True)
    note("undo_bake", skier_left=skier() is not None, slope_left="Slope" in bpy.data.objects)
    yield from screenshot("7_undone")


def gates_by_mouse() -> Steps:
    """Five gates by clicks on the slope, one of them dragged with the preview following, and one undone."""
    live = library("blender.live")
    if skier() is None:
        bpy.ops.ski.add_skier()
    settings = skier().ski
    settings.course.kind, settings.course.start_speed = "gates", 7.0
    settings.course.target_speed_word, settings.course.target_speed = False, 9.0
    bpy.ops.ski.make_slope()
    yield 1.0
    yield from look_from((38.0, 0.0, -7.0), 55.0, 40.0, -90.0)
    yield from click("ski.place_gates")
    yield from until(lambda: modal("SKI_OT_place_gates"), "Place Gates", 10)
    for index in range(5):
        x, y = 20.0 + 9.0 * index, 1.8 if index % 2 == 0 else -1.8
        yield from press(*on_screen((x, y, -x * math.tan(settings.slope.angle_deg))))
    yield from screenshot("8_placing")
    yield from key("RET", *middle())
    yield from until(lambda: not modal("SKI_OT_place_gates"), "Enter", 10)
    spec = library("blender.properties").read_spec(skier().ski)
    note("gates", gates=[[gate.x, gate.y] for gate in spec.gate])
    yield 1.0
    before = live.STATE.preview
    gate = library("blender.course_objects").standing_gates(skier().ski, spec)[2]
    for obj in bpy.context.selected_objects:
        obj.select_set(False)
    gate.select_set(True)
    bpy.context.view_layer.objects.active = gate
    x, y = on_screen(gate.matrix_world.translation)
    move_to(x, y)
    yield 0.3
    yield from key("G", x, y)
    shown = []
    for step in range(1, 7):
        move_to(x - 9 * step, y)
        yield 0.25
        shown.append(live.STATE.preview)
    yield from screenshot("9_dragging")
    note("drag", previews=len({id(one) for one in shown if one is not before}), moving=modal("TRANSFORM_OT_translate"))
    yield from press(x - 54, y)
    yield from screenshot("10_dragged")
    count = len(library("blender.properties").read_spec(skier().ski).gate)
    for _ in range(3):
        yield from key("Z", *middle(), ctrl=True)
    left = len(library("blender.properties").read_spec(skier().ski).gate)
    note("undo_gates", gates_before=count, gates_left=left)
    yield from screenshot("11_gate_undone")


def impossible() -> Steps:
    """A course that nobody can ski is named in the tab."""
    bpy.ops.ski.apply_preset(kind="runs", preset="giant_slalom")
    skier().ski.course.turn_radius, skier().ski.course.start_speed = 5.0, 20.0
    yield 1.0
    yield from click("ski.plan")
    yield from until(lambda: bool(skier().ski.plan_text), "the plan", 20)
    note("impossible", refused=skier().ski.plan_text, refused_failed=skier().ski.plan_failed)
    yield from look_from((30.0, 0.0, -5.0), 75.0, 28.0, -90.0)
    yield from screenshot("12_impossible")


_job = main_job()


def tick() -> float | None:
    """Blender's timer: go on with the job until it ends, then write the result and leave."""
    try:
        return next(_job)
    except StopIteration:
        _result["error"] = ""
    except Exception:
        _result["error"] = traceback.format_exc()
    part = FOLDER / "result.json.part"
    part.write_text(json.dumps(_result, indent=1), encoding="utf-8")
    part.rename(FOLDER / "result.json")
    sys.stdout.flush()
    os._exit(0)


bpy.app.timers.register(tick, first_interval=1.0)
