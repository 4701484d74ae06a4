"""Pictures that say what they were made from, and whether they still are as they were written.

Two texts within the PNG file hold the key of the frame and the digest of its pixels.
"""

from __future__ import annotations

import hashlib
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path

SIGNATURE = b"\x89PNG\r\n\x1a\n"
KEY, PIXELS = "ski_addon:key", "ski_addon:pixels"
CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
"""Numbers a pixel has, by the kind of picture."""
TELLING = (b"tEXt", b"zTXt", b"iTXt", b"tIME")
"""Chunks that tell something about a picture."""
MOST_BYTES = 1 << 31
"""A picture that unpacks to more than this is not read."""


class PictureError(ValueError):
    """A file that is no whole picture; the text says why."""


@dataclass(frozen=True)
class Picture:
    """A whole picture: `size` (width, height), its `texts`, and the digest of its `pixels`."""

    size: tuple[int, int]
    texts: dict[str, str]
    pixels: str


def read_picture(content: bytes) -> Picture:
    """Return what a PNG file holds; every chunk's checksum and the number of its pixels are verified.

    Raises `PictureError`.
    """
    chunks = _chunks(content)
    if not chunks or chunks[0][0] != b"IHDR" or len(chunks[0][1]) != 13:
        raise PictureError("it has no header")
    width, height, depth, kind, _, _, interlaced = struct.unpack(">IIBBBBB", chunks[0][1])
    if kind not in CHANNELS or interlaced:
        raise PictureError("it is of a kind that is not written here")
    raw = _unpacked(b"".join(data for name, data in chunks if name == b"IDAT"))
    if len(raw) != height * (1 + (width * CHANNELS[kind] * depth + 7) // 8):
        raise PictureError("its pixels are incomplete")
    texts = [data.partition(b"\0") for name, data in chunks if name == b"tEXt"]
    found = {name.decode("latin-1"): text.decode("latin-1") for name, _, text in texts}
    return Picture((width, height), found, hashlib.sha256(chunks[0][1] + raw).hexdigest())


def marked(content: bytes, key: str) -> bytes:
    """Return the PNG file with `key` and the digest of its pixels written in; raises `PictureError`.

    Other texts are taken out: Blender's tell how long rendering took.
    """
    texts = {KEY: key, PIXELS: read_picture(content).pixels}
    head, *rest = _chunks(content)
    told = [(b"tEXt", f"{name}\0{text}".encode("latin-1")) for name, text in texts.items()]
    chunks = [head, *told, *(chunk for chunk in rest if chunk[0] not in TELLING)]
    return SIGNATURE + b"".join(_chunk(*chunk) for chunk in chunks)


def flaw(path: Path, key: str) -> str:
    """Return "" if the picture `path` is whole, as it was written, and of `key`; else what is wrong with it."""
    try:
        picture = read_picture(path.read_bytes())
    except FileNotFoundError:
        return "is missing"
    except (OSError, PictureError) as error:
        return f"is damaged ({getattr(error, 'strerror', None) or error})"
    if picture.texts.get(KEY) != key:
        return "was made from something else"
    return "" if picture.texts.get(PIXELS) == picture.pixels else "was edited"


def _chunks(content: bytes) -> list[tuple[bytes, bytes]]:
    """Return name and data of each chunk."""
    if not content.startswith(SIGNATURE):
        raise PictureError("it is not a PNG picture")
    place, chunks = len(SIGNATURE), []
    while True:
        if place + 12 > len(content):
            raise PictureError("it ends too early")
        size, name = struct.unpack_from(">I4s", content, place)
        end = place + 12 + size
        data = content[place + 8 : end - 4]
        if end > len(content) or struct.unpack_from(">I", content, end - 4)[0] != zlib.crc32(name + data):
            raise PictureError("its data are damaged")
        chunks.append((name, data))
        place = end
        if name == b"IEND":
            if place != len(content):
                raise PictureError("something follows its end")
            return chunks


def _unpacked(data: bytes) -> bytes:
    packed = zlib.decompressobj()
    try:
        raw = packed.decompress(data, MOST_BYTES)
    except zlib.error:
        raise PictureError("its data are damaged") from None
    if not packed.eof:
        raise PictureError("its pixels are incomplete")
    return raw


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
