"""The run document: defaults, reading, writing, changing, checking."""

from __future__ import annotations

import dataclasses
import tomllib

import pytest

from ski_addon.errors import MissingInputError, SpecError
from ski_addon.spec import SECTIONS, CourseSpec, RunSpec, field_table, find_field, row_kinds
from ski_addon.spec.fields import CHOICE, FLAG, NUMBER, PLACES, ROWS, TEXT, WHOLE

SHORTEST = """\
[slope]
angle_deg = 9

[course]
kind = "turns"
turn_count = 6
turn_duration = 1.2
transition_duration = 1.5
turn_radius = 15
"""


@pytest.fixture
def write(tmp_path):
    def write_text(text, name="run.toml"):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write_text


def message_of(call):
    with pytest.raises(SpecError) as caught:
        call()
    assert "\n" not in str(caught.value)
    assert caught.value.exit_code == 2
    return str(caught.value)


def test_every_leaf_is_in_the_table_with_a_doc_a_label_and_bounds_its_default_keeps():
    leaves = {"name", "description", *row_kinds()} | {
        f"{s}.{f.name}" for s, c in SECTIONS.items() for f in dataclasses.fields(c)
    }
    assert set(field_table()) == leaves
    for info in (*field_table().values(), *(leaf for rows in row_kinds().values() for leaf in rows.row_fields)):
        assert info.doc and info.label, info.key
        assert info.kind in (NUMBER, WHOLE, FLAG, CHOICE, TEXT, PLACES, ROWS)
        if info.kind in (NUMBER, WHOLE) and info.default != info.word:
            assert info.low <= info.default <= info.high, info.key
        if info.kind == CHOICE:
            assert info.default in info.choices


def test_sections_of_the_spec_are_those_of_the_table():
    nested = [f.name for f in dataclasses.fields(RunSpec) if f.name not in ("name", "description")]
    assert nested == [*SECTIONS, *row_kinds()]
    assert all(isinstance(getattr(RunSpec(), section), cls) for section, cls in SECTIONS.items())


def test_defaults_of_the_contract():
    spec = RunSpec()
    assert (spec.skier.mass, spec.skier.height, spec.skier.stance_width) == (50.0, 1.5, "auto")
    assert (spec.snow.friction, spec.snow.friction_per_speed) == (0.071, 0.004)
    assert (spec.course.turn_count, spec.course.turn_duration, spec.course.transition_duration) == (6, 1.0, 1.5)
    assert (spec.course.first_turn, spec.course.entry, spec.course.half_first_turn) == ("right", "straight", False)
    assert (spec.technique.angulation, spec.technique.inclination_max_deg) == ("auto", 45.0)
    assert (spec.simulation.time_step, spec.bake.fps) == (0.001, 24.0)


def test_written_document_reads_back_equal(write):
    spec = RunSpec.from_dict(
        {
            "name": 'A "run"\n\ttwo\\three é\u00a0⛷',
            "course": {"turn_count": 3, "half_first_turn": True},
            "skier": {"ski_length": 1.7},
            "snow": {"hardness": 9e10, "shear_limit": 300},
        }
    )
    assert RunSpec.from_toml(write(spec.to_toml())) == spec
    assert list(tomllib.loads(spec.to_toml())) == ["name", "description", *SECTIONS]


def test_numbers_are_canonical_so_that_equal_documents_have_equal_hashes():
    whole, floating = RunSpec.from_dict({"course": {"turn_radius": 10}}), RunSpec(course=CourseSpec(turn_radius=10.0))
    built = RunSpec(course=CourseSpec(turn_radius=10))
    assert type(whole.course.turn_radius) is float
    assert whole.content_hash() == floating.content_hash() == built.content_hash()
    assert type(RunSpec.from_dict({"course": {"turn_count": 4.0}}).course.turn_count) is int
    assert RunSpec.from_dict({"technique": {"angulation": -0.0}}).to_toml().count("angulation = 0.0") == 1


def test_hash_is_64_hex_digits_and_changes_with_every_kind_of_key():
    spec = RunSpec()
    changes = {"name": "x", "skier.mass": 51, "course.turn_count": 7, "technique.inclination": False}
    changes |= {"course.first_turn": "left", "technique.angulation": -0.5}
    hashes = {spec.content_hash()} | {
        spec.with_overrides({key: value}).content_hash() for key, value in changes.items()
    }
    assert len(hashes) == 1 + len(changes)
    assert all(len(digest) == 64 and int(digest, 16) for digest in hashes)
    assert RunSpec().content_hash() == spec.content_hash()


def test_shortest_file_takes_defaults_for_the_rest(write):
    spec = RunSpec.from_toml(write(SHORTEST))
    assert spec == RunSpec.from_dict(tomllib.loads(SHORTEST))
    assert spec.slope.angle_deg == 9.0 and spec.skier == RunSpec().skier


@pytest.mark.parametrize("key", [key for key, info in field_table().items() if info.required])
def test_missing_required_key_is_named_with_what_to_write(write, key):
    name = key.rpartition(".")[2]
    text = "\n".join(line for line in SHORTEST.splitlines() if not line.startswith(name))
    message = message_of(lambda: RunSpec.from_toml(write(text)))
    assert f"{key} is missing" in message and f"write {name} under [" in message and find_field(key).allowed in message


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"course.turn_radius": 1.0}, "course.turn_radius = 1.0 is outside 3..200 m: give a number in that range"),
        ({"course.turn_radius": "wide"}, 'course.turn_radius = "wide" is not a number: give a number in 3..200 m'),
        ({"course.turn_radius": True}, "course.turn_radius = True is not a number"),
        ({"course.turn_radius": float("nan")}, "course.turn_radius = nan is not a finite number"),
        ({"course.turn_radius": "-inf"}, "course.turn_radius = -inf is not a finite number"),
        ({"course.turn_radius": "[15]"}, "course.turn_radius = [15] is not a number"),
        ({"course.turn_count": 0}, "course.turn_count = 0 is outside 1..500 turns"),
        ({"course.turn_count": 2.5}, "course.turn_count = 2.5 is not a whole number"),
        ({"course.turn_count": 10**400}, "is outside 1..500 turns"),
        ({"course.first_turn": "up"}, 'course.first_turn = "up" is not one of right, left'),
        ({"course.first_turn": 3}, "course.first_turn = 3 is not one of right, left"),
        ({"course.half_first_turn": 1}, "course.half_first_turn = 1 is not true or false"),
        (
            {"technique.angulation": "aut"},
            'technique.angulation = "aut" is not a number: give a number in -1..0 or auto',
        ),
        ({"technique.angulation": 0.1}, "technique.angulation = 0.1 is outside -1..0 or auto"),
        ({"technique.inclination": "auto"}, 'technique.inclination = "auto" is not true or false'),
        ({"snow.shear_limit": "none"}, "50..20000 N or unlimited"),
        ({"course.turn_radius": ""}, "course.turn_radius has no value: give one of: 3..200 m"),
        ({"course.turn_radius": "10\nturn_count = 3"}, "course.turn_radius"),
        ({"name": 3}, "name = 3 is not text"),
        ({"name": "x" * 121}, "has 121 characters, allowed are at most 120 characters"),
        ({"name": "a\x00b"}, "has control characters"),
    ],
)
def test_bad_value_is_named_with_what_is_allowed(change, words):
    assert words in message_of(lambda: RunSpec().with_overrides(change))


@pytest.mark.parametrize(
    ("key", "nearest"),
    [
        ("course.turn_raduis", "did you mean course.turn_radius?"),
        ("skier.turn_radius", "did you mean course.turn_radius?"),
        ("turn_count", "did you mean course.turn_count?"),
        ("snow.fricton", "did you mean snow.friction?"),
        ("course.turn_radius.x", "is not a key"),
        ("course", "is a section, not a key: name one of its keys, for instance course.kind"),
        ("", "is not a key"),
    ],
)
def test_unknown_key_names_the_nearest(key, nearest):
    assert nearest in message_of(lambda: RunSpec().with_overrides({key: "1"}))


def test_unknown_or_wrong_sections_are_named():
    assert "did you mean [course]?" in message_of(lambda: RunSpec.from_dict({"corse": {"turn_count": 3}}))
    assert "course = 3 is not a table" in message_of(lambda: RunSpec.from_dict({"course": 3}))
    message = message_of(lambda: RunSpec.from_dict({"course": {"turn_radius": {"x": 1}}}))
    assert message.startswith("course.turn_radius = {'x': 1} is not a number")


def test_validate_finds_what_was_built_by_hand():
    assert RunSpec().validate() == RunSpec()
    assert "course.turn_count" in message_of(lambda: RunSpec(course=CourseSpec(turn_count=0)).validate())


def test_huge_turn_counts_say_what_they_would_take():
    message = message_of(lambda: RunSpec().with_overrides({"course.turn_count": "1000000"}))
    assert "28.9 days of skiing" in message and "2500000000 steps" in message and "TB of memory" in message


def test_overrides_read_toml_values_bare_words_and_what_people_type():
    spec = RunSpec().with_overrides(
        {
            "course.turn_radius": " 10 ",
            "course.start_speed": ".5",
            "course.first_turn": "left",
            "course.half_first_turn": "true",
            "technique.angulation": "-0.5",
            "snow.hardness": "2e8",
            "skier.sex": "'female'",
            "name": "Fast run = 3",
            "description": '"quoted"',
        }
    )
    assert (spec.course.turn_radius, spec.course.start_speed, spec.course.first_turn) == (10.0, 0.5, "left")
    assert (spec.course.half_first_turn, spec.technique.angulation, spec.snow.hardness) == (True, -0.5, 2e8)
    assert (spec.skier.sex, spec.name, spec.description) == ("female", "Fast run = 3", "quoted")
    assert spec.with_overrides({"technique.angulation": "auto"}).technique.angulation == "auto"


def test_overrides_leave_the_original_alone():
    spec = RunSpec()
    assert spec.with_overrides({"skier.mass": "80"}).skier.mass == 80.0
    assert spec.skier.mass == 50.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        spec.skier.mass = 3


def test_part_changes_its_sections_only(write):
    part = write('name = "Ice"\ndescription = "hard"\n[snow]\nfriction = 0.02\n', "ice.toml")
    spec = RunSpec(name="Mine").with_part(part)
    assert spec.snow.friction == 0.02 and spec.snow.hardness == RunSpec().snow.hardness
    assert spec == dataclasses.replace(RunSpec(name="Mine"), snow=spec.snow)


def test_errors_in_a_file_name_the_file_and_the_line(write):
    path = write(SHORTEST.replace("turn_radius = 15", "turn_radius = 1"))
    assert message_of(lambda: RunSpec.from_toml(path)).startswith(f"{path} line 9: course.turn_radius = 1 is outside")
    path = write(SHORTEST + "\n[snow]\nfriktion = 1\n")
    assert f"{path} line 12: snow.friktion is not a key" in message_of(lambda: RunSpec.from_toml(path))
    path = write(SHORTEST + "\n[snau]\nfriction = 0.1\n")
    assert f"{path} line 11: [snau] is not a section" in message_of(lambda: RunSpec.from_toml(path))
    path = write("turn_radius = 3\n" + SHORTEST)
    assert f"{path} line 1: turn_radius is not a key" in message_of(lambda: RunSpec.from_toml(path))


def test_file_that_is_no_toml_names_the_line(write):
    path = write("name = 'a'\nturns == 3\n")
    message = message_of(lambda: RunSpec.from_toml(path))
    assert str(path) in message and "not valid TOML" in message and "line 2" in message


@pytest.mark.parametrize("raw", [b"\xff\xfe\x00", b"PK\x03\x04\x80\x81", b"#" * 1_000_001, b"a = " + b"[" * 5000])
def test_file_that_is_no_run_document_is_refused_in_one_line(write, raw):
    path = write(raw)
    assert str(path) in message_of(lambda: RunSpec.from_toml(path))


def test_windows_text_with_a_byte_order_mark_is_read(write):
    raw = b"\xef\xbb\xbf" + SHORTEST.replace("\n", "\r\n").encode()
    assert RunSpec.from_toml(write(raw)).course.turn_count == 6


@pytest.mark.parametrize("name", ["", "missing.toml", "bad\0name.toml"])
def test_file_that_cannot_be_read_is_a_missing_input(tmp_path, name):
    with pytest.raises(MissingInputError) as caught:
        RunSpec.from_toml(tmp_path / name)
    assert caught.value.exit_code == 3 and "\n" not in str(caught.value)


def test_text_of_a_document_can_be_read_too():
    assert RunSpec.from_text(RunSpec(name="x").to_toml()) == RunSpec(name="x")
    assert message_of(lambda: RunSpec.from_text("a = ", "the header")).startswith("the header is not valid TOML")
