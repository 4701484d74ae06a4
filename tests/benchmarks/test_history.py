"""The history: what is compared with what, what fails, and what a damaged file says."""

from __future__ import annotations

import json
from dataclasses import asdict, replace

import pytest

from benchmarks import history
from benchmarks.history import Entry, HistoryError, better_of, last, read, record, worse
from benchmarks.measuring import Measurement
from ski_addon.errors import OutputError

ENTRY = Entry("2025-01-01", "abc1234", "Some CPU", "3.11.7", "1.26.4", True, {"step/solve": 10.0})


@pytest.fixture
def here(monkeypatch):
    """The machine of `ENTRY`."""
    monkeypatch.setattr(history, "cpu", lambda: ENTRY.cpu)
    monkeypatch.setattr(history.platform, "python_version", lambda: "3.11.9")


def row(ratio: float | None, name: str = "solve", *, checked: bool = True) -> Measurement:
    return Measurement("step", name, "us", 1.0, 2.0, 3, ratio, checked=checked)


def test_recorded_entries_are_read_back_in_order(tmp_path):
    path = tmp_path / "history.jsonl"
    first = record([row(12.3456)], True, path, "a note")
    second = record([row(11.0), row(None, "a peer")], False, path)
    assert read(path) == [first, second]
    assert first.ratios == {"step/solve": 12.35} and first.note == "a note"
    assert second.ratios == {"step/solve": 11.0} and second.quick is False


def test_entry_names_the_processor_and_not_the_host(tmp_path):
    import platform

    entry = record([row(1.0)], True, tmp_path / "history.jsonl")
    assert entry.cpu and platform.node() not in json.dumps(asdict(entry))


def test_kind_of_processor_tells_generations_apart():
    text = "cpu family\t: 25\nmodel\t\t: 1\nmodel name\t: AMD EPYC\nflags\t\t: fpu avx2\n"
    assert history.cpu_kind(text) == "AMD EPYC (family 25, model 1)"
    assert history.cpu_kind(text.replace("avx2", "avx2 avx512f sha")) == "AMD EPYC (family 25, model 1, AVX-512)"
    assert history.cpu_kind("model name : Some ARM\n") == "Some ARM" and history.cpu_kind("") == ""


def test_no_history_has_no_entries(tmp_path):
    assert read(tmp_path / "none.jsonl") == [] and last([], "Some CPU") is None
    assert worse([row(99.0)], None) == []


@pytest.mark.parametrize("text", ["{", "[]", "3", '{"date": "2025-01-01"}', '{"ratios": 3}', "\x00"])
def test_damaged_history_is_one_line_that_names_file_and_line(tmp_path, text):
    path = tmp_path / "history.jsonl"
    path.write_text(json.dumps(asdict(ENTRY)) + "\n" + text + "\n", encoding="utf-8")
    with pytest.raises(HistoryError) as caught:
        read(path)
    said = str(caught.value)
    assert len(said.splitlines()) == 1 and f"{path}, line 2" in said and "mend or remove" in said


def test_ratios_that_are_no_numbers_are_refused(tmp_path):
    path = tmp_path / "history.jsonl"
    for ratios in ({"a": "fast"}, ["a"], None):
        path.write_text(json.dumps({**asdict(ENTRY), "ratios": ratios}), encoding="utf-8")
        with pytest.raises(HistoryError, match="line 1"):
            read(path)


def test_damaged_history_is_not_written_to(tmp_path):
    path = tmp_path / "history.jsonl"
    path.write_text("{\n", encoding="utf-8")
    with pytest.raises(HistoryError):
        record([row(1.0)], True, path)
    assert path.read_text(encoding="utf-8") == "{\n"


def test_the_last_entry_of_this_processor_counts_or_else_the_last_of_all():
    older, other = replace(ENTRY, commit="old"), replace(ENTRY, cpu="Another CPU")
    assert last([older, ENTRY, other], "Some CPU") is ENTRY
    assert last([older, ENTRY, other], "A third CPU") is other


def test_only_checked_rows_that_are_half_again_as_slow_fail(here):
    rows = [row(15.1), row(14.9), row(99.0, checked=False), row(99.0, "new"), row(None)]
    assert worse(rows, ENTRY) == [(rows[0], pytest.approx(1.51))]


@pytest.mark.parametrize("other", [{"cpu": "Another CPU"}, {"python": "3.13.1"}])
def test_another_processor_or_python_may_be_three_times_as_slow(here, other):
    rows = [row(29.0), row(31.0)]
    assert worse(rows, replace(ENTRY, **other)) == [(rows[1], pytest.approx(3.1))]


def test_history_that_cannot_be_written_stays_as_it_was(tmp_path, monkeypatch):
    path = tmp_path / "history.jsonl"
    record([row(1.0)], True, path)
    before = path.read_bytes()

    def full(source, target):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.replace", full)
    with pytest.raises(OutputError, match="No space left"):
        record([row(2.0)], True, path)
    assert path.read_bytes() == before and list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("content", [None, b"\xff\xfe"])
def test_history_that_is_no_text_is_one_line(tmp_path, content):
    path = tmp_path / "history.jsonl"
    path.mkdir() if content is None else path.write_bytes(content)
    with pytest.raises(HistoryError, match="cannot be read") as caught:
        read(path)
    assert len(str(caught.value).splitlines()) == 1 and str(path) in str(caught.value)


def test_what_is_too_short_to_be_timed_never_fails(here):
    short = replace(ENTRY, ratios={"step/solve": 1.0})
    assert worse([row(2.9)], short) == [] and len(worse([row(3.1)], short)) == 1


def test_a_second_try_counts_where_it_is_better():
    rows = [row(20.0), row(5.0, "build"), row(None, "a peer")]
    again = [row(11.0), row(6.0, "build"), row(3.0, "another")]
    assert better_of(rows, again) == [again[0], rows[1], rows[2]]


def test_the_shipped_history_can_be_read():
    for entry in read(history.FILE):
        assert entry.ratios and all(ratio > 0.0 for ratio in entry.ratios.values())
