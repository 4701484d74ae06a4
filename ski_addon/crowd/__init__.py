"""Many skiers: runs drawn from one or a few, started so that they stay apart, and simulated in parallel processes."""

from .crowd_spec import SECTIONS, CrowdSpec, MemberRun, field_table, is_crowd_key, section_fields
from .documents import find_crowd, read_crowd, write_crowd
from .sections import SpreadSpec, StartSpec

__all__ = [
    "SECTIONS",
    "CrowdSpec",
    "MemberRun",
    "SpreadSpec",
    "StartSpec",
    "field_table",
    "find_crowd",
    "is_crowd_key",
    "read_crowd",
    "section_fields",
    "write_crowd",
]
