"""What is said about a table of pushes: rows, lines, JSON, CSV and the picture."""

from __future__ import annotations

import csv
import io
import json

import pytest

from ski_addon.errors import OutputError
from ski_addon.robustness import Case, PushTable, Row, summarise_table, write_results
from ski_addon.robustness.summary import csv_text, largest_text, summarise_rows, table_lines
from ski_addon.spec import RunSpec
from tests.robustness.fake_results import TABLE, result, table_results

HEAD_LEFT = Row(5.0, "turn", "head", "left")
SPEC = RunSpec(name="Pushed")


def one_row(**statuses: str):
    cases = {Case(HEAD_LEFT, float(force[1:])): status for force, status in statuses.items()}
    return summarise_rows([result(case, status) for case, status in cases.items()])[0]


def test_largest_force_is_the_one_below_the_first_fall():
    row = one_row(N50="recovered", N100="survived", N150="fell", N200="recovered")
    assert (row.largest_n, row.fell_at_n, row.ratio) == (100.0, 150.0, 0.5)
    assert largest_text(row) == "100 N"


def test_largest_force_of_a_row_that_never_fell_is_only_a_lower_bound():
    row = one_row(N50="recovered", N200="survived")
    assert (row.largest_n, row.fell_at_n) == (200.0, None) and largest_text(row) == ">=200 N"


def test_row_that_always_fell_survives_nothing():
    assert one_row(N50="fell", N100="fell").largest_n == 0.0


def test_summary_counts_the_forces_asked_for_and_not_those_grown():
    grown = [*table_results(), result(Case(HEAD_LEFT, 125.0), "survived")]
    summary = summarise_table(SPEC, TABLE, grown)
    assert summary["all"]["runs"] == 12 and summary["all"]["up"] == 11 and summary["all"]["recovered"] == 10
    assert summary["counts"]["150.0"]["up"] == 3 and summary["counts"]["50.0"]["recovery_max_s"] == 1.25
    assert summary["counts"]["150.0"]["ski_offset_max_m"] == pytest.approx(1.5)
    (head_left,) = [row for row in summary["rows"] if row["body"] == "head" and row["direction"] == "left"]
    assert head_left["largest_n"] == 125.0 and head_left["ratio"] == 0.625
    assert len(summary["runs"]) == 13 and summary["spec_hash"] == SPEC.content_hash()
    json.dumps(summary)


def test_lines_have_a_cell_for_every_run():
    lines = table_lines(TABLE, table_results())
    assert len(lines) == 1 + 4 + 3
    assert lines[1].split() == ["5", "turn", "head", "left", "1.2", "s", "up", "fell", "100", "N", "200", "N", "0.50"]
    assert lines[2].split()[-4:] == [">=150", "N", "-", "-"]
    assert lines[-1] == "150 N: still up 3 of 4, back in time 3"


def test_csv_has_one_line_for_every_run():
    rows = list(csv.DictReader(io.StringIO(csv_text(table_results()))))
    assert len(rows) == 12
    assert rows[0]["body"] == "head" and float(rows[0]["force_n"]) == 50.0 and rows[2]["status"] == "fell"
    assert rows[1]["recovery_s"] == "" and float(rows[0]["recovery_s"]) == 1.25


def test_files_are_written_and_an_older_picture_goes(tmp_path):
    (tmp_path / "robustness.png").write_text("old")
    write_results(tmp_path, SPEC, TABLE, table_results(), picture=False)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["robustness.csv", "robustness.json"]
    assert json.loads((tmp_path / "robustness.json").read_text())["all"]["up"] == 11


def test_nothing_is_written_when_one_file_cannot_be(tmp_path, monkeypatch):
    monkeypatch.setattr(
        "ski_addon.robustness.summary.csv_text", lambda results: (_ for _ in ()).throw(OSError(28, "full"))
    )
    with pytest.raises((OSError, OutputError)):
        write_results(tmp_path, SPEC, TABLE, table_results(), picture=False)
    assert list(tmp_path.iterdir()) == []


def test_picture_shows_every_cell_and_what_follows(tmp_path):
    pytest.importorskip("matplotlib")
    from ski_addon.robustness.plot import draw_table

    figure = draw_table(SPEC, TABLE, summarise_rows(table_results()))
    (axes,) = figure.axes
    texts = [text.get_text() for text in axes.texts]
    assert texts.count("1.2 s") == 10 and texts.count("fell") == 1 and texts.count("up") == 1
    assert {"5 m/s", "turn", "head", "ski.R", "left", "back", "50 N", "150 N", "100 N", "≥ 150 N", "0.50"} <= set(texts)
    assert len(axes.patches) == 12
    assert "still up: 11 of 12; back on the plan within 5 s: 10" in [text.get_text() for text in figure.texts]
    write_results(tmp_path, SPEC, TABLE, table_results(), picture=True)
    assert (tmp_path / "robustness.png").read_bytes().startswith(b"\x89PNG")


def test_picture_stays_within_its_edges():
    """Nothing is cut off, with long names and one row too."""
    pytest.importorskip("matplotlib")
    from ski_addon.robustness.plot import draw_table

    tables = [TABLE, PushTable((50.0,), ("upper_arm.L",), ("forward",), (12.5,), ("transition",))]
    for table in tables:
        figure = draw_table(SPEC, table, summarise_rows([result(case) for case in table.cases]))
        figure.canvas.draw()
        for text in (*figure.texts, *figure.axes[0].texts, *figure.legends[0].get_texts()):
            box = text.get_window_extent()
            assert box.x0 >= 0 and box.y0 >= 0 and box.x1 <= figure.bbox.x1 and box.y1 <= figure.bbox.y1, (
                text.get_text()
            )
