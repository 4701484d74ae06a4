"""The MuJoCo model: its size, its table of addresses, its limits."""

from __future__ import annotations

import dataclasses

import mujoco
import numpy as np
import pytest

from ski_addon.body import BODY_NAMES, build_skier_model
from ski_addon.body.limits import HINGE_LIMITS, HingeLimit, hinge_limit
from ski_addon.spec import SkierSpec
from tests.ski_runs import default_model, mirrored_hinges

MODEL = default_model()
SKELETON = MODEL.skeleton


def name_of(kind: mujoco.mjtObj, index: int) -> str:
    return mujoco.mj_id2name(MODEL.mujoco, kind, index)


def test_degrees_of_freedom():
    assert (MODEL.mujoco.nq, MODEL.mujoco.nv, MODEL.mujoco.nbody - 1) == (42, 41, 20)
    assert (SKELETON.nq, SKELETON.nv, len(SKELETON.joint_names)) == (42, 41, 35)
    assert (len(MODEL.body_dof), len(MODEL.pole_dof), len(MODEL.actuated_dof)) == (37, 4, 31)
    assert sorted([*MODEL.body_dof, *MODEL.pole_dof]) == list(range(41))


def test_bodies_and_hinges_have_the_same_names_and_order_in_the_skeleton_and_in_mujoco():
    assert tuple(name_of(mujoco.mjtObj.mjOBJ_BODY, i + 1) for i in range(20)) == BODY_NAMES == SKELETON.body_names
    for joint, name in enumerate(SKELETON.joint_names):
        index = mujoco.mj_name2id(MODEL.mujoco, mujoco.mjtObj.mjOBJ_JOINT, name)
        assert MODEL.mujoco.jnt_qposadr[index] == SKELETON.joint_qpos[joint]
        assert MODEL.mujoco.jnt_dofadr[index] == SKELETON.joint_dof[joint]
        assert MODEL.mujoco.jnt_bodyid[index] == SKELETON.joint_body[joint] + 1
        np.testing.assert_array_equal(MODEL.mujoco.jnt_axis[index], SKELETON.joint_axis[joint])


def test_bodies_are_in_depth_first_order():
    parents = [BODY_NAMES[p] if p >= 0 else None for p in SKELETON.parent]
    assert parents == [
        *(None, "pelvis", "abdomen", "chest"),
        *("chest", "upper_arm.L", "forearm.L", "hand.L", "chest", "upper_arm.R", "forearm.R", "hand.R"),
        *("pelvis", "thigh.L", "shank.L", "foot.L", "pelvis", "thigh.R", "shank.R", "foot.R"),
    ]


def test_ski_and_leg_addresses():
    names = [name_of(mujoco.mjtObj.mjOBJ_BODY, int(i)) for i in MODEL.ski_body]
    assert names == ["ski.L", "ski.R"]
    hinges = {int(dof): name for dof, name in zip(SKELETON.joint_dof, SKELETON.joint_names, strict=True)}
    for side, dofs in zip("LR", MODEL.leg_dof, strict=True):
        parts = ("thigh_y", "thigh_x", "thigh_z", "shank_y", "foot_y", "foot_x")
        assert [hinges[int(dof)] for dof in dofs] == [f"{part}.{side}" for part in parts]


def test_mujoco_has_the_skeletons_masses():
    np.testing.assert_allclose(MODEL.mujoco.body_mass[1:], SKELETON.mass, rtol=1e-15)
    np.testing.assert_allclose(MODEL.mujoco.body_ipos[1:], SKELETON.com, rtol=1e-15)
    assert MODEL.mass == pytest.approx(50.0)
    data = MODEL.new_data()
    mujoco.mj_forward(MODEL.mujoco, data)
    for body in range(20):  # MuJoCo may turn principal axes about
        axes = np.empty(9)
        mujoco.mju_quat2Mat(axes, MODEL.mujoco.body_iquat[body + 1])
        axes = axes.reshape(3, 3)
        inertia = axes @ np.diag(MODEL.mujoco.body_inertia[body + 1]) @ axes.T
        np.testing.assert_allclose(inertia, np.diag(SKELETON.inertia[body]), atol=1e-12)


def test_gravity_is_the_worlds_and_nothing_else_acts():
    assert MODEL.mujoco.opt.gravity.tolist() == [0, 0, -9.81]
    assert MODEL.mujoco.nu == 0 and MODEL.mujoco.ngeom == 0
    stiff = MODEL.mujoco.jnt_stiffness > 0
    assert {name_of(mujoco.mjtObj.mjOBJ_JOINT, int(i)) for i in np.flatnonzero(stiff)} == {
        f"pole_{axis}.{side}" for axis in "yx" for side in "LR"
    }
    assert np.all(MODEL.mujoco.dof_damping[MODEL.body_dof] == 0) and np.all(MODEL.mujoco.dof_armature == 0)
    assert np.all(MODEL.mujoco.dof_damping[MODEL.pole_dof] == SkierSpec().pole_damping)


def test_every_driven_hinge_has_limits_and_the_poles_have_none():
    driven = [SKELETON.joint_names[i] for i in SKELETON.actuated]
    assert {name.partition(".")[0] for name in driven} == set(HINGE_LIMITS)
    with pytest.raises(KeyError):
        hinge_limit("pole_y.L")
    assert np.all(MODEL.joint_lower < MODEL.joint_upper)
    assert np.all(MODEL.torque_lower < 0) and np.all(MODEL.torque_upper > 0)


def test_right_limits_mirror_left_ones():
    """An x or z hinge turns the other way on the right, so its range and torques change ends."""
    index, sign = mirrored_hinges(MODEL)
    actuated = SKELETON.actuated.tolist()
    for place, joint in enumerate(actuated):
        other = actuated.index(int(index[joint]))
        for lower, upper in ((MODEL.joint_lower, MODEL.joint_upper), (MODEL.torque_lower, MODEL.torque_upper)):
            here, there = (lower[place], upper[place]), (lower[other], upper[other])
            assert there == (here if sign[joint] > 0 else (-here[1], -here[0])), SKELETON.joint_names[joint]


def test_uneven_limits_change_ends_on_the_right(monkeypatch):
    """As long as the table is even in torques, only this can tell which end is which."""
    monkeypatch.setitem(HINGE_LIMITS, "thigh_x", HingeLimit(-10, 20, 30, 40))
    assert hinge_limit("thigh_x.L") == HingeLimit(-10, 20, 30, 40)
    assert hinge_limit("thigh_x.R") == HingeLimit(-20, 10, 40, 30)
    assert hinge_limit("thigh_y.R") == hinge_limit("thigh_y.L")


def test_ranges_are_human():
    """A knee bends one way only; the ankle's side play is the boot's five degrees."""
    names = [SKELETON.joint_names[i] for i in SKELETON.actuated]
    lower, upper = (dict(zip(names, np.rad2deg(x), strict=True)) for x in (MODEL.joint_lower, MODEL.joint_upper))
    for side in "LR":
        assert lower[f"shank_y.{side}"] >= 0 and upper[f"shank_y.{side}"] > 100
        assert (lower[f"foot_x.{side}"], upper[f"foot_x.{side}"]) == pytest.approx((-5, 5))
        assert upper[f"forearm_y.{side}"] == 0


def test_strength_scales_with_mass_times_height_and_with_the_spec():
    base = MODEL.torque_upper
    strong = build_skier_model(SkierSpec(strength=2.0)).torque_upper
    np.testing.assert_allclose(strong, 2 * base)
    reference = build_skier_model(SkierSpec(mass=75, height=1.78))
    knee = [SKELETON.joint_names[i] for i in SKELETON.actuated].index("shank_y.L")
    assert reference.torque_lower[knee] == pytest.approx(-250)
    np.testing.assert_allclose(base, reference.torque_upper * (50 * 1.5) / (75 * 1.78))


def test_hash_tells_dynamics_apart():
    same, other = build_skier_model(SkierSpec()), build_skier_model(SkierSpec(pole_stiffness=6.0))
    assert same.model_hash == MODEL.model_hash != other.model_hash
    assert len(MODEL.model_hash) == 16


def test_address_tables_are_read_only():
    for field in dataclasses.fields(MODEL):
        value = getattr(MODEL, field.name)
        if isinstance(value, np.ndarray):
            assert not value.flags.writeable, field.name


def test_person_and_equipment_of_any_allowed_size_compile():
    extremes = (
        {"mass": 30, "height": 2.1, "ski_mass": 5, "boot_mass": 4, "pole_mass": 1, "sex": "female"},
        {"mass": 130, "height": 1.2, "ski_length": 2.3, "ski_width": 0.14, "pole_length": 1.6},
        {"mass": 30, "height": 1.2, "ski_length": 0.8, "ski_width": 0.05, "pole_length": 0.6, "stance_width": 0.5},
    )
    for sizes in extremes:
        model = build_skier_model(SkierSpec(**sizes))
        assert model.mujoco.body_subtreemass[0] == pytest.approx(sizes["mass"])
