"""Reading grids of heights from files: numpy arrays, text tables, ESRI ASCII grids and grey images."""

from __future__ import annotations

import zipfile
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from .. import archive
from ..errors import MissingInputError, MissingLibraryError, TerrainError
from . import png, text_grids
from .grid_checks import check_shape

Pair = tuple[float, float]


@dataclass(frozen=True)
class GridData:
    """What a file says: `heights` (nx, ny) [m], or 0..1 of an image; spacing [m] and place of the first sample [m].

    Rows run across the slope, the first one uphill; along a row y grows, to the left as one looks downhill. `spacing`
    and `origin` are None where the file does not say.
    """

    heights: np.ndarray
    spacing: Pair | None = None
    origin: Pair | None = None
    is_image: bool = False


def read_grid(path: Path, name: str) -> GridData:
    """Read a grid of heights; `name` is what errors call it.

    Raises `MissingInputError` if the file cannot be read and `TerrainError` if it holds no grid.
    """
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        hint = f"give one of {', '.join(READERS)}"
        raise TerrainError(name, f"files ending in {path.suffix or 'nothing'} are not known as grids", hint)
    try:
        with path.open("rb") as stream:
            return reader(stream, name)
    except FileNotFoundError:
        raise MissingInputError(path) from None
    except IsADirectoryError:
        raise MissingInputError(path, "it is a folder, not a grid of heights") from None
    except OSError as error:
        raise MissingInputError(path, error.strerror or str(error)) from None


def _read_npy(stream: BinaryIO, name: str) -> GridData:
    return GridData(_read_array(stream, name))


def _read_array(stream: Any, name: str) -> np.ndarray:
    """Read one .npy array, its size first."""
    hint = "save it with numpy.save"
    try:
        shape, by_columns, dtype = archive.read_array_header(stream)
        if dtype.hasobject or dtype.kind not in "iufb":
            raise TerrainError(name, f"its heights are of type {dtype}, not numbers", "give heights in metres")
        check_shape(shape, name)
        raw = stream.read(shape[0] * shape[1] * dtype.itemsize)
        return np.frombuffer(raw, dtype).reshape(shape, order="F" if by_columns else "C")
    except archive.ArchiveError as error:
        raise TerrainError(name, str(error), hint) from None
    except (ValueError, EOFError, zlib.error, zipfile.BadZipFile) as error:
        raise TerrainError(name, f"it is not a whole numpy array ({error})", hint) from None


def _read_npz(stream: BinaryIO, name: str) -> GridData:
    try:
        with zipfile.ZipFile(stream) as members:
            names = [entry.removesuffix(".npy") for entry in members.namelist()]
            if "height" not in names:
                problem = f"it has no array height (it has {', '.join(names) or 'none'})"
                raise TerrainError(name, problem, "save it with numpy.savez(..., height=..., spacing=...)")
            with members.open("height.npy") as part:
                heights = _read_array(part, name)
            spacing, origin = (_pair(members, names, key, name) for key in ("spacing", "origin"))
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, RuntimeError) as error:
        raise TerrainError(name, f"it is not a numpy archive ({error})", "save it with numpy.savez") from None
    return GridData(heights, spacing, origin)


def _pair(members: zipfile.ZipFile, names: list[str], key: str, name: str) -> Pair | None:
    """Return the one or two numbers of an array, or None if the archive does not have it."""
    if key not in names:
        return None
    try:
        values = archive.read_member(members, key).astype(float).ravel()
    except (archive.ArchiveError, ValueError, EOFError) as error:
        raise TerrainError(name, f"its {key} is not an array of numbers ({error})", "give one or two numbers") from None
    if values.size not in (1, 2):
        raise TerrainError(name, f"its {key} has {values.size} numbers", "give one or two, in metres")
    return float(values[0]), float(values[-1])


def _read_text(stream: BinaryIO, name: str) -> GridData:
    heights, spacing = text_grids.read_text_grid(stream, name)
    return GridData(heights, None if spacing is None else (spacing, spacing))


def _read_png(stream: BinaryIO, name: str) -> GridData:
    try:
        check_shape(png.read_size(stream), name)
        stream.seek(0)
        return GridData(png.read_grey(stream), is_image=True)
    except png.PngError as error:
        problem, _, hint = str(error).rpartition(": ")
        raise TerrainError(name, problem, hint) from None


def _read_tiff(stream: BinaryIO, name: str) -> GridData:
    try:
        from PIL import Image
    except ImportError:
        raise MissingLibraryError("Pillow", "reading TIFF images", "install it, or save the image as PNG") from None
    try:
        with Image.open(stream) as image:
            check_shape((image.height, image.width), name)
            values = np.asarray(image)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise TerrainError(name, f"it is not a TIFF image that can be read ({error})", "save it as PNG") from None
    if values.ndim != 2 or values.dtype.kind == "b":
        raise TerrainError(name, "it is not a grey image of 8 or 16 bits", "save it as grey")
    if values.dtype.kind == "f":
        return GridData(values)  # heights in metres, as surveys give them
    bits = 8 if values.dtype.itemsize == 1 else 16
    return GridData(values / float(2**bits - 1), is_image=True)


READERS: dict[str, Callable[[BinaryIO, str], GridData]] = {
    ".npy": _read_npy,
    ".npz": _read_npz,
    ".csv": _read_text,
    ".txt": _read_text,
    ".asc": _read_text,
    ".png": _read_png,
    ".tif": _read_tiff,
    ".tiff": _read_tiff,
}
"""Readers by the ending of the file's name."""
