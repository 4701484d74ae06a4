"""Claim 15, what is particular to each figure: feet and hands on the gear, wheels that roll, heels that lift."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.spec import RunSpec
from ski_addon.turning.figures import build_figure, figure_channels, figure_poses
from ski_addon.turning.figures.bicycle_sizes import grip_places
from tests.turning.figures.measures import place, slip_per_metre, turn
from tests.turning.figures.motions import turns
from tests.turning.figures.test_poses import GROUNDS, ridden

MILLIMETRE = 1e-3


def local(poses, body, carrier):
    """Place (m, 3) of a body in the frame of another."""
    return np.einsum("mji,mj->mi", turn(poses, carrier), place(poses, body) - place(poses, carrier))


@pytest.mark.parametrize("ground", GROUNDS)
def test_claim_15_feet_stay_on_the_board(ground):
    model, poses, _, _ = ridden("snowboard", ground)
    sizes = model.sizes
    for side, front in (("L", 1.0), ("R", -1.0)):
        binding = [0.5 * sizes["stance"] * front, 0.0]
        at = local(poses, f"foot.{side}", "board")
        assert np.abs(at[:, 2] - sizes["ankle_height"]).max() < MILLIMETRE
        away = np.linalg.norm(at[:, :2] - binding, axis=1)
        assert np.abs(away - sizes["ankle_setback"]).max() < MILLIMETRE


@pytest.mark.parametrize("ground", GROUNDS)
def test_claim_15_feet_and_hands_stay_on_the_bicycle(ground):
    model, poses, _, _ = ridden("bicycle", ground)
    sizes, half = model.sizes, 0.5 * model.skeleton.lengths["hand"]
    for i, side in enumerate("LR"):
        foot = turn(poses, f"foot.{side}")
        ball = place(poses, f"foot.{side}") + foot @ [sizes["ball_forward"], 0.0, -sizes["ankle_height"]]
        assert np.linalg.norm(ball - place(poses, f"pedal.{side}"), axis=1).max() < MILLIMETRE
        hand = place(poses, f"hand.{side}") - half * turn(poses, f"hand.{side}")[:, :, 2]
        grip = place(poses, "fork") + turn(poses, "fork") @ grip_places(sizes)[i]
        assert np.linalg.norm(hand - grip, axis=1).max() < MILLIMETRE


@pytest.mark.parametrize("ground", GROUNDS)
def test_claim_15_wheels_roll_and_do_not_slip(ground):
    """Sideways at most 5 mm a metre; turned by the way of the wheel's contact over its radius."""
    model, poses, terrain, _ = ridden("bicycle", ground, fps=120.0)
    radius = model.sizes["wheel_radius"]
    for name in ("wheel_rear", "wheel_front"):
        hub, axle = place(poses, name), turn(poses, name)[:, :, 1]
        normal = terrain.normal(hub[:, 0], hub[:, 1])
        down = np.sum(normal * axle, axis=1, keepdims=True) * axle - normal
        contact = hub + radius * down / np.linalg.norm(down, axis=1, keepdims=True)
        ahead = np.cross(axle, normal)
        ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
        settled = slice(60, -60)
        assert slip_per_metre(contact[settled], ahead[settled], normal[settled]) < 5e-3, name
        away = np.abs(contact[:, 2] - terrain.height(contact[:, 0], contact[:, 1]))
        assert away.max() < (2e-3 if ground == "plane" else 0.03), name


def test_pedals_stay_level_and_cranks_turn_by_the_way():
    spec = RunSpec.from_dict({"figure": {"kind": "bicycle", "coasting": False}})
    model, motion = build_figure(spec), turns(seconds=6.0)
    poses = figure_poses(model, spec, motion, 120.0)
    level = np.einsum("mji,mjk->mik", turn(poses, "frame"), turn(poses, "pedal.L"))
    np.testing.assert_allclose(level, np.broadcast_to(np.eye(3), level.shape), atol=1e-9)
    crank = np.einsum("mji,mjk->mik", turn(poses, "frame"), turn(poses, "crank"))
    angle = np.unwrap(np.arctan2(crank[:, 0, 2], crank[:, 0, 0]))
    way = motion.distance[-1] - motion.distance[0]
    assert (angle[-1] - angle[0]) / (2.0 * np.pi) * spec.figure.development == pytest.approx(way, rel=0.02)


@pytest.mark.parametrize("ground", GROUNDS)
def test_a_telemark_skier_leads_with_the_outside_ski_and_lifts_the_heel_behind(ground):
    model, poses, _, motion = ridden("telemark", ground)
    sizes = model.sizes
    pivot = np.array([sizes["pivot_forward"], 0.0, sizes["pivot_height"]])
    curvature = np.interp(poses.time, motion.time, motion.curvature)
    full = np.abs(curvature) > 0.9 * np.abs(curvature).max()
    split = local(poses, "ski.R", "ski.L")[:, 0]  # positive: the right ski leads
    assert np.all(np.sign(split[full]) == np.sign(curvature[full]))
    assert np.abs(split[full]).min() > 0.8 * sizes["split"]
    for side, inside in (("L", 1.0), ("R", -1.0)):
        lift = np.einsum("mji,mjk->mik", turn(poses, f"ski.{side}"), turn(poses, f"foot.{side}"))
        angle = np.degrees(np.arctan2(lift[:, 0, 2], lift[:, 0, 0]))
        behind = full & (inside * curvature > 0.0)
        assert angle[behind].min() > 30.0 and np.abs(angle[full & ~behind]).max() < 1.0
        toes = place(poses, f"foot.{side}") + turn(poses, f"foot.{side}") @ (
            pivot - [-sizes["ankle_setback"], 0.0, sizes["ankle_height"]]
        )
        wanted = place(poses, f"ski.{side}") + turn(poses, f"ski.{side}") @ pivot
        assert np.linalg.norm(toes - wanted, axis=1).max() < MILLIMETRE  # the ball stays where it is


@pytest.mark.parametrize("kind", ["alpine", "snowboard", "telemark", "bicycle"])
def test_numbers_to_drive_with_are_those_of_the_motion(kind):
    model, poses, _, motion = ridden(kind)
    channels = {channel.name: channel for channel in figure_channels(model, RunSpec(), motion, poses.time)}
    assert {"speed", "inclination", "leg_force", "turn_phase"} <= set(channels)
    clock = motion.time - motion.time[0]
    np.testing.assert_allclose(channels["speed"].values, np.interp(poses.time, clock, motion.speed))
    assert np.abs(channels["turn_phase"].values).max() <= 1.0
    lean = channels["inclination"].values
    assert np.degrees(np.abs(motion.lean).max()) >= np.abs(lean).max() > 5.0
    assert all(channel.doc and channel.values.shape == poses.time.shape for channel in channels.values())
