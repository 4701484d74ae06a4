"""Draws the live preview over the 3D views: track, gates' numbers, problem, figure, and the next gate's place."""

from __future__ import annotations

import logging
import textwrap
from collections.abc import Callable
from typing import Any

import bpy
import numpy as np

from ..frames import Array
from .frame_rate import scene_rate
from .gpu_lines import draw_batch, drawing_over, line_batch, pairs, write, write_at
from .jobs import RUNNING
from .live import CURSOR, REFUSED, STATE, Preview, figure_at
from .shown import skier_of

TRACK_WIDTH, FIGURE_WIDTH = 4.0, 3.0
RED, BLUE = (0.98, 0.30, 0.32, 1.0), (0.42, 0.62, 1.0, 1.0)
GROUND = (0.75, 0.85, 1.0, 0.28)
WORDS = (1.0, 1.0, 1.0, 1.0)
_RING = np.linspace(0.0, 2.0 * np.pi, 25)
_log = logging.getLogger(__name__)
_handlers: list[Any] = []


class _Kept:
    """What was sent to the graphics card for the preview drawn last."""

    preview: Preview | None = None
    batch: Any = None
    shader: Any = None
    ground: Any = None


def start() -> None:
    """Begin to draw in every 3D view."""
    for draw, kind in ((_draw_lines, "POST_VIEW"), (_draw_words, "POST_PIXEL")):
        _handlers.append(bpy.types.SpaceView3D.draw_handler_add(_guarded, (draw,), "WINDOW", kind))


def stop() -> None:
    """End drawing."""
    while _handlers:
        bpy.types.SpaceView3D.draw_handler_remove(_handlers.pop(), "WINDOW")
    _Kept.preview = _Kept.batch = _Kept.shader = _Kept.ground = None


def _guarded(draw: Callable[[Preview | None], None]) -> None:
    """Draw what there is, if overlays are on; what fails is told once and forgotten."""
    space = bpy.context.space_data
    if space is None or not space.overlay.show_overlays:
        return
    try:
        draw(STATE.preview if bpy.context.scene.ski_preview else None)
    except Exception as error:
        STATE.preview = None
        _log.warning("drawing the preview failed: %s: %s", type(error).__name__, error)


def _draw_lines(preview: Preview | None) -> None:
    if preview is not None and len(preview.line) > 1:
        if _Kept.preview is not preview:
            _Kept.batch, _Kept.shader = line_batch(pairs(preview.line), pairs(preview.colour))
            _Kept.preview = preview
            _Kept.ground = None
            if len(preview.ground):
                _Kept.ground = line_batch(preview.ground, np.tile(GROUND, (len(preview.ground), 1)))
        if _Kept.ground is not None:
            with drawing_over("LESS_EQUAL"):
                draw_batch(_Kept.ground[0], _Kept.ground[1], 1.0)
        with drawing_over("LESS_EQUAL"):
            draw_batch(_Kept.batch, _Kept.shader, TRACK_WIDTH)
        if _figure_wanted():
            _draw_figure(preview)
    if CURSOR.place is not None:
        ring = CURSOR.place + np.stack((0.4 * np.cos(_RING), 0.4 * np.sin(_RING), 0 * _RING + 0.05), axis=1)
        pole = CURSOR.place + np.array([(0.0, 0.0, 0.0), (0.0, 0.0, 1.8)])
        _draw_now([ring, pole], [np.array((1.0, 0.85, 0.2, 1.0))] * 2, 2.5)


def _figure_wanted() -> bool:
    """Return whether the instant figure is shown: not while its skier has keys to show."""
    skier = skier_of(bpy.context)
    data = None if skier is None else skier.animation_data
    moves = data is not None and (data.action is not None or len(data.nla_tracks) > 0)
    return bool(bpy.context.scene.ski_preview_figure) and not moves and not RUNNING.text


def _draw_figure(preview: Preview) -> None:
    scene = bpy.context.scene
    lines = figure_at(preview, scene.frame_current_final, scene_rate(scene))
    _draw_now([points for points, _ in lines], [_colour(colour) for _, colour in lines], FIGURE_WIDTH)


def _draw_now(strips: list[Array], colours: list[Array], width: float) -> None:
    if not strips:
        return
    points = np.concatenate([pairs(strip) for strip in strips])
    each = [np.tile(colour, (2 * (len(strip) - 1), 1)) for strip, colour in zip(strips, colours, strict=True)]
    batch, shader = line_batch(points, np.concatenate(each))
    with drawing_over():
        draw_batch(batch, shader, width)


def _colour(written: str) -> Array:
    """Return a colour of the drawings ("#1f77b4") for the dark or bright 3D view: lighter than on paper."""
    channels = np.array([int(written[at : at + 2], 16) / 255.0 for at in (1, 3, 5)])
    return np.append(0.35 + 0.65 * channels, 1.0)


def _draw_words(preview: Preview | None) -> None:
    if preview is None:
        return
    scale = bpy.context.preferences.system.ui_scale
    for gate in preview.gates:
        write_at(str(gate.number), gate.place + np.array((0.0, 0.0, 2.1)), RED if gate.is_red else BLUE)
    if preview.problem and preview.problem_place is not None:
        write_at("!", preview.problem_place, REFUSED.tolist(), 22.0, 14.0 * scale)
    left, high = 20.0 * scale + _tool_width(), bpy.context.region.height - 124.0 * scale  # under Blender's own words
    if preview.problem:
        for index, line in enumerate(textwrap.wrap(preview.problem, 80)):
            write(line, left, high - 18.0 * scale * index, (1.0, 0.45, 0.42, 1.0))
    elif preview.motion is not None:
        slow, fast = preview.speeds
        skier = skier_of(bpy.context)
        name = "" if skier is None else f"{skier.name}: "
        words = f"{name}preview {preview.motion.duration:.1f} s, {slow:.1f} to {fast:.1f} m/s"
        write(words, left, high, WORDS)


def _tool_width() -> float:
    """Return the width of the toolbar, which lies over the view's left edge [pixels]."""
    return float(next((region.width for region in bpy.context.area.regions if region.type == "TOOLS"), 0))
