"""A new user in a real window: the zip installed from the preferences, four clicks to a playing run, and Esc.

Figures are left in out/gui/first_run/result.json and printed. Computers differ, so times are bounded very generously;
what holds on any of them is counted: clicks, and how much still happens after Esc.
"""

from __future__ import annotations

from typing import Any

import pytest

from tests.gui.in_window import in_window, run_in_window, shots_of, zip_path

pytestmark = in_window
CLICKS = 5
"""The most clicks to a playing run after the installation."""
LATE = 3
"""The most slices of a simulation, and redraws of the view or its sidebar, that may still come after Esc."""
PATIENCE = 20.0
"""How many times longer than asked for anything may take."""


@pytest.fixture(scope="module")
def outcome(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What the script in the window wrote when it was done."""
    folder, user = tmp_path_factory.mktemp("first"), tmp_path_factory.mktemp("user")
    return run_in_window("first_run", folder, user, zip_path(), install=False)


def test_everything_was_done(outcome: dict[str, Any]) -> None:
    assert not outcome["error"], outcome["error"]
    assert outcome["steps"] == ["install", "sidebar", "tab", "simulated", "baked", "played", "escapes"]


def test_the_zip_was_installed_from_the_preferences(outcome: dict[str, Any]) -> None:
    print(f"installed in {outcome['install_seconds']:.1f} s")
    assert outcome["missing"] == []


def test_a_few_clicks_lead_to_a_playing_run(outcome: dict[str, Any]) -> None:
    waited, frames = outcome["waited"], outcome["frames"][1] - outcome["frames"][0]
    run_seconds, seconds = frames / outcome["rate"], sum(waited.values())
    print(f"{outcome['clicks']} clicks, {seconds:.1f} s of waiting for a run of {run_seconds:.1f} s: {waited}")
    assert outcome["said"].startswith("Skied to the end")
    assert outcome["clicks"] <= CLICKS
    assert seconds < PATIENCE * 60.0 * max(run_seconds / 10.0, 1.0)


def test_esc_is_answered_at_once(outcome: dict[str, Any]) -> None:
    assert len(outcome["escapes"]) == 3
    for found in outcome["escapes"]:
        print(f"Esc after {found['after']:g} s: {found}")
        assert found["said"].startswith("Stopped after")
        assert found["slices"] <= LATE and found["redraws"] <= LATE
        assert found["seconds"] < PATIENCE * 0.2


@pytest.mark.parametrize("name", ["1_preferences", "2_file_browser", "3_installed", "4_playing", "5_stopped"])
def test_screenshot_was_taken(outcome: dict[str, Any], name: str) -> None:
    assert (shots_of("first_run") / f"{name}.png").stat().st_size > 20_000
