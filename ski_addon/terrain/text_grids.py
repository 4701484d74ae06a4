"""Heights as text: tables of numbers (CSV or separated by blanks) and ESRI ASCII grids."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator
from typing import BinaryIO

import numpy as np

from ..errors import TerrainError, show_value
from .grid_checks import SAMPLES_MOST, check_shape

Lines = Iterator[tuple[int, str]]


def read_text_grid(stream: BinaryIO, name: str) -> tuple[np.ndarray, float | None]:
    """Return heights (rows, columns) and the spacing [m] if the text says it; raises `TerrainError`.

    A line is a row; numbers are separated by commas, semicolons or blanks; empty cells are holes (nan); lines that
    begin with # are skipped. A text that begins with "ncols" is an ESRI ASCII grid.
    """
    lines = _lines(io.TextIOWrapper(stream, encoding="utf-8-sig"), name)
    number, first = next(lines, (0, ""))
    if not first:
        raise TerrainError(name, "it is empty", "give a row of heights on each line")
    if first.split()[0].lower() == "ncols":
        return _read_esri(number, first, lines, name)
    return _read_table(number, first, lines, name), None


def _lines(text: io.TextIOWrapper, name: str) -> Lines:
    """Yield the number (from 1) and the text of each line that says something."""
    try:
        for number, line in enumerate(text, start=1):
            stripped = line.strip()
            if stripped and not stripped.startswith("#"):
                yield number, stripped
    except UnicodeDecodeError:
        raise TerrainError(name, "it is not a text file", "give a row of heights on each line") from None


def _read_table(number: int, first: str, lines: Lines, name: str) -> np.ndarray:
    separator = next((mark for mark in (";", ",") if mark in first), None)
    rows = [_numbers(number, first, separator, name)]
    for number, line in lines:
        row = _numbers(number, line, separator, name)
        if len(row) != len(rows[0]):
            problem = f"line {number} has {len(row)} numbers, the first row has {len(rows[0])}"
            raise TerrainError(name, problem, "give rows of one length")
        rows.append(row)
        if len(rows) * len(row) > SAMPLES_MOST:
            check_shape((len(rows), len(row)), name)
    return np.array(rows)


def _numbers(number: int, line: str, separator: str | None, name: str) -> np.ndarray:
    cells = line.split(separator)
    if separator and not cells[-1].strip():
        cells.pop()  # a separator at the end of the line
    cells = [cell if cell.strip() else "nan" for cell in cells]
    try:
        return np.array(cells, dtype=float)
    except ValueError:
        column = next(k for k, cell in enumerate(cells) if not _is_number(cell))
        problem = f"line {number}, column {column + 1}: {show_value(cells[column].strip())} is not a number"
        hint = "write heights in metres, with a point, and nothing else"
        raise TerrainError(name, problem, hint, index=(number, column + 1)) from None


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _read_esri(number: int, line: str, lines: Lines, name: str) -> tuple[np.ndarray, float]:
    """Read a grid of a survey: rows from north to south, so that south is downhill; its place on Earth is left out."""
    header: dict[str, float] = {}
    while line and line[0].isalpha() and len(parts := line.split()) == 2 and _is_number(parts[1]):
        header[parts[0].lower()] = float(parts[1])
        number, line = next(lines, (number, ""))
    for key in ("ncols", "nrows", "cellsize"):
        if not (header.get(key, 0.0) > 0.0 and math.isfinite(header[key])):
            raise TerrainError(
                name, f"its header has no {key}", "an ESRI ASCII grid begins with ncols, nrows, cellsize"
            )
    shape = int(header["nrows"]), int(header["ncols"])
    check_shape(shape, name)
    values = [_numbers(number, line, None, name)] if line else []
    values += [_numbers(number, line, None, name) for number, line in lines]
    count = sum(len(row) for row in values)
    if count != shape[0] * shape[1]:
        problem = f"it has {count} heights, its header says {shape[0]} x {shape[1]} = {shape[0] * shape[1]}"
        raise TerrainError(name, problem, "export it again")
    heights = np.concatenate(values).reshape(shape)
    heights[heights == header.get("nodata_value", -9999.0)] = math.nan
    return heights, header["cellsize"]
