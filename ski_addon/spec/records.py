"""`record`: frozen dataclasses that are made quickly, for the many that are there as soon as Blender starts.

`dataclasses.dataclass` writes and compiles six methods for each class, which took a third of enabling the extension;
records share theirs. To everyone else, a type checker too, they are dataclasses: `fields`, `replace` and `asdict` work,
values compare and hash by their fields, and attributes cannot be set. For the same reason modules of this folder load
what they need only for failures or files when they need it.
"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from dataclasses import dataclass as record

else:

    def record(*, frozen: bool) -> Any:
        """Return what makes a class a frozen dataclass; `frozen` must be true, and says so where it is used."""
        if not frozen:
            raise TypeError("records are frozen")
        return _made


SHARED = ("__init__", "__repr__", "__eq__", "__hash__", "__setattr__", "__delattr__")
"""Methods that `dataclasses.dataclass` would write for every class."""


def _made(cls: type) -> type:
    """Make `cls` a dataclass with the methods of `_Record`."""
    made: Any = dataclasses.dataclass(init=False, repr=False, eq=False)(cls)
    leaves, missing = dataclasses.fields(made), dataclasses.MISSING
    made._names = tuple(leaf.name for leaf in leaves)
    made._defaults = {leaf.name: leaf.default for leaf in leaves if leaf.default is not missing}
    made._factories = {leaf.name: leaf.default_factory for leaf in leaves if leaf.default_factory is not missing}
    for name in SHARED:
        setattr(made, name, _Record.__dict__[name])
    return cls


class _Record:
    """The methods that records share. The names, defaults and makers of defaults are those of each class."""

    _names: ClassVar[tuple[str, ...]]
    _defaults: ClassVar[dict[str, Any]]
    _factories: ClassVar[dict[str, Any]]

    def __init__(self, *given: Any, **named: Any) -> None:
        first = dict(zip(self._names, given, strict=False))
        unknown = named.keys() - self._names | named.keys() & first.keys()
        if unknown or len(given) > len(self._names):
            raise TypeError(f"{type(self).__name__} has no place for {', '.join(sorted(unknown)) or 'so many values'}")
        content = self._defaults | first | named
        content |= {name: make() for name, make in self._factories.items() if name not in content}
        if len(content) < len(self._names):
            missing = ", ".join(name for name in self._names if name not in content)
            raise TypeError(f"{type(self).__name__} needs a value for {missing}")
        self.__dict__.update(content)

    def __repr__(self) -> str:
        return f"{type(self).__qualname__}({', '.join(f'{name}={getattr(self, name)!r}' for name in self._names)})"

    def __eq__(self, other: object) -> bool:
        return self.__dict__ == other.__dict__ if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        content = self.__dict__
        return hash(tuple([content[name] for name in self._names]))

    def __setattr__(self, name: str, _value: Any) -> None:
        raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")

    def __delattr__(self, name: str) -> None:
        raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")
