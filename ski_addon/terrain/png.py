"""Reading grey PNG images of 8 or 16 bits, with nothing but the standard library and numpy.

Blender's Python has no image library that keeps 16 bits, and height maps need them.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from typing import BinaryIO

import numpy as np

SIGNATURE = b"\x89PNG\r\n\x1a\n"
_KINDS = {0: "grey", 2: "colour", 3: "palette", 4: "grey with alpha", 6: "colour with alpha"}


class PngError(ValueError):
    """A PNG image that cannot be read; the text says why and what to do, as "problem: hint"."""


def read_size(stream: BinaryIO) -> tuple[int, int]:
    """Return the number of rows and columns of the image that `stream` begins with; it is not read further."""
    return _read_header(stream)[:2]


def read_grey(stream: BinaryIO) -> np.ndarray:
    """Return the grey values (rows, columns) of an image, black 0 and white 1; raises `PngError`."""
    rows, columns, depth, kind = _read_header(stream)
    channels = 2 if kind == 4 else 1
    row_bytes = columns * channels * depth // 8
    packed = zlib.decompressobj()
    raw = bytearray()
    try:
        for name, content in _chunks(stream):
            if name == b"IDAT":
                raw += packed.decompress(content, max(rows * (row_bytes + 1) - len(raw), 1))
    except zlib.error as error:
        raise PngError(f"its data are damaged ({error}): save it again") from None
    if len(raw) < rows * (row_bytes + 1):
        raise PngError("it ends too early: save it again")
    lines = np.frombuffer(raw, dtype=np.uint8)[: rows * (row_bytes + 1)].reshape(rows, row_bytes + 1)
    plain = _unfiltered(lines[:, 0], lines[:, 1:], channels * depth // 8)
    values = plain.view(">u2" if depth == 16 else np.uint8).reshape(rows, columns, channels)
    return values[:, :, 0] / float(2**depth - 1)


def _read_header(stream: BinaryIO) -> tuple[int, int, int, int]:
    if stream.read(8) != SIGNATURE:
        raise PngError("it is not a PNG image: save it as one")
    name, content = next(_chunks(stream), (b"", b""))
    if name != b"IHDR" or len(content) != 13:
        raise PngError("it has no header: save it again")
    columns, rows, depth, kind, _, _, interlaced = struct.unpack(">IIBBBBB", content)
    if kind not in (0, 4):
        raise PngError(f"it is in {_KINDS.get(kind, 'an unknown mode')}: save it as grey")
    if depth not in (8, 16):
        raise PngError(f"it has {depth} bits a pixel: save it with 8, or better 16")
    if interlaced:
        raise PngError("it is interlaced: save it without")
    return rows, columns, depth, kind


def _chunks(stream: BinaryIO) -> Iterator[tuple[bytes, bytes]]:
    """Yield name and content of each chunk up to the end of the image or of the file."""
    while len(head := stream.read(8)) == 8:
        size, name = struct.unpack(">I4s", head)
        content = stream.read(size)
        stream.read(4)  # a checksum: zlib has its own
        if name == b"IEND":
            return
        yield name, content


def _unfiltered(filters: np.ndarray, lines: np.ndarray, step: int) -> np.ndarray:
    """Return the bytes (rows, m) of lines that were stored as differences; `step` bytes make a pixel."""
    done = np.empty_like(lines)
    above = np.zeros(lines.shape[1], dtype=np.uint8)
    for row, (kind, line) in enumerate(zip(filters.tolist(), lines, strict=True)):
        if kind == 0:
            done[row] = line
        elif kind == 1:
            done[row] = np.cumsum(line.reshape(-1, step), axis=0, dtype=np.uint8).ravel()
        elif kind == 2:
            done[row] = line + above
        elif kind in (3, 4):
            done[row] = _along(line.tolist(), above.tolist(), step, _average if kind == 3 else _paeth)
        else:
            raise PngError(f"its line {row} has an unknown filter ({kind}): save it again")
        above = done[row]
    return done


def _along(line: list[int], above: list[int], step: int, guess: object) -> list[int]:
    """Undo a filter that looks at the byte to the left: one byte after another, there is no way round it."""
    out = [0] * step + line
    above = [0] * step + above
    for k in range(step, len(out)):
        out[k] = (out[k] + guess(out[k - step], above[k], above[k - step])) & 255  # type: ignore[operator]
    return out[step:]


def _average(left: int, above: int, _corner: int) -> int:
    return (left + above) // 2


def _paeth(left: int, above: int, corner: int) -> int:
    """Return which of three neighbours is nearest to left + above - corner."""
    to_left, to_above, to_corner = abs(above - corner), abs(left - corner), abs(left + above - 2 * corner)
    if to_left <= to_above and to_left <= to_corner:
        return left
    return above if to_above <= to_corner else corner
