"""Segments of persons of all sizes: masses add up, inertias are those of bodies that can exist."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from ski_addon.body import build_skeleton
from ski_addon.body.anthropometry import PAIRED, TABLES, person_segments
from ski_addon.spec import SkierSpec

PERSONS = [
    SkierSpec(mass=mass, height=height, sex=sex)
    for mass, height, sex in itertools.product((30, 50, 80, 130), (1.2, 1.5, 1.8, 2.1), ("male", "female"))
]
HEAVY_GEAR = SkierSpec(mass=30, height=1.2, ski_mass=5, boot_mass=4, pole_mass=1)
IDS = [f"{p.sex} {p.mass} kg {p.height} m" for p in PERSONS]


@pytest.mark.parametrize("person", [*PERSONS, HEAVY_GEAR], ids=[*IDS, "heavy gear"])
def test_bodies_weigh_what_the_spec_says_and_have_possible_inertias(person):
    skeleton = build_skeleton(person)
    assert skeleton.mass.sum() == pytest.approx(person.mass, abs=1e-9)
    assert skeleton.mass.min() > 0
    smallest, middle, largest = np.sort(skeleton.inertia, axis=1).T
    assert smallest.min() > 0
    assert np.all(smallest + middle >= largest), "no rigid body has such moments"


@pytest.mark.parametrize("person", PERSONS[::5])
def test_left_and_right_mirror_each_other(person):
    skeleton = build_skeleton(person)
    mirror = np.array([1.0, -1.0, 1.0])
    for left, name in enumerate(skeleton.body_names):
        if not name.endswith(".L"):
            continue
        right = skeleton.body(name[:-1] + "R")
        assert skeleton.mass[left] == skeleton.mass[right]
        np.testing.assert_array_equal(skeleton.com[left] * mirror, skeleton.com[right])
        np.testing.assert_array_equal(skeleton.inertia[left], skeleton.inertia[right])
        np.testing.assert_array_equal(skeleton.offset[left] * mirror, skeleton.offset[right])
    middle = [i for i, name in enumerate(skeleton.body_names) if "." not in name]
    assert np.all(skeleton.com[middle, 1] == 0) and np.all(skeleton.offset[middle, 1] == 0)


@pytest.mark.parametrize("sex", ["male", "female"])
def test_tables_are_de_levas(sex):
    """His fractions add up to a whole person to 0.1 %; no segment's centre lies outside it."""
    table = TABLES[sex]
    assert sum(s.mass * (2 if name in PAIRED else 1) for name, s in table.items()) == pytest.approx(1.0, abs=1.5e-3)
    assert all(0 < segment.com < 1 for segment in table.values())
    trunk = sum(table[name].mass for name in ("pelvis", "abdomen", "chest"))
    assert trunk == pytest.approx({"male": 0.4346, "female": 0.4257}[sex])


def test_segments_scale_with_mass_and_with_the_square_of_height():
    small, tall = person_segments(40, 1.2, "female"), person_segments(80, 1.8, "female")
    for name in small:
        assert tall[name].mass == pytest.approx(2 * small[name].mass)
        assert tall[name].com == pytest.approx(1.5 * small[name].com)
        np.testing.assert_allclose(tall[name].inertia, 2 * 1.5**2 * np.array(small[name].inertia))


def test_standing_height_is_the_stature():
    """Crown over the sole: the head's tabled length ends where the stature does, within 3 %."""
    for person in PERSONS[::3]:
        skeleton = build_skeleton(person)
        standing = {
            name: skeleton.offset[skeleton.body(name)] for name in ("abdomen", "chest", "head", "thigh.L", "shank.L")
        }
        legs = -(standing["thigh.L"] + standing["shank.L"])[2] + skeleton.lengths["shank"] + 0.039 * person.height
        trunk = sum(standing[name][2] for name in ("abdomen", "chest", "head"))
        assert legs + trunk + skeleton.lengths["head"] == pytest.approx(person.height, rel=0.03)


def test_standing_centre_of_mass_is_where_people_have_it():
    """About 55 to 58 % of stature over the floor without equipment; boots and skis bring it down a little."""
    from ski_addon.body import centre_of_mass, forward_kinematics

    light = {"ski_mass": 0.3, "boot_mass": 0.3, "pole_mass": 0.05}
    for sex in ("male", "female"):
        skeleton = build_skeleton(SkierSpec(mass=75, height=1.78, sex=sex, **light))
        qpos = np.zeros((1, 42))
        qpos[0, 3] = 1.0
        position, rotation = forward_kinematics(skeleton, qpos)
        floor = position[0, skeleton.body("foot.L"), 2] - 0.039 * 1.78
        height = centre_of_mass(skeleton, position, rotation)[0, 2] - floor
        assert 0.53 < height / 1.78 < 0.59


def test_equipment_is_as_long_as_asked():
    skeleton = build_skeleton(SkierSpec(ski_length=1.7, pole_length=1.1, stance_width=0.3, ski_width=0.09))
    assert (skeleton.ski_length, skeleton.pole_length) == (1.7, 1.1)
    assert (skeleton.stance_width, skeleton.ski_width) == (0.3, 0.09)


def test_arrays_of_a_skeleton_are_read_only():
    with pytest.raises(ValueError, match="read-only"):
        build_skeleton(SkierSpec()).mass[0] = 1.0
