"""The run document: one TOML file that says who skis what, on which slope and snow, and how it is baked.

`RunSpec` is the document as frozen dataclasses; `field_table` is the one table of its keys (unit, range, meaning).
"""

from __future__ import annotations

from .estimate import Estimate, estimate
from .fields import FieldInfo
from .figure_section import FigureSpec
from .output_sections import BakeSpec, SimulationSpec
from .presets import PART_KINDS, PRESET_KINDS, Preset, find_document, find_ground, list_presets, preset_folder
from .row_values import find_key
from .rows import GateSpec, ObstacleSpec, PointSpec, PushSpec, RhythmSpec
from .run_spec import SCHEMA_VERSION, RunSpec
from .sections import CourseSpec, SkierSpec, SlopeSpec, SnowSpec, TechniqueSpec
from .table import SECTIONS, field_table, find_field, row_kinds, section_fields

__all__ = [
    "PART_KINDS",
    "PRESET_KINDS",
    "SCHEMA_VERSION",
    "SECTIONS",
    "BakeSpec",
    "CourseSpec",
    "Estimate",
    "FieldInfo",
    "FigureSpec",
    "GateSpec",
    "ObstacleSpec",
    "PointSpec",
    "Preset",
    "PushSpec",
    "RhythmSpec",
    "RunSpec",
    "SimulationSpec",
    "SkierSpec",
    "SlopeSpec",
    "SnowSpec",
    "TechniqueSpec",
    "estimate",
    "field_table",
    "find_field",
    "find_document",
    "find_key",
    "find_ground",
    "list_presets",
    "preset_folder",
    "row_kinds",
    "section_fields",
]
