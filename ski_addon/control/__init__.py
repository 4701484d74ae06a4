"""Whole-body control: tasks, the quadratic program and its solver [SG19 sec. 6]."""

from .baselines import FreeSkis, gains_of
from .controller import Command, Controller
from .dynamics import Dynamics
from .formulation import Formulation, Problem
from .gains import Gains, TaskGain
from .solver import OsqpSolver, Solution
from .tasks import TaskSet, progress_rate, rotation_error

__all__ = [
    "Command",
    "Controller",
    "Dynamics",
    "Formulation",
    "FreeSkis",
    "Gains",
    "OsqpSolver",
    "Problem",
    "Solution",
    "TaskGain",
    "TaskSet",
    "gains_of",
    "progress_rate",
    "rotation_error",
]
