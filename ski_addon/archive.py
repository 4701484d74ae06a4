"""Archives of arrays with a header: `.npz` files without pickled objects, whose bytes depend only on their contents.

Every member has a checksum, which reading verifies.
"""

from __future__ import annotations

import json
import math
import struct
import tokenize
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .errors import one_line

DAMAGE = (OSError, ValueError, EOFError, RuntimeError, MemoryError, OverflowError, struct.error, zlib.error)
"""What zipfile and numpy raise on damaged files."""
LARGEST_BYTES = 16 * 2**30
"""An archive that unpacks to more than this is not read."""
_CHUNK = 2**20
_NO_ARRAY = (ValueError, TypeError, EOFError, SyntaxError, tokenize.TokenError, RecursionError, MemoryError)
"""What numpy raises for the header of what is no array: it reads it as a Python literal."""
_EPOCH = (1980, 1, 1, 0, 0, 0)


class ArchiveError(ValueError):
    """An archive that cannot be read; the text says why."""


def write(path: str | Path, header: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> None:
    """Write `arrays` as `np.savez` would, with fixed time stamps, and before them `header` as JSON."""
    document = json.dumps(header, sort_keys=True, ensure_ascii=False).encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as members:
        _write_member(members, "header", np.frombuffer(document, dtype=np.uint8))
        for name, array in arrays.items():
            _write_member(members, name, np.ascontiguousarray(array))


def read(path: str | Path, kind: str, version: int) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Return header and arrays of an archive of this `kind` and `version` (the header's format and format_version).

    Raises `ArchiveError`.
    """
    try:
        with zipfile.ZipFile(path) as members:
            check_size(members)
            header = json.loads(read_member(members, "header").tobytes())
            names = [name.removesuffix(".npy") for name in members.namelist()]
            arrays = {name: read_member(members, name) for name in names if name != "header"}
    except ArchiveError:
        raise
    except (*DAMAGE, KeyError, zipfile.BadZipFile) as problem:
        raise ArchiveError(f"it is truncated or damaged ({problem})") from None
    if not isinstance(header, dict) or header.get("format") != kind:
        raise ArchiveError("it is something else")
    if header.get("format_version") != version:
        raise ArchiveError(f"it has format version {header.get('format_version')}, this version reads {version}")
    return header, arrays


def check_size(members: zipfile.ZipFile) -> None:
    """Raise `ArchiveError` for an archive that unpacks to more than `LARGEST_BYTES`."""
    if sum(info.file_size for info in members.infolist()) > LARGEST_BYTES:
        raise ArchiveError(f"it would unpack to more than {LARGEST_BYTES >> 30} GiB")


def read_member(members: zipfile.ZipFile, name: str) -> np.ndarray:
    """Return the array `name` of an archive of numbers.

    Nothing is allocated before the array's header agrees with the size of its member. Raises `KeyError` if there is
    none of that name, `ArchiveError` for one that is no such array, and what `DAMAGE` lists.
    """
    info = members.getinfo(f"{name}.npy")
    with members.open(info) as stream:
        shape, by_columns, dtype = read_array_header(stream)
        if dtype.hasobject or dtype.kind not in "iufb":
            raise ArchiveError(f"{name} does not hold numbers")
        array = np.empty(_checked_count(name, shape, dtype, info.file_size - stream.tell()), dtype)
        place = array.view(np.uint8).data
        filled = 0
        while chunk := stream.read(_CHUNK):  # up to the end, where the checksum is verified
            place[filled : filled + len(chunk)] = chunk
            filled += len(chunk)
    return array.reshape(shape, order="F" if by_columns else "C")


def read_array_header(stream: Any) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Return shape, whether columns come first, and type of the .npy array that `stream` begins with.

    Raises `ArchiveError` if it is none.
    """
    try:
        version = np.lib.format.read_magic(stream)
        read_header = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, by_columns, dtype = read_header(stream)
    except _NO_ARRAY as problem:
        raise ArchiveError(f"it is not a whole numpy array ({one_line(problem, 80)})") from None
    if min(shape, default=0) < 0:
        raise ArchiveError(f"it is not a whole numpy array (its shape is {shape})")
    return shape, by_columns, dtype


def _checked_count(name: str, shape: tuple[int, ...], dtype: np.dtype[Any], size: int) -> int:
    count = math.prod(shape)
    if count * dtype.itemsize != size:
        raise ArchiveError(f"{name} says it has {count * dtype.itemsize} bytes, and has {size}")
    return count


def _write_member(members: zipfile.ZipFile, name: str, array: np.ndarray) -> None:
    """Write one array as `np.savez` would, with a fixed time stamp, and without copying it first."""
    info = zipfile.ZipInfo(f"{name}.npy", date_time=_EPOCH)
    with members.open(info, "w", force_zip64=True) as member:
        np.lib.format.write_array_header_1_0(member, np.lib.format.header_data_from_array_1_0(array))
        member.write(array.reshape(-1).view(np.uint8).data)
