"""The smoothest line past a row of poles: least change of curvature, passing each pole at an asked distance.

[SG19 sec. 4.5] draws an arc at each gate and joins the arcs by cubic Hermite links, whose curvature jumps where they
meet. Here the whole line is one spline. Over the distance x down the slope, S = sin(heading) has

    S' = curvature,        y' = S / sqrt(1 - S^2),

so S is a cubic B-spline, curvature is its slope, and the line with the least integral of (d curvature / ds)^2 past
all poles is a few banded linear problems away. A turn with an asked radius has its tightest place at the pole: there
curvature must fall to both sides, which makes arcs of large radii and straight runs between tight turns.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .quadratic import solve_quadratic

STEEPEST = np.sin(np.deg2rad(78.0))
"""A line never turns farther from the fall line than the angle of this sine."""
_KNOT_SPACING, _KNOTS_PER_RADIUS = 0.8, 7.0
_FEWEST_CELLS, _MOST_CELLS = 10, 60
_ROUNDS, _PATIENCE = 80, 12
_STIFF, _SOFT = 1e5, 1e-6
"""Weight of an asked radius, and how far curvature may rise where it must fall, in units of what smoothness weighs."""
_FADE = (1.0 / 6.0, 0.5)
"""Over what way curvature fades beside a turn of asked radius: share of the distance between poles, of the radius."""
_HAIR = 1e-6
Sine = Callable[[np.ndarray], np.ndarray]
"""sin(heading) over the distance down the slope [m]."""


@dataclass(frozen=True)
class Poles:
    """Poles to pass: `down`, `left` (n,) [m]; `side` (n,) +1 passed turning left, with the pole to the left, or -1;
    `distance` (n,) [m] from pole to line; `radius` (n,) [m] of the turn, NaN where it is free.
    """

    down: np.ndarray
    left: np.ndarray
    side: np.ndarray
    distance: np.ndarray
    radius: np.ndarray

    def __len__(self) -> int:
        return len(self.down)

    @property
    def ends(self) -> tuple[float, float]:
        """Where the line starts and ends [m left]: half-way between the first two and the last two turns."""
        apex = self.left - self.side * self.distance
        return (float(np.mean(apex[:2])), float(np.mean(apex[-2:]))) if len(self) > 1 else (float(self.left[0]),) * 2

    def part(self, which: slice) -> Poles:
        """Return some of the poles."""
        return Poles(*(value[which] for value in vars(self).values()))


@dataclass(frozen=True)
class FairLine:
    """A line from `begin` to `end` [m down]: `sine`, the spline of sin(heading), and `start_left` [m].

    `apex` (n,) [m down] are the places nearest to the poles; `settled` is False where no such line was found.
    """

    begin: float
    end: float
    sine: Any
    start_left: float
    apex: np.ndarray
    settled: bool

    def sines(self, down: np.ndarray, order: int = 0) -> np.ndarray:
        """Return sin(heading) at `down` [m], or its derivatives: order 1 is the curvature [1/m]."""
        return self.sine(down, order)

    @property
    def steepest(self) -> float:
        """Largest sine of the heading; from 1 on there is no such line."""
        return float(np.max(np.abs(self.sines(np.linspace(self.begin, self.end, 4 * len(self.sine.t))))))

    def sampled(self, spacing: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return `down`, `left` [m] and `curvature` [1/m], each (n,), about `spacing` [m] of arc length apart."""
        coarse = np.linspace(self.begin, self.end, int(np.ceil((self.end - self.begin) / spacing)) * 2 + 1)
        stretch = 1.0 / np.sqrt(1.0 - self.sines(coarse) ** 2)
        arc = np.concatenate(([0.0], np.cumsum(0.5 * (stretch[1:] + stretch[:-1]) * np.diff(coarse))))
        down = np.interp(np.linspace(0.0, arc[-1], int(np.ceil(arc[-1] / spacing)) + 1), arc, coarse)
        return down, self.start_left + self._travel(down), self.sines(down, 1)

    def _travel(self, down: np.ndarray) -> np.ndarray:
        """Return how far the line has gone to the left since the first of `down` (n,) [m]."""
        node, weight = _gauss(5)
        half = 0.5 * np.diff(down)
        at = 0.5 * (down[1:] + down[:-1])[:, None] + half[:, None] * node
        sine = self.sines(at)
        return np.concatenate(([0.0], np.cumsum(half * ((sine / np.sqrt(1.0 - sine**2)) @ weight))))


def fair_line(
    poles: Poles, lead_in: float, lead_out: float, tolerance: float = 1e-7, like: FairLine | None = None
) -> FairLine:
    """Return the smoothest line past `poles`, whose `down` must rise.

    It starts `lead_in` [m] before the first pole and ends `lead_out` [m] after the last, straight down the fall line
    and half-way between turns. `tolerance` says when it has settled, in sines of headings and metres. The line past
    nearly the same poles, `like`, saves work.
    """
    begin, end = float(poles.down[0] - lead_in), float(poles.down[-1] + lead_out)
    gaps = np.diff(np.concatenate(([begin], poles.down, [end])))
    most_shift = 0.45 * np.minimum(gaps[1:], gaps[:-1])
    apex, sine, settled = poles.down.astype(float), None, False
    if like is not None and len(like.apex) == len(poles) and (like.begin, like.end) == (begin, end):
        apex, sine = np.clip(like.apex, poles.down - most_shift, poles.down + most_shift), like.sine
    share, error = np.full(len(poles), 0.7), np.zeros(len(poles))
    for count in range(_ROUNDS):
        problem = _Problem.at(poles, apex, begin, end)
        solved = problem.solve(sine)
        shift = poles.distance * poles.side * np.clip(solved(apex), -STEEPEST, STEEPEST)
        moved = poles.down + np.clip(shift, -most_shift, most_shift)
        largest = np.max(np.abs(solved(problem.points)))
        if sine is not None:
            change = np.max(np.abs(solved(problem.points) - sine(problem.points)))
            settled = bool(max(change, np.max(np.abs(moved - apex))) < tolerance)
        sine = solved
        if settled or (count > _PATIENCE and largest > 1.0):
            break
        share = _secant_share(share, error, moved - apex)
        error = moved - apex
        apex = apex + share * error
    return FairLine(begin, end, sine, poles.ends[0], apex, settled)


def turning_curvature(poles: Poles, line: FairLine, down: np.ndarray) -> np.ndarray:
    """Return the curvature (n,) [1/m] at `down` (n,) [m], without the bends to the first turn and from the last one."""
    curvature = line.sines(down, 1)
    lead_in = (down < line.apex[0]) & (curvature * poles.side[0] < 0.0)
    lead_out = (down > line.apex[-1]) & (curvature * poles.side[-1] < 0.0)
    return np.where(lead_in | lead_out, 0.0, curvature)


def _secant_share(share: np.ndarray, before: np.ndarray, now: np.ndarray) -> np.ndarray:
    """Return what share (n,) of the errors to correct next, from how the errors answered to the last correction."""
    gained = before - now
    with np.errstate(divide="ignore", invalid="ignore"):
        secant = np.clip(share * before / gained, 0.3, 1.2)
    return np.where(np.abs(gained) > 1e-9, secant, share)


@dataclass(frozen=True)
class _Problem:
    """The banded linear problem at given apexes: knots, quadrature `points` with `weights`, `cells` between apexes.

    `value`, `bend`, `rate` are the matrices from coefficients to sin(heading) at the points, to the coefficients of
    curvature, and to the rate of curvature at two places in each cell.
    """

    poles: Poles
    apex: np.ndarray
    knots: np.ndarray
    points: np.ndarray
    weights: np.ndarray

    @classmethod
    def at(cls, poles: Poles, apex: np.ndarray, begin: float, end: float) -> _Problem:
        stops = np.concatenate(([begin], apex, [end]))
        cells = np.clip(np.ceil(np.diff(stops) / _knot_spacing(poles)), _FEWEST_CELLS, _MOST_CELLS).astype(int)
        inner = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(stops, stops[1:], cells, strict=False)]
        breaks = np.concatenate((*inner, [end]))
        node, weight = _gauss(4)
        half = 0.5 * np.diff(breaks)
        points = (breaks[:-1, None] + half[:, None] * (1.0 + node)).ravel()
        knots = np.concatenate(([begin] * 3, breaks, [end] * 3))
        return cls(poles, apex, knots, points, (half[:, None] * weight).ravel())

    def solve(self, previous: Sine | None) -> Sine:
        """Return the next approximation of sin(heading); the first one takes slopes for sines."""
        from scipy.interpolate import BSpline

        bend = _derivative(self.knots, 3)
        cost, pull = self._cost(bend, previous)
        rows, gap = self._passing(previous)
        free = slice(3, -3)  # straight down the fall line, with no jump in the rate of curvature, at both ends
        rising = self._rising(bend)
        solution = solve_quadratic(
            cost[free, free], pull[free], rows[:, free], gap, rising[:, free], _SOFT * self._scale
        )
        spline = BSpline(self.knots, np.concatenate((np.zeros(3), solution, np.zeros(3))), 3)
        if previous is not None:
            return spline
        return lambda down: spline(down) / np.sqrt(1.0 + spline(down) ** 2)

    @property
    def _scale(self) -> float:
        """Usual distance between poles [m]: by it, costs of change and of curvature itself compare."""
        return float(self.knots[-1] - self.knots[0]) / len(self.poles)

    def _cost(self, bend: Any, previous: Sine | None) -> tuple[Any, np.ndarray]:
        """Return the quadratic cost's matrix and right side: changes of curvature, and asked radii."""
        from scipy import sparse
        from scipy.interpolate import BSpline

        knots, count = self.knots, len(self.knots) - 4
        breaks = knots[3:-3]
        half = 0.5 * np.diff(breaks)
        places = (breaks[:-1, None] + half[:, None] * (1.0 + np.array([-1.0, 1.0]) / np.sqrt(3.0))).ravel()
        rate = BSpline.design_matrix(places, knots[2:-2], 1) @ _derivative(knots[1:-1], 2) @ bend
        cosine = np.ones_like(places) if previous is None else np.sqrt(1.0 - _limited(previous(places)) ** 2)
        cost = rate.T @ sparse.diags(np.repeat(half, 2) * cosine) @ rate
        pull = np.zeros(count)
        asked = np.flatnonzero(np.isfinite(self.poles.radius))
        if len(asked):
            stiff = _STIFF / self._scale
            at = BSpline.design_matrix(self.apex[asked], knots[1:-1], 2) @ bend
            pull = stiff * (at.T @ (self.poles.side[asked] / self.poles.radius[asked]))
            cost = cost + stiff * (at.T @ at)
            bends = BSpline.design_matrix(places, knots[1:-1], 2) @ bend
            cost = cost + bends.T @ sparse.diags(self._tension(places) * np.repeat(half, 2) / cosine) @ bends
        return cost.tocsr(), pull

    def _tension(self, places: np.ndarray) -> np.ndarray:
        """Return the weight of curvature itself [1/m^2] at `places`: only around poles with an asked radius.

        Without it a line past tight turns gains by turning longer than it must, and swings from side to side.
        """
        nearest = np.searchsorted(0.5 * (self.apex[1:] + self.apex[:-1]), places)
        fade = np.minimum(self._scale * _FADE[0], self.poles.radius * _FADE[1])
        return np.nan_to_num(fade[nearest] ** -2.0, nan=0.0)

    def _rising(self, bend: Any) -> Any:
        """Return the rows (k, count) of steps of curvature on leaving an asked turn; none of them may be positive."""
        from scipy import sparse

        between = self.knots[4:-4]  # a step is that from one stretch between knots to the next
        every = np.concatenate((self.knots[:1], self.apex, self.knots[-1:]))
        stops = 0.5 * (every[1:] + every[:-1])
        pole = np.clip(np.searchsorted(stops, between) - 1, 0, len(self.poles) - 1)
        beyond = between - self.apex[pole]
        sign = np.where(np.abs(beyond) > _HAIR, np.sign(beyond) * self.poles.side[pole], 0.0)
        sign[np.isnan(self.poles.radius[pole]) | (between < stops[0]) | (between > stops[-1])] = 0.0
        inside = (bend[1:] - bend[:-1])[1:-1]
        return (sparse.diags(sign) @ inside).tocsr()[sign != 0.0]

    def _passing(self, previous: Sine | None) -> tuple[Any, np.ndarray]:
        """Return rows (n + 1, count), values (n + 1,): how far left the line goes from apex to apex and at the ends."""
        from scipy import sparse
        from scipy.interpolate import BSpline

        poles = self.poles
        old = np.zeros_like(self.points) if previous is None else _limited(previous(self.points))
        at_apex = np.zeros_like(self.apex) if previous is None else _limited(previous(self.apex))
        cosine = np.sqrt(1.0 - old**2)
        slope, gain = old / cosine, cosine**-3.0
        section = np.searchsorted(self.apex, self.points)
        shape = (len(poles) + 1, len(self.points))
        pick = sparse.csr_matrix((self.weights, (section, np.arange(len(self.points)))), shape=shape)
        rows = pick @ sparse.diags(gain) @ BSpline.design_matrix(self.points, self.knots, 3)
        begin, end = poles.ends
        left = np.concatenate(([begin], poles.left - poles.side * poles.distance * np.sqrt(1.0 - at_apex**2), [end]))
        return rows.tocsr(), np.diff(left) - pick @ (slope - gain * old)


@functools.cache
def _gauss(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the nodes and weights of Gauss and Legendre."""
    return np.polynomial.legendre.leggauss(count)


def _knot_spacing(poles: Poles) -> float:
    """Return the distance between knots [m]: smaller where tight turns are asked for."""
    asked = poles.radius[np.isfinite(poles.radius)]
    return min(_KNOT_SPACING, float(asked.min()) / _KNOTS_PER_RADIUS) if len(asked) else _KNOT_SPACING


def _limited(sine: np.ndarray) -> np.ndarray:
    return np.clip(sine, -STEEPEST, STEEPEST)


def _derivative(knots: np.ndarray, degree: int) -> Any:
    """Return the sparse matrix from a B-spline's coefficients to those of its derivative."""
    from scipy import sparse

    count = len(knots) - degree - 1
    scale = degree / (knots[degree + 1 : degree + count] - knots[1:count])
    return sparse.diags([-scale, scale], [0, 1], shape=(count - 1, count), format="csr")
