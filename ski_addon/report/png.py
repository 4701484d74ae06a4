"""Pictures as PNG files with nothing but numpy."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np

from ..atomic import atomic_path
from ..frames import Array

_COLOURS = 256


def save_png(pixels: Array, target: str | Path) -> None:
    """Write `pixels` (h, w, 3 or 4), sRGB from 0 to 1, as an opaque picture, in one step.

    The file holds the 256 most frequent colours; others become the nearest of them, which makes plots small. Raises
    `OutputError` if it cannot be written.
    """
    height, width = pixels.shape[:2]
    levels = np.round(255.0 * np.clip(pixels[..., :3], 0.0, 1.0)).astype(np.int64)
    palette, index = _palette(levels @ (1 << 16, 1 << 8, 1))
    rows = np.zeros((height, 1 + width), dtype=np.uint8)  # a zero before each row: its bytes are given as they are
    rows[:, 1:] = index.reshape(height, width)
    head = struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)
    data = zlib.compress(rows.tobytes(), 9)
    chunks = ((b"IHDR", head), (b"PLTE", palette.tobytes()), (b"IDAT", data), (b"IEND", b""))
    with atomic_path(target) as temporary:
        temporary.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*chunk) for chunk in chunks))


def _palette(colours: Array) -> tuple[Array, Array]:
    """Return up to 256 colours (k, 3) uint8, and for each of `colours` (n numbers 0xRRGGBB) which of them it is."""
    found, which, count = np.unique(colours, return_inverse=True, return_counts=True)
    chosen = np.sort(np.argsort(-count, kind="stable")[:_COLOURS])
    parts = np.stack((found >> 16, (found >> 8) & 255, found & 255), axis=1).astype(np.float32)
    palette = parts[chosen]
    # |a - b|^2 without |a|^2, which is the same for all b
    nearest = np.argmin(np.sum(palette**2, axis=1) - 2.0 * parts @ palette.T, axis=1)
    return palette.astype(np.uint8), nearest[which.ravel()].astype(np.uint8)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
