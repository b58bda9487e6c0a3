"""Types of CPN ML, as the checker infers them and the later stages read them.

`int`, `real`, `string`, `char`, `bool`, `exn`, `'a list`, `'a ref`, `'a option`, `order`, `IntInf.int`, enumeration and
union colour sets, user datatypes are `TCon`; records, tuples and `unit` are `TRecord`; `'a ms` *is*
`'a list` in CPN Tools,
and `'a tms` is a list of timed values (`TCon("timed", ('a,))`).
"""

from __future__ import annotations

from pn2code.base.frozen import frozen


@frozen
class TCon:
    """A type constructor applied to arguments; `name` is unique in the program (stamped if shadowed)."""

    name: str
    args: tuple[Type, ...] = ()

    def __str__(self) -> str:
        """As CPN ML writes it."""
        if not self.args:
            return self.name
        if len(self.args) == 1:
            arg = self.args[0]
            text = f"({arg})" if _is_compound(arg) else str(arg)
            return f"{text} {self.name}"
        return f"({', '.join(map(str, self.args))}) {self.name}"


@frozen
class TRecord:
    """A record type; fields sorted in SML's label order (numeric labels by value, before words).

    The tuple `a * b` is the record `{1: a, 2: b}`; `unit` is the record without fields.
    """

    fields: tuple[tuple[str, Type], ...] = ()

    @property
    def is_tuple(self) -> bool:
        """Whether the labels are 1..n with n >= 2."""
        return len(self.fields) >= 2 and all(
            label == str(i) for i, (label, _) in enumerate(self.fields, 1)
        )

    def field(self, label: str) -> Type | None:
        """The type of a field."""
        return next((t for name, t in self.fields if name == label), None)

    def __str__(self) -> str:
        """As CPN ML writes it."""
        if not self.fields:
            return "unit"
        if self.is_tuple:
            return " * ".join(f"({t})" if _is_compound(t) else str(t) for _, t in self.fields)
        return "{" + ", ".join(f"{name}: {t}" for name, t in self.fields) + "}"


@frozen
class TFun:
    """A function type."""

    argument: Type
    result: Type

    def __str__(self) -> str:
        """As CPN ML writes it."""
        arg = f"({self.argument})" if isinstance(self.argument, TFun) else str(self.argument)
        return f"{arg} -> {self.result}"


@frozen
class TVar:
    """A quantified type variable of a scheme (never an unresolved one: those do not leave the checker).

    Args:
        index: number, unique in its scheme; printed as 'a, 'b, ...
        equality: whether only equality types may stand for it (''a).
    """

    index: int
    equality: bool = False

    def __str__(self) -> str:
        """As CPN ML writes it."""
        letter = chr(ord("a") + self.index % 26) + (
            str(self.index // 26) if self.index >= 26 else ""
        )
        return ("''" if self.equality else "'") + letter


Type = TCon | TRecord | TFun | TVar


def _is_compound(t: Type) -> bool:
    return isinstance(t, TFun) or (isinstance(t, TRecord) and t.is_tuple)


def label_key(label: str) -> tuple[int, int, str]:
    """Sort key of SML's record label order."""
    return (0, int(label), "") if label.isdigit() else (1, 0, label)


def record(fields: dict[str, Type]) -> TRecord:
    """A record type from its fields in any order."""
    return TRecord(tuple(sorted(fields.items(), key=lambda kv: label_key(kv[0]))))


def tuple_of(*types: Type) -> Type:
    """The product of the types: unit for none, the type itself for one."""
    if len(types) == 1:
        return types[0]
    return TRecord(tuple((str(i), t) for i, t in enumerate(types, 1)))


INT = TCon("int")
INTINF = TCon("IntInf.int")
REAL = TCon("real")
STRING = TCon("string")
CHAR = TCon("char")
BOOL = TCon("bool")
EXN = TCon("exn")
UNIT = TRecord()


def list_of(t: Type) -> TCon:
    """`t list`, which is also `t ms`."""
    return TCon("list", (t,))


def timed_of(t: Type) -> TCon:
    """One timed token, `v@s`; a timed multi-set is a list of them."""
    return TCon("timed", (t,))
