"""The shipped ground is what its generator makes, and as steep as promised."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ski_addon.spec import SlopeSpec
from ski_addon.terrain import build_terrain
from tests.terrain.rolling_hill import PATH, STEP, packed, rolling_hill


def test_the_file_is_what_the_generator_makes(tmp_path):
    """To a unit of its rounding: other processors may round the last bit of a sine another way."""
    made = tmp_path / "made.npz"
    made.write_bytes(packed(rolling_hill()))
    with np.load(PATH) as shipped, np.load(made) as again:
        assert shipped.files == again.files == ["height", "spacing", "origin"]
        np.testing.assert_allclose(shipped["height"], again["height"], atol=1.01 * STEP)
        np.testing.assert_allclose(shipped["height"], rolling_hill(), atol=0.51 * STEP)
        for name in ("spacing", "origin"):
            np.testing.assert_array_equal(shipped[name], again[name])


def test_the_file_is_small():
    assert PATH.stat().st_size < 200_000


@pytest.mark.parametrize("angle", [0, 15])
def test_steepness_varies_by_five_degrees_about_the_slope(angle):
    terrain = build_terrain(SlopeSpec(kind="grid", angle_deg=angle, grid_file="rolling_hill"))
    assert terrain.extent == (-10.0, 590.0, -60.0, 60.0)
    assert math.degrees(terrain.mean_angle) == pytest.approx(angle, abs=0.2)
    x, y = np.meshgrid(np.arange(-10.0, 590.0), np.arange(-60.0, 60.0), indexing="ij")
    steepness = np.degrees(np.arctan(-terrain.gradient(x, y)[..., 0]))
    assert 3.5 < angle - np.min(steepness) < 5.4 and 3.5 < np.max(steepness) - angle < 5.4
    assert np.std(steepness) > 1.3
    across = np.degrees(np.arctan(terrain.gradient(x, y)[..., 1]))
    assert 3.0 < np.max(np.abs(across)) < 8.0


def test_waves_are_between_25_and_60_metres_long():
    z = rolling_hill()
    power = np.abs(np.fft.rfft2((z - z.mean()) * np.outer(np.hanning(len(z)), np.hanning(z.shape[1])))) ** 2
    along, across = np.fft.fftfreq(z.shape[0], 2.0), np.fft.rfftfreq(z.shape[1], 2.0)
    wave = np.hypot(along[:, None], across)
    within = (wave > 1 / 60 - 0.012) & (wave < 1 / 25 + 0.012)  # a window of 120 m resolves no finer
    assert np.sum(power[within]) > 0.98 * np.sum(power)
