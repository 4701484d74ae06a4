"""Motion planning: speed, inclination, centre of mass and pose along a track."""

from .plan import MotionPlan, plan_motion
from .reference import Reference
from .stance import Stance, build_stance

__all__ = ["MotionPlan", "Reference", "Stance", "build_stance", "plan_motion"]
