"""The table of all keys of a run document, and moving between nested tables and dotted keys."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from ..errors import SpecError
from .fields import ROWS, FieldInfo, field_infos
from .figure_section import FigureSpec
from .output_sections import BakeSpec, SimulationSpec
from .sections import CourseSpec, SkierSpec, SlopeSpec, SnowSpec, TechniqueSpec

SECTIONS: Mapping[str, type] = MappingProxyType(
    {
        "skier": SkierSpec,
        "slope": SlopeSpec,
        "course": CourseSpec,
        "technique": TechniqueSpec,
        "figure": FigureSpec,
        "snow": SnowSpec,
        "simulation": SimulationSpec,
        "bake": BakeSpec,
    }
)
"""Section name -> its dataclass, in document order."""


@functools.cache
def field_table() -> Mapping[str, FieldInfo]:
    """Return every key of a run document, in document order, with its `FieldInfo`; the keys of rows come last."""
    from .run_spec import RunSpec  # the table describes RunSpec and RunSpec uses the table

    own = field_infos("", RunSpec)
    infos = [info for info in own if info.kind != ROWS]
    for section, cls in SECTIONS.items():
        infos += field_infos(f"{section}.", cls)
    infos += [info for info in own if info.kind == ROWS]
    return MappingProxyType({info.key: info for info in infos})


def section_fields(section: str) -> tuple[FieldInfo, ...]:
    """Return the fields of one section ("" for the keys of the document itself), or of one row ("gate")."""
    if section in row_kinds():
        return row_kinds()[section].row_fields
    return tuple(info for info in field_table().values() if info.section == section)


@functools.cache
def row_kinds() -> Mapping[str, FieldInfo]:
    """Return the keys whose values are rows ("gate"), with their `FieldInfo`."""
    return MappingProxyType({key: info for key, info in field_table().items() if info.kind == ROWS})


def find_field(key: str) -> FieldInfo:
    """Return the field of a dotted key; an unknown one raises `SpecError` with the nearest valid key."""
    info = field_table().get(key)
    if info is not None:
        return info
    if key in SECTIONS:
        example = section_fields(key)[0].key
        raise SpecError(key, problem="is a section, not a key", hint=f"name one of its keys, for instance {example}")
    raise SpecError(key, problem="is not a key of a run", hint=f"did you mean {nearest_key(key)}?")


def nearest_key(key: str) -> str:
    """Return the valid dotted key most like `key`; the same name in another section comes first."""
    import difflib

    key = key[:100]  # comparing takes time in proportion to the square of the length
    section, _, name = key.rpartition(".")

    def likeness(info: FieldInfo) -> float:
        by_key = difflib.SequenceMatcher(None, key, info.key).ratio()
        by_name = difflib.SequenceMatcher(None, name, info.name).ratio()
        return by_key + 2 * by_name + (1 if name == info.name else 0) + (0.5 if section == info.section else 0)

    return max(field_table().values(), key=likeness).key


def _nearest_table(key: str) -> str:
    """Return the section or kind of rows most like `key`, as its header is written."""
    import difflib

    nearest = difflib.get_close_matches(key[:100], (*SECTIONS, *row_kinds()), n=1, cutoff=0.0)[0]
    return f"[[{nearest}]]" if nearest in row_kinds() else f"[{nearest}]"


def flattened(content: Mapping[str, Any]) -> dict[str, Any]:
    """Return nested tables as dotted keys; unknown keys and sections that are no tables raise `SpecError`."""
    flat: dict[str, Any] = {}
    for key, value in content.items():
        if key in SECTIONS:
            if not isinstance(value, Mapping):
                raise SpecError(key, value, problem="is not a table", hint=f"write its keys under [{key}]")
            flat |= {f"{key}.{name}": inner for name, inner in value.items()}
        elif isinstance(value, Mapping) and key not in field_table():
            raise SpecError(
                f"[{key}]", problem="is not a section of a run", hint=f"did you mean {_nearest_table(key)}?"
            )
        else:
            flat[key] = value
    for key in flat:
        find_field(key)
    return flat


def nested(flat: Mapping[str, Any]) -> dict[str, Any]:
    """Return dotted keys as nested tables."""
    content: dict[str, Any] = {}
    for key, value in flat.items():
        section, _, name = key.rpartition(".")
        (content.setdefault(section, {}) if section else content)[name] = value
    return content


def get_value(spec: object, key: str) -> Any:
    """Return the value of a dotted key of a `RunSpec`."""
    return functools.reduce(getattr, key.split("."), spec)


def check_required(content: Mapping[str, Any]) -> None:
    """Raise `SpecError` for the first required key a run document does not have.

    A key for some kinds of course or ground only is not missed in a document of another kind.
    """
    flat = flattened(content)
    for key, info in field_table().items():
        if info.required and key not in flat and _is_for(info, flat):
            hint = f"write {info.name} under [{info.section}]: {info.doc[0].lower()}{info.doc[1:]} ({info.allowed})"
            raise SpecError(key, problem="is missing", hint=hint)


def _is_for(info: FieldInfo, flat: Mapping[str, Any]) -> bool:
    """Return whether a key matters in a document with these dotted keys."""
    kind = f"{info.section}.kind"
    return not info.kinds or flat.get(kind, field_table()[kind].default) in info.kinds
