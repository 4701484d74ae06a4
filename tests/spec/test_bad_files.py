"""Files that are no run documents, and what a person may write after `--set key=`."""

from __future__ import annotations

import os
import random
import re

import pytest

from ski_addon.errors import MissingInputError, SkiAddonError, SpecError
from ski_addon.spec import RunSpec, find_document
from ski_addon.spec.document import SIZE_MAX, find_line

FULL = RunSpec(name="Full").to_toml()


@pytest.fixture
def write(tmp_path):
    def write_bytes(raw, name="run.toml"):
        path = tmp_path / name
        path.write_bytes(raw if isinstance(raw, bytes) else raw.encode())
        return path

    return write_bytes


def refused(call) -> str:
    with pytest.raises(SpecError) as caught:
        call()
    line = str(caught.value)
    assert "\n" not in line and len(line) <= 400
    return line


ENDLESS = {
    "dotted key": ".".join(["a"] * 300_000) + " = 1",
    "dotted key in quotes": ".".join(['"a"'] * 150_000) + " = 1",
    "dotted section": "[" + ".".join(["course"] * 100_000) + "]",
    "dotted key in a table": "course = {" + ".".join(["a"] * 300_000) + " = 1}",
    "arrays": "[course]\nturn_radius = " + "[" * 400_000,
    "closed arrays": "[course]\nturn_radius = " + "[" * 20_000 + "]" * 20_000,
    "tables": "a = " + "{a = " * 150_000,
    "key": "[course]\n" + "turn_radius" * 80_000 + " = 1",
    "section": "[" + "course" * 150_000 + "]",
    "hexadecimal number": FULL.replace("turn_radius = 15.0", "turn_radius = 0x" + "F" * 900_000),
    "decimal number": FULL.replace("turn_radius = 15.0", "turn_radius = " + "9" * 900_000),
    "list": FULL.replace("turn_radius = 15.0", "turn_radius = [" + "1," * 50_000 + "]"),
    "text": 'name = "' + "x" * 990_000,
    "open text": "name = '''" + "\n" * 200_000,
    "sections": "".join(f"[a{i}]\n" for i in range(15_000)),
    "keys": "[course]\n" + "".join(f"a{i} = 1\n" for i in range(15_000)),
    "same key": "a = 1\n" * 150_000,
    "ten megabytes": "# nothing\n" * 1_000_000,
}


@pytest.mark.parametrize("text", ENDLESS.values(), ids=ENDLESS)
def test_endless_document_is_refused_at_once(write, text):
    path = write(text)
    assert str(path) in refused(lambda: RunSpec.from_toml(path))


def test_document_of_the_largest_size_is_read(write):
    room = SIZE_MAX - len(FULL)
    assert RunSpec.from_toml(write(FULL + "#" * room)).name == "Full"
    assert "is too large to be a run document" in refused(lambda: RunSpec.from_toml(write(FULL + "#" * (room + 1))))


@pytest.mark.parametrize(
    "raw",
    [
        b"\x89PNG\r\n\x1a\n" + bytes(range(256)),
        b"PK\x03\x04recording",
        b"\x7fELF\x02\x01\x01\x00",
        b"BLENDER-v405" + b"\0" * 50,
        FULL.encode("utf-16"),
        FULL.encode("utf-32"),
        FULL.replace("Full", "Läufe").encode("latin-1"),
        b"\0",
        b"\r" + FULL.encode().replace(b"\n", b"\r"),
        b'{"course": {"turn_count": 6}}',
        b"<?xml version='1.0'?>",
        b"course:\n  turn_count: 6\n",
    ],
)
def test_file_of_another_kind_is_refused_by_its_path(write, raw):
    path = write(raw)
    line = refused(lambda: RunSpec.from_toml(path))
    assert line.startswith(str(path)) and re.search("is not (a text file|valid TOML)", line)


@pytest.mark.parametrize("raw", [b"", b"\n\n", b"\xef\xbb\xbf", b"# only a comment"])
def test_empty_file_lacks_its_first_required_key(write, raw):
    assert "slope.angle_deg is missing" in refused(lambda: RunSpec.from_toml(write(raw)))


def test_random_bytes_and_damaged_documents_never_fail_otherwise(write):
    rng = random.Random(7)
    raw = FULL.encode()
    for count in range(150):
        if count % 3 == 0:
            bad = rng.randbytes(rng.randrange(200))
        elif count % 3 == 1:
            bad = raw[: rng.randrange(len(raw))]
        else:
            at = rng.randrange(len(raw))
            bad = raw[:at] + rng.randbytes(rng.randrange(1, 4)) + raw[at + 1 :]
        path = write(bad)
        try:
            RunSpec.from_toml(path)
        except SkiAddonError as error:
            assert str(path) in str(error) and "\n" not in str(error)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (FULL + "turn_radius = 3\n", None),
        (FULL.replace("turn_count = 6", "turn_count = 6\nturn_count = 7"), "turn_count = 7"),
        (FULL + "[course]\n", "[course]"),
        (FULL.replace("[snow]", "[course]"), "[course]"),
    ],
)
def test_key_or_section_given_twice_is_refused_with_its_line(write, text, line):
    said = refused(lambda: RunSpec.from_toml(write(text)))
    if line is None:
        assert "turn_radius is not a key of a run" in said or "bake.turn_radius" in said
    else:
        number = len(text[: text.rindex(line)].split("\n"))
        assert f"line {number}" in said and "is not valid TOML" in said


def test_lines_are_counted_as_editors_do(write):
    """A line separator within a text is no new line of the file."""
    text = FULL.replace('name = "Full"', 'name = "a\u2028b\u2028c"').replace("turn_radius = 15.0", "turn_radius = 1")
    number = 1 + text.split("\n").index("turn_radius = 1")
    assert f"run.toml line {number}: course.turn_radius = 1 is outside" in refused(
        lambda: RunSpec.from_toml(write(text))
    )


@pytest.mark.parametrize(
    ("text", "key", "line"),
    [
        ("a = 1", "a", 1),
        ("[s]\n\n  a=1", "s.a", 3),
        ("s.a = 1", "s.a", 1),
        ("[s]\nb = 1\n[t]\na = 1", "s.a", None),
        ("[ s ]\na = 1", "[s]", 1),
        ("# a = 1\n", "a", None),
        ("", "a", None),
    ],
)
def test_line_of_a_key(text, key, line):
    assert find_line(text, key) == line


def test_section_as_a_table_in_one_line_is_the_same_document(write):
    path = write(
        'course = {kind = "turns", turn_count = 3, turn_duration = 1, transition_duration = 1, turn_radius = 9}\n'
        "slope.angle_deg = 7\n"
    )
    spec = RunSpec.from_toml(path)
    assert (spec.course.turn_count, spec.course.turn_radius, spec.slope.angle_deg) == (3, 9.0, 7.0)


def test_header_where_a_text_belongs_is_refused_by_its_key(write):
    assert "name = {} is not text" in refused(lambda: RunSpec.from_toml(write(FULL.partition("\n")[2] + "[name]\n")))


@pytest.mark.parametrize("name", ["mein lauf ä ⛷.toml", "with space.toml", "-o.toml", "'quoted'.toml", "$HOME.toml"])
def test_file_of_any_name_is_read_and_named(write, name):
    assert RunSpec.from_toml(write(FULL, name)).name == "Full"
    assert name in refused(lambda: RunSpec.from_toml(write("a = 1", name)))


def test_link_is_followed_and_a_dangling_one_is_missing(write, tmp_path):
    (tmp_path / "link.toml").symlink_to(write(FULL))
    assert RunSpec.from_toml(tmp_path / "link.toml").name == "Full"
    (tmp_path / "gone.toml").symlink_to(tmp_path / "nothing.toml")
    (tmp_path / "round.toml").symlink_to(tmp_path / "round.toml")
    for name in ("gone.toml", "round.toml"):
        with pytest.raises(MissingInputError, match=name):
            RunSpec.from_toml(tmp_path / name)


def test_path_longer_than_any_file_system_takes_says_so(tmp_path):
    with pytest.raises(MissingInputError, match="File name too long$"):
        RunSpec.from_toml(tmp_path / ("x" * 300 + ".toml"))
    with pytest.raises(MissingInputError, match="File name too long$"):
        RunSpec.from_toml(tmp_path / "/".join(["deep"] * 2000))


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read everything")
def test_file_that_may_not_be_read_says_so(write):
    path = write(FULL)
    path.chmod(0)
    with pytest.raises(MissingInputError, match="Permission denied"):
        RunSpec.from_toml(path)


@pytest.mark.parametrize(
    "name",
    ["", " ", "x" * 100_000, "giant slalom", "GIANT_SLALOM", "runs/giant_slalom/", "../runs"],
    ids=lambda name: repr(name[:9]),
)
def test_name_that_is_no_preset_says_what_there_is(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(MissingInputError) as caught:
        RunSpec.from_toml(find_document(name))
    assert "\n" not in str(caught.value) and len(str(caught.value)) <= 400


@pytest.mark.parametrize(
    ("written", "value"),
    [
        ("10", 10.0),
        ("+10", 10.0),
        (" 10 ", 10.0),
        ("1_0", 10.0),
        ("1e1", 10.0),
        ("1.0E+1", 10.0),
        ("0xA", 10.0),
        ("0o12", 10.0),
        ("0b1010", 10.0),
        ("10.", 10.0),
        ("10 # metres", 10.0),
        ("010", 10.0),
    ],
)
def test_number_in_any_form_that_toml_or_people_write(written, value):
    assert RunSpec().with_overrides({"course.turn_radius": written}).course.turn_radius == value


@pytest.mark.parametrize(
    "written",
    ["ten", "10m", "10 m", "1,5", "'10'", "[10]", "{a=1}", "true", "1979-05-27", "07:32:00", "1e", "--10", "10\n11",
     "10\nvalue=3", "=10", "'", '"', "9" * 5000, "0x" + "F" * 5000, "nan", "inf", "-inf", "+nan", "1e999", "[" * 5000],
    ids=lambda written: repr(written[:9]),
)  # fmt: skip
def test_number_in_any_other_form_is_refused(written):
    assert refused(lambda: RunSpec().with_overrides({"course.turn_radius": written})).startswith(
        "course.turn_radius = "
    )


@pytest.mark.parametrize("written", ["left", "'left'", '"left"', "'''left'''", ' "left" ', '"\\u006ceft"'])
def test_word_in_any_quotes_or_none(written):
    assert RunSpec().with_overrides({"course.first_turn": written}).course.first_turn == "left"


@pytest.mark.parametrize(
    ("written", "name"),
    [
        ("", ""),
        ("  ", ""),
        ("12", "12"),
        ("true", "true"),
        ("Evening run # 3", "Evening run # 3"),
        ("a = [b]", "a = [b]"),
        ("'it is'", "it is"),
        ('"tab\\tand \\u26f7"', "tab\tand ⛷"),
        ('"never closed', '"never closed'),
        ("'a' and 'b'", "'a' and 'b'"),
    ],
)
def test_text_may_be_plain_or_quoted(written, name):
    assert RunSpec().with_overrides({"name": written}).name == name


@pytest.mark.parametrize(("written", "value"), [("true", True), ("false", False), (" true ", True)])
def test_flag_is_written_as_in_toml(written, value):
    assert RunSpec().with_overrides({"course.half_first_turn": written}).course.half_first_turn is value


@pytest.mark.parametrize("written", ["True", "yes", "1", "'true'", "on", ""])
def test_flag_in_another_form_is_refused(written):
    assert "course.half_first_turn" in refused(lambda: RunSpec().with_overrides({"course.half_first_turn": written}))
