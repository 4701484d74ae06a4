"""The layout of the table."""

from __future__ import annotations

import re

import pytest

from benchmarks.measuring import Measurement
from benchmarks.table import TITLES, line, number, table

WHOLE = Measurement("step", "whole step", "us", 123.4, 567.8, 4000, 25.5, 785, 27.55, "TSID", 0.71, 0.93)
ROWS = [
    WHOLE,
    Measurement("step", "record", "us", 2, 4.0, 4000, 0.5),
    Measurement("plan", "track", "ms", 70, 80, 3, 9e4),
]


def test_columns_stand_below_their_names():
    lines = table(ROWS, {"step/whole step": 25.5}).splitlines()
    for column, cell in (
        ("median", "123"),
        ("p99", "568"),
        ("x loop", "25.5"),
        ("objects", "785"),
        ("x peer", "0.71"),
        ("p99 x", "0.93"),
    ):
        end = lines[0].index(column) + len(column)
        assert lines[3][:end].endswith(cell)


def test_subjects_have_one_heading_each():
    lines = table(ROWS).splitlines()
    assert [text for text in lines[2:] if not text.startswith(" ")] == [TITLES["step"], TITLES["plan"]]


def test_no_line_is_wider_than_the_table_even_with_long_names():
    long = Measurement(
        "step", "n" * 80, "MB/s", 123456.0, 1234567.0, 123456, 1234567.0, 99999, 12345.6, "p" * 80, 1234.5, 1234.5
    )
    lines = table([*ROWS, long], {long.key: 10.0}).splitlines()
    assert all(len(text) <= len(lines[1]) for text in lines) and len(lines[1]) <= 120


def test_what_is_not_known_is_blank():
    text = line(Measurement("files", "peer", "MB/s", 1.5, 1.0, 7))
    assert text.split() == ["peer", "MB/s", "1.50", "1.00", "7"]


@pytest.mark.parametrize(("ratio", "mark"), [(14.9, "1.49"), (15.1, "1.51!"), (5.0, "0.50")])
def test_change_is_by_the_last_one_and_marked_when_it_fails(ratio, mark):
    row = Measurement("step", "solve", "us", 1.0, 1.0, 1, ratio)
    assert mark in line(row, 10.0).split()


def test_unchecked_row_is_never_marked():
    assert "!" not in line(Measurement("files", "read", "MB/s", 1.0, 1.0, 1, 90.0, checked=False), 10.0)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, ""),
        (0.0, "0"),
        (0.123, "0.12"),
        (12.34, "12.3"),
        (99.94, "99.9"),
        (99.96, "100"),
        (9.996, "10.0"),
        (12345.6, "12346"),
    ],
)
def test_numbers_have_few_figures_and_no_exponent(value, text):
    assert number(value) == text and not re.search("e", number(value))
