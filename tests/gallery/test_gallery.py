"""The gallery: every picture can be drawn, by name, from the command line."""

from __future__ import annotations

import pytest

from ski_addon import cli
from ski_addon.errors import SpecError
from ski_addon.gallery import PICTURES, draw_picture, find_pictures


@pytest.mark.parametrize("name", PICTURES)
def test_every_picture_shows_something_and_says_what(name):
    figure = draw_picture(PICTURES[name])
    assert all(axes.lines or axes.collections or axes.patches for axes in figure.axes)
    assert any(axes.get_title(loc="left") for axes in figure.axes) and PICTURES[name].title


def test_command_writes_small_pictures(tmp_path, capsys):
    from PIL import Image

    assert cli.main(["gallery", "figure_07", "-o", str(tmp_path / "out")]) == 0
    (path,) = (tmp_path / "out").iterdir()
    with Image.open(path) as image:
        assert path.name == "figure_07.png" and image.mode == "P" and image.width <= 1200
    assert path.stat().st_size < 150_000 and "Controlling ellipses" in capsys.readouterr().out


def test_unknown_picture_is_named_with_the_nearest(tmp_path, capsys):
    with pytest.raises(SpecError, match="did you mean figure_10"):
        find_pictures(["figure_100"])
    assert cli.main(["gallery", "figure_7", "-o", str(tmp_path / "out")]) == 2
    assert "figure_07" in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_pictures_come_in_the_papers_order_and_fit_a_page():
    assert list(find_pictures([])) == list(PICTURES)
    assert all(picture.size[0] <= 12.0 for picture in PICTURES.values())
