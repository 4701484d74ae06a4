"""The live preview: the track of the skier in the tab, worked out anew while anything changes, kept in no file."""

from __future__ import annotations

import logging
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from ..errors import SkiAddonError
from ..frames import Array
from ..gravity import STANDARD_GRAVITY
from ..spec import RunSpec
from ..spec.records import record
from . import changes
from .course_objects import standing_gates
from .gate_heights import OffSnow, gates_off_snow, off_snow_words
from .jobs import RUNNING
from .placing import moved, terrain_of, world_from_run
from .preferences import preferences
from .properties import read_spec
from .shown import skier_of

if TYPE_CHECKING:
    from ..turning.figures import FigureModel
    from ..turning.motion import TurningMotion
    from ..turning.quick import QuickPreview

SPEED_COLOURS = np.array(
    [(0.16, 0.36, 0.72, 1.0), (0.10, 0.60, 0.72, 1.0), (0.25, 0.72, 0.42, 1.0), (0.95, 0.80, 0.25, 1.0)]
)
"""Colours from the slowest to the fastest place of a run; the preferences say which the two ends are."""
REFUSED = np.array((0.90, 0.10, 0.12, 1.0))
"""Colour of places that cannot be skied, unless the preferences say another."""
ABOVE_SNOW = 0.05
"""How far over the ground the track is drawn [m]."""
QUIET = 0.4
"""Time [s] without a change after which a quick preview is made exact."""
GROUND_MARGIN, GROUND_STEP = 8.0, 4.0
"""How far round the track the slope is shown by lines while it has no mesh, and how far apart they are [m]."""
DELAY = 0.01
"""Pause [s] between a change and the preview of it: changes that come together are shown together."""
_log = logging.getLogger(__name__)


@record(frozen=True)
class Numbered:
    """A gate's number: where it stands (3,) [m, world] and whether it is a red one."""

    place: Array
    number: int
    is_red: bool


@record(frozen=True)
class Preview:
    """What is drawn of a run: `line` (n, 3) [m, world] with its colours (n, 4), gates' numbers, the `problem` in one
    line with the place (3,) it is at, or None; what the figure is made from; and `ground` (2 k, 3) [m, world], the ends
    of lines that show the slope while it has no mesh. `quick` is there for a quick preview, which is a little less
    exact, and helps the next one. `off_snow` are the gates that were dragged off the snow.
    """

    key: str
    line: Array
    colour: Array
    gates: tuple[Numbered, ...] = ()
    problem: str = ""
    problem_place: Array | None = None
    speeds: tuple[float, float] = (0.0, 0.0)
    motion: TurningMotion | None = None
    spec: RunSpec | None = None
    matrix: Array = field(default_factory=lambda: np.eye(4))
    ground: Array = field(default_factory=lambda: np.zeros((0, 3)))
    quick: QuickPreview | None = None
    off_snow: tuple[OffSnow, ...] = ()


@dataclass
class Cursor:
    """Where the next gate would stand (3,) [m, world], or None."""

    place: Array | None = None


@dataclass
class State:
    """What is shown now: the `preview`, the `figure` it has, and the name of the skier whose `overlay` is drawn."""

    preview: Preview | None = None
    figure: Any = None
    overlay: str = ""


STATE = State()
CURSOR = Cursor()


def preview_of(settings: Any, before: Preview | None = None, *, quick: bool = False) -> Preview:
    """Return the preview of a skier's run, `before` itself if nothing of it was changed.

    Where the run has no track the one `before` is kept, with the problem. With `quick` that of gates is a little less
    exact, see `turning.quick`.
    """
    matrix = world_from_run(settings)
    try:
        spec = read_spec(settings)
        bare = _is_bare(settings)
        standing = spec.course.kind == "gates" and spec.course.gate_setting == "list"
        off = gates_off_snow(settings, spec) if standing else ()
        key = f"{spec.content_hash()} {matrix.tobytes().hex()} {bare} {[(gate.number, gate.height) for gate in off]}"
    except SkiAddonError as error:
        return _without_track(str(error), before)
    if before is not None and before.key == key and (quick or before.quick is None):
        return before
    try:
        return _with_track(settings, spec, matrix, key, off, before if quick else None)
    except SkiAddonError as error:
        return _without_track(str(error), before)


def _with_track(
    settings: Any, spec: RunSpec, matrix: Array, key: str, off: tuple[OffSnow, ...], before: Preview | None
) -> Preview:
    from ..turning.preview import preview_course
    from ..turning.quick import quick_gates

    quick, terrain = None, terrain_of(spec.slope)
    if before is not None and spec.course.kind == "gates":
        quick = quick_gates(spec, terrain, before.quick)
        found = quick.preview
    else:
        found = preview_course(spec, terrain)
    motion = found.motion
    line = moved(matrix, motion.position + ABOVE_SNOW * motion.surface_normal)
    slow, fast = float(motion.speed.min()), float(motion.speed.max())
    colour = speed_colours(motion.speed)
    problem, place = "" if found.problem is None else str(found.problem), None if found.problem is None else line[-1]
    refused, outside = too_steep(spec, motion), off_the_slope(spec, motion)
    colour[refused | outside] = refused_colour()
    if outside.any() and not problem:
        first = int(np.argmax(outside))
        problem, place = (
            f"the track leaves the slope after {motion.distance[first]:.0f} m: shorten or turn it",
            line[first],
        )
    if refused.any() and not problem:
        problem, place = _too_much_lean(spec, motion, refused), line[int(np.argmax(refused))]
    if off and not problem:
        problem, place = off_snow_words(off), off[0].place
    gates = _numbers(settings, spec)
    ground = moved(matrix, ground_lines(spec, motion.position)) if _is_bare(settings) else np.zeros((0, 3))
    speeds = slow, fast
    return Preview(key, line, colour, gates, problem, place, speeds, motion, spec, matrix, ground, quick, off)


def ground_lines(spec: RunSpec, track: Array) -> Array:
    """Return the ends (2 k, 3) [m, run] of lines on the ground along and across, round `track` (n, 3)."""
    low, high = track[:, :2].min(axis=0) - GROUND_MARGIN, track[:, :2].max(axis=0) + GROUND_MARGIN
    x, y = (np.arange(a, b + GROUND_STEP, GROUND_STEP) for a, b in zip(low, high, strict=True))
    down, left = np.meshgrid(x, y, indexing="ij")
    mesh = np.stack((down, left, terrain_of(spec.slope).height(down, left)), axis=-1)
    along = np.stack((mesh[:-1], mesh[1:]), axis=2).reshape(-1, 3)
    across = np.stack((mesh[:, :-1], mesh[:, 1:]), axis=2).reshape(-1, 3)
    return np.concatenate((along, across))


def _is_bare(settings: Any) -> bool:
    """Return whether the slope has no mesh to be seen by."""
    return settings.ground is None and settings.slope_mesh is None


def _without_track(problem: str, before: Preview | None) -> Preview:
    if before is None:
        return Preview("", np.zeros((0, 3)), np.zeros((0, 4)), problem=problem)
    grey = np.tile((0.5, 0.5, 0.5, 0.6), (len(before.line), 1))
    return Preview("", before.line, grey, before.gates, problem)


def speed_colours(speed: Array) -> Array:
    """Return colours (n, 4) for `speed` (n,) [m/s], from the slowest of them to the fastest."""
    low, high = float(speed.min()), float(speed.max())
    share = (speed - low) / max(high - low, 0.5) * (len(SPEED_COLOURS) - 1)
    colours, known = SPEED_COLOURS.copy(), preferences()
    if known is not None:
        colours[0, :3], colours[-1, :3] = known.slow, known.fast
    return np.stack([np.interp(share, np.arange(len(colours)), colours[:, channel]) for channel in range(4)], axis=1)


def refused_colour() -> Array:
    """Return the colour (4,) of places that cannot be skied."""
    known = preferences()
    return REFUSED if known is None else np.append(np.array(known.refused), 1.0)


def needed_lean(motion: TurningMotion) -> Array:
    """Return the lean (n,) [rad] that balances the turns of `motion`."""
    into = STANDARD_GRAVITY * motion.surface_normal[:, 2]
    return np.arctan2(np.square(motion.speed) * np.abs(motion.curvature), into)


def too_steep(spec: RunSpec, motion: TurningMotion) -> Array:
    """Return where (n,) a run needs more lean than the skier may have."""
    return needed_lean(motion) > np.radians(spec.technique.inclination_max_deg) + 1e-3


def off_the_slope(spec: RunSpec, motion: TurningMotion) -> Array:
    """Return where (n,) a run is beyond the ground that is known."""
    place = motion.position
    return ~np.broadcast_to(terrain_of(spec.slope).contains(place[:, 0], place[:, 1]), len(place))


def _too_much_lean(spec: RunSpec, motion: TurningMotion, refused: Array) -> str:
    first = int(np.argmax(refused))
    stretch = np.arange(len(refused)) < first + max(1, int(np.argmin(np.append(refused[first:], False))))
    worst = int(np.argmax(np.where(stretch, needed_lean(motion), 0.0)))
    degrees, radius = np.degrees(needed_lean(motion)[worst]), 1.0 / max(abs(motion.curvature[worst]), 1e-9)
    return (
        f"too fast at {motion.distance[worst]:.0f} m: {motion.speed[worst]:.1f} m/s round {radius:.0f} m needs "
        f"{degrees:.0f} degrees of lean, at most {spec.technique.inclination_max_deg:g} are allowed: "
        "widen the turn or slow down"
    )


def _numbers(settings: Any, spec: RunSpec) -> tuple[Numbered, ...]:
    """Return the numbers of the gates in the order they are passed."""
    if spec.course.kind != "gates":
        return ()
    poles = standing_gates(settings, spec) if spec.course.gate_setting == "list" else []
    if poles:
        places = np.array([pole.matrix_world.translation for pole in poles])
    else:
        from ..course import course_gates

        gates = course_gates(spec, terrain_of(spec.slope))
        places = moved(world_from_run(settings), np.array(gates.position)) if gates is not None else np.zeros((0, 3))
    return tuple(Numbered(place, index + 1, index % 2 == 0) for index, place in enumerate(places))


def figure_at(preview: Preview, frame: float, rate: float) -> list[tuple[Array, str]]:
    """Return the lines (k, 3) [m, world] and colours of the instant figure at a frame; at the start before it."""
    if preview.motion is None or preview.spec is None:
        return []
    from ..gallery.sticks import figure_lines
    from ..turning.figures.poses import poses_at

    spec, motion = preview.spec, preview.motion
    time = np.clip((frame - spec.bake.frame_start) / rate, 0.0, motion.duration)
    model = _model(spec)
    poses = poses_at(model, spec, motion, np.array([time, time]), terrain=terrain_of(spec.slope))
    return [(moved(preview.matrix, points), colour) for points, colour in figure_lines(model, poses, 0)]


def _model(spec: RunSpec) -> FigureModel:
    """Return the figure of `spec`, the same again for the same person and gear."""
    from ..turning.figures import build_figure

    key = (spec.skier, spec.figure)
    if STATE.figure is None or STATE.figure[0] != key:
        STATE.figure = key, build_figure(spec)
    return STATE.figure[1]


def refresh(*, quick: bool = False) -> None:
    """Work the preview out for the skier in the tab, if anything changed, and have the views drawn."""
    scene = bpy.context.scene
    skier = skier_of(bpy.context) if scene is not None and scene.ski_preview else None
    before = STATE.preview
    STATE.preview = None if skier is None else preview_of(skier.ski, before, quick=quick)
    if STATE.preview is not before:
        redraw_views()


def request(_settings: Any = None) -> None:
    """Have the preview worked out in a moment; without a window nothing is shown and nothing is done."""
    if not bpy.app.background and not RUNNING.text and not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=DELAY)


def _tick() -> None:
    _guarded(quick=True)
    if STATE.preview is not None and STATE.preview.quick is not None:
        if bpy.app.timers.is_registered(_settle):
            bpy.app.timers.unregister(_settle)
        bpy.app.timers.register(_settle, first_interval=QUIET)


def _settle() -> None:
    """Make a quick preview exact when nothing has changed for a while."""
    if STATE.preview is not None and STATE.preview.quick is not None and not RUNNING.text:
        _guarded(quick=False)


def _guarded(*, quick: bool) -> None:
    try:
        refresh(quick=quick)
    except Exception as error:  # a timer that fails would fail after every change
        STATE.preview = None
        _log.warning("the preview failed: %s: %s", type(error).__name__, error)


@bpy.app.handlers.persistent
def _after_change(_scene: Any, _depsgraph: Any = None) -> None:
    screen = bpy.context.screen
    if screen is None or not screen.is_animation_playing:
        request()


@bpy.app.handlers.persistent
def _after_load(_path: Any) -> None:
    STATE.preview, STATE.overlay, CURSOR.place = None, "", None  # the overlay hides itself
    request()


def redraw_views() -> None:
    """Ask for a redraw of all 3D views."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def _handlers() -> tuple[tuple[Any, Any], ...]:
    known = bpy.app.handlers
    return (
        (known.depsgraph_update_post, _after_change),
        (known.undo_post, _after_change),
        (known.redo_post, _after_change),
        (known.load_post, _after_load),
    )


def register() -> None:
    """Begin to listen; handlers belong to the running Blender, not to its file."""
    changes.listen(request)
    for handlers, handler in _handlers():
        handlers.append(handler)
    if not bpy.app.background:
        from . import live_drawing

        live_drawing.start()


def unregister() -> None:
    """Stop listening and drawing."""
    if not bpy.app.background:
        from . import live_drawing, overlay

        live_drawing.stop()
        overlay.hide()
        for timer in (_tick, _settle):
            if bpy.app.timers.is_registered(timer):
                bpy.app.timers.unregister(timer)
    for handlers, handler in _handlers():
        if handler in handlers:
            handlers.remove(handler)
    changes.unlisten(request)
    STATE.preview = STATE.figure = None
    STATE.overlay = ""
