"""Types during inference: `types.Type` with holes.

A `Meta` is an unknown type. It may carry a restriction: only equality types, only one of some base types (an
overloaded operator or literal), or any record with at least some fields. `Quant` is a type variable that a
scheme quantifies. `ERROR` is the type of what was reported already; it unifies with everything (`unifier`).
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

from pn2code.base.frozen import frozen, record
from pn2code.ml.core.types import UNIT, TCon, TFun, TRecord, TVar, Type, label_key


@frozen
class ICon:
    """As `TCon`."""

    name: str
    args: tuple[Ty, ...] = ()


@frozen
class IRec:
    """As `TRecord`; fields sorted."""

    fields: tuple[tuple[str, Ty], ...] = ()


@frozen
class IFun:
    """As `TFun`."""

    argument: Ty
    result: Ty


@frozen
class IAbstract:
    """A type whose implementation a signature hides (`S :> SIG`); later stages see the implementation.

    Args:
        name: unique in the program.
        args: its arguments.
        hidden: the implementation, at these arguments.
        equality: whether the signature says `eqtype`.
    """

    name: str
    args: tuple[Ty, ...]
    hidden: Ty
    equality: bool


@frozen
class IError:
    """The type of what was reported already."""


@record(eq=False)
class Quant:
    """A quantified variable; `index` is given when the declaration is translated."""

    equality: bool = False
    index: int = -1


@record(eq=False)
class Meta:
    """An unknown type.

    Args:
        level: depth of the `let` that it belongs to; deeper ones may be generalised.
        equality: only an equality type may stand for it.
        among: only one of these may stand for it (the first when nothing decides).
        fields: only a record with these fields may stand for it (and others, unless solved).
        ref: what stands for it, once known.
    """

    level: int
    equality: bool = False
    among: tuple[str, ...] = ()
    fields: dict[str, Ty] | None = None
    ref: Ty | None = None


Ty = ICon | IRec | IFun | IAbstract | IError | Quant | Meta

ERROR = IError()
I_UNIT = IRec()
I_INT = ICon("int")
I_REAL = ICon("real")
I_BOOL = ICon("bool")
I_STRING = ICon("string")
I_CHAR = ICon("char")
I_EXN = ICon("exn")


def i_list(t: Ty) -> ICon:
    """`t list`."""
    return ICon("list", (t,))


def i_tuple(*items: Ty) -> IRec:
    """The product."""
    return IRec(tuple((str(i), t) for i, t in enumerate(items, 1)))


def i_record(fields: Mapping[str, Ty]) -> IRec:
    """A record from fields in any order."""
    return IRec(tuple(sorted(fields.items(), key=lambda f: label_key(f[0]))))


def prune(t: Ty) -> Ty:
    """The type behind solved metas."""
    while isinstance(t, Meta) and t.ref is not None:
        t = t.ref
    return t


def parts(t: Ty) -> tuple[Ty, ...]:
    """The direct components."""
    if isinstance(t, ICon):
        return t.args
    if isinstance(t, IRec):
        return tuple(f for _, f in t.fields)
    if isinstance(t, IFun):
        return (t.argument, t.result)
    if isinstance(t, IAbstract):
        return (*t.args, t.hidden)
    return ()


@lru_cache(maxsize=10_000)
def _i_atom(name: str) -> ICon:
    """A type constructor without arguments: most types of a net are one."""
    return ICon(name)


@lru_cache(maxsize=10_000)
def _atom(name: str) -> TCon:
    return TCon(name)


def from_type(t: Type, variables: list[Ty]) -> Ty:
    """A finished type as one of inference, `variables` for its `TVar`s."""
    if isinstance(t, TVar):
        return variables[t.index]
    if isinstance(t, TCon):
        if not t.args:
            return _i_atom(t.name)
        return ICon(t.name, tuple(from_type(a, variables) for a in t.args))
    if isinstance(t, TRecord):
        return IRec(tuple((n, from_type(f, variables)) for n, f in t.fields))
    return IFun(from_type(t.argument, variables), from_type(t.result, variables))


def to_type(t: Ty) -> Type:
    """The finished type. What is still unknown is used nowhere and becomes unit; overloaded ones take the
    first choice.
    """
    t = prune(t)
    if isinstance(t, Meta):
        return TCon(t.among[0]) if t.among else UNIT
    if isinstance(t, Quant):
        return TVar(t.index, t.equality)
    if isinstance(t, ICon):
        if not t.args:
            return _atom(t.name)
        return TCon(t.name, tuple(to_type(a) for a in t.args))
    if isinstance(t, IRec):
        return TRecord(tuple((n, to_type(f)) for n, f in t.fields))
    if isinstance(t, IFun):
        return TFun(to_type(t.argument), to_type(t.result))
    if isinstance(t, IAbstract):
        return to_type(t.hidden)
    raise AssertionError("the error type left the checker")
