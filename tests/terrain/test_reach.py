"""Bumps that are more than legs can take are explained in one line, with what would work."""

from __future__ import annotations

import dataclasses

import pytest

from ski_addon.errors import SpecError
from ski_addon.spec import SlopeSpec
from ski_addon.terrain import build_terrain, check_bumps

PAPER = SlopeSpec(kind="bumps", angle_deg=5, bump_height=3, bump_width=8)
LOW = dataclasses.replace(PAPER, bump_height=0.3)
MOGULS = SlopeSpec(kind="moguls", angle_deg=20)


def line_of(*arguments, **more):
    with pytest.raises(SpecError) as caught:
        check_bumps(*arguments, **more)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 400
    return str(caught.value)


def test_the_papers_three_metre_bumps_get_an_explanation():
    build_terrain(PAPER)  # the ground itself can be made
    assert line_of(PAPER, 0.3) == (
        "slope.bump_height = 3 is more than a skier can take: arcs meet at 73.7 degrees, crests throw stiff legs off "
        "the snow above 6.4 m/s, and the ground rises 6.00 m where legs take up 0.30 m: a height of 0.15 m would work"
    )


@pytest.mark.parametrize("absorption", [0.0, 0.05, 0.5, 1.0])
def test_no_share_of_absorption_makes_them_skiable(absorption):
    line_of(PAPER, 0.3, absorption=absorption)


def test_low_bumps_are_taken_in_part_by_the_legs():
    """Legs of ordinary travel can absorb half of 0.3 m, not all of it."""
    check_bumps(LOW, leg_travel=0.3, speed=8.0, absorption=0.5)
    assert line_of(LOW, 0.3).endswith("a height of 0.15 m would work")


def test_stiff_legs_leave_the_snow_above_the_speed_of_gravity_on_the_crest():
    check_bumps(LOW, 0.3, speed=16.1, absorption=0.0)
    line = line_of(LOW, 0.3, speed=16.3, absorption=0.0)
    assert "above 16.2 m/s" in line and line.endswith("a height of 0.29 m or a speed of 16.1 m/s would work")
    check_bumps(LOW, 0.3, speed=16.3, absorption=0.5)


def test_legs_that_cannot_move_take_up_nothing():
    check_bumps(LOW, 0.0, absorption=0.0)
    assert line_of(LOW, 0.0).endswith("make them wider")


@pytest.mark.parametrize(
    ("slope", "arguments"),
    [
        (PAPER, (0.3, 4.0, 1.0)),
        (PAPER, (0.3, 4.0, 0.05)),
        (LOW, (0.3, 25.0, 0.2)),
        (MOGULS, (0.3, 5.0, 1.0)),
        (MOGULS, (0.3, 6.0, 0.5)),
        (MOGULS, (0.3, 6.0, 0.0)),
        (dataclasses.replace(MOGULS, mogul_spacing=1.5), (0.5, 3.0, 0.9)),
    ],
)
def test_what_the_line_offers_works(slope, arguments):
    line = line_of(slope, *arguments)
    offered = line.rpartition(": ")[2]
    if "a height of" in offered:
        height = float(offered.split("a height of ")[1].split()[0])
        key = f"{slope.kind[:-1]}_height"
        check_bumps(dataclasses.replace(slope, **{key: height}), *arguments)
        line_of(dataclasses.replace(slope, **{key: round(height + 0.01, 2)}), *arguments)
    if "a speed of" in offered:
        speed = float(offered.split("a speed of ")[1].split()[0])
        check_bumps(slope, arguments[0], speed, arguments[2])


def test_moguls_name_their_own_key():
    assert line_of(MOGULS, 0.3).startswith(
        "slope.mogul_height = 0.5 is more than a skier can take: sides stand at 24.2 degrees"
    )
    check_bumps(MOGULS, 0.5, speed=9.0)


@pytest.mark.parametrize("kind", ["plane"])
def test_other_ground_is_fine(kind):
    check_bumps(SlopeSpec(kind=kind, bump_height=3.0), 0.0, 50.0)
