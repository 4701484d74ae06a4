"""Plan: can this track be skied, and how."""

from __future__ import annotations

import bpy

from ..ski_addon.blender.properties import read_spec, tell
from ..ski_addon.blender.shown import required_skier
from ..ski_addon.blender.words import plan_lines
from ..ski_addon.errors import SkiAddonError
from .failing import Failed, reported


class SKI_OT_plan(bpy.types.Operator):
    """Plan the run: whether the track can be skied, how fast and with how much lean."""

    bl_idname = "ski.plan"
    bl_label = "Plan"
    bl_options = {"REGISTER"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Plan and keep what the plan says."""
        try:
            with reported(self):
                from ..ski_addon.blender.slope_taking import check_on_mesh
                from ..ski_addon.pipeline import make_plan

                context.view_layer.update()  # gates and curves may have been moved a moment ago
                settings = required_skier(context).ski
                spec = read_spec(settings)
                try:
                    planned = make_plan(spec)
                    check_on_mesh(settings, planned.track)
                    plan = planned.plan
                except SkiAddonError as infeasible:
                    tell(settings, "plan", spec, [str(infeasible)], failed=True)
                    raise
        except Failed:
            return {"CANCELLED"}
        lines = plan_lines(plan)
        tell(settings, "plan", spec, lines)
        self.report({"INFO"}, lines[0])
        return {"FINISHED"}


CLASSES = (SKI_OT_plan,)
