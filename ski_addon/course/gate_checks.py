"""Whether every gate can be passed, and what would work where one cannot."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from ..errors import SpecError
from ..spec import RunSpec
from ..spec.gate_defaults import MARGIN, gate_defaults
from ..terrain import Terrain
from .fair_line import FairLine, Poles, fair_line
from .gate_settings import set_poles

RADIUS_MIN = 3.0
"""No turn is tighter than this [m]."""
CLOSEST = 2.0
"""Gates stand at least this far down the slope from each other [m]."""
_FARTHEST = float(np.sin(np.deg2rad(70.0)))
"""No line to a gate turns farther from the fall line than the angle of this sine."""
_SAME_PLACE = 0.1
_ROUNDING = 0.97
_LEEWAY = 0.005
_NEIGHBOURS, _HALVINGS = 2, 7


def check_places(spec: RunSpec, poles: Poles, terrain: Terrain) -> None:
    """Raise `SpecError` for the first pole that is off the terrain or not below the one before it."""
    inside = terrain.contains(poles.down * np.cos(terrain.mean_angle), poles.left)
    for k in range(len(poles)):
        if not inside[k]:
            x, y = _nearest_inside(terrain, poles, k)
            raise _refused(k, f"is off the terrain{_there(poles, k)}", f"x = {x:g}, y = {y:g} would work")
        if k and poles.down[k] - poles.down[k - 1] < CLOSEST:
            raise _refused(k, _misplaced(poles, k), _below(spec, poles, k))


def check_line(spec: RunSpec, poles: Poles, line: FairLine) -> None:
    """Raise `SpecError` for the first pole that `line`, the smoothest one past `poles`, cannot pass as asked."""
    free = np.isnan(poles.radius)
    unasked = dataclasses.replace(poles, radius=np.full(len(poles), np.nan))
    found = _first_fault(unasked, line if free.all() else _line_past(unasked))
    if found is not None and spec.course.gate_setting == "list":
        raise _refused(found[0], found[1], _way_out(spec, unasked, found[0]))
    if found is not None:
        raise _refused_set(spec, unasked, *found)
    if not free.all() and (tight := _unfit(poles, line)) is not None:
        raise _refused_radius(spec, poles, tight)


def _first_fault(poles: Poles, line: FairLine) -> tuple[int, str] | None:
    """Return the first pole that cannot be passed and why, or None."""
    if not line.settled or line.steepest > _FARTHEST:
        places = np.linspace(line.begin, line.end, 40 * len(poles))
        steep = places[int(np.argmax(np.abs(line.sines(places))))]
        after = int(np.clip(np.searchsorted(line.apex, steep), 1, len(poles) - 1))
        k = max((after - 1, after), key=lambda gate: abs(_straight_place(poles, gate) - poles.left[gate]))
        return k, f"is too far to one side for the way down to the next one{_there(poles, k)}"
    bend = poles.side * line.sines(line.apex, 1)
    tight = _tightest(line)
    for k in range(len(poles)):
        if bend[k] < 0.0:
            side, other = ("left", "right") if poles.side[k] > 0 else ("right", "left")
            return k, f"cannot be passed turning {side}: the line past its neighbours turns {other} there"
        if np.isnan(poles.radius[k]) and 1.0 / tight[k] < RADIUS_MIN:
            return k, f"needs a turn of {1.0 / tight[k]:.1f} m radius, tighter than {RADIUS_MIN:g} m{_there(poles, k)}"
    missed = _first_missed(poles, line)
    return None if missed is None else (missed, "would be passed nearer than asked: the line to its neighbours cuts it")


def _unfit(poles: Poles, line: FairLine) -> int | None:
    """Return the first pole whose asked radius the line cannot keep, or None."""
    with np.errstate(invalid="ignore"):
        tight = 1.0 / _tightest(line) < _ROUNDING * poles.radius
    if tight.any():
        return int(np.argmax(tight))
    found = _first_fault(poles, line)
    asked = np.flatnonzero(np.isfinite(poles.radius))
    return None if found is None else int(asked[np.argmin(np.abs(asked - found[0]))])


def _first_missed(poles: Poles, line: FairLine) -> int | None:
    down, left, _ = line.sampled(0.02)
    for k in range(len(poles)):
        near = slice(*np.searchsorted(down, (poles.down[k] - 6.0, poles.down[k] + 6.0)))
        gap = np.hypot(down[near] - poles.down[k], left[near] - poles.left[k])
        if gap.min() < poles.distance[k] - _LEEWAY:
            return k
    return None


def _tightest(line: FairLine) -> np.ndarray:
    """Return the largest curvature (n,) [1/m] on the part of the line that is nearest to each pole."""
    stops = np.concatenate(([line.begin], 0.5 * (line.apex[1:] + line.apex[:-1]), [line.end]))
    places = np.linspace(stops[:-1], stops[1:], 80, axis=1)
    return np.maximum(np.max(np.abs(line.sines(places, 1)), axis=1), 1e-9)


def _line_past(poles: Poles) -> FairLine:
    gaps = np.diff(poles.down) if len(poles) > 1 else np.array([10.0])
    return fair_line(poles, MARGIN * float(gaps[0]), MARGIN * float(gaps[-1]), tolerance=1e-6)


# -- what would work ---------------------------------------------


def _way_out(spec: RunSpec, poles: Poles, k: int) -> str:
    """Return a hint that names the side or the nearest place with which gate `k` could be passed."""
    if (side := _other_side(spec, k)) is not None:
        return f'side = "{side}" would work'
    straight = _straight_place(poles, k)

    def aside(share: float) -> Poles:
        left = poles.left.copy()
        left[k] = _rounded(left[k], straight, share)
        return dataclasses.replace(poles, left=left)

    def lower(share: float) -> Poles:
        return dataclasses.replace(poles, down=poles.down + np.where(np.arange(len(poles)) >= k, _lowered(share), 0.0))

    if (share := _least(aside, k)) is not None:
        return f"y = {_rounded(poles.left[k], straight, share):.1f} would work"
    if k and (share := _least(lower, k)) is not None:
        rest = "" if k + 1 == len(poles) else ", with all gates after it as much farther down,"
        return f"x = {poles.down[k] + _lowered(share):.1f}{rest} would work"
    return "take it out, or move it and the gates beside it"


def _other_side(spec: RunSpec, k: int) -> str | None:
    """Return the other side for gate `k`, if the gates beside it could then be passed."""
    side = "right" if set_poles(spec).side[k] > 0 else "left"
    rows = tuple(dataclasses.replace(row, side=side) if i == k else row for i, row in enumerate(spec.gate))
    turned = set_poles(dataclasses.replace(spec, gate=rows))
    free = dataclasses.replace(turned, radius=np.full(len(turned), np.nan))
    return side if _passable(free.part(_around(k))) else None


def _refused_set(spec: RunSpec, poles: Poles, k: int, problem: str) -> SpecError:
    """Return the error of a generated set of gates, with the largest offset or the least spacing that would work."""
    usual = gate_defaults(spec.course)
    problem = f"makes a course that cannot be skied: gate {k + 1} {problem}"
    share = _least(lambda f: dataclasses.replace(poles, left=(1.0 - f) * poles.left), k, len(poles))
    if share is not None and usual.offset * (1.0 - share) >= 0.1:
        hint = f"at most {np.floor(10.0 * usual.offset * (1.0 - share)) / 10.0:.1f} m would work"
        return SpecError("course.gate_offset", usual.offset, problem=problem, hint=hint)
    share = _least(lambda f: dataclasses.replace(poles, down=(1.0 + 9.0 * f) * poles.down), k, len(poles))
    least = None if share is None else np.ceil(10.0 * usual.spacing * (1.0 + 9.0 * share)) / 10.0
    hint = "use a smaller course.gate_distance" if least is None else f"at least {least:.1f} m would work"
    return SpecError("course.gate_spacing", usual.spacing, problem=problem, hint=hint)


def _refused_radius(spec: RunSpec, poles: Poles, k: int) -> SpecError:
    works = _largest_radius(poles, k)
    problem = f"is more than fits: the line past its neighbours must turn tighter{_there(poles, k)}"
    key = f"gate {k + 1}: radius"
    if spec.course.gate_setting != "list":
        key, problem = "course.gate_radius", f"is more than fits: at gate {k + 1} the line must turn tighter"
    return SpecError(
        key, float(poles.radius[k]), problem=problem, hint=f"at most {works:.1f} m would work" if works else "give auto"
    )


def _around(k: int) -> slice:
    """Return the gates whose places matter to gate `k`."""
    return slice(max(k - _NEIGHBOURS, 0), k + _NEIGHBOURS + 1)


def _largest_radius(poles: Poles, k: int) -> float | None:
    """Return the largest radius [m], in tenths, that fits at gate `k` and is asked of no gate near it, or None."""
    free = _line_past(dataclasses.replace(poles, radius=np.full(len(poles), np.nan)))
    natural = 1.0 / abs(float(free.sines(free.apex[k], 1)))
    most = min(float(poles.radius[k]), max(1.6 * natural, 2.0 * RADIUS_MIN))  # arcs alone gain a fifth

    def radius(share: float) -> float:
        return float(np.floor(10.0 * (most + share * (RADIUS_MIN - most)) + 1e-6) / 10.0)

    share = _least(lambda f: dataclasses.replace(poles, radius=np.minimum(poles.radius, radius(f))), k)
    return None if share is None else radius(share)


def _least(course: Callable[[float], Poles], k: int, until: int = 0) -> float | None:
    """Return nearly the least share in 0..1 for which `course(share)` can be passed around gate `k`, or None.

    The gates near `k` are tried first; what works for them is then tried with all gates, with a little more if it must,
    for which gates from `until` on may still be at fault.
    """
    near = _around(k)
    if not _passable(course(1.0).part(near)):
        return None
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if _passable(course(middle).part(near)) else (middle, high)
    for more in (0.0, 0.02, 0.05, 0.1, 0.2, 0.4):
        if high + more <= 1.0 and _passable(course(high + more), max(near.stop, until)):
            return high + more
    return None


def _passable(poles: Poles, until: int | None = None) -> bool:
    """Return whether the line past these poles has no fault before gate `until`."""
    line = _line_past(poles)
    fault = _unfit(poles, line) if np.isfinite(poles.radius).any() else (_first_fault(poles, line) or (None,))[0]
    return fault is None or (until is not None and fault >= until)


def _lowered(share: float) -> float:
    return float(np.ceil(300.0 * share)) / 10.0


def _straight_place(poles: Poles, k: int) -> float:
    """Return where pole `k` would stand [m left] if the line hardly turned at it."""
    apex = poles.left - poles.side * poles.distance
    others = np.delete(np.arange(len(poles)), k)
    chord = float(np.interp(poles.down[k], poles.down[others], apex[others])) if len(others) else float(apex[k])
    room = 0.3 if 0 < k < len(poles) - 1 else 1.5
    return chord + float(poles.side[k]) * (float(poles.distance[k]) - room)


def _rounded(begin: float, end: float, share: float) -> float:
    """Return the place at `share` of the way, in tenths, rounded towards `end`."""
    place = 10.0 * (begin + share * (end - begin))
    return float(np.ceil(place) if end > begin else np.floor(place)) / 10.0


def _nearest_inside(terrain: Terrain, poles: Poles, k: int) -> tuple[float, float]:
    """Return the nearest place on the known ground, in tenths [m down, m left]."""
    x_low, x_high, y_low, y_high = terrain.extent
    cosine = float(np.cos(terrain.mean_angle))
    low, high = np.ceil(10.0 * x_low / cosine) / 10.0, np.floor(10.0 * x_high / cosine) / 10.0
    right, left = np.ceil(10.0 * y_low) / 10.0, np.floor(10.0 * y_high) / 10.0
    return float(np.clip(poles.down[k], low, high)), float(np.clip(poles.left[k], right, left))


# -- words ---------------------------------------------


def _refused(k: int, problem: str, hint: str) -> SpecError:
    return SpecError(f"gate {k + 1}", problem=problem, hint=hint)


def _there(poles: Poles, k: int) -> str:
    return f" (x = {poles.down[k]:.1f}, y = {poles.left[k]:.1f})"


def _misplaced(poles: Poles, k: int) -> str:
    below = float(poles.down[k] - poles.down[k - 1])
    aside = abs(float(poles.left[k] - poles.left[k - 1]))
    if abs(below) < _SAME_PLACE and aside < _SAME_PLACE:
        return f"is in the place of gate {k}"
    if below < -_SAME_PLACE:
        return f"is {-below:.1f} m uphill of gate {k}{_there(poles, k)}"
    return f"is beside gate {k}, only {max(below, 0.0):.1f} m below it"


def _below(spec: RunSpec, poles: Poles, k: int) -> str:
    if spec.course.gate_setting != "list":
        return f"use a course.gate_spacing of at least {CLOSEST / 0.75:.1f} m or less course.gate_variation"
    lowest = poles.down[k - 1] + CLOSEST
    return f"gates are passed in the order they are written: x of at least {np.ceil(10.0 * lowest) / 10.0:.1f} could do"
