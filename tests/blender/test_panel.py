"""The Ski tab, drawn onto a layout that only remembers what was drawn."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

OLD = "From before the last change:"


class Layout:
    """Remembers labels, properties, operators and progress bars in the order they were drawn."""

    def __init__(self, drawn: list[tuple[str, str]] | None = None, enabled: bool = True) -> None:
        self.drawn: list[tuple[str, str]] = [] if drawn is None else drawn
        self.enabled = enabled

    def _inner(self, **_how: Any) -> Layout:
        return Layout(self.drawn)

    column = row = box = _inner

    def label(self, text: str = "", icon: str = "NONE") -> None:
        self.drawn.append(("label", text))

    def prop(self, group: Any, name: str, **_how: Any) -> None:
        assert name in group.bl_rna.properties, f"{name} is not a property"
        self.drawn.append(("prop", name))

    def operator(self, name: str, **_how: Any) -> None:
        import bpy

        family, _, verb = name.partition(".")
        getattr(getattr(bpy.ops, family), verb).get_rna_type()  # raises if there is no such operator
        self.drawn.append(("operator", name))

    def progress(self, factor: float = 0.0, text: str = "") -> None:
        self.drawn.append(("progress", text))

    def of(self, kind: str) -> list[str]:
        return [what for drawn, what in self.drawn if drawn == kind]


@pytest.fixture
def draw(core, scene):
    """Draws the tab and returns what was drawn."""
    import bpy

    panels = core("blender.panels")

    def drawn() -> Layout:
        layout = Layout()
        context = SimpleNamespace(scene=scene, region=SimpleNamespace(width=320), preferences=bpy.context.preferences)
        panels.SKI_PT_main.draw(SimpleNamespace(layout=layout), context)
        return layout

    return drawn


def test_the_tab_has_presets_parameters_and_three_buttons(draw) -> None:
    layout = draw()
    assert layout.of("prop")[0] == "preset"
    assert {"mass", "height", "angle_deg", "turn_count", "turn_radius", "turn_duration", "transition_duration"} <= set(
        layout.of("prop")
    )
    assert layout.of("operator") == ["ski.plan", "ski.simulate", "ski.bake"]


def test_the_tab_is_in_the_3d_view_s_sidebar(core, scene) -> None:
    panel = core("blender.panels").SKI_PT_main
    assert (panel.bl_space_type, panel.bl_region_type, panel.bl_category) == ("VIEW_3D", "UI", "Ski")


def test_changed_settings_offer_the_way_back(scene, draw) -> None:
    scene.ski.course.turn_radius += 1.0
    assert "ski.reset_to_preset" in draw().of("operator")


def test_results_are_shown_and_marked_when_they_are_old(core, scene, draw) -> None:
    properties = core("blender.properties")
    properties.tell(
        scene.ski, "plan", properties.read_spec(scene.ski), ["Can be skied: 90 m in 12 s", "Speed 5 to 9 m/s"]
    )
    labels = draw().of("label")
    assert "Can be skied: 90 m in 12 s" in labels
    assert OLD not in labels
    scene.ski.skier.mass += 5.0
    assert OLD in draw().of("label")


def test_long_lines_are_wrapped(core, scene, draw) -> None:
    properties = core("blender.properties")
    line = "the track cannot be skied at turn 3 (61.2 m, 8.1 s): at 12.3 m/s it needs 58 degrees of lean; slow down"
    properties.tell(scene.ski, "plan", properties.read_spec(scene.ski), [line], failed=True)
    labels = [label for label in draw().of("label") if label in line]
    assert " ".join(labels) == line
    assert len(labels) >= 3


def test_a_running_simulation_shows_its_progress(core, draw, monkeypatch) -> None:
    jobs = core("blender.jobs")
    monkeypatch.setattr(jobs.RUNNING, "text", "3.1 of 12.0 s skied, 20 s left")
    monkeypatch.setattr(jobs.RUNNING, "fraction", 0.26)
    layout = draw()
    assert layout.of("progress") == ["26%"]
    assert any("Esc" in label for label in layout.of("label"))


def test_missing_libraries_are_named(core, draw, monkeypatch) -> None:
    monkeypatch.setattr(core("blender.panels"), "missing_dependencies", lambda: ["mujoco", "osqp"])
    said = " ".join(draw().of("label"))
    assert "mujoco, osqp" in said
    assert "Install the Ski Addon zip" in said
