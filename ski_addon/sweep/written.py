"""Keys that vary and their values, as `--vary KEY=VALUE,VALUE,...` writes them for `sweep` and for `submit`."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from ..errors import SpecError
from ..spec.fields import TEXT, WHOLE, FieldInfo

_RANGE = re.compile(r"(-?[0-9]{1,9})-(-?[0-9]{1,9})")
_HINT = "write for instance --vary course.turn_radius=10,15,20"


def read_written(
    written: Sequence[str], find_key: Callable[[str], FieldInfo], most: int
) -> dict[str, tuple[FieldInfo, list[str]]]:
    """Return each key's field and the texts of its values, in the order they were written.

    Values that hold commas are parted by semicolons. `1-5` stands for the whole numbers from 1 to 5 where the key
    takes whole numbers; `most` bounds how many. Raises `SpecError` naming the key, or the option.
    """
    table: dict[str, tuple[FieldInfo, list[str]]] = {}
    for text in written:
        key, equals, values = text.partition("=")
        key = key.strip()
        if not equals:
            raise SpecError(f"--vary {text}", problem="has no values", hint=_HINT)
        info = find_key(key)
        if key in table:
            raise SpecError(f"--vary {key}", problem="is given twice", hint="name all its values at once")
        parts = [part.strip() for part in values.split(";" if ";" in values else ",")]
        if not all(parts) and info.kind != TEXT:
            raise SpecError(f"--vary {text}", problem="has an empty value", hint=_HINT)
        table[key] = info, [value for part in parts for value in _spread(info, part, most)]
    return table


def _spread(info: FieldInfo, part: str, most: int) -> list[str]:
    span = _RANGE.fullmatch(part)
    if info.kind != WHOLE or not span:
        return [part]
    first, last = int(span[1]), int(span[2])
    if not first <= last < first + most:
        allowed = f"a range of 1..{most} whole numbers"
        raise SpecError(f"--vary {info.key}", part, allowed, "write the lower number first, and fewer")
    return [str(value) for value in range(first, last + 1)]
