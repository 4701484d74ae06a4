"""Plan: can this track be skied, and how."""

from __future__ import annotations

import bpy

from ..ski_addon.blender.properties import read_spec, tell
from ..ski_addon.blender.words import plan_lines
from ..ski_addon.errors import PlanInfeasible
from .failing import Failed, reported


class SKI_OT_plan(bpy.types.Operator):
    """Plan the run: whether the track can be skied, how fast and with how much lean."""

    bl_idname = "ski.plan"
    bl_label = "Plan"
    bl_options = {"REGISTER"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Plan and keep what the plan says."""
        settings = context.scene.ski
        try:
            with reported(self):
                from ..ski_addon.pipeline import make_plan

                spec = read_spec(settings)
                try:
                    plan = make_plan(spec).plan
                except PlanInfeasible as infeasible:
                    tell(settings, "plan", spec, [str(infeasible)], failed=True)
                    raise
        except Failed:
            return {"CANCELLED"}
        lines = plan_lines(plan)
        tell(settings, "plan", spec, lines)
        self.report({"INFO"}, lines[0])
        return {"FINISHED"}
