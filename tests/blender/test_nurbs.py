"""NURBS splines: our points lie on the curve that Blender shows, whatever its order, ends, weights and loops."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

PLACES = [(0, 0, 0), (4, 3, -1), (9, -3, -2), (13, 4, -3), (20, 2, -5), (24, -4, -6), (30, 0, -7)]


def make_nurbs(scene: Any, order: int = 4, *, ends: bool = True, bezier: bool = False, cyclic: bool = False) -> Any:
    """A NURBS curve of seven points with unequal weights."""
    import bpy

    data = bpy.data.curves.new("Line", "CURVE")
    data.dimensions = "3D"
    data.resolution_u = 300
    spline = data.splines.new("NURBS")
    spline.points.add(len(PLACES) - 1)
    for index, (point, place) in enumerate(zip(spline.points, PLACES, strict=True)):
        point.co = (*place, 1.0 + 0.5 * (index % 3))
    spline.order_u, spline.use_cyclic_u = order, cyclic
    spline.use_endpoint_u, spline.use_bezier_u = ends, bezier
    obj = bpy.data.objects.new("Line", data)
    scene.collection.objects.link(obj)
    return obj


def shown(obj: Any) -> np.ndarray:
    """The vertices (n, 3) of the curve as Blender makes a mesh of it."""
    mesh = obj.to_mesh()
    places = np.array([vertex.co for vertex in mesh.vertices])
    obj.to_mesh_clear()
    return places


def furthest(places: np.ndarray, line: np.ndarray) -> float:
    """The largest distance of `places` (n, 3) from the polyline `line` (m, 3)."""
    begin, way = line[:-1], np.diff(line, axis=0)
    length = np.maximum(np.sum(way * way, axis=1), 1e-12)
    along = np.clip(np.sum((places[:, None] - begin) * way, axis=2) / length, 0.0, 1.0)
    return float(np.linalg.norm(places[:, None] - begin - along[..., None] * way, axis=2).min(axis=1).max())


LOOPS = [(order, ends, True) for order in (2, 3, 4) for ends in (True, False)]
"""Of loops of higher order Blender's releases themselves have not the same."""


@pytest.mark.parametrize(
    ("order", "ends", "cyclic"), [*itertools.product((2, 3, 4, 6), (True, False), (False,)), *LOOPS]
)
def test_the_line_is_the_curve_that_is_seen(core, scene, order: int, ends: bool, cyclic: bool) -> None:
    obj = make_nurbs(scene, order, ends=ends, cyclic=cyclic)
    line, seen = core("blender.nurbs").nurbs_line(obj.data.splines[0], 0.05), shown(obj)
    seen = np.concatenate((seen, seen[:1])) if cyclic else seen
    assert furthest(line, seen) < 0.03
    assert furthest(seen, line) < 0.03
    if not cyclic:
        np.testing.assert_allclose(line[[0, -1]], seen[[0, -1]], atol=0.02)


def test_bezier_knots_too(core, scene) -> None:
    obj = make_nurbs(scene, 4, ends=True, bezier=True)
    line, seen = core("blender.nurbs").nurbs_line(obj.data.splines[0], 0.05), shown(obj)
    assert furthest(line, seen) < 0.03 and furthest(seen, line) < 0.03


def test_each_control_point_has_its_place_on_the_curve(core, scene) -> None:
    obj = make_nurbs(scene)
    nurbs = core("blender.nurbs")
    own, line = nurbs.nurbs_knots(obj.data.splines[0]), nurbs.nurbs_line(obj.data.splines[0], 0.02)
    assert len(own) == len(PLACES)
    assert furthest(own, line) < 0.01
    np.testing.assert_allclose(own[[0, -1]], [PLACES[0], PLACES[-1]], atol=1e-9)
    for place, control in zip(own, PLACES, strict=True):
        assert np.linalg.norm(place - control) < 3.5, "near the point that it belongs to"


def test_a_line_of_two_points(core, scene) -> None:
    obj = make_nurbs(scene, 2)
    line = core("blender.nurbs").nurbs_line(obj.data.splines[0], 1.0)
    for place in PLACES:
        assert np.linalg.norm(line - place, axis=1).min() < 1e-9, "corners are kept"
