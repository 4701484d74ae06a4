"""Pictures as PNG files with nothing but numpy."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np

from ..atomic import atomic_path
from ..frames import Array

_COLOURS = 256
_COARSE = 4
"""Bits by which colours may differ and still be put into one."""


def save_png(pixels: Array, target: str | Path) -> None:
    """Write `pixels` (h, w, 3 or 4), sRGB from 0 to 1, as an opaque picture, in one step.

    The file holds at most 256 colours: those that nearly agree become the most frequent of them, which
    keeps plots small. Raises
    `OutputError` if it cannot be written.
    """
    height, width = pixels.shape[:2]
    levels = np.round(255.0 * np.clip(pixels[..., :3], 0.0, 1.0)).astype(np.int64)
    palette, index = _palette(levels.reshape(-1, 3))
    rows = np.zeros((height, 1 + width), dtype=np.uint8)  # a zero before each row: its bytes are given as they are
    rows[:, 1:] = index.reshape(height, width)
    head = struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)
    data = zlib.compress(rows.tobytes(), 9)
    chunks = ((b"IHDR", head), (b"PLTE", palette.tobytes()), (b"IDAT", data), (b"IEND", b""))
    with atomic_path(target) as temporary:
        temporary.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*chunk) for chunk in chunks))


def _palette(levels: Array) -> tuple[Array, Array]:
    """Return up to 256 colours (k, 3) uint8, and for each of `levels` (n, 3), 0 to 255, which is nearest to it."""
    found, which, count = np.unique(levels @ (1 << 16, 1 << 8, 1), return_inverse=True, return_counts=True)
    parts = np.stack((found >> 16, (found >> 8) & 255, found & 255), axis=1)
    order = np.argsort(-count, kind="stable")
    _, first, bins = np.unique((parts[order] >> _COARSE) @ (1 << 16, 1 << 8, 1), return_index=True, return_inverse=True)
    total = np.bincount(bins.ravel(), count[order])
    palette = parts[order[first[np.argsort(-total, kind="stable")[:_COLOURS]]]]
    # |a - b|^2 without |a|^2, which is the same for all b
    nearest = np.argmin(np.sum(palette**2, axis=1) - 2 * parts @ palette.T, axis=1)
    return palette.astype(np.uint8), nearest[which.ravel()].astype(np.uint8)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
