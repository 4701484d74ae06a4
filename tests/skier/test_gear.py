"""Snowboarder, telemark skier and cyclist: wholly bound, of the right size, gear that fits the person."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from ski_addon.blender.skier.bicycle import GRIP_LENGTH, bicycle_points
from ski_addon.blender.skier.build import WARDROBE, figure_parts
from ski_addon.blender.skier.figure import Figure, figure_of
from ski_addon.blender.skier.paints import OTHER_FIGURES, PALETTE
from ski_addon.blender.skier.shapes import Part
from ski_addon.blender.skier.snowboard import binding_places
from ski_addon.blender.skier.telemark import telemark_boots
from ski_addon.frames import rotation_about
from ski_addon.spec import RunSpec
from ski_addon.turning.figures import build_figure

KINDS = tuple(WARDROBE)
PEOPLE = {"small": {"skier.height": 1.2, "skier.mass": 30}, "tall": {"skier.height": 2.0, "skier.mass": 110}}


def figure(kind: str, **changes: float | str) -> Figure:
    return figure_of(build_figure(RunSpec().with_overrides({"figure.kind": kind, **changes})))


@pytest.fixture(scope="module", params=[(kind, person) for kind in KINDS for person in PEOPLE], ids="-".join)
def dressed(request) -> tuple[Figure, dict[str, Part]]:
    kind, person = request.param
    made = figure(kind, **PEOPLE[person])
    return made, figure_parts(made)


@pytest.fixture(scope="module")
def parts() -> dict[str, dict[str, Part]]:
    return {kind: figure_parts(figure(kind)) for kind in KINDS}


def test_every_vertex_is_used_and_wholly_bound(dressed) -> None:
    for name, part in dressed[1].items():
        assert {index for face in part.faces for index in face} == set(range(len(part.vertices))), name
        assert len(part.materials) == len(part.faces)
        np.testing.assert_allclose(sum(part.weights.values()), 1.0, atol=1e-9, err_msg=name)


def test_gear_goes_with_its_body(dressed) -> None:
    made, pieces = dressed
    assert set(pieces) == {"body", *made.gear}
    for name in made.gear:
        assert list(pieces[name].weights) == [name]


def test_nothing_is_below_the_ground_and_something_on_it(dressed) -> None:
    low = {name: part.vertices[:, 2].min() for name, part in dressed[1].items()}
    assert min(low.values()) == pytest.approx(0.0, abs=1e-9)


def test_paints_are_just_those_that_are_worn(parts: dict[str, dict[str, Part]]) -> None:
    worn = {kind: {m for part in pieces.values() for m in part.materials} for kind, pieces in parts.items()}
    assert worn["alpine"] == set(PALETTE)
    assert set().union(*worn.values()) == set(PALETTE) | set(OTHER_FIGURES)


def test_left_and_right_are_alike(parts: dict[str, dict[str, Part]]) -> None:
    for pieces in parts.values():
        body = pieces["body"].vertices
        distance, _ = cKDTree(body).query(body * [1.0, -1.0, 1.0])
        assert distance.max() < 1e-6


def test_figures_are_low_poly(parts: dict[str, dict[str, Part]]) -> None:
    for pieces in parts.values():
        assert sum(len(part.faces) for part in pieces.values()) < 15000


def test_a_board_has_its_length_and_its_bindings_their_distance() -> None:
    made = figure("snowboard", **{"figure.board_length": 1.5, "figure.foot_distance": 0.52})
    board = figure_parts(made)["board"].vertices
    assert np.ptp(board[:, 1]) == pytest.approx(1.5, abs=1e-6)  # it lies across under the rider
    (front, _), (rear, _) = binding_places(made)
    assert front - rear == pytest.approx(0.52)


@pytest.mark.parametrize(("stance", "side"), [("regular", -1.0), ("goofy", 1.0)])
def test_bindings_face_the_side_that_the_rider_faces(stance: str, side: float) -> None:
    made = figure("snowboard", **{"figure.stance": stance, "figure.front_foot_deg": 20, "figure.rear_foot_deg": -5})
    for (_, angle), towards_nose in zip(binding_places(made), (20.0, -5.0), strict=True):
        toes = np.array([np.cos(angle), np.sin(angle)])
        assert toes[1] * side == pytest.approx(np.cos(np.deg2rad(towards_nose)))
        assert toes[0] == pytest.approx(np.sin(np.deg2rad(towards_nose)))


def test_wheels_stand_on_the_ground_and_turn_round_their_axles(dressed) -> None:
    made, pieces = dressed
    for name in ("wheel_rear", "wheel_front"):
        if name not in pieces:
            continue
        away = (pieces[name].vertices - made.place[name])[:, [0, 2]]
        assert np.linalg.norm(away, axis=1).max() == pytest.approx(made.sizes["wheel_radius"], abs=1e-9)


def test_a_bicycle_hangs_together() -> None:
    """Each tube ends within the piece that it joins."""
    made = figure("bicycle")
    pieces, points = figure_parts(made), bicycle_points(made)
    for name, places in {
        "frame": (points.rear + [0, 0.062, 0], points.bottom, points.seat, points.head),
        "fork": (points.front + [0, 0.058, 0], points.bar, points.head),
        "crank": (points.bottom, made.place["pedal.L"], made.place["pedal.R"]),
    }.items():
        for place in places:
            assert np.linalg.norm(pieces[name].vertices - place, axis=1).min() < 0.045, name
    bar = pieces["fork"].vertices
    assert np.ptp(bar[:, 1]) == pytest.approx(made.sizes["bar_width"] + GRIP_LENGTH, abs=0.002)


def test_a_fork_clears_its_wheel() -> None:
    made = figure("bicycle")
    legs = figure_parts(made)["fork"].vertices
    away = np.linalg.norm((legs - made.place["wheel_front"])[:, [0, 2]], axis=1)
    beside = np.abs(legs[:, 1]) < 0.022
    assert away[beside & (legs[:, 2] < 0.9)].min() > made.sizes["wheel_radius"] + 0.003


def test_a_telemark_boot_lifts_its_heel_and_keeps_its_toes_on_the_ski() -> None:
    made = figure("telemark")
    part = telemark_boots(made)
    ankle, ski = made.place["foot.L"], made.place["ski.L"]
    pivot = ski + [made.sizes["pivot_forward"], 0.0, made.sizes["pivot_height"]]
    turned = (part.vertices - pivot) @ rotation_about("y", np.deg2rad(35.0)).T + pivot
    on_ski, left = part.weights["ski.L"], part.vertices[:, 1] > 0.0
    moved = on_ski[:, None] * part.vertices + (1.0 - on_ski)[:, None] * turned
    toes = left & (part.vertices[:, 0] > pivot[0] + 0.03)
    heel = left & (part.vertices[:, 0] < ankle[0] - 0.05) & (part.vertices[:, 2] < made.sole + 0.01)
    assert toes.sum() > 20 and heel.sum() > 5
    np.testing.assert_allclose(moved[toes], part.vertices[toes], atol=1e-9)
    assert moved[heel, 2].min() > made.sole + 0.08
    low = left & (part.vertices[:, 2] < ankle[2])
    assert moved[low, 2].min() > made.sole - 0.012  # the sole gives a little where it bends
