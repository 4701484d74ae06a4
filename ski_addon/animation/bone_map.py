"""Which bone follows which body: an immutable table, read from a TOML document."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from ..errors import MissingInputError, SpecError

_ENTRY_KEYS = {"body": str, "location": bool, "share": float, "parent": str, "optional": bool}
_DOCUMENT_KEYS = ("name", "root", "bones", "settings")


@dataclass(frozen=True)
class BoneEntry:
    """`bone` turns with `body`; `location` says that it also moves freely (it must then not be a connected bone).

    Only an armature that was not made here uses the rest: `share` (0..1) turns the bone only that part of the way from
    the body's parent to the body, for a spine of many bones; `parent` is the bone that carries it where the armature's
    own parent follows by constraints; an `optional` bone may be missing.
    """

    bone: str
    body: str
    location: bool = False
    share: float = 1.0
    parent: str = ""
    optional: bool = False


@dataclass(frozen=True)
class BoneSetting:
    """A number to key once: the custom property `name` of `bone` gets `value`, as for a switch from IK to FK."""

    bone: str
    name: str
    value: float


@dataclass(frozen=True)
class BoneMap:
    """Table of bones that follow bodies, in order; bones that are not in it are never touched.

    `root` is the bone that may carry the whole figure along ("" for none); `settings` are keyed beside the bones.
    """

    name: str
    entries: tuple[BoneEntry, ...]
    root: str = ""
    settings: tuple[BoneSetting, ...] = field(default=())

    @property
    def bones(self) -> tuple[str, ...]:
        """Names of the mapped bones."""
        return tuple(entry.bone for entry in self.entries)

    @classmethod
    def from_document(cls, document: dict[str, object], source: str = "bone map") -> BoneMap:
        """Read a parsed TOML document.

        It has a `name`, one `[bones]` key a bone with a body's name or a table (see `BoneEntry`), and may have `root`
        and a table `[settings."bone"]` of numbers for each bone with switches. Raises `SpecError` for anything else.
        """
        for key in document:
            if key not in _DOCUMENT_KEYS:
                raise SpecError(key, None, ", ".join(_DOCUMENT_KEYS), source, problem="is not one of")
        for key in ("name", "root"):
            if not isinstance(document.get(key, ""), str):
                raise SpecError(key, document[key], "a name", source, problem="is not")
        bones = document.get("bones")
        if not isinstance(bones, dict) or not bones:
            raise SpecError(
                "bones", None, "", f'write one line a bone, as in pelvis = "pelvis" ({source})', problem="is missing"
            )
        entries = tuple(_entry(bone, value) for bone, value in bones.items())
        return cls(
            str(document.get("name", source)), entries, str(document.get("root", "")), _settings(document, source)
        )

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

    def resolved(self, bones: Iterable[str]) -> tuple[BoneMap, tuple[str, ...]]:
        """Return this map with the names that `bones` really have, and the names of bones that are missing.

        A bone may have a prefix that ends with a colon ("mixamorig:Hips"). Missing bones are left out of the map.
        """
        actual = self.actual_names(bones)
        wanted = [entry.bone for entry in self.entries if not entry.optional]
        wanted += [name for entry in self.entries if entry.parent for name in [entry.parent]]
        wanted += [item.bone for item in self.settings]
        missing = tuple(dict.fromkeys(name for name in wanted if not actual[name]))
        return self.renamed(actual), missing

    def actual_names(self, bones: Iterable[str]) -> dict[str, str]:
        """Return for every bone that this map names the name that `bones` have for it, "" for one that is missing."""
        known = list(bones)
        short = {name.rpartition(":")[2]: name for name in reversed(known)}
        return {name: name if name in known else short.get(name, "") for name in self._all_names()}

    def renamed(self, names: Mapping[str, str]) -> BoneMap:
        """Return this map with other `names` of its bones; those without one are left out."""
        entries = tuple(
            replace(entry, bone=names[entry.bone], parent=names.get(entry.parent, ""))
            for entry in self.entries
            if names.get(entry.bone)
        )
        settings = tuple(replace(item, bone=names[item.bone]) for item in self.settings if names.get(item.bone))
        return BoneMap(self.name, entries, names.get(self.root, ""), settings)

    def to_toml(self) -> str:
        """Return the document that `load` reads."""
        lines = [f"name = {_quoted(self.name)}"]
        lines += [f"root = {_quoted(self.root)}"] if self.root else []
        lines += ["", "[bones]"]
        for entry in self.entries:
            inner = ", ".join(f"{key} = {_written(value)}" for key, value in _plain(entry).items())
            lines.append(f"{_quoted(entry.bone)} = {{ {inner} }}")
        for bone in dict.fromkeys(item.bone for item in self.settings):
            values = [f"{_quoted(item.name)} = {item.value!r}" for item in self.settings if item.bone == bone]
            lines += ["", f"[settings.{_quoted(bone)}]", *values]
        return "\n".join(lines) + "\n"

    def _all_names(self) -> set[str]:
        names = {*self.bones, *(entry.parent for entry in self.entries), *(item.bone for item in self.settings)}
        return (names | {self.root}) - {""}


def _plain(entry: BoneEntry) -> dict[str, object]:
    """Return a bone's table without what goes without saying."""
    usual = BoneEntry(entry.bone, entry.body)
    return {
        key: getattr(entry, key) for key in _ENTRY_KEYS if key == "body" or getattr(entry, key) != getattr(usual, key)
    }


def _written(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return _quoted(value) if isinstance(value, str) else repr(value)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)  # a JSON string is a TOML string


def _entry(bone: str, value: object) -> BoneEntry:
    if isinstance(value, str):
        return BoneEntry(bone, value)
    if not isinstance(value, dict) or "body" not in value or not set(value) <= set(_ENTRY_KEYS):
        raise SpecError(f"bones.{bone}", value, f"a body's name or {{{', '.join(_ENTRY_KEYS)}}}", problem="is not")
    for key, item in value.items():
        kind = _ENTRY_KEYS[key]
        if not (_is_number(item) if kind is float else isinstance(item, kind)):
            words = {str: "a name", bool: "true or false", float: "a number"}[kind]
            raise SpecError(f"bones.{bone}.{key}", item, words, problem="is not")
    if not 0.0 <= value.get("share", 1.0) <= 1.0:
        raise SpecError(f"bones.{bone}.share", value["share"], "0..1", "1 turns the bone as far as its body")
    return BoneEntry(bone, **value)


def _settings(document: dict[str, object], source: str) -> tuple[BoneSetting, ...]:
    tables = document.get("settings", {})
    if not isinstance(tables, dict):
        raise SpecError(
            "settings", tables, 'tables, as in [settings."thigh_parent.L"]', source, problem="is not made of"
        )
    found = []
    for bone, table in tables.items():
        if not isinstance(table, dict):
            raise SpecError(f"settings.{bone}", table, "a table of numbers", source, problem="is not")
        for name, value in table.items():
            if not (_is_number(value) or isinstance(value, bool)):
                raise SpecError(f"settings.{bone}.{name}", value, "a number", source, problem="is not")
            found.append(BoneSetting(bone, name, float(value)))
    return tuple(found)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
