"""Gates of a course: one pole each in slalom, two with a panel in giant slalom, plumb on the snow."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import bpy
import numpy as np

from ..animation.gate_motion import POLE_LENGTH, GateSwing
from ..course import Gates, course_gates
from ..frames import Array, matrix_from_quaternion, quaternion_multiply
from ..spec import RunSpec
from ..spec.gate_defaults import SLALOM_SPACING_MAX
from ..terrain import Terrain
from .channels import MARK, assign_action, bake_action
from .fewer_keys import FewerKeys, KeyOptions
from .gate_carrier import own_turn
from .materials import Paint, painted
from .meshes import part_mesh
from .skier.shapes import Part, Ring, box, dome, join, stack

POLE_RADIUS = 0.016
"""Half thickness of a pole [m]."""
PANEL_WIDTH, PANEL_HEIGHT, PANEL_LOW = 0.75, 0.50, 1.05
"""Distance between a gate's two poles, height of its panel and of the panel's lower edge over the snow [m]."""
COLOURS = ("red", "blue")
PART, OUTER, PANEL = "ski_gate_part", "outer", "panel"
"""Custom property of the outer pole and the panel of a gate put by hand: which of the two it is."""
_BURIED = 0.30
_PAINTS = {
    "red": Paint("d1202b", 0.40),
    "blue": Paint("1f52b8", 0.40),
    "joint": Paint("1a1c20", 0.60),
    "red panel": Paint("d1202b", 0.75),
    "blue panel": Paint("1f52b8", 0.75),
}


def build_gates(spec: RunSpec, terrain: Terrain, collection: bpy.types.Collection) -> list[list[bpy.types.Object]]:
    """Return for each gate of `spec` on `terrain` its new objects in `collection`; none for a course without gates.

    "Gate 1" is the pole the skis turn round at the first gate; red and blue alternate, red first. Gates set as far
    apart as in giant slalom also have "Gate 1 outer", a pole further from the skis, and "Gate 1 panel" between them.
    The poles of one colour share a mesh. All are turned by quaternions, from plumb.
    """
    gates = course_gates(spec, terrain)
    if gates is None:
        return []
    meshes: dict[str, bpy.types.Mesh] = {}
    wide = has_panels(gates)
    built = []
    for index, (foot, side) in enumerate(zip(gates.position, gates.side.tolist(), strict=True)):
        name, colour = f"Gate {index + 1}", COLOURS[index % 2]
        pole = _shared(meshes, f"{colour} pole", partial(_pole, colour))
        objects = [_stand(name, pole, foot, collection)]
        if wide:
            x, y = foot[0], foot[1] + side * PANEL_WIDTH
            outer = np.array((x, y, float(terrain.height(x, y))))
            key, make = _panel_mesh(colour, side)
            objects.append(_stand(f"{name} outer", pole, outer, collection))
            objects.append(_stand(f"{name} panel", _shared(meshes, key, make), foot, collection))
        built.append(objects)
    return built


def stand_pole(collection: bpy.types.Collection, index: int) -> bpy.types.Object:
    """Return a new turning pole in `collection`, for a gate that is put and moved by hand; see `dress_gate`."""
    return _stand(f"Gate {index + 1}", _kept(f"{COLOURS[index % 2]} pole", _pole_of(index)), np.zeros(3), collection)


def dress_gate(pole: bpy.types.Object, index: int, side: float) -> None:
    """Give a gate put by hand its number and colour, and a panel to the left (`side` 1), right (-1) or none (0).

    What of it stands there already is used again. Outer pole and panel go with the turning pole.
    """
    colour = COLOURS[index % 2]
    pole.name, pole.data = f"Gate {index + 1}", _kept(f"{colour} pole", _pole_of(index))
    parts = {child[PART]: child for child in pole.children if PART in child}
    if not side:
        for part in parts.values():
            bpy.data.objects.remove(part)
        return
    key, make = _panel_mesh(colour, side)
    wanted = {OUTER: pole.data, PANEL: _kept(key, make)}
    for name, mesh in wanted.items():
        part = parts.get(name)
        if part is None:
            part = _stand("", mesh, np.zeros(3), pole.users_collection[0])
            part.parent, part[PART] = pole, name
        part.data, part.name = mesh, f"{pole.name} {name}"
        part.location = (0.0, side * PANEL_WIDTH if name == OUTER else 0.0, 0.0)


def _pole_of(index: int) -> Callable[[], Part]:
    return partial(_pole, COLOURS[index % 2])


def _panel_mesh(colour: str, side: float) -> tuple[str, Callable[[], Part]]:
    return f"{colour} panel {'left' if side > 0 else 'right'}", partial(_panel, colour, side)


def _kept(name: str, make: Callable[[], Part]) -> bpy.types.Mesh:
    """Return a mesh that all gates put by hand share, made on first use."""
    mesh = bpy.data.meshes.get(f"Ski gate {name}")
    if mesh is None:
        mesh = _shared({}, name, make)
        mesh.name = f"Ski gate {name}"
    return mesh


def pose_gates(gates: list[list[bpy.types.Object]], swings: list[GateSwing | None], time: Array) -> None:
    """Tilt each of `gates` just so far that it lies clear of the skier at all of the moments `time` (m,) [s]."""
    for objects, swing in zip(gates, swings, strict=True):
        if swing is not None:
            turn = swing.quaternion(np.interp(time, swing.time, swing.pushed).max())
            for obj in objects:
                obj.rotation_quaternion = turn


def bake_gates(
    gates: list[list[bpy.types.Object]],
    swings: list[GateSwing | None],
    rate: float,
    frame_start: float,
    turn: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0),
    keys: KeyOptions | None = None,
) -> None:
    """Give `gates` keys on the frames during which they swing, at `rate` [frames/s]; time 0 is `frame_start`.

    `turn` is the quaternion of the run's frame in the world; `keys` says which frames are baked, and which keys are
    left out. The keys of an earlier bake go, also of a gate that does not swing now.
    """
    keys = keys or KeyOptions()
    for objects, swing in zip(gates, swings, strict=True):
        own = own_turn(objects[0], turn)
        _forget(objects, own)
        if swing is None:
            continue
        frame = np.arange(np.floor(swing.time[0] * rate), np.ceil(swing.time[-1] * rate) + 1.0)
        frame = frame[keys.span.within(frame_start + frame)]
        if not len(frame):
            continue
        swung = swing.quaternion(swing.at(frame / rate))
        action, slot, channelbag = bake_action(objects[0], objects[0].name)
        writer = FewerKeys(channelbag, frame_start + frame, keys)
        writer.rotations("rotation_quaternion", quaternion_multiply(np.array(own), swung), "Gate")
        for obj in objects:
            if obj.parent != objects[0]:  # they move as one, with the same parent if any
                assign_action(obj, action, slot)
            elif obj.get(PART) == OUTER:
                _hold_foot(obj, frame_start + frame, swung, keys)


def _hold_foot(outer: bpy.types.Object, frame: Array, swung: Array, keys: KeyOptions) -> None:
    """Key the place of an outer pole that hangs on its gate's turning pole, so that its own foot stays in the snow."""
    back = np.swapaxes(matrix_from_quaternion(swung), -1, -2)
    action, slot, channelbag = bake_action(outer, outer.name)
    FewerKeys(channelbag, frame, keys).places("location", back @ _beside(outer), "Gate")
    assign_action(outer, action, slot)


def _beside(outer: bpy.types.Object) -> Array:
    """Return where an outer pole stands from its gate's turning pole (3,) [m]."""
    return np.array((0.0, math.copysign(PANEL_WIDTH, outer.location.y), 0.0))


def _forget(objects: list[bpy.types.Object], turn: tuple[float, float, float, float]) -> None:
    """Take away the keys that an earlier bake gave the parts of a gate, unless they are used elsewhere too."""
    for obj in objects:
        action = obj.animation_data.action if obj.animation_data else None
        if action is None or not action.get(MARK) or not action.is_editable:
            continue
        moved = [one for one in objects if one.animation_data and one.animation_data.action == action]
        if action.users - int(action.use_fake_user) > len(moved):
            continue
        for one in moved:
            one.animation_data.action = None
            one.rotation_quaternion = (1.0, 0.0, 0.0, 0.0) if one.parent in objects else turn
            if one.get(PART) == OUTER:
                one.location = _beside(one)
        bpy.data.actions.remove(action)


def has_panels(gates: Gates) -> bool:
    """Return whether `gates` stand as far apart as in giant slalom, down the slope."""
    return len(gates) > 1 and float(np.median(np.diff(gates.position[:, 0]))) > SLALOM_SPACING_MAX


def _shared(meshes: dict[str, bpy.types.Mesh], name: str, make: Callable[[], Part]) -> bpy.types.Mesh:
    if name not in meshes:
        meshes[name] = part_mesh(f"Gate {name}", make(), lambda paint: painted(f"Ski gate {paint}", _PAINTS[paint]))
    return meshes[name]


def _stand(name: str, mesh: bpy.types.Mesh, foot: Array, collection: bpy.types.Collection) -> bpy.types.Object:
    obj = bpy.data.objects.new(name, mesh)
    obj.location = foot.tolist()
    obj.rotation_mode = "QUATERNION"
    collection.objects.link(obj)
    return obj


def _pole(colour: str) -> Part:
    """Return a pole whose foot on the snow is the origin: a shaft that springs up from a dark joint at the snow."""
    radius = POLE_RADIUS
    joint = [(-_BURIED, 1.0), (0.015, 1.0), (0.02, 0.75), (0.05, 0.65), (0.08, 0.75), (0.085, 1.0), (0.12, 1.0)]
    top = Ring(POLE_LENGTH - radius, radius, radius, radius)
    shaft = [Ring(0.12, radius, radius, radius), top, *dome(top, radius)]
    return join(
        [
            stack([Ring(z, s * radius, s * radius, s * radius) for z, s in joint], 12, "joint", (False, False)),
            stack(shaft, 12, colour, (False, True)),
        ]
    )


def _panel(colour: str, side: float) -> Part:
    """Return the panel of a gate whose turning pole stands at the origin and whose outer pole on that `side`."""
    sleeve = box((0.006, PANEL_WIDTH + 2.4 * POLE_RADIUS, PANEL_HEIGHT), f"{colour} panel", 0.005)
    return sleeve.moved((0.0, 0.5 * side * PANEL_WIDTH, PANEL_LOW + 0.5 * PANEL_HEIGHT))
