"""Properties that hold for all values, tried on many by hypothesis: the same ones every time."""

from __future__ import annotations

import math
import string

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from ski_addon.errors import SkiAddonError, SpecError, one_line, show_value
from ski_addon.spec import FieldInfo, RunSpec, field_table
from ski_addon.spec.fields import CHOICE, FLAG, NUMBER, PLACES, ROWS, TEXT, WHOLE
from ski_addon.tasks.frame_list import frame_words, read_frames

EVERY_TIME = settings(
    derandomize=True,
    deadline=None,
    max_examples=60,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)
FIELDS = [info for key, info in field_table().items() if key != "slope.grid_file"]
NUMBERS = [info for info in FIELDS if info.kind in (NUMBER, WHOLE)]


def values_of(info: FieldInfo) -> st.SearchStrategy:
    """Every value that a key may have."""
    if info.kind == FLAG:
        return st.booleans()
    if info.kind == CHOICE:
        return st.sampled_from(info.choices)
    if info.kind == TEXT:
        return st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=int(info.high))
    if info.kind == WHOLE:
        return st.integers(int(info.low), int(info.high))
    numbers = st.floats(info.low, info.high, allow_nan=False)
    if info.kind == PLACES:
        return st.lists(st.tuples(numbers, numbers).map(list), max_size=4)
    if info.kind == ROWS:
        row = st.fixed_dictionaries({field.name: values_of(field) for field in info.row_fields})
        return st.lists(row, max_size=3)
    return numbers | st.just(info.word) if info.word else numbers


changes = st.lists(st.sampled_from(FIELDS), min_size=1, max_size=6, unique_by=lambda info: info.key).flatmap(
    lambda infos: st.fixed_dictionaries({info.key: values_of(info) for info in infos})
)


def changed(values) -> RunSpec:
    """The default run with these values; keys that contradict each other are not what is tried."""
    try:
        return RunSpec().with_overrides(values)
    except SkiAddonError as error:
        assert str(error) == one_line(str(error))
        assume(False)
        raise


@EVERY_TIME
@given(changes)
def test_a_run_document_goes_round(values):
    spec = changed(values)
    again = RunSpec.from_text(spec.to_toml())
    assert again == spec and again.content_hash() == spec.content_hash() and again.to_toml() == spec.to_toml()


@EVERY_TIME
@given(changes)
def test_runs_that_differ_have_different_hashes(values):
    spec = changed(values)
    assert (spec == RunSpec()) == (spec.content_hash() == RunSpec().content_hash())


@EVERY_TIME
@given(st.sampled_from(NUMBERS), st.floats(1e-3, 1e12), st.booleans())
def test_a_number_out_of_range_is_refused_by_name_and_range(info, beyond, above):
    value = info.high + beyond * max(abs(info.high), 1.0) if above else info.low - beyond * max(abs(info.low), 1.0)
    value = math.ceil(value) if info.kind == WHOLE and above else math.floor(value) if info.kind == WHOLE else value
    with pytest.raises(SpecError) as caught:
        RunSpec().with_overrides({info.key: value})
    assert caught.value.field == info.key and info.allowed.split(" ")[0] in str(caught.value)


@EVERY_TIME
@given(st.sampled_from(NUMBERS), st.sampled_from([math.nan, math.inf, -math.inf, "nan", "1e999", "[1]", "{}", "''"]))
def test_what_is_no_number_is_refused_by_name(info, value):
    with pytest.raises(SpecError) as caught:
        RunSpec().with_overrides({info.key: value})
    assert caught.value.field == info.key


@EVERY_TIME
@given(st.text(st.sampled_from(string.printable + "é\u2028\x00"), max_size=200))
def test_any_text_is_a_run_document_or_one_line_says_why_not(written):
    try:
        assert isinstance(RunSpec.from_text(written), RunSpec)
    except SkiAddonError as error:
        assert str(error) and "\n" not in str(error)


@EVERY_TIME
@given(
    st.recursive(
        st.none() | st.booleans() | st.floats() | st.text(),
        lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    )
)
def test_any_value_can_be_shown_on_one_short_line(value):
    shown = show_value(value)
    assert "\n" not in shown and len(shown) <= 80


@EVERY_TIME
@given(st.sets(st.integers(-500, 3000), min_size=1, max_size=60), st.booleans())
def test_frames_are_read_as_they_are_said(frames, steps):
    assert read_frames(frame_words(sorted(frames), steps=steps)) == sorted(frames)


@EVERY_TIME
@given(st.text(max_size=30))
def test_any_text_is_a_list_of_frames_or_refused(written):
    try:
        frames = read_frames(written)
    except SpecError:
        return
    assert frames == sorted(set(frames)) and np.all(np.abs(frames) <= 1_048_574)
