"""The key reference in docs/run_spec.md, made from the table of keys: `python -m ski_addon.spec.reference`."""

from __future__ import annotations

from pathlib import Path

from .. import atomic
from .fields import CHOICE, FLAG, PLACES, ROWS, TEXT, FieldInfo, show_number
from .table import SECTIONS, row_kinds, section_fields

HEAD = """\
# The run document

A run is one TOML file: who skis, on which slope and track, how, on what snow, and how the motion is baked. The command
line, the sidebar in Blender and the presets all use this document. `presets/runs` holds whole runs; `presets/courses`,
`presets/skiers`, `presets/snow` and `presets/styles` hold parts, documents of one section (and its rows) that are laid
over a run.

A short one, with all it must have:

```toml
name = "Evening run"

[slope]
angle_deg = 9

[course]
kind = "turns"
turn_count = 6
turn_duration = 1.2
transition_duration = 1.5
turn_radius = 15
```

Keys marked *required* must be in a file; all others have the default shown. A meaning that begins with a word such as
`gates` is that of a key for that `kind` of its section only; it does nothing, and is not required, for the others.
Units are SI; angles are in degrees only in keys ending in `_deg`. Where a word such as `auto` is allowed beside a
number, write it in quotes. A file with an unknown key, a wrong type or a value outside its range is refused with one
line that names the file, the line in it, the key, its value and what is allowed:

```
run.toml line 11: course.turn_radius = 1.0 is outside 3..200 m: give a number in that range
```

Times of a rhythm, gates, points of a path, obstacles and pushes are rows: their keys stand under a header in double
brackets, which is written again for each of them, in order, at the end of the file. Messages count them from 1
(`gate 3: radius = 1 is outside ...`).

```toml
[[push]]
body = "abdomen"
direction = "left"
force = 100
start = 4.5
```

On the command line single keys are changed with `--set`, where words need no quotes
(`--set course.turn_radius=18 --set technique.angulation=auto`, and `--set gate.2.radius=12` for the second gate), and
parts are laid over a run with `--part`. Rows of a part take the place of all the run's rows of that kind.

This page is made from the tables of keys in `ski_addon/spec/` by
`python -m ski_addon.spec.reference`.
"""


def key_reference() -> str:
    """Return the reference page of all keys as Markdown."""
    sections = [key_table(f"[{name}]", section_fields(name), cls.__doc__ or "") for name, cls in SECTIONS.items()]
    rows = [key_table(f"[[{key}]]", info.row_fields, info.row.__doc__ or "") for key, info in row_kinds().items()]
    return "\n".join((HEAD, key_table("Document", section_fields("")), *sections, *rows))


def write_reference(path: Path | None = None) -> Path:
    """Write the reference page (docs/run_spec.md if no path is given) and return where."""
    path = path or Path(__file__).resolve().parent.parent.parent / "docs" / "run_spec.md"
    atomic.write_text(path, key_reference())
    return path


def key_table(title: str, infos: tuple[FieldInfo, ...], text: str = "") -> str:
    """Return one section of a reference page: its title, `text`, and a row of Markdown for each of `infos`."""
    rows = (f"| `{info.name}` | {_default(info)} | {_allowed(info)} | {_meaning(info)} |" for info in infos)
    head = (f"## {title}", text, "", "| key | default | allowed | meaning |", "|---|---|---|---|")
    return "\n".join((*head, *rows)).replace("\n\n\n", "\n\n") + "\n"


def _default(info: FieldInfo) -> str:
    if info.required:
        return "*required*"
    if info.kind in (PLACES, ROWS):
        return "none"
    if isinstance(info.default, str):
        return f'`"{info.default}"`'
    return f"`{str(info.default).lower()}`" if info.kind == FLAG else f"`{show_number(info.default)}`"


def _allowed(info: FieldInfo) -> str:
    if info.kind == CHOICE:
        return ", ".join(f'`"{word}"`' for word in info.choices)
    if info.kind in (FLAG, TEXT, PLACES, ROWS) or not info.word:
        return info.allowed
    return info.allowed.replace(f"or {info.word}", f'or `"{info.word}"`')


def _meaning(info: FieldInfo) -> str:
    doc = f"{info.doc} (advanced)" if info.advanced else info.doc
    return f"{', '.join(f'`{kind}`' for kind in info.kinds)}: {doc}" if info.kinds else doc


if __name__ == "__main__":
    write_reference()
