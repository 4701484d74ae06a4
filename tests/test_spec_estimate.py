"""What a run would take, and how durations and sizes are said."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.simulation.recorder import COUNTS, SHAPES
from ski_addon.spec import RunSpec, estimate
from ski_addon.spec.estimate import BYTES_PER_STEP, MEMORY_MAX, show_bytes, show_duration


def estimate_of(**changes):
    return estimate(RunSpec().with_overrides({key.replace("__", "."): value for key, value in changes.items()}))


def test_a_run_that_starts_in_its_turn_has_one_transition_less():
    paper = estimate_of(course__entry="turn")
    assert paper.simulated_seconds == pytest.approx(6 * 1.0 + 5 * 1.5)  # 13.5 s, as Fig. 11 of the 2019 paper
    assert estimate_of().simulated_seconds == pytest.approx(6 * 1.0 + 6 * 1.5)


def test_half_first_turn_takes_half_a_turn_less():
    assert estimate_of(course__half_first_turn=True).simulated_seconds == pytest.approx(5.5 * 1.0 + 6 * 1.5)


def test_turns_from_rest_begin_when_the_skier_is_fast_enough():
    gain = 9.81 * (np.sin(np.radians(10)) - 0.08 * np.cos(np.radians(10)))
    seconds = estimate_of(course__start_speed=0, slope__angle_deg=10).simulated_seconds
    assert seconds - estimate_of().simulated_seconds == pytest.approx(4.0 / gain)
    assert estimate_of(course__start_speed=0, slope__angle_deg=0).simulated_seconds == estimate_of().simulated_seconds


def test_stop_takes_longer_from_higher_speeds_and_with_softer_braking():
    def stop(**changes):
        glide = estimate_of(**changes).simulated_seconds
        return estimate_of(course__finish="stop", **changes).simulated_seconds - glide

    slow, fast = stop(course__target_speed=4), stop(course__start_speed=12, course__target_speed=12)
    assert 4.0 < slow < fast < 12.0
    soft = stop(course__target_speed=4, technique__stop_deceleration=2)
    assert soft - slow == pytest.approx(4.0 / 2.0 - 4.0 / 4.0)


def test_gliding_is_slower_on_gentler_slopes_and_never_faster_than_the_speed_to_hold():
    way = {"course__kind": "bumps", "course__run_length": 200}
    seconds = [estimate_of(**way, slope__angle_deg=angle).simulated_seconds for angle in (4, 8, 16)]
    assert seconds[0] > seconds[1] > seconds[2]
    assert estimate_of(**way, slope__angle_deg=16, course__target_speed=6).simulated_seconds == pytest.approx(200 / 6)
    assert estimate_of(**way, slope__angle_deg=4, course__target_speed=40).simulated_seconds == seconds[0]


def test_steps_memory_and_waiting_grow_as_the_time_step_shrinks():
    coarse, fine = estimate_of(simulation__time_step=0.002), estimate_of(simulation__time_step=0.0005)
    assert coarse.steps == 7500 and fine.steps == 30000
    assert fine.memory_bytes == 4 * coarse.memory_bytes
    assert fine.wall_seconds > 2 * coarse.wall_seconds


def test_memory_of_a_step_is_that_of_a_recorded_one():
    numbers = sum(int(np.prod(shape, dtype=int)) for shape in SHAPES.values()) + len(COUNTS)
    assert pytest.approx(2 * 8 * numbers, rel=0.1) == BYTES_PER_STEP


def test_too_large_by_skiing_or_by_memory():
    assert not estimate_of().too_large
    assert estimate_of(course__turn_count=500, course__turn_duration=10).too_large
    by_memory = estimate_of(course__turn_count=500, course__turn_duration=3, simulation__time_step=0.0005)
    assert by_memory.simulated_seconds < 3600 and by_memory.memory_bytes > MEMORY_MAX / 2
    assert by_memory.too_large == (by_memory.memory_bytes > MEMORY_MAX)


def test_description_has_all_four_numbers():
    assert estimate_of(course__entry="turn").described.startswith("13.5 s of skiing, 13500 steps, ")
    assert "MB of memory, about" in estimate_of().described


@pytest.mark.parametrize(
    ("seconds", "said"), [(0.5, "0.5 s"), (119, "119 s"), (600, "10 min"), (7200, "2 h"), (864000, "10 days")]
)
def test_durations(seconds, said):
    assert show_duration(seconds) == said


@pytest.mark.parametrize(
    ("count", "said"), [(500, "0.5 kB"), (25e6, "25 MB"), (8.59e9, "8.59 GB"), (4.4e12, "4.4 TB"), (3e15, "3e+03 TB")]
)
def test_sizes(count, said):
    assert show_bytes(count) == said
