"""Path following: the best ride along a drawn path past obstacles, planned ahead stage by stage [VP93 sec. 6]."""

from __future__ import annotations

from .desired_path import DesiredPath, hermite_path, polyline_path
from .follower import Followed, between_samples, follow, follow_to_the_end, plain
from .lane import Lane, lane_on_flat, lane_with
from .obstacles import DISC, LINE, POLYGON, Obstacle, Obstacles
from .plain_search import plain_plan
from .problem import Plan, Problem
from .search import best_plan
from .settings import SearchSettings
from .stepping import Bodies, body_on

__all__ = [
    "DISC",
    "LINE",
    "POLYGON",
    "Bodies",
    "DesiredPath",
    "Followed",
    "Lane",
    "Obstacle",
    "Obstacles",
    "Plan",
    "Problem",
    "SearchSettings",
    "best_plan",
    "between_samples",
    "body_on",
    "follow",
    "follow_to_the_end",
    "hermite_path",
    "lane_on_flat",
    "lane_with",
    "plain",
    "plain_plan",
    "polyline_path",
]
