"""Frames into a folder, with a stand-in for Blender: what is rendered, what is kept, what is said."""

from __future__ import annotations

import json

import pytest

from ski_addon import cli, results
from ski_addon.tasks.picture import read_picture
from tests.tasks.pictures import png


class FakeFilm:
    first, last = 1, 8

    def __init__(self):
        self.rendered = []

    def render(self, frame, target):
        self.rendered.append(frame)
        target.write_bytes(png(shade=frame))


@pytest.fixture
def film(monkeypatch):
    fake = FakeFilm()
    fake.opened = []
    monkeypatch.setattr(results, "check_blender", lambda needed_for: None)
    monkeypatch.setattr(results, "open_frames", lambda blend, settings: fake.opened.append(settings) or fake)
    return fake


@pytest.fixture
def blend(tmp_path):
    (tmp_path / "skier.blend").write_bytes(b"BLENDER")
    return tmp_path / "skier.blend"


@pytest.fixture
def render(blend, capsys):
    def call(*words):
        code = cli.main(["render", str(blend), "-o", str(blend.parent / "frames"), *words])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call


def frames(blend):
    return sorted(path.name for path in (blend.parent / "frames").iterdir())


def test_all_frames_of_the_file_are_rendered_and_then_kept(film, render, blend):
    code, out, err = render("--json")
    assert (code, err) == (0, "") and film.rendered == [*range(1, 9)]
    assert json.loads(out)["rendered"] == film.rendered and frames(blend)[0] == "frame_0001.png"
    assert render("--json")[1].count('"kept": 8') == 1 and len(film.rendered) == 8


def test_asked_frames_that_are_there_need_no_blender(film, render):
    assert "rendered 3 of frames 2-4" in render("--frames", "2-4")[1]
    assert "frames 2-4 are up to date" in render("--frames", "2-4")[1] and len(film.opened) == 1


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda path: path.unlink(), ""),
        (lambda path: path.write_bytes(path.read_bytes()[:-9]), "frame_0003.png is damaged (it ends too early)"),
        (lambda path: path.write_bytes(png(shade=3)), "frame_0003.png was made from something else"),
        (lambda path: path.write_bytes(b""), "frame_0003.png is damaged (it is not a PNG picture)"),
    ],
)
def test_only_frames_that_are_not_right_are_rendered_again(film, render, blend, spoil, said):
    render("--frames", "1-5")
    before = read_picture((blend.parent / "frames" / "frame_0003.png").read_bytes())
    spoil(blend.parent / "frames" / "frame_0003.png")
    code, out, _ = render("--frames", "1-5")
    assert code == 0 and film.rendered == [1, 2, 3, 4, 5, 3] and said in out
    assert read_picture((blend.parent / "frames" / "frame_0003.png").read_bytes()) == before


def test_another_file_or_other_settings_make_other_frames(film, render, blend):
    render("--frames", "1-2")
    blend.write_bytes(b"BLENDER changed")
    render("--frames", "1-2")
    render("--frames", "1-2", "--samples", "8")
    assert film.rendered == [1, 2] * 3 and film.opened[-1].samples == 8


def test_parts_in_any_order_make_the_same_film(film, render, blend):
    for part in ("7-8", "1-3", "4-6"):
        render("--frames", part)
    assert render()[1].count("up to date") == 1 and sorted(film.rendered) == [*range(1, 9)]


def test_frames_the_file_does_not_have_are_left_out(film, render, blend):
    code, out, _ = render("--frames", "7-12")
    assert code == 0 and film.rendered == [7, 8] and "skier.blend has frames 1 to 8: 9-12 left out" in out
    assert render("--frames", "20-30")[0] == 0 and len(frames(blend)) == 2


def test_redo_renders_what_is_there(film, render):
    render("--frames", "1-2")
    render("--frames", "1-2", "--redo")
    assert film.rendered == [1, 2, 1, 2]


def test_picture_that_is_not_whole_is_exit_code_7_and_no_file(film, render, blend, monkeypatch):
    monkeypatch.setattr(film, "render", lambda frame, target: target.write_bytes(png()[:-5]))
    code, _, err = render("--frames", "1-2")
    assert code == 7 and err.count("\n") == 1 and "frame_0001.png could not be rendered" in err
    assert not (blend.parent / "frames").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--frames", "9-1"), "--frames"),
        (("--size", "big"), '--size = "big" is outside 4x4..16384x16384: write for instance 1920x1080'),
        (("--size", "2x2"), "--size"),
        (("--samples", "0"), "--samples"),
        (("--motion-blur", "9"), "--motion-blur"),
        (("--engine", "workbench", "--motion-blur"), "--motion-blur is not for workbench"),
        (("--engine", "eevee"), "invalid choice: 'eevee'"),
        (("--stop",), "--stop is for recordings"),
    ],
)
def test_wrong_options_are_named(film, render, words, said):
    code, out, err = render(*words)
    assert (code, out) == (2, "") and said in err and err.count("\n") == 1 and not film.rendered


def test_options_of_frames_are_not_for_recordings(film, capsys, tmp_path):
    assert cli.main(["render", str(tmp_path), "--frames", "1-2"]) == 2
    assert "--frames is for the frames of a .blend file" in capsys.readouterr().err


def test_missing_file_is_exit_code_3_and_leaves_no_folder(film, capsys, tmp_path):
    assert cli.main(["render", str(tmp_path / "none.blend"), "-o", str(tmp_path / "frames")]) == 3
    assert "none.blend" in capsys.readouterr().err and not (tmp_path / "frames").exists()
