"""Whole-body control: tasks, the quadratic program and its solver [SG19 sec. 6]."""

from .baselines import FreeSkis, gains_of
from .controller import Command, Controller
from .dynamics import Dynamics
from .effort import Effort, Solution
from .formulation import Formulation, Problem
from .gains import Gains, TaskGain
from .program import Program
from .small_program import SmallProgram
from .solver import OsqpSolver
from .tasks import TaskSet, progress_rate, rotation_error

__all__ = [
    "Command",
    "Controller",
    "Dynamics",
    "Effort",
    "Formulation",
    "FreeSkis",
    "Gains",
    "OsqpSolver",
    "Problem",
    "Program",
    "SmallProgram",
    "Solution",
    "TaskGain",
    "TaskSet",
    "gains_of",
    "progress_rate",
    "rotation_error",
]
