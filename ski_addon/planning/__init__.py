"""Motion planning: speed, inclination, centre of mass and pose along a track."""

from .comparison import BY_CLOCK, as_planned
from .plan import MotionPlan, plan_motion
from .reference import Reference
from .stance import Stance, build_stance

__all__ = ["BY_CLOCK", "MotionPlan", "Reference", "Stance", "as_planned", "build_stance", "plan_motion"]
