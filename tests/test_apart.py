"""Blender kept apart: silence on the streams, and processes whose failures come back as one line."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
import types

import pytest

from ski_addon import apart
from ski_addon.errors import SkiAddonError


def python(code):
    return ["-c", code], [sys.executable]


def test_what_is_written_straight_to_the_streams_is_silenced_and_comes_back_after(capfd):
    with apart.silenced():
        os.write(1, b"chatter\n")
        os.write(2, b"warning\n")
        subprocess.run([sys.executable, "-c", "print('from a child')"], check=True)
    os.write(1, b"result\n")
    assert capfd.readouterr() == ("result\n", "")


def test_silence_ends_when_the_block_fails(capfd):
    with pytest.raises(ValueError, match="stop"), apart.silenced():
        raise ValueError("stop")
    os.write(2, b"failure\n")
    assert capfd.readouterr().err == "failure\n"


def test_inside_blender_is_not_its_module(monkeypatch):
    monkeypatch.setitem(sys.modules, "bpy", types.SimpleNamespace(app=types.SimpleNamespace(module=True)))
    assert not apart.inside_blender()
    monkeypatch.setitem(sys.modules, "bpy", types.SimpleNamespace(app=types.SimpleNamespace(module=False)))
    assert apart.inside_blender()
    monkeypatch.delitem(sys.modules, "bpy")
    assert not apart.inside_blender()


def test_process_that_ends_well_says_nothing_and_knows_that_it_is_apart(capfd):
    apart.run_apart(*python(f"import os; print('chatter'); assert '{apart.VARIABLE}' in os.environ"))
    assert capfd.readouterr() == ("", "") and not apart.is_apart()


def test_our_own_failures_come_back_with_their_code_and_line():
    with pytest.raises(SkiAddonError, match="^cannot read the recording none.npz: there is no such file$") as caught:
        apart.run_apart(["report", "none.npz"])
    assert caught.value.exit_code == 3


def test_only_the_last_line_of_a_failure_is_kept():
    with pytest.raises(SkiAddonError, match="^no device$") as caught:
        apart.run_apart(*python("import sys; sys.stderr.write('noise\\nski_addon: no device\\n\\n'); sys.exit(7)"))
    assert caught.value.exit_code == 7


def test_crash_is_a_failed_picture():
    with pytest.raises(SkiAddonError, match="ended unexpectedly") as caught:
        apart.run_apart(*python("import os; os.kill(os.getpid(), 9)"))
    assert caught.value.exit_code == 7


def test_interrupt_stops_the_process_at_once(tmp_path):
    mark = tmp_path / "alive"
    code = f"import time; open({str(mark)!r}, 'w').close(); time.sleep(60); open({str(mark)!r} + '2', 'w').close()"

    def interrupt_when_alive():
        while not mark.exists():
            time.sleep(0.02)
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt_when_alive, daemon=True).start()
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        apart.run_apart(*python(code))
    assert time.monotonic() - started < 20
