"""What an object remembers from step to step, named by itself, taken out and put back by one mechanism.

A class lists in `STATE` the attributes that the next step depends on: numbers, words, None, arrays, and objects that
have a `STATE` of their own. Everything else it holds must follow from how it was made and from what is listed. Arrays
are written in place: whoever holds a view of one sees the restored numbers.
"""

from __future__ import annotations

from typing import Any

import numpy as np

Value = np.ndarray | float | int | bool | str | None
State = dict[str, Value]
"""Values by dotted name, for instance `controller.balance.steering.offset`."""


class StateError(ValueError):
    """A state that is not one of the object it was to be put into."""


def take_state(owner: Any, prefix: str = "") -> State:
    """Return what `owner` remembers; arrays are copies."""
    state: State = {}
    for name in owner.STATE:
        value = getattr(owner, name)
        if hasattr(value, "STATE"):
            state |= take_state(value, f"{prefix}{name}.")
        else:
            state[prefix + name] = value.copy() if isinstance(value, np.ndarray) else value
    return state


def put_state(owner: Any, state: State) -> None:
    """Make `owner` remember `state`; raises `StateError`, with nothing changed, if that is of another kind."""
    _check(owner, state)
    _put(owner, state, "")


def _check(owner: Any, state: State) -> None:
    present = take_state(owner)
    if present.keys() != state.keys():
        odd = sorted(present.keys() ^ state.keys())
        raise StateError(f"{odd[0]} is missing or unknown")
    for name, value in present.items():
        new = state[name]
        if isinstance(value, np.ndarray) != isinstance(new, np.ndarray):
            raise StateError(f"{name} is of another kind")
        if isinstance(value, np.ndarray) and _kind(value) != _kind(new):
            raise StateError(f"{name} is {_kind(new)} instead of {_kind(value)}")


def _put(owner: Any, state: State, prefix: str) -> None:
    for name in owner.STATE:
        value = getattr(owner, name)
        if hasattr(value, "STATE"):
            _put(value, state, f"{prefix}{name}.")
        elif isinstance(value, np.ndarray):
            value[...] = state[prefix + name]
        else:
            setattr(owner, name, state[prefix + name])


def _kind(array: Any) -> str:
    return f"{array.dtype} {array.shape}"
