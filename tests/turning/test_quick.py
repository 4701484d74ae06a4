"""The preview of gates while one is dragged: nearly the whole preview, from whatever came before."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.drag import COURSES, listed, moved
from ski_addon.errors import SpecError
from ski_addon.turning.preview import preview_course
from ski_addon.turning.quick import quick_gates


def apart(motion, exact) -> float:
    """How far the track of a quick preview is from the whole one, up to where the quick one ends [m]."""
    mine, theirs = motion.position[:, :2], exact.position[::5, :2]
    theirs = theirs[theirs[:, 0] < mine[-1, 0]]
    return float(np.linalg.norm(theirs[:, None] - mine[None], axis=2).min(axis=1).max())


@pytest.mark.parametrize("name", COURSES)
def test_it_is_nearly_the_whole_preview(name: str) -> None:
    spec, terrain = listed(name)
    exact = preview_course(spec, terrain).motion
    motion = quick_gates(spec, terrain).preview.motion
    assert apart(motion, exact) < 0.12
    place = np.linspace(0.0, 0.6 * motion.position[-1, 0], 200)  # beyond, one who is to stop brakes already
    fast, quick = (np.interp(place, one.position[:, 0], one.speed) for one in (exact, motion))
    np.testing.assert_allclose(quick, fast, rtol=0.05)
    lean, other = (np.interp(place, one.position[:, 0], np.degrees(one.lean)) for one in (exact, motion))
    np.testing.assert_allclose(other, lean, atol=1.5)


def test_it_is_the_same_whatever_came_before() -> None:
    """Dragged to a place by steps or put there at once: the same line, nearly the same speeds."""
    spec, terrain = listed("slalom")
    dragged = quick_gates(spec, terrain)
    for aside in np.linspace(0.1, 0.8, 8):
        dragged = quick_gates(moved(spec, float(aside)), terrain, dragged)
    put = quick_gates(moved(spec, 0.8), terrain)
    assert apart(dragged.preview.motion, put.preview.motion) < 0.12
    assert dragged.preview.motion.speed.mean() == pytest.approx(put.preview.motion.speed.mean(), rel=0.05)


def test_speeds_are_worked_out_anew_for_another_way() -> None:
    spec, terrain = listed("slalom")
    before = quick_gates(spec, terrain)
    wide = spec.with_overrides({f"gate.{k}.y": 3.0 * spec.gate[k - 1].y for k in range(1, len(spec.gate) + 1)})
    after = quick_gates(wide, terrain, before)
    assert after.length > 1.03 * before.length
    assert after.riding is not before.riding


def test_another_number_of_gates_begins_anew() -> None:
    spec, terrain = listed("slalom")
    fewer = type(spec).from_dict({**spec.to_dict(), "gate": spec.to_dict()["gate"][:-3]})
    made = quick_gates(fewer, terrain, quick_gates(spec, terrain)).preview.motion
    assert apart(made, preview_course(fewer, terrain).motion) < 0.12


@pytest.mark.parametrize(("gate", "values"), [(5, {"x": 5.0}), (9, {"y": 60.0})])
def test_gates_that_cannot_be_passed_are_named(gate: int, values: dict[str, float]) -> None:
    spec, terrain = listed("slalom")
    before = quick_gates(spec, terrain)
    changed = spec.with_overrides({f"gate.{gate}.{name}": value for name, value in values.items()})
    with pytest.raises(SpecError, match="gate"):
        quick_gates(changed, terrain, before)
