"""Runs inside a real Blender: does the main job in the Ski tab with the mouse, and says what happened.

Started by test_window.py with `blender --enable-event-simulate --python drive.py -- FOLDER`. Writes FOLDER/result.json;
asks for a screenshot by a file FOLDER/NAME.shot and goes on when that file is gone.
"""

from __future__ import annotations

import json
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


def click(operator: str) -> Steps:
    """Find the sidebar's button of an operator by moving the mouse down the sidebar, and click it."""
    _, region = sidebar()
    x = region.x + region.width // 2
    for y in range(region.y + region.height - 10, region.y, -9):
        move_to(x, y)
        yield 0.06
        if command_under_mouse().startswith(f"bpy.ops.{operator}("):
            window().event_simulate(type="LEFTMOUSE", value="PRESS", x=x, y=y)
            yield 0.2
            window().event_simulate(type="LEFTMOUSE", value="RELEASE", x=x, y=y)
            yield 0.3
            return
    raise LookupError(f"no button in the Ski tab calls {operator}")


def running() -> bool:
    """Whether the simulation is running in the window."""
    return any(operator.bl_idname == "SKI_OT_simulate" for operator in window().modal_operators)


def main_job() -> Steps:
    """What a user does first: open the tab, plan, simulate, stop that, simulate again, bake, play."""
    yield 2.0
    area, region = sidebar()
    area.spaces.active.show_region_ui = True
    yield 1.5
    region.active_panel_category = "Ski"
    area.tag_redraw()
    yield from screenshot("1_tab")

    settings = bpy.context.scene.ski
    settings.preset = "giant_slalom"
    settings.course.turn_count = 2
    yield from click("ski.plan")
    yield from until(lambda: bool(settings.plan_text), "the plan")
    note("plan", plan=settings.plan_text, plan_failed=settings.plan_failed)
    yield from screenshot("2_planned")

    yield from click("ski.simulate")
    yield from until(running, "the simulation's start", 20)
    yield from screenshot("3_simulating")
    if running():  # a fast machine may have finished
        _, region = sidebar()
        window().event_simulate(type="ESC", value="PRESS", x=region.x - 200, y=region.y + 200)
    yield from until(lambda: not running(), "Esc", 20)
    note("stop", stopped=settings.simulation_text)
    yield from screenshot("4_stopped")

    yield from click("ski.simulate")
    yield from until(running, "the simulation's second start", 20)
    yield from until(lambda: not running(), "the simulation's end", 180)
    note("simulate", simulated=settings.simulation_text, simulation_failed=settings.simulation_failed)
    yield from click("ski.bake")
    yield from until(lambda: settings.armature is not None, "the bake")
    scene = bpy.context.scene
    note(
        "bake",
        action=settings.armature.animation_data.action.name,
        frames=[scene.frame_start, scene.frame_end],
        bones=len(settings.armature.pose.bones),
    )
    scene.frame_set((scene.frame_start + scene.frame_end) // 2)
    yield from show_skier(settings.armature)
    yield from screenshot("5_baked")


def show_skier(armature: bpy.types.Object) -> Steps:
    """Look at the skier from near."""
    area, _ = sidebar()
    view = area.spaces.active.region_3d
    view.view_location = armature.matrix_world @ armature.pose.bones["pelvis"].head
    view.view_distance = 5.0
    yield 1.0


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
