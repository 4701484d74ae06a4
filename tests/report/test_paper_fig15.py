"""What the 2019 paper's Fig. 15 shows, in the numbers that the report draws of its run."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.report import series
from ski_addon.results import simulate_run
from ski_addon.spec import RunSpec, find_document

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def recording():
    spec = RunSpec.from_toml(find_document("paper_fig15"))
    return simulate_run(spec, lambda fraction, text: True)[0]


def test_first_turn_is_to_the_right_and_transitions_are_where_the_paper_has_them(recording):
    bands = series.phase_bands(recording.time, recording.phase)
    assert [band.phase for band in bands] == [-1, 0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1]
    middles = [(band.start + band.end) / 2 for band in bands if band.phase == 0]
    np.testing.assert_allclose(middles, 1.5 + 2.0 * np.arange(6), atol=0.2)


def test_sideways_force_follows_the_inclination(recording):
    split = series.force_split(recording)
    assert np.corrcoef(split.left, np.tan(recording.inclination))[0, 1] > 0.99


def test_normal_force_dips_in_the_middle_of_every_transition(recording):
    normal = series.force_split(recording).normal
    bands = series.phase_bands(recording.time, recording.phase)

    def mean_around(time):
        return normal[np.abs(recording.time - time) < 0.1].mean()

    for before, transition, after in zip(bands[0::2], bands[1::2], bands[2::2], strict=False):
        middle = mean_around((transition.start + transition.end) / 2)
        turns = [mean_around((band.start + band.end) / 2) for band in (before, after)]
        assert middle < min(turns) - 0.01, f"transition at {transition.start:.2f} s"
