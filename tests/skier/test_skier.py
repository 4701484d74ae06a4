"""The dressed skier: any person, symmetric, wholly bound, equipment of the right size and in the right place."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.blender.skier.build import EQUIPMENT, build_parts
from ski_addon.blender.skier.figure import build_figure
from ski_addon.blender.skier.shapes import Part
from ski_addon.blender.skier.skis import half_width
from ski_addon.body import Skeleton, build_skeleton, forward_kinematics
from ski_addon.body.rest import rest_configuration
from ski_addon.spec import SkierSpec

PEOPLE = [
    SkierSpec(),
    SkierSpec(mass=30, height=1.2),
    SkierSpec(mass=130, height=2.1),
    SkierSpec(mass=48, height=1.75, sex="female", ski_length=1.65),
    SkierSpec(mass=95, height=1.8, ski_width=0.1, ski_sidecut_radius=12.0, ski_length=1.8, pole_length=1.2),
]


@pytest.fixture(scope="module", params=PEOPLE, ids=lambda skier: f"{skier.height:g}m-{skier.mass:g}kg")
def skeleton(request) -> Skeleton:
    return build_skeleton(request.param)


@pytest.fixture(scope="module")
def parts(skeleton: Skeleton) -> dict[str, Part]:
    return build_parts(skeleton)


def test_every_vertex_is_wholly_bound(parts: dict[str, Part]) -> None:
    for name, part in parts.items():
        np.testing.assert_allclose(sum(part.weights.values()), 1.0, atol=1e-9, err_msg=name)
        assert all(np.all((weight >= 0) & (weight <= 1 + 1e-9)) for weight in part.weights.values()), name


def test_every_vertex_is_used_and_every_face_has_a_material(parts: dict[str, Part]) -> None:
    for name, part in parts.items():
        assert {index for face in part.faces for index in face} == set(range(len(part.vertices))), name
        assert len(part.materials) == len(part.faces)
        assert np.all(np.isfinite(part.vertices))


def test_the_skier_is_symmetric(parts: dict[str, Part]) -> None:
    for left, right in (("body", "body"), ("ski.L", "ski.R"), ("pole.L", "pole.R")):
        mirrored = parts[left].vertices * np.array([1.0, -1.0, 1.0])
        one, other = (np.round(v[np.lexsort(np.round(v, 6).T)], 6) for v in (mirrored, parts[right].vertices))
        np.testing.assert_allclose(one, other, atol=2e-6)


def test_the_skier_stands_as_tall_as_the_person(skeleton: Skeleton, parts: dict[str, Part]) -> None:
    """From sole to vertex, and a helmet of a few centimetres."""
    figure = build_figure(skeleton)
    top = parts["body"].vertices[:, 2].max() - figure.z("foot.L") + 0.039 * skeleton.height
    assert skeleton.height < top < skeleton.height + 0.06


def test_skis_lie_on_the_ground_and_have_their_length(skeleton: Skeleton, parts: dict[str, Part]) -> None:
    ski = parts["ski.L"].vertices
    assert ski[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    assert np.ptp(ski[:, 0]) == pytest.approx(skeleton.ski_length, abs=1e-6)
    assert ski[:, 0].mean() < ski[:, 0].max()


def test_the_boot_stands_on_its_ski(skeleton: Skeleton, parts: dict[str, Part]) -> None:
    body, figure = parts["body"], build_figure(skeleton)
    foot = body.vertices[body.weights["foot.L"] > 0.5]
    assert foot[:, 2].min() == pytest.approx(figure.sole, abs=1e-9)
    binding = parts["ski.L"].vertices
    assert binding[:, 2].max() > figure.sole
    assert abs(foot[:, 1].mean() - figure.place["ski.L"][1]) < 0.01


def test_poles_have_their_length_and_run_through_the_hand(skeleton: Skeleton, parts: dict[str, Part]) -> None:
    figure, pole = build_figure(skeleton), parts["pole.L"].vertices
    axis = figure.turn["pole.L"][:, 2]
    along = (pole - figure.place["pole.L"]) @ axis
    assert np.ptp(along) == pytest.approx(skeleton.pole_length, abs=1e-6)
    glove = parts["body"].vertices[parts["body"].weights["hand.L"] > 0.99]
    assert np.all(glove.min(axis=0) < figure.place["pole.L"])
    assert np.all(glove.max(axis=0) > figure.place["pole.L"])


@pytest.mark.parametrize("radius", [10.0, 15.0, 30.0])
def test_the_sidecut_has_its_radius(radius: float) -> None:
    x = np.linspace(-0.5, 0.5, 9)
    y = half_width(x, 1.6, 0.07, radius)
    assert y[4] == pytest.approx(0.035)
    centre = 0.035 + radius  # of the circle that the left side is a part of
    np.testing.assert_allclose(np.hypot(x, centre - y), radius, rtol=1e-9)


def test_equipment_is_wholly_bound_to_its_body(parts: dict[str, Part]) -> None:
    for name in EQUIPMENT:
        assert list(parts[name].weights) == [name]


def test_it_is_a_low_poly_skier(parts: dict[str, Part]) -> None:
    assert sum(len(part.faces) for part in parts.values()) < 8000


def test_rest_stands_on_the_skis(skeleton: Skeleton) -> None:
    position, rotation = forward_kinematics(skeleton, rest_configuration(skeleton)[None])
    for ski in ("ski.L", "ski.R"):
        assert position[0, skeleton.body(ski), 2] == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(rotation[0, skeleton.body("thigh.R")], np.eye(3), atol=1e-12)
