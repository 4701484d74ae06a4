"""Parts of the skier's mesh: closed, facing out, bound as asked."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.blender.skier.shapes import Part, Ring, box, chain_weights, dome, join, loft, smooth_step, stack


def volume(part: Part) -> float:
    """Signed volume: positive when the faces of a closed part look out."""
    total = 0.0
    for face in part.faces:
        for second, third in zip(face[1:], face[2:], strict=False):
            total += np.dot(part.vertices[face[0]], np.cross(part.vertices[second], part.vertices[third])) / 6.0
    return float(total)


def open_edges(part: Part) -> int:
    """Edges that do not have exactly one face in each direction."""
    seen: dict[tuple[int, int], int] = {}
    for face in part.faces:
        for a, b in zip(face, (*face[1:], face[0]), strict=True):
            seen[a, b] = seen.get((a, b), 0) + 1
    return sum(1 for (a, b), count in seen.items() if count != 1 or seen.get((b, a)) != 1)


def test_a_stack_of_rings_is_closed_and_looks_out() -> None:
    part = stack([Ring(0.0, 1.0, 1.0, 1.0), Ring(2.0, 1.0, 1.0, 1.0)], 64, "jacket")
    assert open_edges(part) == 0
    assert volume(part) == pytest.approx(2 * np.pi, rel=3e-3)


def test_a_stack_looks_out_whichever_way_it_is_stacked() -> None:
    rings = [Ring(2.0, 1.0, 1.0, 1.0), Ring(0.0, 0.5, 0.5, 0.5)]
    assert volume(stack(rings, 16, "jacket")) > 0
    assert volume(stack(rings[::-1], 16, "jacket")) > 0


def test_an_open_stack_has_open_ends() -> None:
    part = stack([Ring(0.0, 1.0, 1.0, 1.0), Ring(2.0, 1.0, 1.0, 1.0)], 10, "jacket", (False, False))
    assert open_edges(part) == 20
    assert len(part.faces) == 10


def test_a_box_has_its_size() -> None:
    part = box((0.4, 0.2, 0.1), "skis", bevel=0.0)
    np.testing.assert_allclose(np.ptp(part.vertices, axis=0), (0.4, 0.2, 0.1))
    assert volume(part) == pytest.approx(0.4 * 0.2 * 0.1)


def test_a_mirrored_part_is_the_other_side_and_still_looks_out() -> None:
    part = box((0.4, 0.2, 0.1), "skis").moved((0.0, 1.0, 0.0)).bound("ski.L")
    other = part.mirrored()
    assert list(other.weights) == ["ski.R"]
    np.testing.assert_allclose(other.vertices[:, 1], -part.vertices[:, 1])
    assert volume(other) == pytest.approx(volume(part))


def test_joined_parts_keep_faces_materials_and_weights() -> None:
    one, two = box((1, 1, 1), "skis").bound("a"), box((1, 1, 1), "poles").moved((3, 0, 0)).bound("b")
    part = join([one, two])
    assert len(part.faces) == len(part.materials) == len(one.faces) + len(two.faces)
    np.testing.assert_array_equal(part.weights["a"] + part.weights["b"], 1.0)
    assert volume(part) == pytest.approx(volume(one) + volume(two))


def test_materials_may_go_by_row_and_column() -> None:
    rings = np.stack([Ring(float(z), 1.0, 1.0, 1.0).points(5) for z in range(3)])
    part = loft(rings, lambda row, column: f"{row}{column}", (False, False))
    assert sorted(part.materials) == sorted(f"{row}{column}" for row in range(2) for column in range(5))


def test_a_ring_has_its_half_sizes() -> None:
    points = Ring(0.3, 0.2, 0.5, 0.1, x=1.0, y=2.0).points(8)
    np.testing.assert_allclose(points[0], (1.5, 2.0, 0.3))
    np.testing.assert_allclose(points[2], (1.0, 2.2, 0.3), atol=1e-12)
    np.testing.assert_allclose(points[4], (0.9, 2.0, 0.3), atol=1e-12)


def test_a_dome_closes_upwards_within_its_height() -> None:
    rings = dome(Ring(1.0, 0.5, 0.5, 0.5), 0.3)
    assert all(1.0 < ring.z <= 1.3 for ring in rings)
    assert [ring.side for ring in rings] == sorted((ring.side for ring in rings), reverse=True)


def test_smooth_step_falls_where_the_limits_are_turned_round() -> None:
    np.testing.assert_allclose(smooth_step(np.array([0.0, 1.0, 2.0]), 2.0, 0.0), [1.0, 0.5, 0.0])


def test_chain_weights_add_up_and_meet_at_the_joints() -> None:
    z = np.linspace(-1.0, 1.0, 41)
    weights = chain_weights(z, ("thigh", "shank", "foot"), [0.4, -0.4], [0.1, 0.1])
    np.testing.assert_allclose(sum(weights.values()), 1.0)
    assert weights["thigh"][-1] == weights["foot"][0] == 1.0
    assert weights["thigh"][np.argmin(np.abs(z - 0.4))] == pytest.approx(0.5)
    rising = chain_weights(z, ("pelvis", "chest"), [0.0], [0.1], rising=True)
    assert rising["pelvis"][0] == rising["chest"][-1] == 1.0
