"""The numbers behind the plots, against what the synthetic recording was made of."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ski_addon.report import series
from ski_addon.spec import RunSpec
from tests.synthetic_recording import HINGES, synthetic_recording


@pytest.fixture(scope="module")
def recording():
    return synthetic_recording()


def test_body_weight_is_of_the_mass_that_was_simulated():
    heavy = RunSpec().with_overrides({"skier.mass": 80})
    assert series.body_weight(synthetic_recording(heavy)) == pytest.approx(80 * 9.81)


def test_forces_in_body_weights_do_not_depend_on_the_skier(recording):
    heavy = synthetic_recording(RunSpec().with_overrides({"skier.mass": 100}))
    np.testing.assert_allclose(series.ski_forces(heavy), series.ski_forces(recording))


def test_split_gives_back_the_forces_the_recording_was_made_of(recording):
    split = series.force_split(recording)
    swing = np.sin(2 * np.pi * recording.time / 5.0)
    np.testing.assert_allclose(split.normal, 1 - 0.2 * (swing**2 < 0.1), atol=1e-9)
    along = np.sum(recording.track_tangent * [0.0, 1.0, 0.0], axis=1)
    across = np.tan(recording.inclination) * np.sqrt(1 - along**2)  # the force was made along world y
    np.testing.assert_allclose(split.left, across, atol=1e-9)


def test_forces_of_both_skis_add_up_to_the_split(recording):
    split = series.force_split(recording)
    total = np.linalg.norm(recording.snow_force.sum(axis=1), axis=1) / series.body_weight(recording)
    assert np.all(np.hypot(split.normal, split.left) <= total + 1e-9)


def test_bands_cover_the_run_without_gaps(recording):
    bands = series.phase_bands(recording.time, recording.phase)
    assert bands[0].start == recording.time[0] and bands[-1].end == recording.time[-1]
    assert all(before.end == after.start for before, after in zip(bands, bands[1:], strict=False))
    assert [band.phase for band in bands[:5]] == [0, 1, 0, -1, 0]
    assert bands[1].start == pytest.approx(5.0 / 12, abs=0.011)  # where the sine passes one half


def test_bands_of_one_phase_and_of_nothing():
    assert series.phase_bands(np.arange(3.0), np.ones(3)) == [(1, 0.0, 2.0)]
    assert series.phase_bands(np.zeros(0), np.zeros(0)) == []


def test_every_hinge_belongs_to_exactly_one_joint(recording):
    joints = series.torque_by_joint(recording)
    assert [joint.name for joint in joints][:3] == ["ankle", "knee", "hip"]
    assert {joint.name for joint in joints} == set(series.JOINT_GROUPS)
    assert max(joint.peak for joint in joints) == pytest.approx(np.abs(recording.torque_ratio).max())
    for joint in joints:
        assert joint.ratio.max() == pytest.approx(joint.peak)
        column = recording.torque_ratio[:, HINGES.index(joint.peak_hinge)]
        assert np.abs(column).max() == pytest.approx(joint.peak)


def test_torques_are_joined_by_size_so_that_negative_ones_count(recording):
    ratio = recording.torque_ratio.copy()
    ratio[7, HINGES.index("shank_y.R")] = -3.0
    hardest = series.torque_by_joint(dataclasses.replace(recording, torque_ratio=ratio))[0]
    assert (hardest.name, hardest.peak, hardest.peak_hinge) == ("knee", 3.0, "shank_y.R")


def test_thinning_keeps_peaks_of_either_sign_and_short_curves_whole():
    time, values = np.arange(100000.0), np.zeros(100000)
    values[[1234, 77777]] = 5.0, -7.0
    thin_time, thin = series.thinned(time, values, most=1000)
    assert len(thin) <= 1000 and thin.max() == 5.0 and thin.min() == -7.0
    assert thin_time[thin.argmin()] == 77777 and np.all(np.diff(thin_time) > 0)
    assert (
        series.thinned(time[:10], values[:10])[0] is not None and len(series.thinned(time[:10], values[:10])[1]) == 10
    )
