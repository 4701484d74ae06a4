"""Claim 15: what the body's motion does to knees, waist, skis, trunk, arms and poles [VP93 sec. 7]."""

from __future__ import annotations

import functools

import numpy as np
import pytest

from ski_addon.spec import RunSpec
from ski_addon.turning.figures import build_figure, figure_poses
from tests.turning.figures.measures import joint_angles, place, point, turn
from tests.turning.figures.motions import turns

FPS = 240.0
SETTLED = slice(240, -240)
"""Away from both ends of a run, where plants are cut off."""


@functools.cache
def mapped(kind, period=2.5, lean=23.0, seconds=10.0, side=1.0, **style):
    spec = RunSpec.from_dict({"skier": {"height": 1.75, "mass": 75}, "figure": {"kind": kind, **style}})
    motion = turns(period, lean, 8.0, seconds, side=side)
    model = build_figure(spec)
    poses = figure_poses(model, spec, motion, FPS)
    return model, poses, motion


def over_time(poses, motion, values):
    return np.interp(poses.time, motion.time, values)


def edge(poses, ski):
    """Tilt (m,) [rad] of a ski or board on level ground, positive to the left."""
    left = turn(poses, ski)[:, :, 1]
    return -np.arcsin(left[:, 2])


def yaw(poses, body, motion):
    """Direction (m,) [rad] of a body's x against the path."""
    ahead = turn(poses, body)[:, :, 0]
    heading = np.stack([over_time(poses, motion, motion.heading_direction[:, i]) for i in range(2)], axis=1)
    return np.arctan2(heading[:, 0] * ahead[:, 1] - heading[:, 1] * ahead[:, 0], np.sum(heading * ahead[:, :2], axis=1))


def correlation(a, b):
    return float(np.corrcoef(a[SETTLED], b[SETTLED])[0, 1])


def lag(a, b, most=0.5):
    """Time [s] by which `a` is later than `b`, by the best correlation."""
    shifts = np.arange(-round(most * FPS), round(most * FPS) + 1)
    inside = slice(len(shifts), -len(shifts))
    found = [np.corrcoef(np.roll(a, -shift)[inside], b[inside])[0, 1] for shift in shifts]
    return shifts[int(np.argmax(found))] / FPS


@pytest.mark.parametrize("kind", ["alpine", "telemark", "snowboard"])
def test_claim_15_legs_bend_in_phase_with_the_leg_force(kind):
    """The spring: a leg is shorter where the force is greater. A lunge has a bend of its own, which swings likewise."""
    model, poses, motion = mapped(kind, lean=30.0)
    force = over_time(poses, motion, motion.leg_force)
    knees = np.mean([joint_angles(poses, f"shank.{side}")[:, 0] for side in "LR"], axis=0)
    assert correlation(knees, force) > (0.9 if kind != "telemark" else 0.7)
    assert abs(lag(knees, force)) < 0.05 and np.ptp(knees[SETTLED]) > 10.0


@pytest.mark.parametrize("kind", ["alpine", "snowboard"])
def test_claim_15_the_waist_bends_with_the_knees(kind):
    _, poses, _ = mapped(kind, lean=30.0)
    knees = np.mean([joint_angles(poses, f"shank.{side}")[:, 0] for side in "LR"], axis=0)
    trunk = np.degrees(np.arccos(np.clip(turn(poses, "chest")[:, 2, 2], -1, 1)))
    assert correlation(trunk, knees) > (0.99 if kind == "alpine" else 0.85)
    springs = (mapped(kind, lean=30.0, leg_stiffness=stiffness)[1] for stiffness in (8.0, 3.0))
    stiff, soft = (np.ptp(joint_angles(poses, "shank.L")[:, 0]) for poses in springs)
    assert soft > 1.5 * stiff, "a softer spring, more up and down"


@pytest.mark.parametrize("kind", ["alpine", "telemark", "snowboard"])
def test_claim_15_tilt_is_linear_in_curvature_and_greater_on_the_outside(kind):
    model, poses, motion = mapped(kind)
    curvature = over_time(poses, motion, motion.curvature)
    skis = [name for name in model.gear if name.startswith(("ski", "board"))]
    tilts = [edge(poses, name) for name in skis]
    for tilt in tilts:
        assert correlation(tilt, curvature) > 0.98
    if kind == "snowboard":
        slope, _ = np.polyfit(curvature, tilts[0], 1)
        np.testing.assert_allclose(tilts[0], slope * curvature, atol=0.03 * np.abs(tilts[0]).max())
        return
    full = np.abs(curvature) > 0.7 * np.abs(curvature).max()
    left, right = (np.abs(tilt[full]) for tilt in tilts)
    outside_more = np.where(curvature[full] > 0, right - left, left - right)
    assert outside_more.min() > 0.0 and np.degrees(outside_more.max()) < 10.0


def test_claim_15_the_leg_takes_up_what_the_ski_is_tilted_more_or_less_than_the_body():
    """With twice the tilt of the body's lean, skis go on edge by the legs; the feet stay in their bindings."""
    for tilt in (0.5, 1.4):
        model, poses, motion = mapped("alpine", tilt=tilt)
        lean = over_time(poses, motion, motion.lean)
        full = np.abs(lean) > 0.9 * np.abs(lean).max()
        share = np.mean([edge(poses, f"ski.{side}")[full] / lean[full] for side in "LR"])
        assert share == pytest.approx(tilt, rel=0.2)
        for side in "LR":
            sole = np.swapaxes(turn(poses, f"ski.{side}"), 1, 2) @ turn(poses, f"foot.{side}")
            np.testing.assert_allclose(sole, np.broadcast_to(np.eye(3), sole.shape), atol=1e-6)


@pytest.mark.parametrize(("style", "degrees"), [({}, -30.0), ({"pole_plant": "paper"}, 30.0)])
@pytest.mark.parametrize("kind", ["alpine", "telemark"])
def test_claim_15_poles_are_planted_at_their_phase_and_their_tips_stay(kind, style, degrees):
    model, poses, motion = mapped(kind, **style)
    length = model.sizes["tip_distance"]
    phase = np.interp(poses.time, motion.time, np.unwrap(motion.phase))
    for side, half in (("L", 0.0), ("R", 180.0)):
        tip = point(poses, f"pole.{side}", [0.0, 0.0, -length])
        down = np.abs(tip[:, 2]) < 1e-6
        begin = np.flatnonzero(~down[:-1] & down[1:]) + 1
        end = np.flatnonzero(down[:-1] & ~down[1:])
        assert len(begin) >= 3
        past = np.degrees(np.mod(phase[begin] - np.radians(degrees + half) + np.pi, 2 * np.pi) - np.pi)
        assert np.abs(past).max() < 1.0, past
        for first in begin:
            last = end[end > first]
            if len(last):
                stay = tip[first : last[0] + 1]
                assert len(stay) > 10 and np.linalg.norm(stay - stay[len(stay) // 2], axis=1).max() < 5e-3


def test_no_pole_is_planted_where_none_is_asked_for():
    model, poses, _ = mapped("alpine", pole_plant="none")
    for side in "LR":
        assert point(poses, f"pole.{side}", [0.0, 0.0, -model.sizes["tip_distance"]])[:, 2].min() > 0.02


@pytest.mark.parametrize("kind", ["alpine", "telemark", "snowboard"])
def test_claim_15_the_upper_body_twists_in_phase_with_the_curvature(kind):
    """Skiers out of the turn, as taught, snowboarders into it; the key turns it round."""
    _, poses, motion = mapped(kind)
    curvature = over_time(poses, motion, motion.curvature)
    twist = np.unwrap(yaw(poses, "chest", motion) - yaw(poses, "pelvis", motion))
    sign = 1.0 if kind == "snowboard" else -1.0
    assert sign * correlation(twist, curvature) > 0.95
    assert abs(lag(sign * twist, curvature)) < 0.04
    _, other, _ = mapped(kind, twist=-sign)
    turned = np.unwrap(yaw(other, "chest", motion) - yaw(other, "pelvis", motion))
    assert -sign * correlation(turned, curvature) > 0.95


def test_claim_15_a_snowboarders_arms_lead_the_twist():
    """A swing that is 0.12 s early differs from one that is not by a swing a quarter of a period and 0.06 s early."""
    hands = []
    for lead in (0.12, 0.0):
        _, poses, motion = mapped("snowboard", arms_lead=lead)
        arm = place(poses, "hand.L") - 0.5 * (place(poses, "upper_arm.L") + place(poses, "upper_arm.R"))
        hands.append(np.unwrap(np.arctan2(arm[:, 1], arm[:, 0])))
    curvature = over_time(poses, motion, motion.curvature)
    assert lag(curvature, hands[0] - hands[1], 1.0) == pytest.approx(2.5 / 4 + 0.06, abs=0.03)
    assert RunSpec().figure.arms_lead == 0.12


def test_claim_15_steering_follows_the_curvature_and_the_rider_looks_into_the_turn():
    model, poses, motion = mapped("bicycle", lean=15.0)
    curvature = over_time(poses, motion, motion.curvature)
    ways = [np.cross(turn(poses, wheel)[:, :, 1], [0.0, 0.0, 1.0]) for wheel in ("wheel_rear", "wheel_front")]
    rear, front = (np.unwrap(np.arctan2(way[:, 1], way[:, 0])) for way in ways)
    steering = front - rear
    assert correlation(steering, curvature) > 0.95
    slope = np.polyfit(curvature[SETTLED], steering[SETTLED], 1)[0]
    assert slope == pytest.approx(model.sizes["wheelbase"], rel=0.2), "tan(steering) is about l C"
    assert correlation(np.unwrap(yaw(poses, "head", motion)), curvature) > 0.8
