"""The keys `slope.grid_...`: which file, how it is turned, how high it is and where the run starts on it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ski_addon.errors import MissingInputError, SpecError, TerrainError
from ski_addon.spec import SlopeSpec
from ski_addon.terrain import build_terrain
from tests.terrain.images import png_bytes

DOWN, LEFT = np.arange(40.0), np.arange(21.0)
HILL = -0.2 * DOWN[:, None] + 0.3 * np.sin(DOWN[:, None] / 4 + LEFT / 3)


@pytest.fixture
def ground(tmp_path):
    def build(heights=HILL, angle_deg=0.0, origin=None, name="hill.npz", **keys):
        path = tmp_path / name
        if heights is not None:
            np.savez(path, height=heights, spacing=1.0, **({} if origin is None else {"origin": origin}))
        return build_terrain(SlopeSpec(kind="grid", angle_deg=angle_deg, grid_file=str(path), **keys))

    return build


def test_a_run_starts_five_metres_in_and_in_the_middle(ground):
    assert ground().extent == (-5.0, 34.0, -10.0, 10.0)
    assert ground(HILL[:9]).extent == (-2.0, 6.0, -10.0, 10.0)  # of a short grid a quarter


def test_a_run_starts_where_the_file_or_the_document_says(ground):
    assert ground(origin=(-12.0, -3.0)).extent == (-12.0, 27.0, -3.0, 17.0)
    assert ground(origin=(-12.0, -3.0), grid_start_down=2).extent == (-2.0, 37.0, -3.0, 17.0)
    assert ground(grid_start_down=20.5, grid_start_across=0).extent == (-20.5, 18.5, 0.0, 20.0)


@pytest.mark.parametrize(
    ("keys", "line"),
    [
        (
            {"grid_start_down": 50.0},
            "slope.grid_start_down = 50.0 is outside 0..39 m: the run has to start on the grid",
        ),
        ({"grid_start_across": 21.0}, "slope.grid_start_across = 21.0 is outside 0..20 m: the run has to start on"),
        ({"origin": (3.0, 0.0)}, "slope.grid_start_down = -3.0 is outside 0..39 m"),
    ],
)
def test_a_run_starts_on_the_grid(ground, keys, line):
    with pytest.raises(SpecError) as caught:
        ground(**keys)
    assert str(caught.value).startswith(line)


@pytest.mark.parametrize(
    ("side", "turned"),
    [
        ("bottom", lambda z: z),
        ("top", lambda z: z[::-1, ::-1]),
        ("right", lambda z: z.T[::-1]),
        ("left", lambda z: z.T[:, ::-1]),
    ],
)
def test_the_side_that_lies_downhill_is_turned_to_the_bottom(ground, side, turned):
    """Written as an image is seen: turning the picture by hand gives the same ground, never a mirrored one."""
    expected = ground()
    shown = ground(turned(HILL), grid_downhill=side, name="turned.npz")
    x, y = np.random.default_rng(15).uniform((-8, -12), (36, 12), (50, 2)).T
    np.testing.assert_allclose(shown.height(x, y), expected.height(x, y), atol=1e-9)
    assert shown.extent == expected.extent


@pytest.mark.parametrize(("side", "downhill"), [("right", (0.0, 1.0)), ("top", (-1.0, 0.0)), ("left", (0.0, -1.0))])
def test_turning_keeps_the_place_of_the_start(tmp_path, side, downhill):
    """The file's own origin turns with the grid about the start of the run."""
    x, y = np.arange(-10.0, 11.0), np.arange(-6.0, 15.0)
    heights = -0.2 * (x[:, None] * downhill[0] + y * downhill[1]) + 0.1 * np.sin(x[:, None]) + 0.05 * np.cos(y / 2)
    np.savez(tmp_path / "h.npz", height=heights, spacing=[1.0, 1.0], origin=[-10.0, -6.0])
    terrain = build_terrain(SlopeSpec(kind="grid", angle_deg=0, grid_file=str(tmp_path / "h.npz"), grid_downhill=side))
    for i, j in ((3, 4), (15, 17)):
        down = x[i] * downhill[0] + y[j] * downhill[1]
        left = -x[i] * downhill[1] + y[j] * downhill[0]
        assert terrain.height(down, left) + terrain.altitude == pytest.approx(heights[i, j], abs=1e-9)


def test_angle_lies_under_the_grid(ground):
    flat, steep = ground(), ground(angle_deg=20.0)
    assert steep.height(10.0, 3.0) == pytest.approx(flat.height(10.0, 3.0) - 10 * math.tan(math.radians(20)))


def test_an_image_is_as_high_as_asked(tmp_path):
    values = np.clip(65535 * (1 - DOWN[:, None] / 39) + 0 * LEFT, 0, 65535).astype(int)
    (tmp_path / "hill.png").write_bytes(png_bytes(values, depth=16, filters=(4,)))
    spec = SlopeSpec(kind="grid", angle_deg=0, grid_file=str(tmp_path / "hill.png"), grid_spacing=0.5, grid_height=4.0)
    terrain = build_terrain(spec)
    assert terrain.extent == (-4.875, 14.625, -5.0, 5.0)
    assert terrain.height(-4.875, 0.0) - terrain.height(14.625, 0.0) == pytest.approx(4.0)
    assert math.tan(terrain.mean_angle) == pytest.approx(4.0 / 19.5, rel=1e-3)


def test_spacing_has_to_be_known(tmp_path):
    np.save(tmp_path / "hill.npy", HILL)
    spec = SlopeSpec(kind="grid", angle_deg=0, grid_file=str(tmp_path / "hill.npy"))
    with pytest.raises(SpecError) as caught:
        build_terrain(spec)
    assert str(caught.value) == (
        'slope.grid_spacing = "auto" is not enough: hill.npy does not say it: write the metres between samples, for '
        "instance grid_spacing = 1.0 under [slope]"
    )


def test_smoothing_is_passed_on(ground):
    assert np.ptp(ground(grid_smoothing=5.0).normal(DOWN, 0.0)[:, 1]) < 0.5 * np.ptp(ground().normal(DOWN, 0.0)[:, 1])


def test_errors_in_the_data_name_the_key_and_the_file(ground):
    holed = HILL.copy()
    holed[2, 3] = math.nan
    with pytest.raises(TerrainError) as caught:
        ground(holed)
    assert str(caught.value).startswith("slope.grid_file hill.npz: height[2, 3] = nan is a hole, the first of 1")


def test_a_hole_is_named_as_it_lies_in_the_file(ground):
    holed = HILL.copy()
    holed[2, 3] = math.nan
    with pytest.raises(TerrainError) as caught:
        ground(holed, grid_downhill="top")
    assert caught.value.index == (2, 3)


def test_a_grid_needs_a_file(tmp_path):
    with pytest.raises(SpecError) as caught:
        build_terrain(SlopeSpec(kind="grid"))
    assert str(caught.value) == (
        'slope.grid_file is needed for slope.kind = "grid": name a file of heights, or a shipped ground such as '
        '"rolling_hill"'
    )
    with pytest.raises(MissingInputError, match=r"cannot read .*nowhere\.npy: there is no such file"):
        build_terrain(SlopeSpec(kind="grid", grid_file=str(tmp_path / "nowhere.npy")))
    with pytest.raises(MissingInputError, match=r"cannot read rolling: there is no such ground \(shipped are rolling_"):
        build_terrain(SlopeSpec(kind="grid", grid_file="rolling"))
