"""Which keys a bake writes: of what part of the run, and how near straight lines between them must come."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..animation.reduction import kept_numbers, kept_places, kept_rotations
from ..animation.span import ALL_FRAMES, FrameSpan
from ..frames import Array
from .channels import KeyWriter


@dataclass(frozen=True)
class KeyOptions:
    """Which keys are written: of the frames in `span`, those that deviate from straight lines between the others by
    more than `tolerance_deg` [degrees], `tolerance_mm` [mm], or `tolerance_percent` of the range that a number has in
    the run (0 keeps all); `as_strip` makes a strip instead of the active action.
    """

    as_strip: bool = False
    tolerance_deg: float = 0.0
    tolerance_mm: float = 0.0
    tolerance_percent: float = 0.0
    span: FrameSpan = ALL_FRAMES


class FewerKeys:
    """Writes curves with keys at `frame` (m,) into `channelbag`, as few of them as `options` allow."""

    def __init__(self, channelbag: Any, frame: Array, options: KeyOptions) -> None:
        self._channelbag, self._frame, self._options = channelbag, frame, options

    def places(self, path: str, values: Array, group: str) -> None:
        """Write places `values` (m, 3) [m]."""
        self._write(path, values, kept_places(self._frame, values, 0.001 * self._options.tolerance_mm), group)

    def rotations(self, path: str, values: Array, group: str) -> None:
        """Write quaternions `values` (m, 4) without jumps."""
        self._write(path, values, kept_rotations(self._frame, values, "QUATERNION", self._options.tolerance_deg), group)

    def numbers(self, path: str, values: Array, group: str) -> None:
        """Write numbers `values` (m,) of any unit."""
        self._write(path, values, kept_numbers(self._frame, values, 0.01 * self._options.tolerance_percent), group)

    def _write(self, path: str, values: Array, kept: Array, group: str) -> None:
        KeyWriter(self._channelbag, self._frame[kept]).write(path, np.asarray(values)[kept], group)
