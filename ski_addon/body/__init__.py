"""The skier's body: anthropometry, equipment, skeleton, MuJoCo model and leg inverse kinematics."""

from .kinematics import centre_of_mass, forward_kinematics
from .model import SkierModel, build_skier_model
from .skeleton import BODY_NAMES, Skeleton, build_skeleton

__all__ = [
    "BODY_NAMES",
    "Skeleton",
    "SkierModel",
    "build_skeleton",
    "build_skier_model",
    "centre_of_mass",
    "forward_kinematics",
]
