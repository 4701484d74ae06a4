"""Gates dragged off the snow: the preview says which, a button puts them back, and undo knows it."""

from __future__ import annotations

import math

import numpy as np
import pytest


def gate(ski, number: int):
    """The pole of a standing gate."""
    import bpy

    bpy.context.view_layer.update()
    poles = [obj for obj in ski.gates.all_objects if obj.ski_gate.is_gate]
    return sorted(poles, key=lambda pole: pole.matrix_world.translation.x)[number - 1]


@pytest.fixture
def course(core, ski):
    """Five gates of slalom that stand on the snow of a plane."""
    import bpy

    bpy.ops.ski.set_gates(discipline="slalom", count=5)
    ski.course.start_speed, ski.course.target_speed_word, ski.course.target_speed = 5.0, False, 7.0
    bpy.context.view_layer.update()
    return ski


@pytest.fixture
def shown(core, course):
    """A function that works the preview out."""
    import bpy

    live = core("blender.live")

    def work_out(before=None, *, quick: bool = False):
        bpy.context.view_layer.update()
        return live.preview_of(course, before, quick=quick)

    return work_out


def test_gates_on_the_snow_are_no_problem(shown) -> None:
    assert shown().off_snow == () and shown().problem == ""


@pytest.mark.parametrize(("height", "words"), [(1.2, "hangs 1.20 m over the snow"), (-0.4, "is 0.40 m under the snow")])
@pytest.mark.parametrize("quick", [False, True])
def test_a_gate_off_the_snow_is_named_while_it_is_dragged(course, shown, height, words, quick) -> None:
    before = shown()
    gate(course, 3).location.z += height
    after = shown(before, quick=quick)
    assert after is not before
    assert after.problem == f"gate 3 {words}: put it on the snow"
    np.testing.assert_allclose(after.problem_place, gate(course, 3).matrix_world.translation, atol=1e-6)
    assert len(after.line) == pytest.approx(len(before.line), abs=5), "it can be skied all the same"
    np.testing.assert_allclose(after.line[-1], before.line[-1], atol=0.2)
    assert after.gates[2].place[2] == pytest.approx(gate(course, 3).matrix_world.translation.z, abs=1e-6)


def test_the_furthest_of_several_is_named(course, shown) -> None:
    for number, height in ((2, 0.3), (4, -0.9), (5, 0.2)):
        gate(course, number).location.z += height
    said = shown().problem
    assert said == "gates 2, 4 and 5 are off the snow; gate 4 is 0.90 m under the snow: put them on the snow"


def test_what_cannot_be_skied_comes_first(course, shown) -> None:
    gate(course, 3).location.z += 1.0
    course.technique.inclination_max_deg = math.radians(30.0)
    course.course.start_speed = 16.0
    course.course.target_speed_word = True
    after = shown()
    assert after.off_snow and after.problem
    assert "off the snow" not in after.problem and "gate 3 hangs" not in after.problem


def test_put_on_snow_moves_only_those_that_are_off_it(course, shown) -> None:
    import bpy

    gate(course, 3).location.z += 1.2
    gate(course, 3).location.x += 0.5
    places = {number: tuple(gate(course, number).matrix_world.translation) for number in range(1, 6)}
    names = [gate(course, number).name for number in range(1, 6)]
    assert bpy.ops.ski.put_gates_on_snow() == {"FINISHED"}
    for number, place in places.items():
        now = tuple(gate(course, number).matrix_world.translation)
        assert now[:2] == pytest.approx(place[:2], abs=1e-4), "straight down"
        if number != 3:
            assert now == pytest.approx(place, abs=1e-6)
    assert [gate(course, number).name for number in range(1, 6)] == names
    assert shown().off_snow == ()


def test_a_parented_gate_is_put_on_the_snow_too(course, shown, scene) -> None:
    import bpy

    holder = bpy.data.objects.new("Holder", None)
    scene.collection.objects.link(holder)
    gate(course, 2).parent = holder
    holder.location.z = 2.0
    assert "gate 2 hangs 2.00 m" in shown().problem
    bpy.ops.ski.put_gates_on_snow()
    assert shown().problem == ""


def test_one_undo_takes_it_back(course, shown) -> None:
    import bpy

    gate(course, 3).location.z += 1.2
    bpy.ops.ed.undo_push(message="Dragged")
    bpy.ops.ski.put_gates_on_snow()
    bpy.ops.ed.undo_push(message="Put on Snow")
    bpy.ops.ed.undo()
    (pole,) = [obj for obj in bpy.data.objects if obj.name == "Gate 3"]
    ski = bpy.data.objects["Skier"].ski
    height = pole.matrix_world.translation.z + pole.matrix_world.translation.x * math.tan(ski.slope.angle_deg)
    assert height == pytest.approx(1.2, abs=0.01)


def test_a_gate_beside_the_slope_is_said_by_number(core, course, shown) -> None:
    import bpy

    course.slope.kind, course.slope.grid_file = "grid", "rolling_hill"
    bpy.ops.ski.set_gates(discipline="slalom", count=4)
    before = shown()
    assert before.off_snow == ()
    gate(course, 3).location.y = 400.0
    after = shown(before)
    assert "gate 3 is off the terrain" in after.problem and len(after.line) == len(before.line)
    gate(course, 2).location.z += 1.0
    assert bpy.ops.ski.put_gates_on_snow() == {"FINISHED"}
    heights = core("blender.gate_heights")
    off = heights.gates_off_snow(course, core("blender.properties").read_slope(course))
    assert [(one.number, bool(np.isnan(one.height))) for one in off] == [(3, True)]
    assert heights.off_snow_words(off) == "gate 3 stands beside the slope: move it back"


def test_gates_left_behind_by_a_moved_start_are_said(course, shown) -> None:
    """Gates without a parent are the scene's: they stay where start and slope go away from under them."""
    import bpy

    for number in range(1, 6):
        gate(course, number).parent = None
    course.start.location.z -= 0.5
    assert "5 are off the snow" in shown().problem and "0.50 m over the snow" in shown().problem
    bpy.ops.ski.put_gates_on_snow()
    assert shown().problem == ""


def test_the_panel_offers_the_button_only_then(core, course, shown, monkeypatch) -> None:
    import bpy

    live, parts = core("blender.live"), core("blender.panel_parts")

    class Layout:
        """Notes the operators that are drawn."""

        def __init__(self) -> None:
            self.operators: list[str] = []

        def column(self, **_how):
            return self

        row = box = column

        def operator(self, name: str, **_how):
            self.operators.append(name)

        def operator_menu_enum(self, *_names, **_how) -> None:
            pass

        label = prop = operator_menu_enum

    for height, offered in ((0.0, False), (1.0, True)):
        gate(course, 3).location.z += height
        monkeypatch.setattr(live.STATE, "preview", shown())
        layout = Layout()
        parts.draw_gates(layout, bpy.context, course)
        assert ("ski.put_gates_on_snow" in layout.operators) == offered
