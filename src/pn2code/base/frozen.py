"""`@frozen`: what `@dataclass(frozen=True, slots=True)` gives, for modules with dozens of node classes.

Python 3.11's dataclasses compile six functions for each class, about a millisecond; with some hundred node classes that
was half of the start-up time. A frozen class compiles one, its `__init__`, when the first object is made; the rest is
shared. They are dataclasses in every other way: `fields`, `replace`, `match`, subclasses. What they do not have:
`__post_init__`, `init=False`, key-word-only fields, class variables, comparisons and the like of their own.

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


@dataclasses.dataclass(init=False, repr=False, eq=False, slots=True)
class _Sample:
    """What the standard library puts into a class."""

    field: int


_KIND: Any = _Sample.__dataclass_fields__["field"]._field_type  # type: ignore[attr-defined]
_PARAMETERS: Any = _Sample.__dataclass_params__  # type: ignore[attr-defined]


_SHARED = frozenset(
    {"__init__", "__eq__", "__hash__", "__repr__", "__reduce__", "__setattr__", "__delattr__"}
)
"""What all frozen classes have from here."""


@dataclass_transform(frozen_default=True, field_specifiers=(dataclasses.field,))
def frozen(cls: type[T]) -> type[T]:
    """Make a class a frozen, slotted dataclass that compares and hashes by value."""
    inherited: dict[str, dataclasses.Field[Any]] = {}
    for base in reversed(cls.__mro__[1:]):
        inherited.update(getattr(base, "__dataclass_fields__", {}))
    content = dict(cls.__dict__)
    annotations = content.get("__annotations__", {})
    own = {name: _field(cls, name, content.pop(name, dataclasses.MISSING)) for name in annotations}
    for name, f in own.items():
        f.name, f.type = name, annotations[name]
    everything = {**inherited, **own}
    for name in ("__dict__", "__weakref__"):
        content.pop(name, None)
    metaclass: Any = type(cls)
    if _SHARED & content.keys():
        names = ", ".join(sorted(_SHARED & content.keys()))
        raise TypeError(f"{cls.__name__}: its own {names}: not for @frozen; use @dataclass")
    made: Any = metaclass(
        cls.__name__,
        cls.__bases__,
        {
            **content,
            "__doc__": cls.__doc__ or cls.__name__,
            "__slots__": tuple(name for name in own if name not in inherited),
            "__match_args__": tuple(everything),
            "__dataclass_fields__": everything,
            "__dataclass_params__": _PARAMETERS,
            "__repr__": _repr,
            "__reduce__": _reduce,
            "__setattr__": _frozen,
            "__delattr__": _frozen,
        },
    )
    made.__qualname__ = cls.__qualname__
    fields = tuple(everything.values())
    made.__init__ = _first_init(made, fields)
    made.__eq__, made.__hash__ = _comparison(tuple(f.name for f in fields if f.compare))
    return made  # type: ignore[no-any-return]


def _field(cls: type, name: str, default: object) -> dataclasses.Field[Any]:
    """The field of a name from what the class statement assigns to it."""
    f: Any = default
    if not isinstance(default, dataclasses.Field):
        if default.__class__.__hash__ is None:
            raise ValueError(f"{cls.__name__}.{name}: a default that can change; use a factory")
        f = (
            dataclasses.field(default=default)
            if default is not dataclasses.MISSING
            else dataclasses.field()
        )
    annotation = cls.__annotations__[name]
    if (
        not f.init
        or f.kw_only is True
        or hasattr(cls, "__post_init__")
        or (isinstance(annotation, str) and "ClassVar" in annotation)
    ):
        raise TypeError(f"{cls.__name__}.{name}: not for @frozen; use @dataclass")
    f.kw_only = False
    f._field_type = _KIND
    return f  # type: ignore[no-any-return]


def _first_init(made: Any, fields: tuple[dataclasses.Field[Any], ...]) -> Callable[..., None]:
    """An `__init__` that puts the real one in its place: of many classes no object is ever made."""

    def first(self: Any, *values: Any, **named: Any) -> None:
        made.__init__ = _init(made, fields)
        made.__init__(self, *values, **named)

    return first


def _init(made: type, fields: tuple[dataclasses.Field[Any], ...]) -> Callable[..., None]:
    names: dict[str, object] = {"MISSING": dataclasses.MISSING}
    parameters, lines = ["self"], []
    for f in fields:
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
