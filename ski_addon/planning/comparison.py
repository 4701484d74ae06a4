"""What other systems and the 2019 paper as printed would plan, to compare with: `technique.controller`, `equations`."""

from __future__ import annotations

from dataclasses import replace

from ..spec import RunSpec

RIGID_LEAN = ("rigid_lean", "paper")
"""Values of `technique.equations` whose centre of mass is that of SG19 Eq. 14."""
FRICTIONLESS = ("frictionless", "paper")
"""Values of `technique.equations` whose plan knows neither friction nor drag [SG19 sec. 4.1]; the snow still does."""
BY_CLOCK = ("clock", "paper")
"""Values of `technique.equations` whose reference runs by the clock, whether the skier keeps up or not."""


def as_planned(spec: RunSpec) -> RunSpec:
    """Return the run document that the plan is made from; the simulation keeps to `spec`.

    They differ only for comparisons. A planner without friction believes in snow that has none. A skier of inclination
    alone, as in Oberegger's seven bodies on a prescribed track, neither angulates nor absorbs, and no leg bends to keep
    a load.
    """
    if spec.technique.equations in FRICTIONLESS:
        snow = replace(spec.snow, friction=0.0, friction_per_speed=0.0)
        spec = replace(spec, snow=snow, skier=replace(spec.skier, drag_area=0.0))
    if spec.technique.controller == "inclination_only":
        spec = replace(spec, technique=replace(spec.technique, angulation=0.0, absorption=0.0, load_min=0.0))
    return spec
