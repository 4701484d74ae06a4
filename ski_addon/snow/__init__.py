"""Ski-snow contact: penetration, shear, friction and the points where they act."""

from .contact import contact_points, edge_bearing, edge_bearings, edge_lift, lift_slope
from .model import Snow, penetration_depth

__all__ = ["Snow", "contact_points", "edge_bearing", "edge_bearings", "edge_lift", "lift_slope", "penetration_depth"]
