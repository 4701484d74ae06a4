"""Runs inside a real Blender of factory settings: installs the zip from its preferences, and skis by four clicks.

Then Esc stops simulations at several moments; how soon is measured.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).parent))  # Blender runs this file alone

from mouse import (
    CLICKS,
    FOLDER,
    Steps,
    area_of_view,
    click,
    key,
    library,
    main_region,
    middle,
    modal,
    note,
    press,
    run,
    running,
    screenshot,
    sidebar,
    skier,
    until,
    window,
)

PACKAGE = "bl_ext.user_default.ski_addon"
ZIP = Path(sys.argv[sys.argv.index(str(FOLDER)) + 1])
TAB: list[int] = []
_waited: dict[str, float] = {}


def first_run() -> Steps:
    """From factory settings, without the extension, to a playing run."""
    yield 2.0
    yield from install()
    yield from open_tab()
    CLICKS.clear()
    yield from four_clicks()
    note("played", clicks=len(CLICKS), waited=_waited)
    yield from escapes()


def other_area(kind: str) -> tuple[Any, Any] | None:
    """A window beside the first one and its area of a kind, if there is one."""
    for one in list(bpy.context.window_manager.windows)[1:]:
        for area in one.screen.areas:
            if area.type == kind:
                return one, area
    return None


def install() -> Steps:
    """Install from disk as the preferences do: their operator, its file browser, the zip chosen in it."""
    bpy.ops.screen.userpref_show()
    yield from until(lambda: other_area("PREFERENCES") is not None, "the preferences", 20)
    bpy.context.preferences.active_section = "EXTENSIONS"
    yield from screenshot("1_preferences")
    shown, area = other_area("PREFERENCES")
    with bpy.context.temp_override(window=shown, area=area):
        bpy.ops.extensions.package_install_files("INVOKE_DEFAULT", repo="user_default")
    yield from until(lambda: other_area("FILE_BROWSER") is not None, "the file browser", 20)
    yield 1.0
    shown, area = other_area("FILE_BROWSER")
    parameters = area.spaces.active.params
    parameters.directory, parameters.filename = str(ZIP.parent).encode(), ZIP.name
    yield from screenshot("2_file_browser")
    shown, area = other_area("FILE_BROWSER")
    begin = time.monotonic()
    with bpy.context.temp_override(window=shown, area=area):
        bpy.ops.file.execute()
    yield from until(lambda: PACKAGE in bpy.context.preferences.addons, "the installation", 120)
    note("install", install_seconds=time.monotonic() - begin, missing=library("dependencies").missing_dependencies())
    yield from screenshot("3_installed")
    while other_area("PREFERENCES") is not None:
        shown, _ = other_area("PREFERENCES")
        with bpy.context.temp_override(window=shown):
            bpy.ops.wm.window_close()
        yield 0.5


def open_tab() -> Steps:
    """Find out where the sidebar has the tab, with the sidebar closed again."""
    yield from key("N", *middle())
    yield 1.0
    _, region = sidebar()
    note("sidebar", sidebar_width=region.width)
    begin, x, y = region.active_panel_category, region.x + region.width - 12, region.y + region.height - 20
    while region.active_panel_category != "Ski" and y > region.y:
        y -= 15
        yield from press(x, y)
    TAB.extend((x, y - 10))  # the tab begins where it was met first
    note("tab", tab=TAB)
    region.active_panel_category = begin
    yield 0.5
    yield from key("N", *middle())


def waiting(step: str, condition: Any, seconds: float) -> Steps:
    """Wait for what the last click brings about, and keep how long it took, with half a second of releasing."""
    yield from until(condition, step, seconds)
    _waited[step] = time.monotonic() - CLICKS[-1]


def four_clicks() -> Steps:
    """N, then the tab, Add Skier, Simulate and Bake by mouse, then the space bar."""
    yield from key("N", *middle())
    yield 0.5
    yield from press(*TAB)
    yield from until(lambda: sidebar()[1].active_panel_category == "Ski", "the tab", 10)
    yield from click("ski.add_skier")
    yield from waiting("add", lambda: skier() is not None, 20)
    yield from click("ski.simulate")
    yield from until(running, "the simulation's start", 20)
    yield from waiting("simulate", lambda: not running(), 240)
    note("simulated", said=skier().ski.simulation_text)
    yield from click("ski.bake(")
    yield from waiting("bake", lambda: bool(skier().ski.bake_text), 30)
    scene = bpy.context.scene
    note("baked", frames=[scene.frame_start, scene.frame_end], rate=scene.render.fps)
    begin = time.monotonic()
    yield from key("SPACE", *middle())
    yield from until(lambda: window().screen.is_animation_playing and scene.frame_current > 3, "playing", 20)
    _waited["play"] = time.monotonic() - begin
    yield from screenshot("4_playing")
    with bpy.context.temp_override(window=window(), area=area_of_view()):
        bpy.ops.screen.animation_cancel(restore_frame=False)


def escapes() -> Steps:
    """Stop simulations after 1, 3 and 6 seconds: how many slices and redraws still came, and how long it took."""
    runner, counted, found = library("blender.jobs").JobRunner, {"slices": 0, "redraws": 0}, []
    original = runner.slice

    def slice_counted(self: Any, context: Any) -> bool:
        counted["slices"] += 1
        return original(self, context)

    def redraw_counted() -> None:
        counted["redraws"] += 1

    runner.slice = slice_counted
    handles = [
        bpy.types.SpaceView3D.draw_handler_add(redraw_counted, (), kind, "POST_PIXEL") for kind in ("UI", "WINDOW")
    ]
    for seconds in (1.0, 3.0, 6.0):
        with bpy.context.temp_override(window=window(), area=area_of_view(), region=main_region()):
            bpy.ops.ski.simulate("INVOKE_DEFAULT")
        yield from until(running, "the simulation's start", 20)
        yield from until(lambda: counted["slices"] > 0, "the first slice", 20)
        yield seconds
        counted.update(slices=0, redraws=0)
        begin = time.perf_counter()
        x, y = middle()
        window().event_simulate(type="ESC", value="PRESS", x=x, y=y)
        while modal("SKI_OT_simulate"):
            if time.perf_counter() - begin > 20.0:
                raise TimeoutError("waited 20 s for Esc")
            yield 0.005
        found.append(
            {"after": seconds, "seconds": time.perf_counter() - begin, **counted, "said": skier().ski.simulation_text}
        )
        yield 0.5
    for handle, kind in zip(handles, ("UI", "WINDOW"), strict=True):
        bpy.types.SpaceView3D.draw_handler_remove(handle, kind)
    runner.slice = original
    note("escapes", escapes=found)
    yield from screenshot("5_stopped")


run(first_run())
