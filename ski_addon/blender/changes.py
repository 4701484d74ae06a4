"""Word that a skier's settings were changed: whoever draws or plans listens, nobody is called back within a change."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any

Listener = Callable[[Any], None]
_listeners: list[Listener] = []
_held = 0


def listen(listener: Listener) -> None:
    """Call `listener` with the settings after each change."""
    _listeners.append(listener)


def unlisten(listener: Listener) -> None:
    """Call `listener` no more."""
    if listener in _listeners:
        _listeners.remove(listener)


def changed(settings: Any) -> None:
    """Tell all listeners that `settings` were changed, unless changes are held."""
    if not _held:
        for listener in list(_listeners):
            listener(settings)


@contextlib.contextmanager
def held() -> Iterator[None]:
    """Tell nobody of the changes within: there are many of them, and they make sense only together."""
    global _held
    _held += 1
    try:
        yield
    finally:
        _held -= 1
