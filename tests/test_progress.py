"""Progress on a terminal, and where there is none."""

from __future__ import annotations

import io

from ski_addon.progress import ProgressDisplay


class Terminal(io.StringIO):
    def isatty(self):
        return True


class Clock:
    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now


def work(stream, *, steps=100, seconds=10.0, text="simulating"):
    clock = Clock()
    with ProgressDisplay(stream, clock) as display:
        for step in range(steps + 1):
            clock.now = seconds * step / steps
            assert display(step / steps, text) is True
        return display, stream.getvalue() if stream else ""


def test_plain_lines_come_every_tenth_with_the_time_left():
    _, written = work(io.StringIO())
    lines = written.splitlines()
    assert len(lines) == 10 and "\r" not in written
    assert lines[4].split() == ["simulating:", "50%,", "5", "s", "left"]
    assert lines[-1].split() == ["simulating:", "100%"]


def test_coarse_steps_give_one_plain_line_each():
    _, written = work(io.StringIO(), steps=3)
    assert [line.split()[1].strip(",") for line in written.splitlines()] == ["33%", "67%", "100%"]


def test_terminal_redraws_one_line_and_removes_it_at_the_end():
    stream = Terminal()
    _, during = work(stream)
    assert "\n" not in stream.getvalue()
    last = during.split("\r")[-1]
    assert last.startswith("simulating [############################] 100%")
    width = max(len(line) for line in during.split("\r"))
    assert stream.getvalue().endswith("\r" + " " * width + "\r")


def test_terminal_bar_shows_half_and_the_time_left():
    _, during = work(Terminal(), seconds=20.0)
    half = next(line for line in during.split("\r") if " 50%" in line)
    assert half.rstrip() == "simulating [##############..............]  50%, 10 s left"


def test_terminal_is_drawn_at_most_ten_times_a_second():
    _, during = work(Terminal(), steps=5000, seconds=2.0)
    assert 15 <= len(during.split("\r")) <= 23


def test_new_work_starts_its_own_clock_and_lines():
    stream, clock = io.StringIO(), Clock()
    with ProgressDisplay(stream, clock) as display:
        display(1.0, "planning")
        clock.now = 100.0
        display(0.0, "simulating")
        clock.now = 102.0
        display(0.5, "simulating")
    assert stream.getvalue().splitlines() == ["planning: 100%", "simulating:  50%, 2 s left"]


def test_text_that_counts_along_is_the_same_work():
    stream, clock = io.StringIO(), Clock()
    with ProgressDisplay(stream, clock) as display:
        for second in range(11):
            clock.now = float(second)
            display(second / 10, f"simulating {second} of 10 s")
    lines = stream.getvalue().splitlines()
    assert len(lines) == 10 and lines[4] == "simulating 5 of 10 s:  50%, 5 s left"


def test_fractions_outside_zero_to_one_are_clamped():
    stream = io.StringIO()
    with ProgressDisplay(stream, Clock()) as display:
        display(-3.0, "a")
        display(7.0, "a")
    assert stream.getvalue() == "a: 100%\n"


def test_without_a_stream_nothing_is_shown():
    display, written = work(None)
    assert written == "" and display(0.5, "more") is True
