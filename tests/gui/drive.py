"""Runs inside a real Blender: does the main job in the Ski tab with the mouse, and says what happened."""

from __future__ import annotations

import math
import sys
import time
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))  # Blender runs this file alone

from mouse import (
    Steps,
    area_of_view,
    click,
    key,
    library,
    look_from,
    middle,
    modal,
    move_to,
    note,
    on_screen,
    press,
    run,
    running,
    screenshot,
    sidebar,
    skier,
    until,
    window,
)


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


run(main_job())
