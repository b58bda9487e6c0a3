"""The built-in data types, and what else there is of type constructors: arities, abbreviations, equality."""

from __future__ import annotations

from pn2code.ml.core.terms import Constructor, DatatypeDec
from pn2code.ml.core.types import INT, INTINF, TCon, TVar, Type, tuple_of
from pn2code.ml.library.builtin_table_sized import INTEGERS, WORD_BITS

_LIST_A = TCon("list", (TVar(0),))


def _datatype(name: str, generics: int, *constructors: tuple[str, Type | None]) -> DatatypeDec:
    made = tuple(
        (Constructor(c, name, tag, argument is not None, len(constructors)), argument)
        for tag, (c, argument) in enumerate(constructors)
    )
    return DatatypeDec(name, generics, made, None)


DATATYPES: dict[str, DatatypeDec] = {
    "bool": _datatype("bool", 0, ("false", None), ("true", None)),
    "list": _datatype("list", 1, ("nil", None), ("::", tuple_of(TVar(0), _LIST_A))),
    "option": _datatype("option", 1, ("NONE", None), ("SOME", TVar(0))),
    "order": _datatype("order", 0, ("LESS", None), ("EQUAL", None), ("GREATER", None)),
    "StringCvt.radix": _datatype(
        "StringCvt.radix", 0, ("BIN", None), ("OCT", None), ("DEC", None), ("HEX", None)
    ),
    "StringCvt.realfmt": _datatype(
        "StringCvt.realfmt",
        0,
        ("SCI", TCon("option", (INT,))),
        ("FIX", TCon("option", (INT,))),
        ("GEN", TCon("option", (INT,))),
        ("EXACT", None),
    ),
    "IEEEReal.rounding_mode": _datatype(
        "IEEEReal.rounding_mode",
        0,
        ("TO_NEAREST", None),
        ("TO_NEGINF", None),
        ("TO_POSINF", None),
        ("TO_ZERO", None),
    ),
    "OS.FileSys.access_mode": _datatype(
        "OS.FileSys.access_mode", 0, ("A_READ", None), ("A_WRITE", None), ("A_EXEC", None)
    ),
}
"""The built-in data types by name; constructors of those with a qualified name are in that structure only."""


FALSE, TRUE = (c for c, _ in DATATYPES["bool"].constructors)


NIL, CONS = (c for c, _ in DATATYPES["list"].constructors)


_ABSTRACT = (
    "TextIO.instream", "TextIO.outstream", "OS.FileSys.dirstream", "OS.Process.status", "OS.syserror", "Time.time",
    "Timer.real_timer", "Timer.cpu_timer", "Random.rand",
    "Word8Vector.vector", *(name for name in WORD_BITS if "." in name), *(f"{name}.int" for name in INTEGERS),
)  # fmt: skip


TYPE_ARITY: dict[str, int] = {
    "int": 0, "real": 0, "string": 0, "char": 0, "bool": 0, "exn": 0, "order": 0, "IntInf.int": 0,
    "list": 1, "option": 1, "ref": 1, "timed": 1, "vector": 1, "array": 1, "word": 0, "substring": 0,
    **dict.fromkeys(_ABSTRACT, 0),
    **{name: 0 for name in DATATYPES if "." in name},
}  # fmt: skip
"""Type constructors that are there at the start and their number of arguments."""


TYPE_ABBREVIATIONS: dict[str, str] = {
    "unit": "unit", "ms": "'a ms", "tms": "'a tms", "time": "time",
    "Connection": "string", "ConnManagementLayer.Connection": "string", "CPN'Time.time": "time",
    "Int.int": "int", "Real.real": "real", "String.string": "string", "Char.char": "char", "Bool.bool": "bool",
    "LargeInt.int": "IntInf.int", "General.unit": "unit", "General.exn": "exn", "General.order": "order",
    "List.list": "'a list", "Option.option": "'a option", "ModelTime.time": "time", "Vector.vector": "'a vector",
    "Array.array": "'a array", "Word.word": "word", "Substring.substring": "substring", "String.char": "char",
    "Char.string": "string", "TextIO.vector": "string", "TextIO.elem": "char", "SMLTime.time": "Time.time",
       "Int31.int": "int", "Word31.word": "word",
    "LargeWord.word": "Word32.word", "Position.int": "int", "LargeReal.real": "real", "Math.real": "real",
}  # fmt: skip
"""Names for other types; their arguments are `'a`, `'b`."""


NO_EQUALITY: frozenset[str] = frozenset(
    {"exn", "substring", "TextIO.instream", "TextIO.outstream", "OS.FileSys.dirstream", "Random.rand",
     "Timer.real_timer", "Timer.cpu_timer"}
)  # fmt: skip
"""Type constructors whose values have no equality (functions have none either). `real` has: CPN Tools patched it in."""


LITERAL_TYPES: tuple[TCon, ...] = (INT, INTINF, *(TCon(f"{name}.int") for name in INTEGERS))
"""What an integer literal may be; int when nothing decides."""
WORD_TYPES: tuple[TCon, ...] = tuple(map(TCon, WORD_BITS))
"""What a literal like `0wx1F` may be; word when nothing decides."""
