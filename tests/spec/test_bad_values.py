"""Any one key with a value it may not have: refused with one line that names key, value and what is allowed."""

from __future__ import annotations

import math
import random
from typing import Any

import pytest

from ski_addon.errors import SpecError
from ski_addon.spec import RunSpec, field_table
from ski_addon.spec.fields import CHOICE, FLAG, NUMBER, TEXT, WHOLE
from tests.spec.random_documents import KEYS, NUMBERS, misspelt, nested, random_flat

INFO = field_table()
CHOICES = tuple(key for key in KEYS if INFO[key].kind == CHOICE)
FLAGS = tuple(key for key in KEYS if INFO[key].kind == FLAG)
TEXTS = tuple(key for key in KEYS if INFO[key].kind == TEXT)
DEEP: list[Any] = []
for _ in range(3000):
    DEEP = [DEEP]


def refusal(key: str, value: Any) -> str:
    """The one line that refuses `key = value` in a document that is otherwise fine."""
    content = nested(random_flat(random.Random(key), share=0.3) | {key: value})
    with pytest.raises(SpecError) as caught:
        RunSpec.from_dict(content)
    line = str(caught.value)
    assert caught.value.field == key and caught.value.exit_code == 2
    assert "\n" not in line and len(line) <= 400
    assert line.startswith(f"{key} = "), line
    return line


@pytest.mark.parametrize("key", NUMBERS)
def test_number_just_outside_its_range(key):
    info = INFO[key]
    step = 1 if info.kind == WHOLE else None
    below = info.low - 1 if step else math.nextafter(info.low, -math.inf)
    above = info.high + 1 if step else math.nextafter(info.high, math.inf)
    for value in (below, above):
        assert refusal(key, value).startswith(f"{key} = {value!r} is outside {info.allowed}: give a")
    RunSpec.from_dict(nested({key: info.low}))
    RunSpec.from_dict(nested({key: info.high}))


@pytest.mark.parametrize("key", NUMBERS)
def test_number_of_any_size_outside_its_range(key):
    for value in (-1e300, 1e300, 10**30, -(10**30), 10**5000, 16**4000):
        line = refusal(key, value)
        assert f"is outside {INFO[key].allowed}" in line


@pytest.mark.parametrize("key", NUMBERS)
def test_number_that_is_not_finite(key):
    for value in (math.nan, math.inf, -math.inf):
        assert f"{key} = {value} is not a finite number" in refusal(key, value)
        assert INFO[key].allowed in refusal(key, value)


@pytest.mark.parametrize("key", NUMBERS)
def test_number_of_the_wrong_type(key):
    for value in ("", "10", "Auto", "⛷", "x" * 10_000, "1\n2", True, False, [], [10.0], {"x": 1}, DEEP):
        line = refusal(key, value)
        named = "a whole number" if INFO[key].kind == WHOLE else "a number"
        assert f"is not {named}: give {named} in {INFO[key].allowed}" in line


@pytest.mark.parametrize("key", [key for key in NUMBERS if INFO[key].kind == WHOLE])
def test_whole_number_with_a_fraction(key):
    assert "is not a whole number" in refusal(key, INFO[key].default + 0.5)
    RunSpec.from_dict(nested({key: float(INFO[key].default)}))


@pytest.mark.parametrize("key", [key for key in NUMBERS if INFO[key].word])
def test_word_beside_a_number_is_that_word_only(key):
    word = INFO[key].word
    RunSpec.from_dict(nested({key: word}))
    for wrong in (word.upper(), word[:-1], word + " ", "none", "default"):
        assert f"or {word}" in refusal(key, wrong)


@pytest.mark.parametrize("key", CHOICES)
def test_choice_that_is_none(key):
    for value in ("", "LEFT", "⛷", "x" * 10_000, 0, 1, 1.5, True, math.nan, [], ["left"], {}, DEEP):
        assert f"is not one of {', '.join(INFO[key].choices)}: choose one of these" in refusal(key, value)


@pytest.mark.parametrize("key", FLAGS)
def test_flag_that_is_neither(key):
    for value in (0, 1, 1.0, "true", "", "yes", math.nan, [], [True], {}, DEEP, 10**5000):
        assert "is not true or false: write true or false without quotes" in refusal(key, value)


@pytest.mark.parametrize("key", TEXTS)
def test_text_that_is_none(key):
    for value in (0, 1.5, True, math.inf, [], ["x"], {}, DEEP, 10**5000):
        assert "is not text: write it in quotes" in refusal(key, value)


@pytest.mark.parametrize("key", TEXTS)
def test_text_of_any_letters_up_to_its_length(key):
    most = int(INFO[key].high)
    RunSpec.from_dict(nested({key: "⛷" * most}))
    assert f"has {most + 1} characters, allowed are at most {most}" in refusal(key, "⛷" * (most + 1))


@pytest.mark.parametrize("key", TEXTS)
def test_text_with_a_letter_that_no_terminal_and_no_file_should_get(key):
    for letter in ("\0", "\r", "\x1b", "\x7f", "\x85", "\ud800", "\x08"):
        assert "has control characters: remove them" in refusal(key, f"a{letter}b")


@pytest.mark.parametrize("key", NUMBERS)
def test_numpy_numbers_are_numbers_only_where_they_are_pythons(key):
    """np.float64 is a float; an array is refused by name instead of failing in a comparison."""
    numpy = pytest.importorskip("numpy")
    info = INFO[key]
    if info.kind == NUMBER:
        assert RunSpec.from_dict(nested({key: numpy.float64(info.low)})) == RunSpec.from_dict(nested({key: info.low}))
    assert "is not" in refusal(key, numpy.array([1.0, 2.0]))


def test_first_of_several_bad_keys_is_named_in_document_order():
    with pytest.raises(SpecError) as caught:
        RunSpec.from_dict({"bake": {"fps": 0}, "course": {"turn_radius": 0}, "skier": {"mass": 0}})
    assert caught.value.field == "skier.mass"


@pytest.mark.parametrize("key", KEYS)
def test_misspelt_key_names_the_right_one(key):
    rng = random.Random(key)
    section, dot, name = key.rpartition(".")
    tries = {section + dot + misspelt(name, rng) for _ in range(12)} - set(KEYS)
    for wrong in tries:
        with pytest.raises(SpecError) as caught:
            RunSpec().with_overrides({wrong: "1"})
        assert str(caught.value) == f"{wrong} is not a key of a run: did you mean {key}?"


@pytest.mark.parametrize("key", [key for key in KEYS if "." in key])
def test_key_under_the_wrong_section_names_the_right_one(key):
    name = key.rpartition(".")[2]
    owners = {other for other in KEYS if other.rpartition(".")[2] == name}
    for section in {other.partition(".")[0] for other in KEYS if "." in other} | {""}:
        wrong = f"{section}.{name}" if section else name
        if wrong in KEYS:
            continue
        with pytest.raises(SpecError, match="is not a key of a run") as caught:
            RunSpec.from_dict(nested({wrong: 1}))
        assert any(f"did you mean {owner}?" in str(caught.value) for owner in owners)


@pytest.mark.parametrize("section", sorted({key.partition(".")[0] for key in KEYS if "." in key}))
def test_misspelt_section_names_the_right_one(section):
    rng = random.Random(section)
    for wrong in {misspelt(section, rng) for _ in range(8)} - {section}:
        with pytest.raises(SpecError) as caught:
            RunSpec.from_dict({wrong: {}})
        assert f"[{wrong}] is not a section of a run: did you mean [{section}]?" == str(caught.value)
