"""Pictures say what they were made from, and whether they are as they were written."""

from __future__ import annotations

import pytest

from ski_addon.tasks.picture import PictureError, flaw, marked, read_picture
from tests.tasks.pictures import chunk, png


def test_marks_change_no_pixel():
    plain, picture = read_picture(png()), read_picture(marked(png(), "abc"))
    assert picture.size == (4, 3) and picture.pixels == plain.pixels
    assert picture.texts == {"ski_addon:key": "abc", "ski_addon:pixels": plain.pixels}


def test_texts_that_differ_from_time_to_time_are_taken_out():
    told = png()[:33] + chunk(b"tEXt", b"render_time\0" + b"00:00.03") + chunk(b"tIME", b"1234567") + png()[33:]
    assert marked(told, "abc") == marked(png(), "abc")


def test_other_pixels_and_other_sizes_have_other_digests():
    digests = {read_picture(png(*shape)).pixels for shape in ((4, 3), (3, 4), (4, 3, 8))}
    assert len(digests) == 3


def spoiled(kind):
    whole = marked(png(), "abc")
    place = whole.index(b"IDAT") + 6
    return {
        "cut": whole[:-20],
        "of half a chunk": whole[: whole.index(b"IDAT")],
        "with another bit": whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :],
        "empty": b"",
        "no picture": b"GIF89a" + whole,
        "followed by something": whole + b"x",
        "without lines": png(rows=2),
        "with pixels that are no pixels": png()[:33] + chunk(b"IDAT", b"x" * 20) + chunk(b"IEND", b""),
        "without a header": png()[:8] + chunk(b"IEND", b""),
    }[kind]


@pytest.mark.parametrize(
    "kind",
    [
        *("cut", "of half a chunk", "with another bit", "empty", "no picture", "followed by something"),
        *("without lines", "with pixels that are no pixels", "without a header"),
    ],
)
def test_picture_that_is_not_whole_is_damaged(kind, tmp_path):
    path = tmp_path / "a.png"
    path.write_bytes(spoiled(kind))
    with pytest.raises(PictureError):
        read_picture(path.read_bytes())
    assert flaw(path, "abc").startswith("is damaged (")


def test_whole_pictures_are_told_apart(tmp_path):
    path = tmp_path / "a.png"
    assert flaw(path, "abc") == "is missing"
    path.write_bytes(marked(png(), "abc"))
    assert flaw(path, "abc") == ""
    assert flaw(path, "abd") == "was made from something else"
    head, texts = png()[:33], marked(png(), "abc")[33 : -len(png()) + 33]
    path.write_bytes(head + texts + png(shade=8)[33:])  # as a program that keeps texts saves it
    assert flaw(path, "abc") == "was edited"
