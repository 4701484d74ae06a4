"""Grey PNG images are read without an image library."""

from __future__ import annotations

import io

import numpy as np
import pytest

from ski_addon.terrain.png import PngError, read_grey, read_size
from tests.terrain.images import png_bytes

RNG = np.random.default_rng(11)


def read(content):
    return read_grey(io.BytesIO(content))


@pytest.mark.parametrize("depth", [8, 16])
@pytest.mark.parametrize("filters", [(0,), (1,), (2,), (3,), (4,), (4, 0, 1, 3, 2)])
def test_every_filter_and_depth_gives_the_values_back(depth, filters):
    values = RNG.integers(0, 2**depth, (13, 9))
    np.testing.assert_allclose(read(png_bytes(values, depth=depth, filters=filters)), values / (2**depth - 1))


@pytest.mark.parametrize("depth", [8, 16])
def test_alpha_is_left_out(depth):
    values = RNG.integers(0, 2**depth, (6, 7, 2))
    made = png_bytes(values, kind=4, depth=depth, filters=(4, 1, 3))
    np.testing.assert_allclose(read(made), values[:, :, 0] / (2**depth - 1))


def test_an_image_of_another_program_is_read(tmp_path):
    image = pytest.importorskip("PIL.Image")
    values = np.cumsum(RNG.integers(0, 60, (40, 50)), axis=0).astype(np.uint16)
    image.fromarray(values).save(tmp_path / "hill.png")
    np.testing.assert_allclose(read((tmp_path / "hill.png").read_bytes()), values / 65535)


def test_the_size_is_known_before_the_image_is_read():
    assert read_size(io.BytesIO(png_bytes(np.zeros((13, 9)))[:40])) == (13, 9)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"GIF89a and more", "it is not a PNG image: save it as one"),
        (b"", "it is not a PNG image"),
        (png_bytes(np.zeros((4, 4)))[:12], "it has no header"),
        (png_bytes(np.zeros((4, 4, 3)), kind=2), "it is in colour: save it as grey"),
        (png_bytes(np.zeros((4, 4)), kind=3), "it is in palette"),
        (png_bytes(np.zeros((4, 4)), depth=4), "it has 4 bits a pixel"),
        (png_bytes(np.zeros((4, 4)), interlaced=1), "it is interlaced"),
        (png_bytes(np.zeros((40, 40)), cut=10), "it ends too early"),
        (png_bytes(np.zeros((4, 4)))[:60], "it ends too early"),
        (png_bytes(np.zeros((4, 4)), filters=(7,)), r"its line 0 has an unknown filter \(7\)"),
        (png_bytes(np.zeros((4, 4))).replace(b"\x78\x9c", b"\x00\x00"), "its data are damaged"),
    ],
)
def test_what_cannot_be_read_says_what_to_do(content, words):
    with pytest.raises(PngError, match=words):
        read(content)
