"""Runs inside a real Blender: mouse, keys, screenshots and waiting, for the scripts that do a job in its window.

Such a script is started by `run_in_window` with `blender --enable-event-simulate --python SCRIPT -- FOLDER ...`. It
writes FOLDER/result.json; it asks for a screenshot by a file FOLDER/NAME.shot and goes on when that file is gone.
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
CLICKS: list[float] = []
"""When [s] a mouse button was pressed so far."""

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
    """Turn the wheel over the sidebar; where that has nothing to scroll, the view behind it would be zoomed."""
    area, region = sidebar()
    distance = area.spaces.active.region_3d.view_distance
    x, y = region.x + region.width // 2, region.y + region.height // 2
    move_to(x, y)
    yield 0.1
    for _ in range(times):
        window().event_simulate(type=kind, value="PRESS", x=x, y=y)
        yield 0.03
    yield 0.3
    area.spaces.active.region_3d.view_distance = distance


def press(x: int, y: int, kind: str = "LEFTMOUSE") -> Steps:
    """Press and release a mouse button."""
    move_to(x, y)
    yield 0.2
    window().event_simulate(type=kind, value="PRESS", x=x, y=y)
    CLICKS.append(time.monotonic())
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


def area_of_view() -> bpy.types.Area:
    """The 3D view's area."""
    return sidebar()[0]


def run(job: Steps) -> None:
    """Go through a job by Blender's timer, then write the result and leave."""

    def tick() -> float | None:
        try:
            return next(job)
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
