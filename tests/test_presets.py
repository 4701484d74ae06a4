"""Shipped presets: each is a document that validates, and says what it is."""

from __future__ import annotations

import dataclasses
import tomllib

import numpy as np
import pytest

from ski_addon.errors import MissingInputError, SpecError
from ski_addon.pipeline import make_plan
from ski_addon.results import simulate_run
from ski_addon.spec import (
    PART_KINDS,
    PRESET_KINDS,
    SECTIONS,
    RunSpec,
    estimate,
    find_document,
    list_presets,
    row_kinds,
)
from ski_addon.spec.figure_section import KINDS as FIGURE_KINDS
from ski_addon.turning.figures import build_figure, figure_poses
from ski_addon.turning.preview import preview_motion

RUNS = list_presets("runs")
PHYSICAL = [preset for preset in RUNS if RunSpec.from_toml(preset.path).figure.kind == "alpine"]
"""Runs with the whole physics; the others are for the preview."""
PARTS = [preset for kind in PART_KINDS for preset in list_presets(kind)]
SECTION_OF = {"courses": "course", "skiers": "skier", "snow": "snow", "styles": "technique"}
PAPER = ("paper_main", "paper_r10", "paper_r25", "paper_fig15")
LIVELY = ("giant_slalom", "medium_carving", "short_turns")


def read(identifier):
    return RunSpec.from_toml(find_document(identifier))


def identifiers(presets):
    return [f"{preset.kind}/{preset.identifier}" for preset in presets]


def test_the_runs_that_are_promised_are_there():
    assert {preset.identifier for preset in RUNS} >= {*PAPER, *LIVELY, "beginner_turns"}


@pytest.mark.parametrize("preset", RUNS, ids=identifiers(RUNS))
def test_run_validates_and_is_of_a_size_to_try(preset):
    spec = RunSpec.from_toml(preset.path)
    assert 6 < estimate(spec).simulated_seconds < 40
    assert spec.name == preset.name and len(spec.description) > 20


@pytest.mark.parametrize("preset", PARTS, ids=identifiers(PARTS))
def test_part_changes_its_own_section_only(preset):
    content = tomllib.loads(preset.path.read_text(encoding="utf-8"))
    section = SECTION_OF[preset.kind]
    rows = set(row_kinds()) & set(content) if preset.kind == "courses" else set()
    assert set(content) == {"name", "description", section, *rows} and len(preset.description) > 10
    before = read("giant_slalom")
    after = before.with_part(preset.path)
    assert dataclasses.replace(after, **{key: getattr(before, key) for key in (section, *rows)}) == before


@pytest.mark.parametrize("kind", ["snow", "styles"])
def test_parts_of_a_kind_set_the_same_keys_so_that_one_replaces_another_fully(kind):
    keys = {frozenset(tomllib.loads(p.path.read_text("utf-8"))[SECTION_OF[kind]]) for p in list_presets(kind)}
    assert len(keys) == 1


def test_names_are_unique_within_a_kind():
    for kind in PRESET_KINDS:
        names = [preset.name for preset in list_presets(kind)]
        assert len(names) == len(set(names)) >= 4, kind


@pytest.mark.parametrize(
    ("identifier", "turns", "transition", "radius"),
    [("paper_main", 6, 1.5, 15), ("paper_r10", 6, 1.5, 10), ("paper_r25", 6, 1.5, 25), ("paper_fig15", 7, 1.0, 15)],
)
def test_paper_runs_have_the_papers_numbers(identifier, turns, transition, radius):
    spec = read(identifier)
    assert (spec.skier.mass, spec.skier.height, spec.slope.angle_deg) == (50, 1.5, 5)
    assert (spec.course.turn_count, spec.course.turn_duration, spec.course.turn_radius) == (turns, 1.0, radius)
    assert (spec.course.transition_duration, spec.course.first_turn, spec.course.entry) == (transition, "right", "turn")
    assert (spec.snow.friction, spec.snow.friction_per_speed) == (0.071, 0.004)


def test_paper_parts_are_what_the_paper_runs_use():
    spec = read("paper_main")
    for kind in PART_KINDS:
        assert spec.with_part(find_document(f"{kind}/paper", PART_KINDS)) == spec


def test_lively_runs_are_on_slopes_that_carry_them():
    for identifier in LIVELY:
        spec = read(identifier)
        assert 8 <= spec.slope.angle_deg <= 12 and 0.04 <= spec.snow.friction <= 0.06
        assert spec.technique.angulation == "auto" and spec.technique.inclination_max_deg == 45


def test_presets_are_not_all_of_one_person():
    people = {(read(p.identifier).skier.mass, read(p.identifier).skier.height) for p in RUNS}
    assert len(people) >= 4 and {read(p.identifier).skier.sex for p in RUNS} == {"male", "female"}


def test_document_is_found_by_path_by_name_and_by_folder(tmp_path):
    assert find_document("giant_slalom").name == "giant_slalom.toml"
    assert find_document("snow/paper", PART_KINDS).parent.name == "snow"
    assert find_document("soft", PART_KINDS).parent.name == "snow"
    mine = tmp_path / "run_without_suffix"
    mine.write_text("")
    assert find_document(str(mine)) == mine
    assert find_document("nowhere.toml").name == "nowhere.toml"  # reading it says that it is not there


@pytest.mark.parametrize(
    ("name", "kinds", "words"),
    [
        ("giant_slalon", ("runs",), "did you mean giant_slalom?"),
        ("zzz", ("runs",), "presets are beginner_turns, b"),
        ("paper", PART_KINDS, "say courses/paper or skiers/paper or snow/paper or styles/paper"),
        ("soft", ("runs",), "there is no such file or preset"),
    ],
)
def test_unknown_preset_names_what_there_is(name, kinds, words):
    with pytest.raises(MissingInputError, match=words):
        find_document(name, kinds)


def test_presets_of_another_folder_can_be_listed(tmp_path):
    (tmp_path / "mine.toml").write_text('description = "x"\n[snow]\nfriction = 0.1\n')
    (preset,) = list_presets("snow", tmp_path)
    assert (preset.identifier, preset.name, preset.description) == ("mine", "mine", "x")
    assert set(SECTION_OF.values()) <= set(SECTIONS)


def test_each_figure_has_a_run():
    assert {RunSpec.from_toml(preset.path).figure.kind for preset in RUNS} == set(FIGURE_KINDS)


@pytest.mark.parametrize("preset", RUNS, ids=identifiers(RUNS))
def test_every_run_can_be_previewed_to_its_end(preset):
    spec = RunSpec.from_toml(preset.path)
    motion = preview_motion(spec)
    assert motion.duration > 5.0
    if spec.course.finish == "glide":
        assert motion.speed.min() > 1.5
    figure = build_figure(spec)
    poses = figure_poses(figure, spec, motion, 4.0)
    assert poses.body_names == figure.body_names and np.all(np.isfinite(poses.position))


@pytest.mark.parametrize("preset", [p for p in RUNS if p not in PHYSICAL], ids=lambda preset: preset.identifier)
def test_runs_for_the_preview_say_so(preset):
    with pytest.raises(SpecError, match=r"figure\.kind.*preview"):
        make_plan(RunSpec.from_toml(preset.path))


@pytest.mark.slow
@pytest.mark.parametrize("preset", PHYSICAL, ids=identifiers(PHYSICAL))
def test_run_is_skied_to_its_end_within_twice_the_bounds_of_the_papers_cases(preset):
    spec = RunSpec.from_toml(preset.path)
    _, summary = simulate_run(spec, lambda fraction, text: True)
    assert summary["status"] == "finished" and summary["unconverged_steps"] == 0
    if spec.course.finish == "stop":  # skis thrown across slide on along themselves, where nobody steers them
        assert summary["ski_error_max_m"] <= 1.0 and summary["com_error_max_m"] <= 1.0
        assert summary["speed_end"] < 0.1
    else:
        assert summary["ski_error_max_m"] <= 0.010 and summary["ski_error_rms_m"] <= 0.004
        assert summary["com_error_max_m"] <= 0.010
    assert summary["torque_ratio_max"] <= 1.0
    assert summary["root_residual_max"] <= 0.05  # [N, N m]
    if preset.identifier in LIVELY:
        assert 25 <= summary["inclination_max_deg"] <= 45
