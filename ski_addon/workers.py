"""A pool of processes that stop when told to, pass their failures on, and end with the first one."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing.process import BaseProcess
from multiprocessing.synchronize import Event
from typing import Any

from .errors import SkiAddonError
from .spec import FieldInfo
from .spec.values import check, parse_text

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Environment variables that say how many threads linear algebra uses."""


GRACE = 3.0
"""How long [s] a worker whose first process was killed may take to finish the file it writes."""


def read_jobs(text: str | None) -> int:
    """Return the number of processes written after `--jobs`, or as many as this process may use processors."""
    if text is None:
        affinity = getattr(os, "sched_getaffinity", None)  # not on every system
        return len(affinity(0)) if affinity else os.cpu_count() or 1
    info = FieldInfo("--jobs", "whole", 1, "", low=1, high=1024)
    value: Any = parse_text(info, text)
    check(info, value)
    return int(value)


def run_all(
    pool: ProcessPoolExecutor,
    work: Callable[..., Any],
    tasks: Sequence[tuple[Any, ...]],
    progress: Callable[[float, str], Any],
    what: str,
    each: Callable[[Any], Any] = lambda _result: None,
) -> list[Any]:
    """Return `work(*task, stop=...)` of every task, in order; the first failure is raised.

    `each(result)` and then `progress(fraction, text)` are called after each; `what` says in its text what is done.
    """
    with _interrupts_held():
        futures = [pool.submit(_in_worker, work, *task) for task in tasks]
    for done, future in enumerate(as_completed(futures), start=1):
        outcome = future.result()
        if isinstance(outcome, _Failure):
            error = SkiAddonError(outcome.message)
            error.exit_code = outcome.exit_code
            raise error
        each(outcome)
        progress(done / len(futures), f"{what}: {done} of {len(futures)}")
    return [future.result() for future in futures]


@contextlib.contextmanager
def worker_pool(jobs: int) -> Iterator[ProcessPoolExecutor]:
    """Yield a pool of `jobs` new processes; whatever goes wrong, they are told to stop and waited for."""
    context = multiprocessing.get_context("spawn")  # a fork would copy the threads of numpy and MuJoCo half
    stop = context.Event()
    unset = [name for name in THREADS if name not in os.environ]
    os.environ.update(dict.fromkeys(unset, "1"))  # the workers share the processors already
    pool = ProcessPoolExecutor(jobs, context, _start_worker, (stop,))
    try:
        yield pool
    except BrokenProcessPool:
        message = "a process ended unexpectedly: was there memory enough? Try fewer --jobs"
        raise SkiAddonError(message) from None
    finally:
        stop.set()
        pool.shutdown(wait=True, cancel_futures=True)
        for name in unset:
            os.environ.pop(name, None)


@dataclass(frozen=True)
class _Failure:
    """A failure in a worker: exceptions with evidence of their own do not survive the way between processes."""

    message: str
    exit_code: int


_stop: Event | None = None


def _in_worker(work: Callable[..., Any], *arguments: Any) -> Any:
    """Run `work` in a worker; return its failure instead of raising it."""
    try:
        return work(*arguments, stop=_stop.is_set if _stop else lambda: False)
    except SkiAddonError as error:
        return _Failure(str(error), error.exit_code)


def _start_worker(stop: Event) -> None:
    """Leave Ctrl+C and kills to the first process, which stops all workers; end when it is gone."""
    global _stop
    _stop = stop
    for number in (signal.SIGINT, signal.SIGTERM):  # a whole group may be told to end
        signal.signal(number, signal.SIG_IGN)
    first = multiprocessing.parent_process()
    if first is not None:
        threading.Thread(target=_end_with, args=(first,), daemon=True).start()


@contextlib.contextmanager
def _interrupts_held() -> Iterator[None]:
    """Keep Ctrl+C for later while processes are started: they inherit that, and are not hit before they ignore it."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _end_with(first: BaseProcess) -> None:
    """Wait for the end of the first process, then end this one: soon, so that the file it writes is whole or gone."""
    first.join()
    if _stop is not None:
        _stop.set()
        time.sleep(GRACE)
    os._exit(1)
