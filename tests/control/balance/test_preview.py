"""What the plan asks of a faster skier: the tables against pendulums that are simulated forwards."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ski_addon.control.balance import Preview
from ski_addon.control.balance.preview import lean_offset
from ski_addon.gravity import STANDARD_GRAVITY
from ski_addon.planning import Reference
from tests.ski_runs import MAIN, planned


@pytest.fixture(scope="module")
def preview() -> Preview:
    run = planned("paper_main", MAIN)
    return Preview(Reference(run.plan, run.model))


def made_up(load, sideways, height=0.7, end=6.0):
    """A reference along x whose load [weights] and sideways acceleration [m/s^2] are functions of time."""
    columns = {"along": slice(0, 3), "across": slice(3, 6), "normal": slice(6, 9), "com": slice(9, 12)}
    columns |= {"track_position": slice(12, 15), "load": slice(15, 16)}

    def at(now):
        sample = np.zeros((3, 16))
        sample[0, :9] = np.eye(3).ravel()
        sample[0, 11], sample[0, 15] = height, load(now)
        sample[2, 10] = sideways(now)
        return sample

    return SimpleNamespace(columns=columns, at=at, end=end)


def test_nothing_is_asked_of_a_skier_who_is_as_fast_as_planned(preview):
    for progress in np.linspace(0.0, 3.5, 9):
        assert preview.at(progress, 1.0, 0.0)[1] == 0.0


def test_in_a_steady_turn_the_lean_grows_with_the_square_of_the_speed():
    """y'' = omega^2 y + (1 - r^2) P is at rest at y = (r^2 - 1) P / omega^2."""
    steady = Preview(made_up(lambda now: 1.0, lambda now: 3.0))
    omega, wanted = steady.at(2.0, 1.25, 0.0)
    assert omega == pytest.approx(np.sqrt(STANDARD_GRAVITY / 0.7))
    assert wanted == pytest.approx((1.25**2 - 1.0) * 3.0 / omega**2, rel=1e-6)


@pytest.mark.parametrize("rate", [0.6, 1.25, 2.0])
def test_a_pendulum_that_starts_where_it_is_asked_to_stays_near_the_plan(rate):
    """Forward integration of y'' = (g / h) y + (1 - r^2) P(r t) with y' = omega (xi - y); elsewhere it runs away."""
    sideways = lambda now: 3.0 * np.sin(1.5 * now)  # noqa: E731
    table = Preview(made_up(lambda now: 1.0, sideways, end=12.0))

    def largest(error: float) -> float:
        progress, step, y, worst = 1.0, 1e-3, 0.0, 0.0
        omega, wanted = table.at(progress, rate, 0.0)
        y_rate = omega * (wanted + error - y)
        for _ in range(1500):
            bend = STANDARD_GRAVITY / 0.7 * y + (1.0 - rate**2) * sideways(progress)
            y_rate += step * bend
            y += step * y_rate
            progress += step * rate
            worst = max(worst, abs(y))
        return worst

    bound = 1.5 * abs(1.0 - rate**2) * 3.0 / 9.0
    assert largest(0.0) < bound
    assert min(largest(0.05), largest(-0.05)) > 3.0 * bound


def test_omega_separates_the_growing_part_of_a_changing_pendulum():
    """omega' = omega^2 - N / h by central differences."""
    table = Preview(made_up(lambda now: 1.0 + 0.3 * np.sin(2.0 * now), lambda now: 0.0))
    for now in (0.7, 1.9, 3.3, 4.4):
        before, omega, after = (table.at(now + shift, 1.0, 0.0)[0] for shift in (-0.02, 0.0, 0.02))
        stiffness = (1.0 + 0.3 * np.sin(2.0 * now)) * STANDARD_GRAVITY / 0.7
        assert (after - before) / 0.04 == pytest.approx(omega**2 - stiffness, abs=0.05)


def test_faster_skiers_lean_further_and_slower_ones_less(preview):
    """In the middle of the second turn, a left one; and it comes before the turn does."""
    wanted = [preview.at(3.0, rate, 0.0)[1] for rate in (0.5, 0.8, 1.0, 1.2, 1.6)]
    assert wanted == sorted(wanted) and wanted[0] < -0.1 and wanted[-1] > 0.1
    assert preview.at(1.9, 1.3, 0.0)[1] > 0.02, "at the change of sides"


def test_off_to_the_outside_of_a_turn_the_body_is_pulled_further_out(preview):
    """The circle of skis that are to the right of a left turn is larger: less pull to the inside is missing."""
    inside, on, outside = (preview.at(3.0, 1.0, offset)[1] for offset in (1.0, 0.0, -1.0))
    assert inside < on == 0.0 < outside and inside == pytest.approx(-outside)


def test_between_table_rates_the_answer_is_smooth(preview):
    rates = np.linspace(0.3, 2.9, 400)
    answers = np.array([preview.at(2.6, float(rate), 0.3)[1] for rate in rates])
    assert np.abs(np.diff(answers, 2)).max() < 0.01


@pytest.mark.parametrize(("progress", "rate"), [(-1.0, 1.2), (99.0, 1.2), (2.0, 0.0), (2.0, 9.0)])
def test_beyond_the_table_the_answer_is_a_finite_number(preview, progress, rate):
    omega, wanted = preview.at(progress, rate, 0.1)
    assert np.isfinite([omega, wanted]).all() and 2.0 < omega < 9.0


@pytest.mark.parametrize("y", [-0.4, 0.0, 0.3])
@pytest.mark.parametrize("even", [-0.3, 0.0, 0.2])
def test_a_leg_of_fixed_length_has_the_tangent_of_the_even_pendulum(y, even):
    h = 0.6
    offset = y + lean_offset(even, y, h)
    height = np.sqrt(y * y + h * h - offset * offset)
    assert offset / height == pytest.approx((y + even) / h)
