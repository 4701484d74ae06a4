"""Four figures on one turning body: how its motion becomes poses of a person and gear [VP93 sec. 7]."""

from .channels import figure_channels
from .model import FigureModel, build_figure
from .poses import figure_poses, poses_at

__all__ = ["FigureModel", "build_figure", "figure_channels", "figure_poses", "poses_at"]
