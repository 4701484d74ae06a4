"""The sidebar in a real window, by mouse: from an empty scene to a playing run, Esc, undo, gates, an impossible course.

Needs SKI_ADDON_BLENDER (the command of a Blender with a window), SKI_ADDON_ZIP (a zip that fits its Python), DISPLAY,
and ImageMagick's `import` for the screenshots, which are left in out/gui/drive to be looked at.
"""

from __future__ import annotations

import math
from typing import Any

import pytest

from tests.gui.in_window import in_window, run_in_window, shots_of

pytestmark = in_window


@pytest.fixture(scope="module")
def outcome(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What the script in the window wrote when it was done."""
    return run_in_window("drive", tmp_path_factory.mktemp("window"), tmp_path_factory.mktemp("user"))


def test_everything_was_done_by_mouse(outcome: dict[str, Any]) -> None:
    assert not outcome["error"], outcome["error"]
    steps = [
        "preset",
        "simulate",
        "bake",
        "play",
        "overlay",
        "stop",
        "undo_bake",
        "gates",
        "drag",
        "undo_gates",
        "impossible",
    ]
    assert outcome["steps"] == steps


def test_a_preset_was_chosen_from_the_menu(outcome: dict[str, Any]) -> None:
    assert outcome["preset"] == "medium_carving"


def test_the_run_was_simulated_baked_and_played(outcome: dict[str, Any]) -> None:
    assert not outcome["simulation_failed"]
    assert outcome["action"]
    assert outcome["frames"][1] - outcome["frames"][0] > 100
    assert outcome["bones"] >= 20
    assert outcome["frame_reached"] > 1


def test_the_overlay_was_drawn(outcome: dict[str, Any]) -> None:
    assert outcome["overlay"]  # a handler that fails takes itself away


def test_esc_kept_what_was_done(outcome: dict[str, Any]) -> None:
    assert outcome["stopped"].startswith("Stopped after")
    assert outcome["finished"].startswith("Skied to the end")


def test_undo_took_the_bake_away_and_nothing_else(outcome: dict[str, Any]) -> None:
    assert outcome["skier_left"]
    assert not outcome["slope_left"]


def test_five_gates_stand_where_they_were_clicked(outcome: dict[str, Any]) -> None:
    gates = outcome["gates"]
    assert len(gates) == 5
    cosine = math.cos(math.radians(11.0))
    for index, (down, left) in enumerate(gates):
        assert abs(down * cosine - (20.0 + 9.0 * index)) < 0.6  # a pixel is wide so far off
        assert abs(left - (1.8 if index % 2 == 0 else -1.8)) < 0.3


def test_the_preview_followed_the_dragged_gate(outcome: dict[str, Any]) -> None:
    assert outcome["moving"]
    assert outcome["previews"] >= 3


def test_gates_were_undone_one_by_one(outcome: dict[str, Any]) -> None:
    assert outcome["gates_before"] == 5
    assert 1 <= outcome["gates_left"] < 5


def test_an_impossible_course_is_told(outcome: dict[str, Any]) -> None:
    assert outcome["refused_failed"]
    assert "cannot be skied at turn" in outcome["refused"]


SCREENS = ("tab", "skier", "presets", "simulating", "baked", "stopped", "undone", "placing", "dragging", "dragged")


@pytest.mark.parametrize("name", [*(f"{i + 1}_{n}" for i, n in enumerate(SCREENS)), "11_gate_undone", "12_impossible"])
def test_screenshot_was_taken(outcome: dict[str, Any], name: str) -> None:
    assert (shots_of("drive") / f"{name}.png").stat().st_size > 20_000
