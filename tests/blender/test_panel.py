"""The Ski tab, drawn onto a layout that only remembers what was drawn."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

OLD = "From before the last change:"
WORK = ["skier", "slope", "course", "technique", "snow", "simulate", "bake", "crowd", "analyse"]


class Button:
    """What an operator's button gives: its properties can be set."""


class Layout:
    """Remembers labels, properties, operators, menus and progress bars in the order they were drawn."""

    def __init__(self, drawn: list[tuple[str, str]] | None = None) -> None:
        self.drawn: list[tuple[str, str]] = [] if drawn is None else drawn

    def _inner(self, **_how: Any) -> Layout:
        return Layout(self.drawn)

    column = row = box = _inner

    def label(self, text: str = "", icon: str = "NONE") -> None:
        self.drawn.append(("label", text))

    def prop(self, group: Any, name: str, **_how: Any) -> None:
        assert name in group.bl_rna.properties, f"{name} is not a property"
        self.drawn.append(("prop", name))

    def operator(self, name: str, **_how: Any) -> Button:
        import bpy

        family, _, verb = name.partition(".")
        getattr(getattr(bpy.ops, family), verb).get_rna_type()  # raises if there is no such operator
        self.drawn.append(("operator", name))
        return Button()

    def operator_menu_enum(self, name: str, _property: str, **_how: Any) -> None:
        self.operator(name)

    def menu(self, name: str, **_how: Any) -> None:
        import bpy

        assert hasattr(bpy.types, name), f"{name} is not a menu"
        self.drawn.append(("menu", name))

    def template_list(self, _kind: str, name: str, *_rest: Any, **_how: Any) -> None:
        self.drawn.append(("list", name))

    def prop_search(self, group: Any, name: str, *_rest: Any, **_how: Any) -> None:
        self.prop(group, name)

    def separator(self) -> None:
        pass

    def progress(self, factor: float = 0.0, text: str = "") -> None:
        self.drawn.append(("progress", text))

    def of(self, kind: str) -> list[str]:
        return [what for drawn, what in self.drawn if drawn == kind]


@pytest.fixture
def draw(core, scene):
    """Draws the tab, or some of its panels, and returns what was drawn."""
    import bpy

    panels = core("blender.panels")

    def drawn(*only: str) -> Layout:
        layout = Layout()
        context = SimpleNamespace(
            scene=scene,
            object=bpy.context.object,
            region=SimpleNamespace(width=320),
            preferences=bpy.context.preferences,
        )
        for cls in panels.CLASSES:
            name = cls.__name__.removeprefix("SKI_PT_")
            if not issubclass(cls, bpy.types.Panel) or (only and name not in only):
                continue
            if hasattr(cls, "poll") and not cls.poll(context):
                continue
            panel = SimpleNamespace(layout=layout)
            if hasattr(cls, "draw_header_preset"):
                cls.draw_header_preset(panel, context)
            cls.draw(panel, context)
        return layout

    return drawn


def test_an_empty_scene_offers_a_skier_and_nothing_else(draw) -> None:
    layout = draw()
    assert layout.of("operator") == ["ski.add_skier", "ski.use_armature"]
    assert layout.of("menu") == ["SKI_MT_add_skier"]


def test_the_panels_are_in_the_order_of_the_work(core, scene) -> None:
    import bpy

    classes = [cls for cls in core("blender.panels").CLASSES if issubclass(cls, bpy.types.Panel)]
    assert [c.__name__.removeprefix("SKI_PT_") for c in classes if not getattr(c, "bl_parent_id", "")] == WORK
    assert all((c.bl_space_type, c.bl_region_type, c.bl_category) == ("VIEW_3D", "UI", "Ski") for c in classes)


def test_what_matters_is_on_top(ski, draw) -> None:
    drawn = set(draw(*WORK).of("prop"))
    wanted = {"height", "mass", "angle_deg", "turn_count", "turn_radius", "start_speed", "speed_limit", "friction"}
    assert wanted <= drawn
    assert not {"strength", "hardness", "time_step", "equations"} & drawn


def test_every_field_of_a_run_can_be_reached(core, ski, draw) -> None:
    core("blender.preferences").preferences().expert = True
    try:
        drawn: set[str] = set()
        kinds = {"course": "kind", "slope": "kind", "figure": "kind"}
        spec = core("spec")
        for section, name in kinds.items():
            for choice in spec.find_field(f"{section}.{name}").choices:
                setattr(getattr(ski, section), name, choice)
                drawn |= set(draw().of("prop")) | {f"[{name}]" for name in draw().of("list")}
        ski.course.kind, ski.course.gate_setting = "gates", "list"
        drawn |= {f"[{name}]" for name in draw().of("list")}
    finally:
        core("blender.preferences").preferences().expert = False
    missing = [key for key, info in spec.field_table().items() if info.section and info.name not in drawn]
    assert missing == ["bake.fps"]  # Blender's own frame rate counts
    assert {"[gate]", "[rhythm]", "[obstacle]", "[push]"} <= drawn
    assert "curve" in drawn  # the points of a path come from it


def test_every_field_of_a_crowd_can_be_reached(core, ski, draw) -> None:
    names = [info.name for info in core("crowd").field_table().values()]
    drawn = draw("crowd", "crowd_more").of("prop")
    assert sorted(names + ["crowd_jobs"]) == sorted(name for name in drawn if not name.endswith("_word"))
    assert draw("crowd").of("operator") == ["ski.crowd", "ski.bake_crowd"]


def test_fields_for_experts_are_folded_away(core, ski, draw) -> None:
    assert not {"hardness", "equations"} & set(draw().of("prop"))
    core("blender.preferences").preferences().expert = True
    try:
        assert {"hardness", "equations"} <= set(draw().of("prop"))
    finally:
        core("blender.preferences").preferences().expert = False


def test_every_step_has_its_presets(ski, draw) -> None:
    kinds = ["skiers", "runs", "courses", "styles", "snow"]
    assert draw().of("menu") == [f"SKI_MT_{kind}_presets" for kind in kinds]


def test_changed_settings_offer_the_way_back(ski, draw) -> None:
    assert "ski.reset_to_preset" not in draw("skier").of("operator")
    ski.course.turn_radius += 1.0
    assert "ski.reset_to_preset" in draw("skier").of("operator")


def test_a_figure_that_does_not_fit_offers_to_be_rebuilt(ski, draw) -> None:
    assert "ski.fit_figure" not in draw("skier").of("operator")
    ski.skier.height = 1.6
    assert "ski.fit_figure" in draw("skier").of("operator")


def test_a_figure_without_physics_offers_its_preview(ski, draw) -> None:
    ski.figure.kind = "snowboard"
    layout = draw("simulate", "bake")
    assert layout.of("operator") == ["ski.bake"]
    assert any("bake the preview" in label for label in layout.of("label"))


def test_results_are_shown_and_marked_when_they_are_old(core, ski, draw) -> None:
    properties = core("blender.properties")
    said = ["Can be skied: 90 m in 12 s", "Speed 5 to 9 m/s"]
    properties.tell(ski, "plan", properties.read_spec(ski), said)
    labels = draw("simulate").of("label")
    assert "Can be skied: 90 m in 12 s" in labels
    assert OLD not in labels
    ski.skier.mass += 5.0
    assert OLD in draw("simulate").of("label")


def test_long_lines_are_wrapped(core, ski, draw) -> None:
    properties = core("blender.properties")
    line = "the track cannot be skied at turn 3 (61.2 m, 8.1 s): at 12.3 m/s it needs 58 degrees of lean; slow down"
    properties.tell(ski, "plan", properties.read_spec(ski), [line], failed=True)
    labels = [label for label in draw("simulate").of("label") if label in line]
    assert " ".join(labels) == line
    assert len(labels) >= 3


def test_a_running_simulation_shows_its_progress(core, ski, draw, monkeypatch) -> None:
    jobs = core("blender.jobs")
    monkeypatch.setattr(jobs.RUNNING, "text", "3.1 of 12.0 s skied, 20 s left")
    monkeypatch.setattr(jobs.RUNNING, "fraction", 0.26)
    layout = draw("simulate")
    assert layout.of("progress") == ["26%"]
    assert any("Esc" in label for label in layout.of("label"))


def test_missing_libraries_are_named(core, ski, draw, monkeypatch) -> None:
    monkeypatch.setattr(core("blender.panels"), "missing_dependencies", lambda: ["mujoco", "osqp"])
    said = " ".join(draw("skier").of("label"))
    assert "mujoco, osqp" in said
    assert "install the Ski Addon zip" in said


def test_the_preview_s_problem_stands_in_the_panel(core, ski, draw, monkeypatch) -> None:
    live = core("blender.live")
    ski.course.turn_radius, ski.course.start_speed = 5.0, 15.0
    monkeypatch.setattr(live.STATE, "preview", live.preview_of(ski))
    assert "cannot be skied at turn" in " ".join(draw("course").of("label"))
