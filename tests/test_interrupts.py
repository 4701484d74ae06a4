"""Interrupts that are noted, and handlers that come back."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from ski_addon import interrupts

ROOT = Path(__file__).resolve().parents[1]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_first_interrupt_is_noted_and_the_second_is_raised(number):
    before = signal.getsignal(number)
    with pytest.raises(KeyboardInterrupt), interrupts.held() as asked:
        assert not asked()
        os.kill(os.getpid(), number)
        assert asked()
        os.kill(os.getpid(), number)
    assert signal.getsignal(number) is before


def test_signals_that_somebody_ignores_are_left_alone():
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with interrupts.held() as asked:
            os.kill(os.getpid(), signal.SIGINT)
            assert not asked() and signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)


def test_handler_that_python_did_not_set_ends_as_the_usual_one(monkeypatch):
    """Inside Blender the former handler is its own, which Python calls None and cannot set."""
    kept = {number: signal.getsignal(number) for number in interrupts.SIGNALS}
    monkeypatch.setattr(signal, "signal", lambda number, handler, real=signal.signal: real(number, handler) and None)
    try:
        with interrupts.held():
            pass
        assert signal.getsignal(signal.SIGINT) is signal.SIG_DFL
    finally:
        monkeypatch.undo()
        for number, handler in kept.items():
            signal.signal(number, handler)


def test_other_threads_have_no_interrupts():
    found = []

    def look():
        with interrupts.held() as asked, interrupts.at_once(lambda: None):
            found.append(asked())

    thread = threading.Thread(target=look)
    thread.start()
    thread.join()
    assert found == [False]


BUSY = """
import os, signal, threading, time
from ski_addon import apart, interrupts
with interrupts.at_once(lambda: print("tidied up", flush=True)), apart.silenced():
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGTERM)).start()
    while True:
        time.sleep(60)
"""


def test_process_ends_at_once_though_its_streams_lead_nowhere():
    done = subprocess.run(
        [sys.executable, "-c", BUSY], cwd=ROOT, capture_output=True, text=True, timeout=30, check=False
    )
    assert done.returncode == 130 and done.stdout == "tidied up\n"
    assert done.stderr == "ski_addon: interrupted: what is finished is kept\n"


def test_without_an_interrupt_nothing_happens_and_no_file_stays_open():
    before, files = signal.getsignal(signal.SIGINT), len(os.listdir("/proc/self/fd")) if os.path.isdir("/proc") else 0
    with interrupts.at_once(lambda: pytest.fail("tidied up")):
        pass
    assert signal.getsignal(signal.SIGINT) is before
    assert not files or len(os.listdir("/proc/self/fd")) == files
