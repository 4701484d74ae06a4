"""Figs. 16 to 18 and Photo 5: paths that are followed past obstacles, from the presets of the same questions."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..course.drawn_points import distinct_points
from ..course.follow_problem import follow_problem
from ..report.style import INK, LEFT, QUIET, RIGHT, TRANSITION
from ..spec import RunSpec, find_document
from ..terrain import build_terrain
from ..turning.following import DISC, POLYGON, Followed, Obstacle, Problem, body_on, follow

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MARGIN, ASIDE = 1.0, 4.5
"""Room [m] left at the ends of a track, and to its sides."""


def draw_trees(figure: Figure) -> None:
    """Draw two tracks through trees, with plans of 10 and of 12 stages, as in Fig. 16."""
    problem = example("tree_skiing")
    axes = figure.subplots()
    draw_scene(axes, problem)
    for stages, colour in ((10, LEFT), (12, RIGHT)):
        followed = ridden(problem, stages)
        cost = f"{followed.cost:.0f} m of distance"
        _draw_track(axes, followed, colour, f"plans of {stages} stages, {cost}")
    axes.set_title("Between trees, with plans of 3 s and of 3.6 s")
    _finish(axes, problem)


def draw_gates(figure: Figure) -> None:
    """Draw turns that are found from a straight path and lines beside it, as in Fig. 17."""
    axes = figure.subplots()
    _draw_one(axes, example("slalom_by_planning"))
    axes.set_title("A straight path past eight lines that end near it: the turns are found")


def draw_corner(figure: Figure) -> None:
    """Draw a bicycle's track round the corner of a street, as in Fig. 18."""
    axes = figure.subplots()
    _draw_one(axes, example("corner"))
    axes.set_title("Round a corner, clear of the kerbs")


def draw_potholes(figure: Figure) -> None:
    """Draw a bicycle's track along a road with potholes, as in Photo 5."""
    axes = figure.subplots()
    _draw_one(axes, example("potholes"))
    axes.set_title("Past potholes, between the edges of the road")


def example(name: str) -> Problem:
    """Return what a preset asks to follow."""
    spec = RunSpec.from_toml(find_document(name))
    return follow_problem(spec, build_terrain(spec.slope), distinct_points(spec)[0])[0]


def ridden(problem: Problem, stages: int) -> Followed:
    """Return how the path of `problem` is followed with plans of so many stages."""
    settings = replace(problem.settings, stages=stages)
    return follow(replace(problem, settings=settings), body_on(problem.lane))


def draw_scene(axes: Any, problem: Problem) -> None:
    """Draw the desired path and the obstacles; what the track keeps clear of for tolerance's sake is pale."""
    path = problem.lane.path
    places = path.places[: path.last + 1]
    axes.plot(*places.T, color=QUIET, lw=1.2, ls=(0, (5, 3)), label="the path asked for")
    for obstacle in problem.obstacles.all:
        _draw_obstacle(axes, obstacle)


def _draw_one(axes: Any, problem: Problem) -> None:
    draw_scene(axes, problem)
    _draw_track(axes, ridden(problem, problem.settings.stages), LEFT, "the track that is ridden")
    _finish(axes, problem)


def _draw_track(axes: Any, followed: Followed, colour: str, label: str) -> None:
    axes.plot(*followed.places.T, color=colour, lw=1.8, label=label)


def _draw_obstacle(axes: Any, obstacle: Obstacle) -> None:
    from matplotlib.patches import Circle, Polygon

    points = np.asarray(obstacle.points, dtype=float).reshape(-1, 2)
    if obstacle.kind == DISC:
        axes.add_patch(Circle(points[0], obstacle.radius + obstacle.tolerance, color=TRANSITION, zorder=0))
        axes.add_patch(Circle(points[0], max(obstacle.radius, 0.08), color=INK))
    elif obstacle.kind == POLYGON:
        axes.add_patch(Polygon(points, closed=True, color=INK))
    else:
        axes.plot(*points.T, color=INK, lw=2.0, solid_capstyle="round")


def _finish(axes: Any, problem: Problem) -> None:
    """Give a picture of a path its range, equal scales and, beneath it, a legend."""
    path = problem.lane.path
    places = path.places[: path.last + 1]
    low, high = places.min(axis=0), places.max(axis=0)
    axes.set_aspect("equal")
    across = high[1] - low[1] > 10.0  # the path ends upward in the picture, and has its sides to the left and right
    axes.set_xlim(low[0] - MARGIN, high[0] + (ASIDE if across else MARGIN))
    axes.set_ylim(low[1] - ASIDE, high[1] + (MARGIN if across else ASIDE))
    axes.set_xlabel("m")
    axes.set_ylabel("m")
    axes.figure.legend(loc="outside lower left", ncols=3)
