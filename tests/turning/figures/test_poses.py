"""What holds for every figure: nothing comes apart, slips, flips or bends the wrong way, on every ground."""

from __future__ import annotations

import functools

import numpy as np
import pytest

from ski_addon.frames import mirror_quaternion, mirror_vector
from ski_addon.spec import RunSpec
from ski_addon.terrain import build_terrain
from ski_addon.turning.figures import build_figure, figure_poses
from ski_addon.turning.figures.poses import MAPPINGS
from tests.turning.figures.measures import joint_angles, limb_gaps, place, slip_per_metre, turn, turns_between_frames
from tests.turning.figures.motions import turns

KINDS = tuple(MAPPINGS)
GROUNDS = ("plane", "bumps", "moguls")
SLOPE = 12.0
CASES = {  # period [s], lean [deg], speed [m/s]
    "usual": (2.5, 23.0, 8.0),
    "short": (1.5, 14.0, 6.0),
    "steep": (3.0, 40.0, 12.0),
    "gentle": (2.0, 7.0, 8.0),
}
RANGES = {  # of plausible joint angles [deg] about y, x, z of the left side; x and z mirror
    "abdomen": ((-15, 45), (-25, 25), (-30, 30)),
    "chest": ((-15, 40), (-20, 20), (-30, 30)),
    "head": ((-60, 50), (-40, 40), (-80, 80)),
    "upper_arm": ((-170, 60), (-40, 150), (-95, 95)),
    "forearm": ((-150, -5), (-0.1, 0.1), (-95, 95)),
    "thigh": ((-125, 25), (-50, 50), (-50, 50)),
    "shank": ((5, 135), (-0.1, 0.1), (-35, 35)),
    "foot": ((-55, 45), (-25, 25), (-25, 25)),
}


@functools.cache
def ridden(kind, ground="plane", case="usual", fps=24.0, height=1.75, seconds=6.0, side=1.0):
    spec = RunSpec.from_dict(
        {
            "skier": {"height": height, "mass": 75},
            "figure": {"kind": kind},
            "slope": {"angle_deg": SLOPE, "kind": ground, "mogul_height": 0.35, "mogul_spacing": 5},
        }
    )
    terrain = build_terrain(spec.slope)
    period, lean, speed = CASES[case]
    dropped = None if ground == "plane" else terrain
    motion = turns(period, lean, speed, seconds, angle=np.deg2rad(SLOPE), terrain=dropped, side=side)
    model = build_figure(spec)
    return model, figure_poses(model, spec, motion, fps, terrain=terrain), terrain, motion


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("case", CASES)
def test_bodies_hang_together_and_bend_as_people_do(kind, ground, case):
    for height in (1.3, 1.75, 2.0):
        model, poses, _, _ = ridden(kind, ground, case, height=height)
        assert np.isfinite(poses.position).all() and np.isfinite(poses.quaternion).all()
        assert limb_gaps(model, poses) < 1e-4
        for part, ranges in RANGES.items():
            for side in ("",) if part in ("abdomen", "chest", "head") else (".L", ".R"):
                angles = joint_angles(poses, part + side) * ([1, -1, -1] if side == ".R" else 1)
                for axis, (low, high) in enumerate(ranges):
                    found = angles[:, axis]
                    assert low <= found.min() and found.max() <= high, (
                        part + side,
                        "yxz"[axis],
                        found.min(),
                        found.max(),
                    )


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("ground", GROUNDS)
def test_claim_15_skis_and_boards_do_not_slip_sideways(kind, ground):
    for fps in (24.0, 240.0):
        model, poses, terrain, _ = ridden(kind, ground, fps=fps)
        for name in (name for name in model.gear if name.startswith(("ski", "board"))):
            at = place(poses, name)
            slip = slip_per_metre(at, turn(poses, name)[:, :, 0], terrain.normal(at[:, 0], at[:, 1]))
            assert slip < 2e-3, (name, fps, slip)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("case", CASES)
def test_nothing_pops_or_flips_between_frames(kind, ground, case):
    """Finer frames turn less in proportion: a flip would turn as far however fine they are."""
    limit = 9.0 if ground == "plane" else 16.0
    model, poses, _, _ = ridden(kind, ground, case, fps=120.0)
    found = turns_between_frames(poses)
    loose = [i for i, name in enumerate(model.body_names) if not name.startswith(("wheel", "crank"))]
    assert found[:, loose].max() < limit, model.body_names[loose[int(found[:, loose].max(axis=0).argmax())]]


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind in ("alpine", "telemark")])
def test_a_mirrored_motion_has_mirrored_poses(kind):
    _, one, _, _ = ridden(kind)
    _, other, _, _ = ridden(kind, side=-1.0)
    swap = [
        one.body_names.index(name[:-2] + {".L": ".R", ".R": ".L"}.get(name[-2:], name[-2:])) for name in one.body_names
    ]
    np.testing.assert_allclose(mirror_vector(one.position), other.position[:, swap], atol=1e-9)
    same = np.abs(np.sum(mirror_quaternion(one.quaternion) * other.quaternion[:, swap], axis=-1))
    np.testing.assert_allclose(same, 1.0, atol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_frames_and_subframes_show_the_same_motion(kind):
    model, poses, _, motion = ridden(kind)
    spec = RunSpec.from_dict({"skier": {"height": 1.75, "mass": 75}, "figure": {"kind": kind}})
    fine = figure_poses(model, spec, motion, 24.0, subframes=2, frame_start=10)
    assert fine.frame[0] == 10 and fine.frame[1] == 10.5 and fine.body_names == model.body_names
    np.testing.assert_allclose(fine.time[::2], poses.time, atol=1e-12)
    np.testing.assert_allclose(fine.position[::2], poses.position, atol=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_without_a_terrain_a_plane_gives_the_same(kind):
    model, poses, _, motion = ridden(kind)
    spec = RunSpec.from_dict({"skier": {"height": 1.75, "mass": 75}, "figure": {"kind": kind}})
    np.testing.assert_allclose(figure_poses(model, spec, motion, 24.0).position, poses.position, atol=1e-9)
