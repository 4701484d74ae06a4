"""`RunSpec`: the whole request for one run, as data."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import Any

from ..errors import SpecError
from . import document, row_values, table, values
from .fields import ROWS, rows, text
from .figure_section import FigureSpec
from .output_sections import BakeSpec, SimulationSpec
from .presets import ground_beside
from .records import record
from .rows import GateSpec, ObstacleSpec, PointSpec, PushSpec, RhythmSpec
from .sections import CourseSpec, SkierSpec, SlopeSpec, SnowSpec, TechniqueSpec

SCHEMA_VERSION = 1
"""Version of the run document; part of the content hash."""


@record(frozen=True)
class RunSpec:
    """One run: skier, slope, course, technique, figure, snow, simulation, bake, and rows of gates, points and others.

    The same document serves the sidebar, a preset, the command line and the farm. `from_toml`, `from_dict` and
    `with_overrides` return checked specs; call `validate` on one built from the section classes by hand.
    """

    name: str = text("Untitled run", 120, "Name", "Name of the run, shown in reports")
    description: str = text("", 2000, "Description", "What the run is for")
    skier: SkierSpec = field(default_factory=SkierSpec)
    slope: SlopeSpec = field(default_factory=SlopeSpec)
    course: CourseSpec = field(default_factory=CourseSpec)
    technique: TechniqueSpec = field(default_factory=TechniqueSpec)
    figure: FigureSpec = field(default_factory=FigureSpec)
    snow: SnowSpec = field(default_factory=SnowSpec)
    simulation: SimulationSpec = field(default_factory=SimulationSpec)
    bake: BakeSpec = field(default_factory=BakeSpec)
    rhythm: tuple[RhythmSpec, ...] = rows(RhythmSpec, 500, "Rhythm", "What a rhythm is like, time by time")
    gate: tuple[GateSpec, ...] = rows(GateSpec, 500, "Gates", "Gates of a gate course, in the order they are passed")
    point: tuple[PointSpec, ...] = rows(PointSpec, 5000, "Points", "Corners of a drawn path, in the order they are met")
    obstacle: tuple[ObstacleSpec, ...] = rows(ObstacleSpec, 500, "Obstacles", "What a course of kind follow goes round")
    push: tuple[PushSpec, ...] = rows(PushSpec, 100, "Pushes", "Forces from outside that the skier does not know of")

    @classmethod
    def from_toml(cls, path: str | Path) -> RunSpec:
        """Read a run document; its required keys must be there, the others have defaults.

        A relative `slope.grid_file` is one beside the document; the spec has its whole path.
        Raises `MissingInputError` if the file cannot be read and `SpecError` (naming file and line) if it is wrong.
        """
        return cls.from_text(document.read_text(Path(path)), str(path))._with_ground_beside(Path(path).parent)

    @classmethod
    def from_text(cls, written: str, source: str = "the run document") -> RunSpec:
        """Read a whole run document from TOML text (the header of a recording has one); `source` names it in errors."""
        parsed = document.parse_document(written, source)
        with parsed.errors_named():
            table.check_required(parsed.content)
            return cls.from_dict(parsed.content)

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> RunSpec:
        """Build a spec from nested tables `{"course": {"turn_count": 6}}`; what is not given keeps its default."""
        return cls()._merged(content)

    def to_dict(self) -> dict[str, Any]:
        """Return the spec as nested plain tables in canonical order, numbers as float or int by their field.

        Rows are lists of tables; where there are none, their key is left out.
        """
        flat = {key: values.canonical(info, table.get_value(self, key)) for key, info in table.field_table().items()}
        for key in table.row_kinds():
            flat[key] = row_values.plain_rows(flat[key])
            if not flat[key]:
                del flat[key]
        return table.nested(flat)

    def to_toml(self) -> str:
        """Return the canonical TOML document: every key, in the order of the reference, then the rows."""
        return document.write_document(self.to_dict())

    def with_overrides(self, overrides: Mapping[str, Any]) -> RunSpec:
        """Return a copy with dotted keys replaced, as `--set course.turn_radius=10` does.

        Strings are read as TOML values; words need no quotes. Other values are taken as they are. `gate.2.radius` is
        the radius of the second gate, which must be there; `gate` stands for all gates. A relative
        `slope.grid_file` is one in the present folder.
        """
        places = {key: row_values.find_place(key) for key in overrides}
        flat = {
            key: values.parse_text(table.find_field(key), value)
            for key, value in overrides.items()
            if places[key] is None
        }
        changed = self._merged(table.nested(flat))
        changed = changed._with_ground_beside(Path()) if "slope.grid_file" in flat else changed
        inner = {place: values.parse_text(place.field, overrides[key]) for key, place in places.items() if place}
        return changed._merged(row_values.with_places(changed, inner)) if inner else changed

    def with_tables(self, content: Mapping[str, Any]) -> RunSpec:
        """Return a checked copy with nested tables `{"course": {"turn_count": 6}}` laid over this spec."""
        return self._merged(content)

    def with_part(self, path: str | Path) -> RunSpec:
        """Return a copy with the sections of a part document (a skier, a snow, a style) laid over this one.

        The part's own `name` and `description` are not taken over.
        """
        source = document.parse_document(document.read_text(Path(path)), str(path))
        part = {key: value for key, value in source.content.items() if key not in ("name", "description")}
        with source.errors_named():
            changed = self._merged(part)
        return changed._with_ground_beside(Path(path).parent) if "grid_file" in part.get("slope", {}) else changed

    def validate(self) -> RunSpec:
        """Raise `SpecError` if any value has a wrong type or lies outside its range; return the spec itself."""
        for key, info in table.field_table().items():
            values.check(info, table.get_value(self, key), self)
        return self

    def check_physics(self) -> None:
        """Raise `SpecError` if it is a run of a figure that can only be shown by the instant preview."""
        if self.figure.kind != "alpine":
            hint = 'show it with the command preview, or set figure.kind to "alpine"'
            problem = "has no whole physics, which is for alpine skiers"
            raise SpecError("figure.kind", self.figure.kind, hint=hint, problem=problem)

    def content_hash(self) -> str:
        """Return the SHA-256 hex digest of the canonical document and its schema version."""
        canonical = json.dumps([SCHEMA_VERSION, self.to_dict()], sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(canonical.encode()).hexdigest()

    def _with_ground_beside(self, folder: Path) -> RunSpec:
        """Return a copy whose `slope.grid_file`, written in `folder`, can be found from anywhere."""
        path = ground_beside(self.slope.grid_file, folder)
        return self if path == self.slope.grid_file else self._merged({"slope": {"grid_file": path}})

    def _merged(self, content: Mapping[str, Any]) -> RunSpec:
        """Return a checked copy with the given tables laid over this spec."""
        infos = {key: table.find_field(key) for key in table.flattened(content)}
        flat = {
            key: row_values.read_rows(infos[key], value) if infos[key].kind == ROWS else value
            for key, value in table.flattened(content).items()
        }
        _replaced(self, flat).validate()
        return _replaced(self, {key: values.canonical(infos[key], value) for key, value in flat.items()})


def _replaced(spec: RunSpec, flat: Mapping[str, Any]) -> RunSpec:
    """Return a copy with the values of dotted keys; each section is made once."""
    changes = table.nested(flat)
    for section in table.SECTIONS.keys() & changes.keys():
        changes[section] = dataclasses.replace(getattr(spec, section), **changes[section])
    return dataclasses.replace(spec, **changes)
