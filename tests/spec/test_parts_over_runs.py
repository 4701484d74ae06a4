"""Parts laid over runs, and presets whose words are true of their numbers."""

from __future__ import annotations

import itertools
import re

import pytest

from ski_addon.spec import PART_KINDS, RunSpec, estimate, list_presets

RUNS = list_presets("runs")
PARTS = {kind: list_presets(kind) for kind in PART_KINDS}
MANNER = {kind: presets for kind, presets in PARTS.items() if kind != "courses"}
"""Parts that leave the course alone."""
SECTION_OF = {"courses": "course", "skiers": "skier", "snow": "snow", "styles": "technique"}
WORDS = {"one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8, "nine": 9, "ten": 10}


def part(kind: str, identifier: str) -> RunSpec:
    """A run of defaults with the part laid over it."""
    return RunSpec().with_part(next(p.path for p in PARTS[kind] if p.identifier == identifier))


def parts(kind: str) -> dict[str, RunSpec]:
    return {preset.identifier: part(kind, preset.identifier) for preset in PARTS[kind]}


def identifiers(presets):
    return [preset.identifier for preset in presets]


@pytest.mark.parametrize("run", RUNS, ids=identifiers(RUNS))
def test_every_skier_snow_and_style_fits_every_run_in_any_order(run):
    base = RunSpec.from_toml(run.path)
    for rank in range(12):
        chosen = [presets[rank % len(presets)] for presets in MANNER.values()]
        results = set()
        for order in (chosen, chosen[::-1]):
            spec = base
            for preset in order:
                spec = spec.with_part(preset.path)
            results.add(spec)
        (spec,) = results
        assert spec.validate().course == base.course and spec.slope == base.slope and spec.name == base.name
        assert RunSpec.from_text(spec.to_toml()) == spec


@pytest.mark.parametrize("kind", PART_KINDS)
def test_part_laid_twice_is_laid_once(kind):
    for preset in PARTS[kind]:
        once = RunSpec().with_part(preset.path)
        assert once.with_part(preset.path) == once


@pytest.mark.parametrize("kind", PART_KINDS)
def test_parts_of_a_kind_differ_in_more_than_their_names(kind):
    assert len(set(parts(kind).values())) == len(PARTS[kind])


def test_later_part_of_a_kind_wins():
    soft = next(preset.path for preset in PARTS["snow"] if preset.identifier == "soft")
    for preset in PARTS["snow"]:
        assert RunSpec().with_part(preset.path).with_part(soft).snow == part("snow", "soft").snow


@pytest.mark.parametrize("run", RUNS, ids=identifiers(RUNS))
def test_numbers_in_a_runs_description_are_its_own(run):
    spec = RunSpec.from_toml(run.path)
    for radius in re.findall(r"turns of (\d+) m", run.description):
        assert float(radius) == spec.course.turn_radius
    for radius in re.findall(r"(\d+) m$", run.name):
        assert float(radius) == spec.course.turn_radius
    for angle in re.findall(r"\bon (\d+) degrees", run.description):
        assert float(angle) == spec.slope.angle_deg
    counted = re.match(r"(\w+) turns of", run.description)
    if counted and counted[1].lower() in WORDS:
        assert spec.course.turn_count == WORDS[counted[1].lower()]


def test_words_about_runs_are_true_of_each_other():
    spec = {preset.identifier: RunSpec.from_toml(preset.path) for preset in RUNS}
    gentle, short = spec["beginner_turns"], spec["short_turns"]
    assert gentle.slope.angle_deg < min(spec[name].slope.angle_deg for name in ("short_turns", "giant_slalom"))
    assert gentle.course.start_speed == min(run.course.start_speed for run in spec.values())
    assert short.course.turn_radius == min(run.course.turn_radius for run in spec.values())
    assert short.course.turn_duration == min(run.course.turn_duration for run in spec.values())
    fastest = sorted(spec, key=lambda name: spec[name].course.start_speed)[-2:]
    assert fastest == ["giant_slalom", "deep_carving"]  # "Fast", and "Racing"
    assert spec["paper_r25"].course.turn_radius == max(run.course.turn_radius for run in spec.values())
    assert spec["paper_fig15"].course.transition_duration < spec["paper_main"].course.transition_duration
    for name in ("beginner_turns", "short_turns", "giant_slalom", "medium_carving"):
        course = spec[name].course  # "down the fall line": half a first turn leads off straight downhill
        assert course.half_first_turn and course.entry == "straight"


def test_paper_runs_of_another_radius_differ_in_nothing_else_that_is_skied():
    main = RunSpec.from_toml(next(p.path for p in RUNS if p.identifier == "paper_main"))
    for identifier, radius in (("paper_r10", 10), ("paper_r25", 25)):
        other = RunSpec.from_toml(next(p.path for p in RUNS if p.identifier == identifier))
        speed = other.course.start_speed
        same = main.with_overrides({"course.turn_radius": radius, "course.start_speed": speed})
        assert same.to_dict() | {"name": 0, "description": 0} == other.to_dict() | {"name": 0, "description": 0}


@pytest.mark.parametrize("preset", PARTS["skiers"], ids=identifiers(PARTS["skiers"]))
def test_numbers_in_a_skiers_description_are_its_own(preset):
    skier = RunSpec().with_part(preset.path).skier
    stated = 0
    for pattern, value in (
        (r"(\d\.\d+) m\b", skier.height),
        (r"(\d+) kg", skier.mass),
        (r"(\d+) m sidecut", skier.ski_sidecut_radius),
    ):
        for number in re.findall(pattern, preset.description):
            assert float(number) == value
            stated += 1
    assert stated
    if re.search(r"\b(wo)?man\b", preset.description):
        assert skier.sex == ("female" if "woman" in preset.description else "male")
    if "without air drag" in preset.description:
        assert skier.drag_area == 0


def test_words_about_skiers_are_true_of_each_other():
    skier = {name: spec.skier for name, spec in parts("skiers").items()}
    assert skier["heavy"].mass == max(one.mass for one in skier.values())
    assert skier["junior"].height == min(one.height for one in skier.values())
    assert skier["junior"].ski_mass == min(one.ski_mass for one in skier.values())
    assert skier["racer"].strength == max(one.strength for one in skier.values())
    assert skier["racer"].ski_length > skier["racer"].height and skier["racer"].ski_sidecut_radius == 30


def test_words_about_snow_are_true_of_each_other():
    snow = {name: spec.snow for name, spec in parts("snow").items()}
    at_10 = {name: one.friction + 10 * one.friction_per_speed for name, one in snow.items()}
    assert snow["icy"].hardness == max(one.hardness for one in snow.values())  # "fast and very hard"
    assert at_10["icy"] == min(at_10.values())
    assert at_10["spring"] == max(at_10.values())  # "that brakes"
    assert snow["soft"].hardness == min(one.hardness for one in snow.values())  # "the skis sink in"
    assert at_10["soft"] > at_10["hard_piste"]  # "slow"
    assert snow["hard_piste"].shear_strength > snow["soft"].shear_strength  # "firm grip"


def test_words_about_styles_are_true_of_each_other():
    style = {name: spec.technique for name, spec in parts("styles").items()}
    assert style["pendulum"].angulation == 0.0  # "leans as one, without angulation"
    assert style["paper"].angulation == -0.5  # "constant angulation of -0.5"
    assert style["natural"].angulation == "auto"
    numbers = [one.angulation for one in style.values() if one.angulation != "auto"]
    assert style["upright"].angulation == min(numbers)  # "upper body stays nearly upright"
    assert style["upright"].knee_bend_deg == min(one.knee_bend_deg for one in style.values())  # "legs stretched"
    assert style["racing"].knee_bend_deg == max(one.knee_bend_deg for one in style.values())  # "low stance"
    assert style["racing"].load_min == min(one.load_min for one in style.values())  # "light at the transitions"
    assert style["upright"].inclination_max_deg == min(one.inclination_max_deg for one in style.values())


@pytest.mark.parametrize("kind", ["runs", *PART_KINDS])
def test_texts_of_presets_are_short_and_plain_enough_for_a_menu(kind):
    for preset in list_presets(kind):
        assert len(preset.name) <= 30 and preset.name.isascii()
        assert "\n" not in preset.description and len(preset.description) <= 120
        assert preset.name[0].isupper() and not preset.description[0].islower()
        assert not preset.description.endswith(".")
        assert re.fullmatch(r"[a-z0-9_]+", preset.identifier)


def test_estimates_of_runs_do_not_depend_on_the_part():
    for run in RUNS:
        base = RunSpec.from_toml(run.path)
        for preset in itertools.chain(*MANNER.values()):
            assert estimate(base.with_part(preset.path)) == estimate(base)
