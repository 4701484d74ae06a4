"""PNG images written byte by byte, with any filter, to test what reads them."""

from __future__ import annotations

import struct
import zlib

import numpy as np


def png_bytes(values, *, kind=0, depth=8, filters=(0,), interlaced=0, cut=None):
    """A PNG of whole-number `values` (rows, columns) or (rows, columns, channels); `filters` repeat down the lines."""
    values = np.asarray(values)
    rows, columns = values.shape[:2]
    raw = values.astype(">u2" if depth == 16 else np.uint8).reshape(rows, -1).view(np.uint8).reshape(rows, -1)
    step = raw.shape[1] // columns
    lines = [
        bytes([filters[r % len(filters)]]) + _filtered(raw, r, filters[r % len(filters)], step) for r in range(rows)
    ]
    header = struct.pack(">IIBBBBB", columns, rows, depth, kind, 0, 0, interlaced)
    data = zlib.compress(b"".join(lines))[:cut]
    half = len(data) // 2
    chunks = [
        (b"IHDR", header),
        (b"tEXt", b"Comment\0hill"),
        (b"IDAT", data[:half]),
        (b"IDAT", data[half:]),
        (b"IEND", b""),
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*chunk) for chunk in chunks)


def _chunk(name, content):
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))


def _filtered(raw, row, kind, step):
    line = raw[row].astype(int)
    above = raw[row - 1].astype(int) if row else np.zeros_like(line)
    left = np.concatenate((np.zeros(step, int), line[:-step]))
    corner = np.concatenate((np.zeros(step, int), above[:-step]))
    nearest = np.stack((left, above, corner))
    distance = np.abs(left + above - corner - nearest)
    guess = (
        np.zeros_like(line),
        left,
        above,
        (left + above) // 2,
        nearest[np.argmin(distance, axis=0), np.arange(len(line))],
    )[kind if kind < 5 else 0]
    return ((line - guess) % 256).astype(np.uint8).tobytes()
