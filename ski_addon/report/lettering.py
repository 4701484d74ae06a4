"""Letters as pen strokes, so that a picture can be written without a font library: Blender's Python has none.

A letter is a few strokes on a grid: capitals are 10 units high, small letters 7, tails reach 3 below the line. A point
is two digits of base 36, x and then y, with y = 3 on the line that letters stand on. `~` behind a point rounds the
stroke there; `o` at the end of a stroke closes it.
"""

from __future__ import annotations

import functools
import unicodedata

import numpy as np

from ..frames import Array

CAPITAL = 10.0
"""Height of capital letters on the grid."""
_BASELINE = 3
_GAP, _SPACE = 2.9, 3.6
_ROUNDING = np.linspace(0.0, 1.0, 7)[1:, None]
_UNKNOWN = "03 0d 6d 63 o, 03 6d, 0d 63"
_BOWL = "03~ 0a~ 5a~ 53~ o"
_ARCH = "07 0a~ 5a~ 57 53"

STROKES = {
    "A": "03 3d 63, 16 56",
    "B": "03 0d 3d 5d~ 58~ 38 08, 38 68~ 63~ 33 03",
    "C": "6b 6d~ 0d~ 03~ 63~ 65",
    "D": "03 0d 2d 6d~ 63~ 23 03",
    "E": "5d 0d 03 53, 08 48",
    "F": "5d 0d 03, 08 48",
    "G": "6b 6d~ 0d~ 03~ 63~ 68 48",
    "H": "03 0d, 63 6d, 08 68",
    "I": "03 0d",
    "J": "4d 46 43~ 03~ 05",
    "K": "03 0d, 5d 07, 29 53",
    "L": "0d 03 53",
    "M": "03 0d 45 8d 83",
    "N": "03 0d 63 6d",
    "O": "03~ 0d~ 7d~ 73~ o",
    "P": "03 0d 3d 6d~ 67~ 37 07",
    "Q": "03~ 0d~ 7d~ 73~ o, 46 72",
    "R": "03 0d 3d 6d~ 67~ 37 07, 37 63",
    "S": "6b 6d~ 0d~ 08~ 68~ 63~ 03~ 05",
    "T": "0d 6d, 33 3d",
    "U": "0d 06 03~ 63~ 66 6d",
    "V": "0d 33 6d",
    "W": "0d 23 4b 63 8d",
    "X": "03 6d, 0d 63",
    "Y": "0d 38 6d, 38 33",
    "Z": "0d 6d 03 63",
    "a": f"{_BOWL}, 53 5a",
    "b": f"{_BOWL}, 03 0d",
    "c": "49 4a~ 0a~ 03~ 43~ 44",
    "d": f"{_BOWL}, 53 5d",
    "e": "07 57 5a~ 0a~ 03~ 53~ 54",
    "f": "3d 1d~ 1b 13, 0a 3a",
    "g": f"{_BOWL}, 5a 52 50~ 00~ 01",
    "h": f"03 0d, {_ARCH}",
    "i": "03 0a, 0c 0d",
    "j": "1a 12 10~ 00, 1c 1d",
    "k": "03 0d, 4a 06, 17 43",
    "l": "0d 05 03~ 13",
    "m": "03 0a, 07 0a~ 4a~ 47 43, 47 4a~ 8a~ 87 83",
    "n": f"03 0a, {_ARCH}",
    "o": _BOWL,
    "p": f"{_BOWL}, 00 0a",
    "q": f"{_BOWL}, 50 5a",
    "r": "03 0a, 07 0a~ 3a",
    "s": "49 4a~ 0a~ 07~ 47~ 43~ 03~ 04",
    "t": "1d 15 13~ 33, 0a 3a",
    "u": "0a 06 03~ 53~ 56, 5a 53",
    "v": "0a 23 4a",
    "w": "0a 23 49 63 8a",
    "x": "03 4a, 0a 43",
    "y": "0a 23, 4a 10",
    "z": "0a 4a 03 43",
    "0": "03~ 0d~ 6d~ 63~ o",
    "1": "1b 3d 33",
    "2": "0a 0d~ 6d~ 6a~ 03 63",
    "3": "0b 0d~ 5d~ 58~ 28, 28 68~ 63~ 03~ 05",
    "4": "43 4d 05 65",
    "5": "5d 0d 08, 08 09~ 69~ 63~ 03~ 05",
    "6": "5d 0c~ 06, 03~ 09~ 69~ 63~ o",
    "7": "0d 6d 23",
    "8": "18~ 1d~ 5d~ 58~ o, 03~ 08~ 68~ 63~ o",
    "9": "07~ 0d~ 6d~ 67~ o, 13 64~ 6a",
    " ": "",
    ".": "03 04",
    ",": "14 13 01",
    ":": "03 04, 08 09",
    ";": "14 13 01, 18 19",
    "!": "0d 06, 03 04",
    "?": "0b 0d~ 5d~ 59~ 26, 23 24",
    "-": "07 47",
    "+": "07 67, 34 3a",
    "=": "05 65, 09 69",
    "/": "01 5e",
    "\\": "0e 51",
    "|": "00 0e",
    "_": "01 61",
    "(": "2f 0c~ 03~ 20",
    ")": "0f 2c~ 23~ 00",
    "[": "2e 0e 00 20",
    "]": "0e 2e 20 00",
    "{": "2e 1e~ 1a 07 14 10~ 20",
    "}": "0e 1e~ 1a 27 14 10~ 00",
    "<": "6b 07 63",
    ">": "0b 67 03",
    "'": "0b 0d",
    '"': "0b 0d, 2b 2d",
    "`": "0d 1b",
    "^": "0a 2d 4a",
    "~": "07 09~ 36~ 69",
    "*": "3d 38, 0c 69, 09 6c",
    "#": "13 2d, 43 5d, 06 66, 0a 6a",
    "$": "6a 6c~ 0c~ 08~ 68~ 64~ 04~ 06, 32 3e",
    "%": "03 7d, 09~ 0d~ 3d~ 39~ o, 43~ 47~ 77~ 73~ o",
    "&": "63 0b~ 2e~ 4b~ 07~ 03~ 53~ 66",
    "@": "66 6a~ 2a~ 26~ 66~ 95~ 9d~ 0d~ 03~ 73",
    "°": "0a~ 0d~ 3d~ 3a~ o",
    "\N{EN DASH}": "07 57",
    "\N{MULTIPLICATION SIGN}": "04 5a, 0a 54",
    "\N{MIDDLE DOT}": "07 08",
}
"""Letter -> its strokes."""


def text_strokes(words: str) -> list[Array]:
    """Return the strokes of `words`: polylines (n, 2) on the grid, x to the right, y up from the line of writing.

    Accents of letters are left out; a letter that has no strokes is a crossed box.
    """
    out, place = [], 0.0
    for letter in _plain(words):
        strokes, width = _glyph(letter)
        out += [stroke + (place, 0.0) for stroke in strokes]
        place += width + _GAP
    return out


def text_width(words: str) -> float:
    """Return how wide `words` are on the grid."""
    return sum(_glyph(letter)[1] + _GAP for letter in _plain(words)) - _GAP if words else 0.0


@functools.cache
def _glyph(letter: str) -> tuple[list[Array], float]:
    """Return the strokes of one letter and its width."""
    strokes = [_stroke(text) for text in STROKES.get(letter, _UNKNOWN).split(",") if text.strip()]
    width = max((float(stroke[:, 0].max()) for stroke in strokes), default=_SPACE - _GAP)
    return strokes, width


def _stroke(text: str) -> Array:
    """Return the polyline (n, 2) that a stroke's points give: corners are straight or curves about their point."""
    words = text.split()
    closed = words[-1] == "o"
    words = words[:-1] if closed else words
    points = np.array([(int(word[0], 36), int(word[1], 36) - _BASELINE) for word in words], dtype=float)
    rounded = [word.endswith("~") for word in words]
    count = len(points)
    out: list[Array] = [] if closed else [points[:1]]
    for i in range(count) if closed else range(1, count):
        before, after = (i - 1) % count, (i + 1) % count
        if not rounded[i]:
            out.append(points[i : i + 1])
            continue
        start = 0.5 * (points[before] + points[i]) if rounded[before] else points[before]
        end = 0.5 * (points[i] + points[after]) if rounded[after] else points[after]
        share = _ROUNDING
        curve = (1 - share) ** 2 * start + 2 * share * (1 - share) * points[i] + share**2 * end
        out += [start[None], curve]
    line = np.concatenate(out)
    return np.concatenate((line, line[:1])) if closed else line


def _plain(words: str) -> str:
    """Return `words` without the accents that no stroke draws, on one line."""
    bare = (unicodedata.normalize("NFKD", letter) if letter not in STROKES else letter for letter in words)
    joined = "".join(letter for text in bare for letter in text if not unicodedata.combining(letter))
    return " ".join(joined.split(" ")).replace("\n", " ")
