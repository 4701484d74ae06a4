"""Files that somebody or something damaged: bytes flipped, cut off, doubled, swapped; and files made to do harm."""

from __future__ import annotations

import io
import pickle
import random
import struct
import zipfile
import zlib
from pathlib import Path

import numpy as np

NASTY = (
    b"\x00",
    b"\xff",
    b"[",
    b"]",
    b"{",
    b'"',
    b"=",
    b"\n",
    b"1e999",
    b"nan",
    b"-0",
    b"9" * 400,
    b"../",
    b"[[" * 200,
)


def mutated(content: bytes, chance: random.Random) -> bytes:
    """Return `content` with one to eight damages."""
    data = bytearray(content)
    for _ in range(chance.randint(1, 8)):
        place = chance.randrange(len(data) + 1)
        how = chance.randrange(5)
        if how == 0 and data:
            data[min(place, len(data) - 1)] = chance.randrange(256)
        elif how == 1:
            del data[place:]
        elif how == 2:
            data[place:place] = chance.choice(NASTY)
        elif how == 3:
            end = min(place + chance.randint(1, 64), len(data))
            data[place:place] = data[place:end]
        else:
            del data[place : place + chance.randint(1, 64)]
    return bytes(data)


class Bomb:
    """Unpickled, it writes a file: what must never happen."""

    def __init__(self, victim: Path) -> None:
        self.victim = victim

    def __reduce__(self) -> tuple[object, ...]:
        return open, (str(self.victim), "w")


def pickled_npy(victim: Path) -> bytes:
    """An .npy member that holds a pickle."""
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"descr": "|O", "fortran_order": False, "shape": (1,)})
    stream.write(pickle.dumps(Bomb(victim)))
    return stream.getvalue()


def huge_npy(shape: str, descr: str = "<f8") -> bytes:
    """An .npy member whose header promises far more than there is."""
    header = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}".encode()
    header += b" " * (63 - (10 + len(header)) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + b"\x00" * 64


def with_member(archive: bytes, name: str, content: bytes) -> bytes:
    """The zip `archive` with one member replaced, or added."""
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(archive)) as before, zipfile.ZipFile(stream, "w") as after:
        for item in before.namelist():
            if item != name:
                after.writestr(item, before.read(item))
        after.writestr(name, content)
    return stream.getvalue()


def members(archive: bytes) -> list[str]:
    """The names in a zip."""
    with zipfile.ZipFile(io.BytesIO(archive)) as opened:
        return opened.namelist()


def zip_bomb(name: str = "time.npy", size: int = 2**31) -> bytes:
    """A small zip whose member unpacks to `size` bytes."""
    stream = io.BytesIO()
    with (
        zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as opened,
        opened.open(name, "w", force_zip64=True) as member,
    ):
        block = b"\x00" * 2**20
        for _ in range(size // len(block)):
            member.write(block)
    return stream.getvalue()


def png(width: int, height: int, bits: int = 16, data: bytes | None = None) -> bytes:
    """A grey PNG whose header says `width` and `height`."""

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    rows = data if data is not None else b"".join(b"\x00" + b"\x01\x00" * width for _ in range(height))
    head = struct.pack(">IIBBBBB", width, height, bits, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
