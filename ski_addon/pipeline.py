"""The one flow, from a run document to a recording: each arrow of the design as one call."""

from __future__ import annotations

from dataclasses import dataclass

from .body import SkierModel, build_skier_model
from .course import Track, build_track
from .planning import MotionPlan, as_planned, plan_motion
from .simulation import Checkpoints, Progress, Recording, Simulation, check_pushes, resume, simulate
from .spec import RunSpec
from .terrain import Terrain, build_terrain


@dataclass(frozen=True)
class Planned:
    """Everything that is known before the physics runs."""

    spec: RunSpec
    terrain: Terrain
    track: Track
    model: SkierModel
    plan: MotionPlan


def make_plan(spec: RunSpec) -> Planned:
    """Validate `spec` and plan its run.

    Raises `SpecError` for a bad document or a figure that is no alpine skier, and `PlanInfeasible` for a track that
    cannot be skied.
    """
    spec.validate().check_physics()
    terrain = build_terrain(spec.slope)
    believed = as_planned(spec)
    track = build_track(believed, terrain)
    model = build_skier_model(spec.skier)
    plan = plan_motion(believed, track, model)
    check_pushes(spec, plan.duration)
    return Planned(spec, terrain, track, model, plan)


def start_simulation(planned: Planned) -> Simulation:
    """Return the simulation of a plan at its first step, to be advanced by the caller."""
    return Simulation(planned.spec, planned.plan, planned.model, planned.terrain)


def resume_simulation(planned: Planned, recording: Recording, time: float) -> Simulation:
    """Return the simulation of a plan that goes on from `recording` at `time` [s]; raises `SpecError`."""
    simulation = start_simulation(planned)
    resume(simulation, recording, time)
    return simulation


def run_simulation(
    planned: Planned, progress: Progress | None = None, checkpoints: Checkpoints | None = None
) -> tuple[Recording, list[float]]:
    """Simulate a plan to its end; return the recording and each step's wall time [s]. See `simulation.simulate`."""
    return simulate(planned.spec, planned.plan, planned.model, planned.terrain, progress, checkpoints)
