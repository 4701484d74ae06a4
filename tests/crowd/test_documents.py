"""Crowd documents: what is read from them, written again, and said of mistakes."""

from __future__ import annotations

import dataclasses

import pytest

from ski_addon.crowd import CrowdSpec, MemberRun, find_crowd, read_crowd, write_crowd
from ski_addon.crowd.documents import CROWD_KIND
from ski_addon.errors import MissingInputError, SkiAddonError, SpecError
from ski_addon.spec import find_document, list_presets
from tests.crowd.crowds import crowd_of
from tests.ski_runs import preset

PRESETS = list_presets(CROWD_KIND)


def test_there_are_races_and_free_skiing():
    assert {"giant_slalom_race", "pursuit_race", "mass_start", "free_skiing"} <= {shown.identifier for shown in PRESETS}


@pytest.mark.parametrize("shown", PRESETS, ids=lambda shown: shown.identifier)
def test_a_shipped_crowd_is_read(shown):
    crowd = read_crowd(shown.path)
    assert (crowd.name, crowd.description) == (shown.name, shown.description)
    assert crowd.crowd.count >= 5 and len(shown.description) > 10


def test_what_is_written_is_read_again(tmp_path):
    crowd = dataclasses.replace(read_crowd(find_crowd("free_skiing")), name='Läufe "⛷"')
    assert read_crowd(write_crowd(crowd, tmp_path)) == crowd


def test_a_run_is_a_crowd_of_that_run(tmp_path):
    crowd = read_crowd(find_crowd("medium_carving"))
    assert crowd == CrowdSpec((MemberRun(preset("medium_carving")),), crowd.name, crowd.description)


def test_parts_and_changes_are_laid_over_every_run():
    part = find_document("soft", ("snow",))
    crowd = read_crowd(find_crowd("free_skiing"), [part], {"crowd.count": "4", "course.turn_count": "2"})
    assert crowd.crowd.count == 4 and {run.spec.course.turn_count for run in crowd.runs} == {2}
    soft = preset("medium_carving").with_part(part).snow
    assert {run.spec.snow for run in crowd.runs} == {soft}


def test_rows_take_turns():
    crowd = read_crowd(find_crowd("free_skiing"))
    first, second = crowd.runs
    assert [crowd.run_of(index) for index in range(6)] == [first, first, second] * 2


RUN = '[[run]]\nspec = "medium_carving"\n'


@pytest.mark.parametrize(
    ("written", "words"),
    [
        ("[crowd]\ncount = 0\n" + RUN, "bad.toml line 2: crowd.count = 0 is outside 1..999 skiers"),
        (
            "[crowd]\ncuont = 3\n" + RUN,
            "bad.toml line 2: crowd.cuont is not a key of a crowd: did you mean crowd.count",
        ),
        ("[crowd]\napart = -1\n" + RUN, "line 2: crowd.apart = -1 is outside 0..50 m"),
        ('[spread]\nwomen = "many"\n' + RUN, 'line 2: spread.women = "many" is not a number'),
        ("[crowds]\n" + RUN, "line 1: crowds is not a key of a crowd: did you mean crowd?"),
        ("crowd = 3\n" + RUN, "line 1: crowd = 3 is not a table: write its keys under [crowd]"),
        ("[crowd]\ncount = 3\n", "bad.toml: run is missing: write [[run]]"),
        ('[[run]]\nspec = ""\n', "line 2: run 1: spec is missing"),
        ("[[run]]\nrepeat = 2\n", "run 1: spec is missing: write spec under [[run]]"),
        (RUN + "repeat = 0\n", "line 3: run 1: repeat = 0 is outside 1..999 skiers"),
        (RUN + 'style = "racing"\nspeed = 3\n', "line 4: run 1: speed is not a key of [[run]]"),
        (RUN + "[all.course]\nturn_radus = 3\n", "all.course.turn_radus is not a key of a run: did you mean"),
        (
            "[spread]\noffset = 3\n" + '[[run]]\nspec = "slalom"\n',
            "spread.offset = 3.0 moves lines away from the gates",
        ),
        ("[spread]\noffset = 3\n" + '[[run]]\nspec = "moguls"\n', "moves a line off the ground it is made for"),
        ('[[run]]\nspec = "snowboard_carving"\n', 'figure.kind = "snowboard" has no whole physics'),
        (RUN + '[[run]]\nspec = "short_turns"\n', "run 2: slope.angle_deg = 8.0 is not that of run 1 (8.5)"),
        ("[spread]\nhight = 1\n" + RUN, "line 2: spread.hight is not a key of a crowd: did you mean spread.height"),
        ("[spread]\nradius = -0.1\n" + RUN, "line 2: spread.radius = -0.1 is outside 0..0.5"),
        ('[[run]]\nspec = "rolling_slalom"\noffset = 3\n', "run 1: offset = 3.0 moves a line off the ground"),
    ],
)
def test_a_mistake_is_one_line_with_its_place(tmp_path, written, words):
    path = tmp_path / "bad.toml"
    path.write_text(written, encoding="utf-8")
    with pytest.raises(SpecError) as caught:
        read_crowd(path)
    assert words in str(caught.value) and "\n" not in str(caught.value), str(caught.value)


def test_what_is_missing_is_named(tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text('[[run]]\nspec = "nobody.toml"\n', encoding="utf-8")
    with pytest.raises(MissingInputError, match=r"nobody\.toml"):
        read_crowd(path)
    with pytest.raises(MissingInputError, match="did you mean free_skiing"):
        find_crowd("free_sking")
    with pytest.raises(MissingInputError, match=r"crowds/giant_slalom_race or runs/giant_slalom_race"):
        find_crowd("giant_slalom_race")


@pytest.mark.parametrize(
    ("row", "words"), [('style = "racign"', "did you mean racing"), ('skier = "no.toml"', r"no\.toml")]
)
def test_an_unknown_part_is_named(tmp_path, row, words):
    path = tmp_path / "bad.toml"
    path.write_text(f"{RUN}{row}\n", encoding="utf-8")
    with pytest.raises(MissingInputError, match=words):
        read_crowd(path)


def test_a_document_with_comments_is_left_as_it_is(tmp_path):
    path = tmp_path / "crowd.toml"
    path.write_text(f"# mine\n{RUN}", encoding="utf-8")
    assert write_crowd(read_crowd(path), tmp_path) == path
    assert path.read_text(encoding="utf-8").startswith("# mine") and list(tmp_path.iterdir()) == [path]


def test_a_changed_key_is_checked():
    with pytest.raises(SkiAddonError, match=r"crowd\.seed = -1 is outside"):
        crowd_of(changes={"crowd.seed": "-1"})


def test_a_wrong_option_is_not_blamed_on_the_document():
    with pytest.raises(SpecError, match=r"^crowd\.count = 0 is outside"):
        read_crowd(find_crowd("pursuit_race"), (), {"crowd.count": 0})
    with pytest.raises(SpecError, match=r"^course\.turn_radius = 1 is outside"):
        read_crowd(find_crowd("pursuit_race"), (), {"course.turn_radius": 1})
