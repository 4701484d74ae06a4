"""Plan-view curves laid on the ground: exact on a plane, with the ground's own frames on a hill."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.course.surface import track_on_surface
from ski_addon.terrain import PlaneTerrain


class Bowl:
    """z = -x tan(a) + a x^2 + b x y + c y^2."""

    mean_angle = 0.1
    bend = np.array([0.004, -0.003, 0.006])

    def height(self, x, y):
        return -np.tan(self.mean_angle) * x + self.bend[0] * x**2 + self.bend[1] * x * y + self.bend[2] * y**2

    def normal(self, x, y):
        slope_x = -np.tan(self.mean_angle) + 2 * self.bend[0] * x + self.bend[1] * y
        slope_y = self.bend[1] * x + 2 * self.bend[2] * y
        normal = np.stack((-slope_x, -slope_y, np.ones_like(slope_x)), axis=-1)
        return normal / np.linalg.norm(normal, axis=-1, keepdims=True)


def circle(radius, count=400):
    angle = np.linspace(-1.2, 1.2, count)
    return radius * np.sin(angle), radius * (1 - np.cos(angle)), np.ones(count, dtype=int), np.arange(count)


def test_circle_drawn_on_a_steep_plane_keeps_its_radius_and_length():
    track = track_on_surface(PlaneTerrain(0.4), *circle(12.0), 5.0)
    assert np.abs(track.curvature - 1 / 12.0).max() < 1e-6
    assert track.length == pytest.approx(2.4 * 12.0, rel=1e-7)
    assert np.abs(track.normal_curvature).max() < 1e-9 and np.abs(track.torsion).max() < 1e-9


def test_frames_are_orthonormal_and_lie_on_the_ground():
    bowl = Bowl()
    track = track_on_surface(bowl, *circle(12.0), 5.0)
    assert np.abs(track.position[:, 2] - bowl.height(*track.position.T[:2])).max() < 1e-12
    assert np.abs(np.sum(track.tangent * track.surface_normal, axis=1)).max() < 1e-12
    assert np.abs(np.linalg.norm(track.tangent, axis=1) - 1).max() < 1e-12


def test_arc_length_is_the_length_of_the_curve_on_the_ground():
    track = track_on_surface(Bowl(), *circle(12.0), 5.0)
    slope = np.gradient(track.position, track.arc_length, axis=0)[5:-5]
    assert np.abs(np.linalg.norm(slope, axis=1) - 1).max() < 1e-4
    assert np.abs(slope - track.tangent[5:-5]).max() < 1e-4


def test_frame_turns_by_its_curvatures_and_torsion():
    track = track_on_surface(Bowl(), *circle(12.0), 5.0)
    t, n, left = track.tangent, track.surface_normal, track.left
    kg, kn, tg = (c[:, None] for c in (track.curvature, track.normal_curvature, track.torsion))
    for axis, rate in ((t, kg * left + kn * n), (left, -kg * t + tg * n), (n, -kn * t - tg * left)):
        numeric = np.gradient(axis, track.arc_length, axis=0)
        assert np.abs(numeric - rate)[5:-5].max() < 1e-4
    assert np.abs(track.torsion).max() > 1e-3 and np.abs(track.normal_curvature).max() > 1e-3


def test_labels_follow_the_points_they_were_given_with():
    down, left, _, _ = circle(12.0)
    phase = np.where(down < 0, 1, -1)
    track = track_on_surface(PlaneTerrain(0.2), down, left, phase, np.where(down < 0, 1, 2), 5.0)
    x = track.position[:, 0]
    assert set(track.phase[x < -0.1]) == {1} and set(track.phase[x > 0.1]) == {-1}
    assert set(track.turn[x > 0.1]) == {2} and track.phase.dtype == np.int8
