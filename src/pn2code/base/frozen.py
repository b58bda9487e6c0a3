"""`@frozen`: what `@dataclass(frozen=True, slots=True)` gives, for modules with dozens of node classes.

Python 3.11's dataclasses compile six functions for each class, about a millisecond; with some hundred node classes that
was half of the start-up time. A frozen class compiles none: its `__init__` is the code of another class with as many
fields, with its own names in it, and is made when the first object is; the rest is shared. They are dataclasses in
every other way: `fields`, `replace`, `match`, subclasses. What they do not have:
`__post_init__`, `init=False`, key-word-only fields, class variables, comparisons and the like of their own.

`@frozen(eq=False)` compares and hashes by identity, as `@dataclass(frozen=True, slots=True, eq=False)` does, and
`@record` gives what `@dataclass(slots=True)` gives: objects that may be changed.

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
from functools import cache, partial
from operator import attrgetter
from types import CodeType, FunctionType
from typing import Any, NoReturn, TypeVar, dataclass_transform, overload

T = TypeVar("T")


@dataclasses.dataclass(init=False, repr=False, eq=False, slots=True)
class _Sample:
    """What the standard library puts into a class."""

    field: int


# The standard library's own, which has no public name.
_KIND: Any = _Sample.__dataclass_fields__["field"]._field_type  # type: ignore[attr-defined]
_PARAMETERS: Any = _Sample.__dataclass_params__  # type: ignore[attr-defined]  # likewise


_SHARED = frozenset(
    {"__init__", "__eq__", "__hash__", "__repr__", "__reduce__", "__setattr__", "__delattr__"}
)
"""What all frozen classes have from here."""


@overload
@dataclass_transform(frozen_default=True, field_specifiers=(dataclasses.field,))
def frozen(cls: type[T]) -> type[T]: ...


@overload
@dataclass_transform(frozen_default=True, field_specifiers=(dataclasses.field,))
def frozen(*, eq: bool) -> Callable[[type[T]], type[T]]: ...


def frozen(cls: type[T] | None = None, *, eq: bool = True) -> Any:
    """Make a class a frozen, slotted dataclass that compares and hashes by value, or else by identity."""
    return partial(_made, eq=eq) if cls is None else _made(cls, eq)


@overload
@dataclass_transform(field_specifiers=(dataclasses.field,))
def record(cls: type[T]) -> type[T]: ...


@overload
@dataclass_transform(field_specifiers=(dataclasses.field,))
def record(*, eq: bool) -> Callable[[type[T]], type[T]]: ...


def record(cls: type[T] | None = None, *, eq: bool = True) -> Any:
    """Make a class a slotted dataclass whose objects may be changed, and have no hash if they compare by value."""
    changing = partial(_made, eq=eq, is_frozen=False)
    return changing if cls is None else changing(cls)


def replace(item: T, /, **changes: Any) -> T:
    """What `dataclasses.replace` gives, for classes that are made here, in a quarter of its time."""
    kind = item.__class__
    places, values_of = _values_of(kind)  # type: ignore[arg-type]  # a type variable is hashable
    values = [*values_of(item)]
    try:
        for name, value in changes.items():
            values[places[name]] = value
    except KeyError:
        unknown = ", ".join(sorted(changes.keys() - set(places)))
        raise TypeError(f"{kind.__name__} has no {unknown}") from None
    return kind(*values)


@cache
def _values_of(kind: type) -> tuple[dict[str, int], Callable[[Any], tuple[Any, ...]]]:
    """The places of a class's fields by name, and what gives their values in that order."""
    names = tuple(kind.__dataclass_fields__)  # type: ignore[attr-defined]  # it is a dataclass
    places = {name: place for place, name in enumerate(names)}
    if len(names) > 1:
        return places, attrgetter(*names)
    return places, lambda item: tuple(getattr(item, name) for name in names)


def _made(cls: type[T], eq: bool, is_frozen: bool = True) -> type[T]:
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
            **(_UNCHANGED if is_frozen else {}),
        },
    )
    made.__qualname__ = cls.__qualname__
    fields = tuple(everything.values())
    made.__init__ = _first_init(made, fields)
    if eq:
        made.__eq__, hashed = _comparison(tuple(f.name for f in fields if f.compare))
        made.__hash__ = hashed if is_frozen else None
    return made  # type: ignore[no-any-return]  # it is made of `Any`


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
    return f  # type: ignore[no-any-return]  # it is made of `Any`


def _first_init(made: Any, fields: tuple[dataclasses.Field[Any], ...]) -> Callable[..., None]:
    """An `__init__` that puts the real one in its place: of many classes no object is ever made."""

    def first(self: Any, *values: Any, **named: Any) -> None:
        made.__init__ = _init(made, fields)
        made.__init__(self, *values, **named)

    return first


def _init(made: type, fields: tuple[dataclasses.Field[Any], ...]) -> Callable[..., None]:
    """The `__init__` of a class: code for as many fields, in which the names and defaults are those of this one."""
    names: dict[str, object] = {"MISSING": dataclasses.MISSING}
    defaults: list[object] = []
    factories: list[int] = []
    for n, f in enumerate(fields):
        # Setting through the slot itself passes by the `__setattr__` that forbids it.
        names[f"set{n}"] = getattr(made, f.name).__set__
        if f.default_factory is not dataclasses.MISSING:
            names[f"make{n}"] = f.default_factory
            factories.append(n)
            defaults.append(dataclasses.MISSING)
        elif f.default is not dataclasses.MISSING:
            defaults.append(f.default)
        elif defaults:
            raise TypeError(f"non-default argument {f.name!r} follows default argument")
    code = _code(len(fields), tuple(factories)).replace(
        co_varnames=("self", *(f.name for f in fields)),
        co_qualname=f"{made.__qualname__}.__init__",
    )
    return FunctionType(code, names, "__init__", tuple(defaults))


@cache
def _code(count: int, factories: tuple[int, ...]) -> CodeType:
    """That of an `__init__` with so many fields; `factories`: the numbers of those whose default is made anew."""
    lines = [f"def __init__({', '.join(['self', *(f'a{n}' for n in range(count))])}):"]
    for n in range(count):
        value = f"make{n}() if a{n} is MISSING else a{n}" if n in factories else f"a{n}"
        lines.append(f"    set{n}(self, {value})")
    found: dict[str, Any] = {}
    exec("\n".join([*lines, "    return None"]), found)
    code: CodeType = found["__init__"].__code__
    return code


def _comparison(
    names: tuple[str, ...],
) -> tuple[Callable[[Any, object], bool], Callable[[Any], int]]:
    key: Callable[[Any], Any]
    if len(names) > 1:
        key = attrgetter(*names)
    elif names:
        return _comparison_of_one(attrgetter(*names))
    else:

        def key(item: Any) -> Any:
            return ()

    def equal(self: Any, other: object) -> bool:
        return key(self) == key(other) if other.__class__ is self.__class__ else NotImplemented

    def hashed(self: Any) -> int:
        return hash(key(self))

    return equal, hashed


def _comparison_of_one(
    get: Callable[[Any], Any],
) -> tuple[Callable[[Any, object], bool], Callable[[Any], int]]:
    def equal(self: Any, other: object) -> bool:
        # As tuples: what is no number is itself.
        is_one = other.__class__ is self.__class__
        return (get(self),) == (get(other),) if is_one else NotImplemented

    def hashed(self: Any) -> int:
        return hash((get(self),))

    return equal, hashed


def _repr(self: Any) -> str:
    shown = (f"{f.name}={getattr(self, f.name)!r}" for f in dataclasses.fields(self) if f.repr)
    return f"{type(self).__qualname__}({', '.join(shown)})"


def _reduce(self: Any) -> tuple[type, tuple[Any, ...]]:
    return type(self), tuple(getattr(self, f.name) for f in dataclasses.fields(self))


def _frozen(self: object, name: str, value: object = None) -> NoReturn:
    raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")


_UNCHANGED = {"__setattr__": _frozen, "__delattr__": _frozen}
