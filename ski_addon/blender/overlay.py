"""The overlay of the 3D view: forces, centre of mass, plan and edge angles over the scene, kept in no file."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from ..frames import Array
from .gpu_lines import draw_batch, drawing_over, line_batch, write_at
from .overlay_data import OverlayData, OverlayMoment, build_overlay

if TYPE_CHECKING:
    from ..simulation.recording import Recording
    from ..spec import RunSpec

LINE_WIDTH = 2.5
TEXT_SIZE = 15.0
"""Size of lines and words [pixels at a scale of 1 of the interface]."""
_log = logging.getLogger(__name__)


class _Overlay:
    """What is shown, and the handlers that draw it."""

    def __init__(self, data: OverlayData, world_from_run: Array, time_of_frame: Callable[[float], float]) -> None:
        self._data = data
        self._rotation, self._shift = world_from_run[:3, :3], world_from_run[:3, 3]
        self._time_of_frame = time_of_frame
        self._frame: float | None = None
        self._moment: OverlayMoment | None = None
        self._batch: Any = None
        self._failed = False
        self._handlers: list[Any] = []

    def start(self) -> None:
        """Begin to draw."""
        for draw, kind in ((self.draw_lines, "POST_VIEW"), (self.draw_words, "POST_PIXEL")):
            self._handlers.append(bpy.types.SpaceView3D.draw_handler_add(self._guarded, (draw,), "WINDOW", kind))

    def stop(self) -> None:
        """End drawing."""
        while self._handlers:
            bpy.types.SpaceView3D.draw_handler_remove(self._handlers.pop(), "WINDOW")

    def _guarded(self, draw: Callable[[], None]) -> None:
        """Draw, and after the first failure never again: a handler that fails would fail at every redraw."""
        if self._failed:
            return
        try:
            draw()
        except Exception as error:
            self._failed = True
            _log.warning("the ski overlay was switched off: %s: %s", type(error).__name__, error)
            # Not here: Blender is going through its list of handlers.
            bpy.app.timers.register(self._retire, first_interval=0.0)

    def _retire(self) -> None:
        """Take the handlers away, unless that is done already."""
        if self in _shown:
            hide()

    def moment(self, frame: float) -> OverlayMoment:
        """Return what is shown at a frame of the scene; kept until the frame changes."""
        if self._moment is None or frame != self._frame:
            self._moment, self._batch = self._data.at(self._time_of_frame(frame)), None
            self._frame = frame
        return self._moment

    def to_world(self, place: Array) -> Array:
        """Return points (..., 3) of the run frame in the world."""
        return place @ self._rotation.T + self._shift

    def draw_lines(self) -> None:
        """Draw the lines into the 3D view that is being drawn."""
        moment = self.moment(bpy.context.scene.frame_current_final)
        if self._batch is None:
            points = self.to_world(moment.segments).reshape(-1, 3)
            self._batch = line_batch(points, np.repeat(moment.colors, 2, axis=0))
        batch, shader = self._batch
        with drawing_over():
            draw_batch(batch, shader, LINE_WIDTH)

    def draw_words(self) -> None:
        """Write the labels over the 3D view that is being drawn."""
        for label in self.moment(bpy.context.scene.frame_current_final).labels:
            write_at(label.words, self.to_world(label.place), label.color.tolist(), TEXT_SIZE)


_shown: list[_Overlay] = []


def show(recording: Recording, spec: RunSpec, world_from_run: Any, time_of_frame: Callable[[float], float]) -> bool:
    """Draw `recording`, a run of `spec`, over every 3D view, in place of what was shown; returns whether it is.

    `world_from_run` (4, 4) is where the run stands in the world, a matrix or rows of numbers; `time_of_frame` gives the
    time [s] since the start of the recording of a scene's frame, which may be a part of one. Without a window nothing
    happens. Raises `EmptyRecordingError` if nothing was recorded.
    """
    hide()
    if bpy.app.background:
        return False
    overlay = _Overlay(build_overlay(recording, spec), np.array(world_from_run, dtype=float), time_of_frame)
    overlay.start()
    _shown.append(overlay)
    bpy.app.handlers.load_pre.append(_hide_before_load)
    _redraw()
    return True


def hide() -> None:
    """Draw the overlay no more; nothing happens if there is none."""
    if not _shown:
        return
    while _shown:
        _shown.pop().stop()
    if _hide_before_load in bpy.app.handlers.load_pre:
        bpy.app.handlers.load_pre.remove(_hide_before_load)
    _redraw()


def is_shown() -> bool:
    """Return whether an overlay is drawn."""
    return bool(_shown)


@bpy.app.handlers.persistent
def _hide_before_load(*_: Any) -> None:
    """Another file is opened: its frames are not those of the run."""
    hide()


def _redraw() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
