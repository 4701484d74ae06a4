"""Runs from start to end: repeatable, cancellable, and honest about how they ended."""

from __future__ import annotations

import hashlib
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from ski_addon.pipeline import make_plan, run_simulation, start_simulation
from ski_addon.simulation import Recording, summarise
from tests.ski_runs import MAIN, WEAK, planned, preset, simulated

ROOT = Path(__file__).resolve().parents[2]
SHORT = {"course.turn_count": 2, "course.turn_duration": 0.2, "course.transition_duration": 0.4}
UPRIGHT = {"technique.inclination": False, "course.turn_count": 2, "simulation.time_step": 0.002}
PROGRAM = """
import sys
from ski_addon.pipeline import make_plan, run_simulation
from ski_addon.spec import RunSpec
run_simulation(make_plan(RunSpec.from_toml(sys.argv[1])))[0].save(sys.argv[2])
"""


# -- repeatability ------------------------------------------------------------------


def test_same_spec_twice_gives_the_same_bytes(tmp_path):
    files = []
    for number in range(2):
        recording, _ = run_simulation(make_plan(preset("paper_main", SHORT)))
        files.append(recording.save(tmp_path / f"{number}.npz"))
    assert files[0].read_bytes() == files[1].read_bytes()


def test_another_process_gives_the_same_bytes(tmp_path):
    """Nothing depends on hash seeds, memory or what ran before."""
    here = run_simulation(make_plan(preset("paper_main", SHORT)))[0].save(tmp_path / "here.npz")
    document = tmp_path / "run.toml"
    document.write_text(preset("paper_main", SHORT).to_toml(), encoding="utf-8")
    there = tmp_path / "there.npz"
    environment = {**os.environ, "PYTHONHASHSEED": "77"}
    command = [sys.executable, "-c", PROGRAM, str(document), str(there)]
    subprocess.run(command, cwd=ROOT, env=environment, check=True, timeout=120)
    digests = [hashlib.sha256(path.read_bytes()).hexdigest() for path in (here, there)]
    assert digests[0] == digests[1]


def test_steps_do_not_depend_on_how_many_are_asked_for_at_once():
    at_once, in_parts = (start_simulation(planned("paper_main", SHORT)) for _ in range(2))
    at_once.advance(10**6)
    while in_parts.advance(37):
        pass
    np.testing.assert_array_equal(at_once.recording().qpos, in_parts.recording().qpos)
    assert at_once.step_done == in_parts.step_done == len(at_once.recording().time)
    assert not at_once.advance(1), "there is nothing left to do"


def test_plan_may_be_simulated_any_number_of_times():
    first = simulated("paper_main", SHORT)
    again, _ = run_simulation(planned("paper_main", SHORT))
    np.testing.assert_array_equal(first.tau, again.tau)


# -- stopping early ---------------------------------------------------------------------


def test_cancelled_run_keeps_what_is_done(tmp_path):
    told = []

    def progress(fraction: float, text: str) -> bool:
        told.append((fraction, text))
        return len(told) < 3

    recording, seconds = run_simulation(planned("paper_main", MAIN), progress)
    assert recording.status == "cancelled" and recording.header["status_detail"] == {}
    assert len(told) == 3 and len(recording.time) == len(seconds) == 300
    assert 0.0 < told[0][0] < told[2][0] < 0.2 and "simulating 0.1 of 3.5 s" in told[0][1]
    whole = simulated("paper_main", MAIN)
    np.testing.assert_array_equal(recording.qpos, whole.qpos[:300])
    kept = Recording.load(recording.save(tmp_path / "part.npz"))
    assert kept.status == "cancelled" and kept.duration == pytest.approx(0.3)


def test_progress_that_answers_nothing_goes_on_and_ends_at_one():
    told = []
    recording, _ = run_simulation(planned("paper_main", SHORT), lambda fraction, text: told.append(fraction))
    assert recording.status == "finished"
    assert told == sorted(told) and 0.5 < told[-1] <= 1.0
    simulation = start_simulation(planned("paper_main", SHORT))
    assert simulation.recording().status == "cancelled" and len(simulation.recording().time) == 0
    simulation.advance(10**6)
    assert simulation.fraction == 1.0 and simulation.recording().status == "finished"


# -- falls ------------------------------------------------------------------------------


def test_claim_20_without_inclination_the_skier_falls_in_the_first_turn():
    """theta = 0: upright at 9 m/s in a turn of 15 m, the skier tips over, and the recording ends there."""
    recording = simulated("paper_main", UPRIGHT)
    detail = recording.header["status_detail"]
    assert recording.status == "fell" and summarise(recording)["status"] == "fell"
    assert detail["what"] in ("the pelvis tipped over", "the skier lost control") and 0.2 < detail["time"] < 1.0
    assert recording.time[-1] == detail["time"] and recording.arc_length[-1] == detail["where"]
    assert np.abs(recording.inclination).max() > np.deg2rad(25)


def test_a_step_without_a_solution_is_the_last():
    """It is recorded, with its status and its residual, but what the solver left behind moves nobody.

    The steps of the fall itself, where most limits bind, are solved to the solver's tolerance: a tenth of a newton.
    """
    recording = simulated("paper_main", UPRIGHT)
    assert np.all(recording.solver_status[:-1] == 0) and recording.root_residual[:-1].max() < 0.1
    assert recording.root_residual[:-20].max() < 0.01
    assert recording.speed.max() < 12.0 and recording.ski_error.max() < 0.4
    assert np.abs(np.diff(recording.com, axis=0)).max() < 0.1


def test_weak_skier_falls_and_the_reason_is_a_muscle():
    recording = simulated("paper_main", WEAK)
    detail = recording.header["status_detail"]
    assert recording.status == "fell" and recording.solver_status[:-1].max() == 0
    assert 1.0 < detail["time"] < 2.5 and 10.0 < detail["where"] < 30.0
    falls = ("the pelvis tipped", "a ski left its track", "the head", "the body", "the skier lost control")
    assert detail["what"].startswith(falls)
    assert "had been at its torque limit for" in detail["why"]
    assert detail["why"].split(" ")[0] in recording.header["actuated_joint_names"]
    assert recording.torque_ratio.max() <= 1.0 + 1e-12


def test_weak_skier_who_may_steer_aside_stays_up():
    """The same muscles, at their limits as well: the skis give way to the outside instead of the body."""
    recording = simulated("paper_main", {**WEAK, "technique.balance": "steering"})
    assert recording.status == "finished" and recording.solver_status.max() == 0
    assert np.mean(recording.torque_ratio.max(axis=1) > 0.999) > 0.5
    assert 0.3 < np.abs(recording.track_offset[:, 0]).max() < 3.0


def test_fall_is_kept_up_to_where_it_happened(tmp_path):
    recording = Recording.load(simulated("paper_main", WEAK).save(tmp_path / "fell.npz"))
    detail = recording.header["status_detail"]
    assert recording.status == "fell"
    for name in ("qpos", "qvel", "tau", "snow_force", "com", "root_residual"):
        assert np.all(np.isfinite(getattr(recording, name))), name
    assert recording.time[-1] == pytest.approx(detail["time"], abs=0.005)
    assert recording.arc_length[-1] == pytest.approx(detail["where"], abs=0.05)
    assert recording.com_error[-1] > 10 * recording.com_error[50]
    summary = summarise(recording)
    assert summary["status"] == "fell" and summary["status_detail"] == detail


def test_state_that_is_no_number_is_a_divergence_not_a_crash():
    simulation = start_simulation(planned("paper_main", SHORT))
    simulation.advance(25)
    simulation.dynamics.qvel[7] = np.nan
    simulation.advance(200)
    recording = simulation.recording()
    assert recording.status == "diverged" and not simulation.running
    assert recording.header["status_detail"]["what"] == "the state is no longer a number"
    assert recording.header["status_detail"]["time"] <= 0.035


def test_diverged_recording_ends_with_its_last_real_state():
    simulation = start_simulation(planned("paper_main", SHORT))
    simulation.advance(25)
    simulation.dynamics.qvel[7] = np.nan
    simulation.advance(200)
    assert np.all(np.isfinite(simulation.recording().qpos))


def test_skier_who_is_held_back_comes_to_a_stop():
    """Thrown backward up the slope: recognised, named, and not simulated for ever."""
    simulation = start_simulation(planned("paper_main", SHORT))
    simulation.advance(20)
    simulation.dynamics.qvel[:3] *= -0.2
    simulation.advance(500)
    detail = simulation.recording().header["status_detail"]
    assert simulation.recording().status == "fell" and detail["what"] == "the skier came to a stop"
    assert detail["why"] == "friction and slope no longer carry it forward"


# -- numbers about a run ------------------------------------------------------------------


def test_summary_says_what_the_recording_holds():
    recording = simulated("paper_main", MAIN)
    summary = summarise(recording, [0.001] * 90 + [0.003] * 10)
    assert summary["status"] == "finished" and summary["steps"] == len(recording.time)
    assert summary["duration_s"] == pytest.approx(len(recording.time) * 0.001)
    assert summary["ski_error_max_m"] == recording.ski_error.max()
    assert summary["ski_error_rms_m"] == pytest.approx(math.sqrt((recording.ski_error**2).mean()))
    assert summary["com_error_max_m"] == recording.com_error.max()
    assert summary["torque_ratio_max"] == recording.torque_ratio.max()
    strongest = recording.header["actuated_joint_names"].index(summary["torque_ratio_joint"])
    assert recording.torque_ratio[:, strongest].max() == recording.torque_ratio.max()
    assert summary["joint_margin_min_deg"] == pytest.approx(np.rad2deg(recording.joint_margin.min()))
    assert summary["root_residual_max"] == recording.root_residual.max()
    assert summary["unconverged_steps"] == np.count_nonzero(recording.solver_status)
    assert summary["inclination_max_deg"] == pytest.approx(np.rad2deg(np.abs(recording.inclination).max()))
    assert summary["edge_angle_max_deg"] == pytest.approx(np.rad2deg(np.abs(recording.edge_angle).max()))
    force = np.linalg.norm(recording.snow_force.sum(axis=1), axis=1).max()
    assert summary["snow_force_max_bw"] == pytest.approx(force / (50 * 9.81))
    assert (summary["speed_max"], summary["speed_end"]) == (recording.speed.max(), recording.speed[-1])
    assert summary["step_us_median"] == pytest.approx(1000) and summary["step_us_p99"] == pytest.approx(3000)
    assert summary["spec_hash"] == recording.header["spec_hash"]


def test_summary_of_a_run_without_steps():
    nothing = start_simulation(planned("paper_main", SHORT)).recording()
    summary = summarise(nothing)
    assert summary["steps"] == 0 and summary["duration_s"] == 0.0
    assert summary["step_us_median"] is None and summary["ski_error_max_m"] == 0.0


def test_recorded_errors_are_those_of_the_skis_corners():
    """ski_error is the farthest of eight corners from where the plan has it; com_error likewise."""
    from ski_addon.body import forward_kinematics
    from ski_addon.frames import matrix_from_quaternion
    from ski_addon.planning import Reference

    recording, run = simulated("paper_main", WEAK), planned("paper_main", WEAK)
    skeleton, reference = run.model.skeleton, Reference(run.plan, run.model)
    position, rotation = forward_kinematics(skeleton, recording.qpos)
    half = 0.5 * np.array([skeleton.ski_length, skeleton.ski_width, 0.0])
    corners = np.array([(x, y, 0.0) for x in (1, -1) for y in (1, -1)]) * half
    for i in range(0, len(recording.time), 30):
        value = reference.at(recording.progress[i])[0]
        np.testing.assert_allclose(value[reference.columns["com"]], recording.com_reference[i], atol=1e-9)
        assert recording.com_error[i] == pytest.approx(np.linalg.norm(recording.com[i] - recording.com_reference[i]))
        planned_place = value[reference.columns["ski_position"]].reshape(2, 3)
        planned_turn = matrix_from_quaternion(value[reference.columns["quaternion"]].reshape(3, 4)[:2])
        worst = 0.0
        for ski, side in enumerate("LR"):
            body = skeleton.body(f"ski.{side}")
            real = position[i, body] + corners @ rotation[i, body].T
            wanted = planned_place[ski] + corners @ planned_turn[ski].T
            worst = max(worst, np.linalg.norm(real - wanted, axis=1).max())
        assert recording.ski_error[i] == pytest.approx(worst, rel=0.05, abs=1e-5)  # linear in the rotation error


def test_claim_29_model_and_time_step():
    """50 kg, 1.5 m, 18 bodies and 37 degrees of freedom, 6 of them not driven; steps of a millisecond."""
    run = planned("paper_main", MAIN)
    names = run.model.skeleton.body_names
    assert run.model.mass == pytest.approx(50.0) and run.spec.skier.height == 1.5
    assert len([name for name in names if not name.startswith("pole")]) == 18
    assert len(run.model.body_dof) == 37 and len(run.model.actuated_dof) == 31
    assert run.spec.simulation.time_step == 0.001
