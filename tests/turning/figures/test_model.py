"""The four figures at rest: bodies, parents, places and measures."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.blender.skier.figure import build_figure as clothes_figure
from ski_addon.body.skeleton import BODY_NAMES
from ski_addon.errors import SpecError
from ski_addon.pipeline import make_plan
from ski_addon.spec import RunSpec
from ski_addon.spec.figure_section import KINDS
from ski_addon.turning.figures import build_figure
from ski_addon.turning.figures.bicycle_sizes import saddle_place

GEAR = {
    "alpine": {"ski.L", "ski.R", "pole.L", "pole.R"},
    "telemark": {"ski.L", "ski.R", "pole.L", "pole.R"},
    "snowboard": {"board"},
    "bicycle": {"frame", "fork", "wheel_rear", "wheel_front", "crank", "pedal.L", "pedal.R"},
}
HEIGHTS = (1.25, 1.5, 1.78, 2.05)


def figure(kind, height=1.78, **keys):
    return build_figure(RunSpec.from_dict({"skier": {"height": height, "mass": 75}, "figure": {"kind": kind, **keys}}))


@pytest.mark.parametrize("kind", KINDS)
def test_a_figure_is_the_person_and_its_gear_with_parents_first(kind):
    model = figure(kind)
    person = [name for name in BODY_NAMES if not name.startswith(("ski", "pole"))]
    assert len(person) == 16 and list(model.person) == person
    assert set(model.gear) == GEAR[kind] and set(model.body_names) == {*person, *GEAR[kind]}
    assert all(above < i for i, above in enumerate(model.parent))
    assert {name for name, above in zip(model.body_names, model.parent, strict=True) if above < 0} <= model.free
    assert not model.place.flags.writeable and not model.turn.flags.writeable


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("height", HEIGHTS)
def test_at_rest_the_person_stands_upright_on_the_ground_facing_x(kind, height):
    model = figure(kind, height)
    place = dict(zip(model.body_names, model.place, strict=True))
    assert place["pelvis"][:2] == pytest.approx([0, 0], abs=1e-12)
    assert place["foot.L"][2] == pytest.approx(model.sizes["ankle_height"])
    turn = model.turn[[model.body(name) for name in model.person]]
    np.testing.assert_allclose(turn, np.repeat(np.eye(3)[None], 16, axis=0), atol=1e-12)
    square = model.turn @ np.swapaxes(model.turn, 1, 2)
    np.testing.assert_allclose(square, np.broadcast_to(np.eye(3), square.shape), atol=1e-12)
    assert place["head"][2] == pytest.approx(0.87 * height, abs=0.1)


def test_the_alpine_skier_rests_as_the_clothes_and_the_recording_have_it():
    model = figure("alpine")
    clothes = clothes_figure(model.skeleton)
    assert model.body_names == model.skeleton.body_names
    for name, place, turn in zip(model.body_names, model.place, model.turn, strict=True):
        np.testing.assert_array_equal(place, clothes.place[name])
        np.testing.assert_array_equal(turn, clothes.turn[name])


@pytest.mark.parametrize(("stance", "nose"), [("regular", 1.0), ("goofy", -1.0)])
def test_a_board_at_rest_lies_across_with_the_front_foot_to_its_nose(stance, nose):
    model = figure("snowboard", stance=stance)
    np.testing.assert_allclose(model.turn[model.body("board")][:, 0], [0, nose, 0], atol=1e-12)
    np.testing.assert_allclose(model.place[model.body("board")][1:], 0, atol=1e-12)


@pytest.mark.parametrize("height", HEIGHTS)
def test_a_bicycle_fits_its_rider(height):
    model = figure("bicycle", height)
    sizes, place = model.sizes, dict(zip(model.body_names, model.place, strict=True))
    assert place["wheel_rear"][2] == place["wheel_front"][2] == pytest.approx(sizes["wheel_radius"])
    assert place["wheel_front"][0] - place["wheel_rear"][0] == pytest.approx(sizes["wheelbase"])
    axis = model.turn[model.body("fork")][:, 2]
    np.testing.assert_allclose(axis, [-np.cos(sizes["head_angle"]), 0, np.sin(sizes["head_angle"])], atol=1e-12)
    arm = place["wheel_front"] - place["fork"]
    assert arm @ axis == pytest.approx(0, abs=1e-12) and np.linalg.norm(arm) == pytest.approx(sizes["fork_offset"])
    ground = place["fork"] - axis * place["fork"][2] / axis[2]  # where the steering axis meets the ground
    assert ground[0] - place["wheel_front"][0] == pytest.approx(sizes["trail"])
    assert place["pedal.L"][2] - sizes["crank_length"] > 0.05
    saddle = saddle_place(sizes)[2] + sizes["wheel_radius"]
    assert 0.45 * height < saddle < 0.6 * height and 0.0 < sizes["bar_height"] - saddle + 0.1 < 0.25
    assert 0.1 * height < place["wheel_front"][0] - place["pedal.L"][0] - sizes["wheel_radius"] + 0.11 * height


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "alpine"])
def test_whole_physics_of_another_figure_is_refused_with_what_to_do(kind):
    with pytest.raises(SpecError, match=f'figure.kind = "{kind}" has no whole physics.*preview') as caught:
        make_plan(RunSpec.from_dict({"figure": {"kind": kind}}))
    assert caught.value.exit_code == 2 and "\n" not in str(caught.value)
