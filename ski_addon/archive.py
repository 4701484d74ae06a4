"""Archives of arrays with a header: `.npz` files without pickled objects, whose bytes depend only on their contents.

Every member has a checksum, which reading verifies.
"""

from __future__ import annotations

import json
import struct
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

DAMAGE = (OSError, ValueError, EOFError, RuntimeError, MemoryError, OverflowError, struct.error, zlib.error)
"""What zipfile and numpy raise on damaged files."""
LARGEST_BYTES = 16 * 2**30
"""An archive that unpacks to more than this is not read."""
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
            if sum(info.file_size for info in members.infolist()) > LARGEST_BYTES:
                raise ArchiveError(f"it would unpack to more than {LARGEST_BYTES >> 30} GiB")
        with np.load(path, allow_pickle=False) as members:
            header = json.loads(members["header"].tobytes())
            arrays = {name: members[name] for name in members.files if name != "header"}
    except ArchiveError:
        raise
    except (*DAMAGE, KeyError, zipfile.BadZipFile) as problem:
        raise ArchiveError(f"it is truncated or damaged ({problem})") from None
    if not isinstance(header, dict) or header.get("format") != kind:
        raise ArchiveError("it is something else")
    if header.get("format_version") != version:
        raise ArchiveError(f"it has format version {header.get('format_version')}, this version reads {version}")
    return header, arrays


def _write_member(members: zipfile.ZipFile, name: str, array: np.ndarray) -> None:
    """Write one array as `np.savez` would, with a fixed time stamp, and without copying it first."""
    info = zipfile.ZipInfo(f"{name}.npy", date_time=_EPOCH)
    with members.open(info, "w", force_zip64=True) as member:
        np.lib.format.write_array_header_1_0(member, np.lib.format.header_data_from_array_1_0(array))
        member.write(array.reshape(-1).view(np.uint8).data)
