"""`@frozen`: what `@dataclass(frozen=True, slots=True)` gives, for modules with dozens of node classes.

Python 3.11's dataclasses compile six functions for each class, about a millisecond; with some hundred node classes that
was half of the start-up time. A frozen class compiles one, its `__init__`; the rest is shared. They are dataclasses in
every other way: `fields`, `replace`, `match`, subclasses. What they do not have: `__post_init__`, `init=False`,
key-word-only fields.

Example:

    @frozen
    class Node:
        \"\"\"A node.\"\"\"
        name: str
        span: Span = field(default=NOWHERE, compare=False, repr=False)
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from operator import attrgetter
from typing import Any, NoReturn, TypeVar, dataclass_transform

T = TypeVar("T")


@dataclass_transform(frozen_default=True, field_specifiers=(dataclasses.field,))
def frozen(cls: type[T]) -> type[T]:
    """Make a class a frozen, slotted dataclass that compares and hashes by value."""
    cls.__doc__ = cls.__doc__ or cls.__name__  # else dataclasses computes a signature for it
    made: Any = dataclasses.dataclass(init=False, repr=False, eq=False, slots=True)(cls)
    fields = dataclasses.fields(made)
    made.__init__ = _init(made, fields)
    made.__eq__, made.__hash__ = _comparison(tuple(f.name for f in fields if f.compare))
    made.__repr__ = _repr
    made.__reduce__ = _reduce
    made.__setattr__ = _frozen
    made.__delattr__ = _frozen
    return made  # type: ignore[no-any-return]


def _init(made: type, fields: tuple[dataclasses.Field[Any], ...]) -> Callable[..., None]:
    names: dict[str, object] = {"MISSING": dataclasses.MISSING}
    parameters, lines = ["self"], []
    for f in fields:
        if not f.init or f.kw_only or hasattr(made, "__post_init__"):
            raise TypeError(f"{made.__name__}.{f.name}: not for @frozen; use @dataclass")
        # Setting through the slot itself passes by the `__setattr__` that forbids it.
        names[f"set_{f.name}"] = getattr(made, f.name).__set__
        parameter, value = f.name, f.name
        if f.default_factory is not dataclasses.MISSING:
            names[f"make_{f.name}"] = f.default_factory
            parameter = f"{f.name}=MISSING"
            value = f"make_{f.name}() if {f.name} is MISSING else {f.name}"
        elif f.default is not dataclasses.MISSING:
            names[f"default_{f.name}"] = f.default
            parameter = f"{f.name}=default_{f.name}"
        parameters.append(parameter)
        lines.append(f"    set_{f.name}(self, {value})")
    code = "\n".join([f"def __init__({', '.join(parameters)}):", *lines, "    return None"])
    exec(code, names)  # the names come from the class statement
    made_init: Any = names["__init__"]
    made_init.__qualname__ = f"{made.__qualname__}.__init__"
    return made_init  # type: ignore[no-any-return]


def _comparison(
    names: tuple[str, ...],
) -> tuple[Callable[[Any, object], bool], Callable[[Any], int]]:
    key: Callable[[Any], Any]
    if len(names) > 1:
        key = attrgetter(*names)
    elif names:
        get = attrgetter(*names)

        def key(item: Any) -> Any:
            return (get(item),)
    else:

        def key(item: Any) -> Any:
            return ()

    def equal(self: Any, other: object) -> bool:
        return key(self) == key(other) if other.__class__ is self.__class__ else NotImplemented

    def hashed(self: Any) -> int:
        return hash(key(self))

    return equal, hashed


def _repr(self: Any) -> str:
    shown = (f"{f.name}={getattr(self, f.name)!r}" for f in dataclasses.fields(self) if f.repr)
    return f"{type(self).__qualname__}({', '.join(shown)})"


def _reduce(self: Any) -> tuple[type, tuple[Any, ...]]:
    return type(self), tuple(getattr(self, f.name) for f in dataclasses.fields(self))


def _frozen(self: object, name: str, value: object = None) -> NoReturn:
    raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")
