"""Courses from objects of the scene: gates that stand there, and curves as paths or as gate lines."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from mathutils.geometry import interpolate_bezier

from ..errors import SpecError
from ..frames import Array
from ..spec import FieldInfo, RunSpec, section_fields
from .fields import Changed, make_properties, read_field
from .nurbs import nurbs_knots, nurbs_line
from .placing import document_places, moved

OWN_FIELDS = ("side", "radius", "distance")
"""Fields of a gate that its object carries; where it stands says the rest."""
CURVE_STEP = 1.0
"""Distance between the points that are taken from a curve [m], about."""


def gate_fields() -> tuple[FieldInfo, ...]:
    """Return the fields that a gate object has of its own."""
    return tuple(info for info in section_fields("gate") if info.name in OWN_FIELDS)


def gate_group(changed: Changed) -> type:
    """Return a new property group of gate objects, `object.ski_gate`."""
    annotations: dict[str, Any] = {"is_gate": bpy.props.BoolProperty(name="Is a Gate", options={"HIDDEN"})}
    for info in gate_fields():
        annotations |= make_properties(info, info.default, changed)
    group = type("SKI_PG_gate_object", (bpy.types.PropertyGroup,), {"__doc__": "What a gate asks for by itself."})
    group.__annotations__ = annotations
    return group


def standing_gates(settings: Any, spec: RunSpec) -> list[bpy.types.Object]:
    """Return the turning poles of the gates that stand in the scene for a skier, from the top of the slope down."""
    if settings.gates is None:
        return []
    poles = [obj for obj in settings.gates.all_objects if obj.ski_gate.is_gate]
    if not poles:
        return []
    down = document_places(settings, spec.slope, np.array([pole.matrix_world.translation for pole in poles]))[:, 0]
    return [poles[index] for index in np.argsort(down, kind="stable")]


def gate_rows(settings: Any, spec: RunSpec) -> list[dict[str, Any]] | None:
    """Return rows for the gates that stand in the scene, or that a curve has at its points; None if there are none."""
    poles = standing_gates(settings, spec)
    if poles:
        places = document_places(settings, spec.slope, np.array([pole.matrix_world.translation for pole in poles]))
        own = [{info.name: read_field(pole.ski_gate, info) for info in gate_fields()} for pole in poles]
        return [{"x": x, "y": y, **row} for (x, y), row in zip(places.tolist(), own, strict=True)]
    if settings.curve is None:
        return None
    places = document_places(settings, spec.slope, _knots(settings.curve))
    return [{"x": x, "y": y} for x, y in places[np.argsort(places[:, 0], kind="stable")].tolist()]


def curve_points(settings: Any, spec: RunSpec) -> list[dict[str, float]] | None:
    """Return the points of the path that a curve draws, or None without a curve; the upper end is the start."""
    if settings.curve is None:
        return None
    places = document_places(settings, spec.slope, _line(settings.curve))
    if places[0, 0] > places[-1, 0]:
        places = places[::-1]
    return [{"x": x, "y": y} for x, y in places.tolist()]


def _spline(curve: bpy.types.Object) -> Any:
    """Return the first spline of a curve object; raises `SpecError` for one that has no course."""
    if curve.type != "CURVE" or not len(curve.data.splines):
        hint = "draw it in Edit Mode, or choose another curve"
        raise SpecError("curve", curve.name, hint=hint, problem="has no points")
    spline = curve.data.splines[0]
    if len(_points_of(spline)) < 2:
        raise SpecError("curve", curve.name, hint="add points to it in Edit Mode", problem="has fewer than two points")
    return spline


def _points_of(spline: Any) -> Any:
    return spline.bezier_points if spline.type == "BEZIER" else spline.points


def _knots(curve: bpy.types.Object) -> Array:
    """Return the points (n, 3) [m, world] that a curve was drawn with; of a NURBS curve those on it nearest to them."""
    spline = _spline(curve)
    if spline.type == "NURBS":
        return moved(np.array(curve.matrix_world), nurbs_knots(spline))
    return np.array([curve.matrix_world @ point.co.to_3d() for point in _points_of(spline)])


def _line(curve: bpy.types.Object) -> Array:
    """Return points (n, 3) [m, world] along a curve."""
    spline = _spline(curve)
    if spline.type == "NURBS":
        scale = max(np.linalg.norm(np.array(curve.matrix_world)[:3, :3], axis=0).max(), 1e-9)
        return moved(np.array(curve.matrix_world), nurbs_line(spline, CURVE_STEP / scale))
    if spline.type != "BEZIER":
        return _knots(curve)
    points, line = spline.bezier_points, []
    for first, second in zip(points, points[1:], strict=False):
        reach = (curve.matrix_world.to_3x3() @ (second.co - first.co)).length
        count = int(np.clip(np.ceil(reach / CURVE_STEP), 2, 200)) + 1
        line += list(interpolate_bezier(first.co, first.handle_right, second.handle_left, second.co, count))[:-1]
    line.append(points[-1].co.copy())
    return np.array([curve.matrix_world @ place for place in line])


def gate_objects(settings: Any, spec: RunSpec) -> list[list[bpy.types.Object]]:
    """Return for each gate that stands in the scene its objects, the turning pole first; [] where others count."""
    if spec.course.kind != "gates" or spec.course.gate_setting != "list":
        return []
    return [[pole, *pole.children] for pole in standing_gates(settings, spec)]
