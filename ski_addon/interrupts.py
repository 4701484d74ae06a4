"""Interrupts (Ctrl+C, a polite kill) that are noted rather than raised, or that end foreign code at once."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import threading
from collections.abc import Callable, Iterator
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)


@contextlib.contextmanager
def held() -> Iterator[Callable[[], bool]]:
    """Yield a function that says whether an interrupt has come; a second one is raised as `KeyboardInterrupt`.

    Outside the main thread, where signals cannot be had, none ever comes.
    """
    asked = False

    def note(_number: int, _frame: FrameType | None) -> None:
        nonlocal asked
        if asked:
            raise KeyboardInterrupt
        asked = True

    with handled_by(note):
        yield lambda: asked


@contextlib.contextmanager
def handled_by(handler: Callable[[int, FrameType | None], None]) -> Iterator[None]:
    """Let `handler` handle interrupts while the block runs (only the main thread may set signals)."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    heard = [number for number in SIGNALS if signal.getsignal(number) is not signal.SIG_IGN]  # leave it to who asked
    previous = {number: signal.signal(number, handler) for number in heard}
    try:
        yield
    finally:
        for number, before in previous.items():
            # one that was not set by Python, as inside Blender, cannot be had back
            signal.signal(number, signal.SIG_DFL if before is None else before)


@contextlib.contextmanager
def at_once(tidy_up: Callable[[], None]) -> Iterator[None]:
    """End the process when an interrupt comes, even while foreign code runs that Python's handlers wait for.

    `tidy_up` is called before, with one line of failure on stderr and exit code 130 after it. The foreign code must let
    other threads run; where it does not, the process ends after it.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    ours, theirs = socket.socketpair()
    theirs.setblocking(False)
    streams = {number: os.dup(number) for number in (1, 2)}  # they may lead nowhere while foreign code runs
    watcher = threading.Thread(target=_wait, args=(ours, streams, tidy_up), daemon=True)
    watcher.start()
    previous = signal.set_wakeup_fd(theirs.fileno(), warn_on_full_buffer=False)
    try:
        with handled_by(lambda _number, _frame: None):
            yield
    finally:
        signal.set_wakeup_fd(previous)
        theirs.close()
        watcher.join()
        ours.close()
        for copy in streams.values():
            os.close(copy)


def _wait(ours: socket.socket, streams: dict[int, int], tidy_up: Callable[[], None]) -> None:
    """Wait for the number of a signal, or for the other end to be closed."""
    while content := ours.recv(1):
        if content[0] in SIGNALS:
            for number, copy in streams.items():
                os.dup2(copy, number)
            tidy_up()
            os.write(2, b"ski_addon: interrupted: what is finished is kept\n")
            os._exit(130)
