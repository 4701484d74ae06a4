"""Grids of heights are read from arrays, tables, survey grids and images; what is wrong is said in one line."""

from __future__ import annotations

import io
import math
import sys
import zipfile

import numpy as np
import pytest

from ski_addon.errors import MissingInputError, MissingLibraryError, TerrainError
from ski_addon.terrain.grid_files import READERS, read_grid
from tests.terrain.images import png_bytes

HEIGHTS = np.round(np.random.default_rng(12).uniform(100, 110, (6, 5)), 3)
ESRI = "ncols 5\nnrows 6\nxllcorner 500000.0\nyllcorner 4000000.0\ncellsize 2.5\nNODATA_value -9999\n"


def table(separator):
    return "\n".join(separator.join(str(value) for value in row) for row in HEIGHTS.tolist())


def array_bytes(array, **more):
    stream = io.BytesIO()
    np.save(stream, array, **more)
    return stream.getvalue()


def archive_bytes(**arrays):
    stream = io.BytesIO()
    np.savez_compressed(stream, **arrays)
    return stream.getvalue()


@pytest.fixture
def write(tmp_path):
    def write_file(name, content):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write_file


def line_of(path):
    with pytest.raises(TerrainError) as caught:
        read_grid(path, "hill")
    line = str(caught.value)
    assert "\n" not in line and line.startswith("hill: ") and line.count(": ") >= 2
    return line.removeprefix("hill: ")


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("c.npy", array_bytes(HEIGHTS)),
        ("fortran.npy", array_bytes(np.asfortranarray(HEIGHTS))),
        ("big_endian.NPY", array_bytes(HEIGHTS.astype(">f8"))),
        ("packed.npz", archive_bytes(height=HEIGHTS)),
        ("comma.csv", table(",")),
        ("windows.csv", "\ufeff" + table(", ").replace("\n", " ,\r\n")),
        ("semicolon.csv", table(";")),
        ("blank.txt", "# heights\n\n" + table("  ") + "\n\n"),
        ("tab.txt", table("\t")),
        ("survey.asc", ESRI + table(" ")),
        ("wrapped.asc", ESRI.upper().replace(" ", "   ") + table("\n")),
    ],
)
def test_every_format_gives_the_same_heights(write, name, content):
    data = read_grid(write(name, content), "hill")
    np.testing.assert_array_equal(data.heights, HEIGHTS)
    assert data.spacing == ((2.5, 2.5) if name.endswith(".asc") else None)
    assert data.origin is None and not data.is_image


def test_an_archive_may_say_spacing_and_origin(write):
    both = archive_bytes(height=HEIGHTS, spacing=[2.0, 3.0], origin=np.array([-4, 5]))
    data = read_grid(write("a.npz", both), "hill")
    assert data.spacing == (2.0, 3.0) and data.origin == (-4.0, 5.0)
    assert read_grid(write("b.npz", archive_bytes(height=HEIGHTS, spacing=0.5)), "hill").spacing == (0.5, 0.5)


def test_an_image_is_read_from_black_to_white(write):
    values = np.random.default_rng(13).integers(0, 65536, (6, 5))
    data = read_grid(write("hill.png", png_bytes(values, depth=16)), "hill")
    np.testing.assert_allclose(data.heights, values / 65535)
    assert data.is_image


@pytest.mark.parametrize(("kind", "most"), [(np.uint8, 255.0), (np.uint16, 65535.0), (np.float32, None)])
def test_a_tiff_is_read_where_there_is_a_library(tmp_path, kind, most):
    image = pytest.importorskip("PIL.Image")
    values = np.random.default_rng(14).integers(0, 250, (6, 5)).astype(kind)
    image.fromarray(values).save(tmp_path / "hill.tif")
    data = read_grid(tmp_path / "hill.tif", "hill")
    np.testing.assert_allclose(data.heights, values / (most or 1.0))
    assert data.is_image == (most is not None)


def test_a_tiff_without_a_library_says_what_to_do(write, monkeypatch):
    monkeypatch.setitem(sys.modules, "PIL", None)
    with pytest.raises(MissingLibraryError, match="Pillow is needed for reading TIFF images: .* save the image as PNG"):
        read_grid(write("hill.tif", b"II*\0"), "hill")


def test_holes_are_left_for_the_ground_to_name(write):
    survey = ESRI + table(" ").replace(str(HEIGHTS[1, 2]), "-9999")
    assert math.isnan(read_grid(write("holes.asc", survey), "hill").heights[1, 2])
    assert math.isnan(read_grid(write("holes.csv", table(",").replace(str(HEIGHTS[1, 2]), "")), "hill").heights[1, 2])


@pytest.mark.parametrize(
    ("name", "content", "line"),
    [
        ("hill.obj", "", "files ending in .obj are not known as grids: give one of .npy, .npz, .csv"),
        ("hill", "", "files ending in nothing are not known as grids"),
        ("words.csv", "1,2,3,4\n1,2,low,4\n", 'line 2, column 3: "low" is not a number: write heights in metres'),
        ("heading.csv", "x,y,z\n1,2,3\n", 'line 1, column 1: "x" is not a number'),
        ("decimals.csv", "1,5;2,5\n", 'line 1, column 1: "1,5" is not a number: write heights in metres, with a point'),
        ("short.csv", "# x\n1,2,3\n1,2\n", "line 3 has 2 numbers, the first row has 3: give rows of one length"),
        ("empty.csv", "\n# nothing\n", "it is empty: give a row of heights on each line"),
        ("picture.csv", b"\x89PNG\xff\xfe", "it is not a text file: give a row of heights"),
        ("no_rows.asc", "ncols 5\ncellsize 2\n1 2 3\n", "its header has no nrows: an ESRI ASCII grid begins with"),
        ("odd.asc", ESRI.replace("cellsize 2.5", "cellsize -1"), "its header has no cellsize"),
        ("short.asc", ESRI + "1 2 3\n", "it has 3 heights, its header says 6 x 5 = 30: export it again"),
        ("none.asc", ESRI, "it has 0 heights, its header says 6 x 5 = 30"),
        ("words.asc", ESRI + "1 2 x\n", 'line 7, column 3: "x" is not a number'),
        ("huge.asc", ESRI.replace("ncols 5", "ncols 50000000"), "it has 6 x 50000000 samples, allowed are 64 million"),
        ("text.npy", "1 2 3", "it is not a whole numpy array"),
        ("cut.npy", array_bytes(HEIGHTS)[:-8], "it is not a whole numpy array"),
        ("words.npy", array_bytes(np.full((5, 5), "high")), "its heights are of type <U4, not numbers"),
        ("objects.npy", array_bytes(np.full((5, 5), None), allow_pickle=True), "its heights are of type object"),
        ("flat.npy", array_bytes(np.zeros(30)), "its heights are 30, not a table of rows and columns"),
        ("row.npy", array_bytes(np.zeros((1, 30))), "it has 1 x 30 samples, at least 4 x 4 are needed"),
        ("text.npz", "1 2 3", "it is not a numpy archive"),
        ("other.npz", archive_bytes(z=HEIGHTS), "it has no array height (it has z): save it with numpy.savez"),
        ("spacing.npz", archive_bytes(height=HEIGHTS, spacing=[1.0, 2.0, 3.0]), "its spacing has 3 numbers"),
        ("origin.npz", archive_bytes(height=HEIGHTS, origin=["a", "b"]), "its origin is not an array of numbers"),
        ("colour.png", png_bytes(np.zeros((5, 5, 3)), kind=2), "it is in colour: save it as grey"),
        ("small.png", png_bytes(np.zeros((2, 5))), "it has 2 x 5 samples, at least 4 x 4 are needed"),
        ("text.png", "1 2 3", "it is not a PNG image: save it as one"),
    ],
)
def test_what_is_no_grid_is_said_in_one_line(write, name, content, line):
    assert line_of(write(name, content)).startswith(line)


def test_the_size_is_known_before_the_heights_are_read(write):
    """A header that promises a billion heights is refused, however small the file."""
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"descr": "<f8", "fortran_order": False, "shape": (40000, 40000)})
    assert line_of(write("huge.npy", stream.getvalue())).startswith("it has 40000 x 40000 samples, allowed are 64")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("height.npy", stream.getvalue())
    assert line_of(write("huge.npz", packed.getvalue())).startswith("it has 40000 x 40000 samples, allowed are 64")


def test_a_missing_file_is_missing_input(tmp_path):
    for suffix in READERS:
        with pytest.raises(MissingInputError, match="there is no such file") as caught:
            read_grid(tmp_path / f"nowhere{suffix}", "hill")
        assert caught.value.exit_code == 3
    (tmp_path / "folder.npy").mkdir()
    with pytest.raises(MissingInputError, match="it is a folder, not a grid of heights"):
        read_grid(tmp_path / "folder.npy", "hill")
