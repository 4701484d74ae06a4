"""Which bone follows which body: an immutable table, read from a TOML document."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from ..errors import MissingInputError, SpecError


@dataclass(frozen=True)
class BoneEntry:
    """`bone` turns with `body`; `location` says that it also moves freely (it must then not be a connected bone)."""

    bone: str
    body: str
    location: bool = False


@dataclass(frozen=True)
class BoneMap:
    """Table of bones that follow bodies, in order; bones that are not in it are never touched."""

    name: str
    entries: tuple[BoneEntry, ...]

    @property
    def bones(self) -> tuple[str, ...]:
        """Names of the mapped bones."""
        return tuple(entry.bone for entry in self.entries)

    @classmethod
    def from_document(cls, document: dict[str, object], source: str = "bone map") -> BoneMap:
        """Read a parsed TOML document: `name`, and one `[bones]` key a bone, a body's name or {body, location}."""
        bones = document.get("bones")
        if not isinstance(bones, dict) or not bones:
            raise SpecError(
                "bones", None, "", f'write one line a bone, as in pelvis = "pelvis" ({source})', problem="is missing"
            )
        entries = tuple(_entry(bone, value) for bone, value in bones.items())
        return cls(str(document.get("name", source)), entries)

    @classmethod
    def load(cls, path: str | Path) -> BoneMap:
        """Read a bone map from a TOML file."""
        try:
            document = tomllib.loads(Path(path).read_text(encoding="utf-8"))
        except OSError as error:
            raise MissingInputError(path, error.strerror or "cannot be opened") from error
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise SpecError(str(path), None, "", str(error), problem="is not a TOML document") from error
        return cls.from_document(document, Path(path).name)

    def check(self, bones: Iterable[str], bodies: Iterable[str]) -> None:
        """Raise `SpecError` if the map names a bone that is not in `bones` or a body that is not in `bodies`."""
        known_bones, known_bodies = set(bones), set(bodies)
        for entry in self.entries:
            if entry.bone not in known_bones:
                raise SpecError(
                    f"bones.{entry.bone}",
                    None,
                    "",
                    "choose the armature this map was made for",
                    problem="is not a bone of the armature",
                )
            if entry.body not in known_bodies:
                raise SpecError(
                    f"bones.{entry.bone}", entry.body, ", ".join(sorted(known_bodies)), problem="is not one of"
                )


def _entry(bone: str, value: object) -> BoneEntry:
    if isinstance(value, str):
        return BoneEntry(bone, value)
    if isinstance(value, dict) and isinstance(value.get("body"), str) and set(value) <= {"body", "location"}:
        return BoneEntry(bone, value["body"], bool(value.get("location", False)))
    raise SpecError(f"bones.{bone}", value, "a body's name or {body, location}", problem="is not")
