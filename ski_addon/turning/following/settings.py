"""What a search may vary, and how far it looks ahead."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...frames import Array


@dataclass(frozen=True)
class SearchSettings:
    """Settings of a search, with the paper's usual values [VP93 sec. 6.1].

    `stages` N of `stage_time` [s] each are planned, of which the first is ridden; each stage tries `inputs` q values
    of the rate of curvature; the track is sampled every `sample_time` [s]; a lean beyond `lean_bound` [rad] is a
    fall. A search that has expanded `node_limit` nodes gives up.
    """

    stages: int = 10
    stage_time: float = 0.3
    inputs: int = 7
    sample_time: float = 0.1
    lean_bound: float = math.radians(30.0)
    node_limit: int = 400_000

    @property
    def samples(self) -> int:
        """Samples of the track in a stage."""
        return max(round(self.stage_time / self.sample_time), 1)

    @property
    def horizon(self) -> float:
        """How far a plan looks ahead [s]."""
        return self.stages * self.stage_time

    def rates(self, bound: float) -> Array:
        """Return the paper's even grid of rates of curvature (q,) [1/m/s] within `bound`."""
        return np.linspace(-bound, bound, self.inputs)
