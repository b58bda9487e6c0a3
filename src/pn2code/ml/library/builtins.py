"""The built-in environment of CPN ML: what exists, at which type, and what it means.

`BUILTINS` maps each full name (`List.map`, `Int.+`, `Ms.++`) to its type scheme and a one-line meaning; the
evaluator and the compiler implement exactly these names. `TOP_LEVEL` says which short names stand for them
at top level (`map`, `^^`, `time`),
`OVERLOADED` which short names stand for one of several, chosen by type (`+` is `Int.+`, `Real.+` or `IntInf.+`).
`COLSET_MEMBERS` are the functions of a colour set's own structure (`INT.all()` is `Colset.all` at `INT`).

Not in the tables: the constructors (`true`, `nil`, `::`, `SOME`, ... are `core.Con`, see `DATATYPES`),
`empty` and `nil` (both the empty `core.ListExp`), and exceptions (`EXCEPTIONS`).

In types, `time` stands for the type of model time: `IntInf.int`, or `real` in a net with a real clock.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from pn2code.ml.core.terms import Constructor, DatatypeDec
from pn2code.ml.core.types import (
    EXN,
    INT,
    INTINF,
    REAL,
    STRING,
    TCon,
    TFun,
    TRecord,
    TVar,
    Type,
    record,
    tuple_of,
)
from pn2code.ml.library.builtin_table import COLSET_TABLE, TABLE
from pn2code.ml.library.builtin_table_absent import ABSENT_TABLE
from pn2code.ml.library.builtin_table_library import LIBRARY_TABLE

_LIST_A = TCon("list", (TVar(0),))


@dataclass(frozen=True, slots=True)
class BuiltinInfo:
    """One entry.

    Args:
        name: full name.
        text: the type as written in the table.
        meaning: one line.
        unsupported: why it cannot run here; "" when it can. Uses are reported as warnings, and a run stops where it is
            applied.
    """

    name: str
    text: str
    meaning: str
    unsupported: str = ""

    @property
    def generics(self) -> int:
        """Number of type variables."""
        return scheme(self.text)[1]

    def type(self, real_time: bool = False) -> Type:
        """The type, its variables numbered in order of appearance."""
        return scheme(self.text, real_time)[0]


@cache
def scheme(text: str, real_time: bool = False, own: Type | None = None) -> tuple[Type, int]:
    """A type from its text, and the number of its variables; `own` replaces the name `cs`."""
    return _SchemeParser(text, real_time, own).parse()


class _SchemeParser:
    """Types as written in the table: `('a -> 'b) * 'a list -> 'b list`. The text is ours, so a mistake is a bug."""

    def __init__(self, text: str, real_time: bool, own: Type | None) -> None:
        for sign in "(){},":
            text = text.replace(sign, f" {sign} ")
        self._tokens = [*text.split(), ""]
        self._at = 0
        self._variables: dict[str, TVar] = {}
        self._time = REAL if real_time else INTINF
        self._own = own

    def parse(self) -> tuple[Type, int]:
        t = self._function()
        if self._tokens[self._at]:
            raise ValueError(f"in a built-in type: unexpected {self._tokens[self._at]!r}")
        return t, len(self._variables)

    def _next(self) -> str:
        self._at += 1
        return self._tokens[self._at - 1]

    def _accept(self, token: str) -> bool:
        if self._tokens[self._at] == token:
            self._at += 1
            return True
        return False

    def _function(self) -> Type:
        t = self._product()
        return TFun(t, self._function()) if self._accept("->") else t

    def _product(self) -> Type:
        parts = [self._applied()]
        while self._accept("*"):
            parts.append(self._applied())
        return tuple_of(*parts)

    def _applied(self) -> Type:
        t = self._atom()
        while (word := self._tokens[self._at]) and (word[0].isalpha()):
            self._at += 1
            if word == "tms":
                word, t = "list", TCon("timed", (t,))
            t = TCon("list" if word == "ms" else word, (t,))
        return t

    def _atom(self) -> Type:
        word = self._next()
        if word == "{":
            return self._record()
        if word == "(":
            t = self._function()
            if not self._accept(")"):
                raise ValueError("in a built-in type: `)` expected")
            return t
        if word.startswith("'"):
            if word not in self._variables:
                self._variables[word] = TVar(len(self._variables), word.startswith("''"))
            return self._variables[word]
        if word == "unit":
            return TRecord()
        if word == "time":
            return self._time
        if word == "cs" and self._own is not None:
            return self._own
        return TCon(word)

    def _record(self) -> Type:
        fields: dict[str, Type] = {}
        while True:
            label = self._next()
            if not self._accept(":"):
                raise ValueError("in a built-in type: `:` expected")
            fields[label] = self._function()
            if self._accept("}"):
                return record(fields)
            if not self._accept(","):
                raise ValueError("in a built-in type: `,` expected")


def _read(table: str) -> dict[str, BuiltinInfo]:
    out: dict[str, BuiltinInfo] = {}
    unsupported = ""
    for line in table.strip().splitlines():
        if line.startswith("=="):
            unsupported = line[2:].strip()
            continue
        if not line.strip() or line.startswith("--"):
            continue
        name, rest = line.split(" : ", 1)
        text, meaning = rest.split(" ; ", 1)
        out[name.strip()] = BuiltinInfo(name.strip(), text.strip(), meaning.strip(), unsupported)
    return out


def _read_absent(table: str) -> dict[str, BuiltinInfo]:
    out: dict[str, BuiltinInfo] = {}
    reason = ""
    for line in table.strip().splitlines():
        if line.startswith("=="):
            reason = line[2:].strip()
            continue
        structure, members = line.split(" : ", 1)
        for member in members.split():
            name = f"{structure}.{member}"
            out[name] = BuiltinInfo(name, "'a -> 'b", "is not there", reason)
    return out


BUILTINS: dict[str, BuiltinInfo] = {
    **_read_absent(ABSENT_TABLE),
    **_read(TABLE),
    **_read(LIBRARY_TABLE),
}
COLSET_MEMBERS: dict[str, BuiltinInfo] = _read(COLSET_TABLE)


def internal_function(name: str) -> str | None:
    """The built-in that stands for a member of a structure of CPN Tools' own; None if there is no such structure.

    What these structures have is not known here, so any member is taken for a function that is not available.
    """
    structure = name.split(".")[0]
    if structure not in _INTERNAL:
        return None
    reason = "it belongs to the inner parts of CPN Tools"
    return BUILTINS.setdefault(name, BuiltinInfo(name, "'a -> 'b", "is not there", reason)).name


_NUMBERS = ("Int", "Real", "IntInf")
_ORDERED = ("Int", "Real", "IntInf", "String", "Char")

OVERLOADED: dict[str, tuple[str, ...]] = {
    **{op: tuple(f"{s}.{op}" for s in (*_NUMBERS, "Word")) for op in ("+", "-", "*")},
    "~": tuple(f"{s}.~" for s in _NUMBERS),
    "abs": ("Int.abs", "Real.abs", "IntInf.abs"),
    **{op: tuple(f"{s}.{op}" for s in ("Int", "IntInf", "Word")) for op in ("div", "mod")},
    **{op: tuple(f"{s}.{op}" for s in (*_ORDERED, "Word")) for op in ("<", "<=", ">", ">=")},
}
"""Short names that stand for one of several; the first (at int) is taken when nothing decides."""

TOP_LEVEL: dict[str, str] = {
    "/": "Real./",
    "^": "String.^",
    "^^": "List.@",
    "=": "=",
    "<>": "<>",
    "!": "Ref.!",
    ":=": "Ref.:=",
    "ref": "Ref.ref",
    "+=": "Ref.+=",
    "-=": "Ref.-=",
    "*=": "Ref.*=",
    "::=": "Ref.::=",
    "inc": "Ref.inc",
    "dec": "Ref.dec",
    "o": "General.o",
    "before": "General.before",
    "ignore": "General.ignore",
    "exnName": "General.exnName",
    "exnMessage": "General.exnMessage",
    "print": "TextIO.print",
    "not": "Bool.not",
    "real": "Real.fromInt",
    "floor": "Real.floor",
    "ceil": "Real.ceil",
    "round": "Real.round",
    "trunc": "Real.trunc",
    "ord": "Char.ord",
    "chr": "Char.chr",
    "str": "String.str",
    "concat": "String.concat",
    "explode": "String.explode",
    "implode": "String.implode",
    "substring": "String.substring",
    "hd": "List.hd",
    "tl": "List.tl",
    "null": "List.null",
    "length": "List.length",
    "rev": "List.rev",
    "map": "List.map",
    "app": "List.app",
    "foldl": "List.foldl",
    "foldr": "List.foldr",
    "valOf": "Option.valOf",
    "isSome": "Option.isSome",
    "getOpt": "Option.getOpt",
    "mem": "List.mem",
    "remdupl": "List.remdupl",
    "rm": "List.rm",
    "rmall": "List.rmall",
    "pos": "List.pos",
    "contains": "List.contains",
    "contains_all": "List.contains_all",
    "intersect": "List.intersect",
    "union": "List.union",
    "listsub": "List.listsub",
    "ins": "List.ins",
    "ins_new": "List.ins_new",
    "sort": "List.sort",
    "unique_sort": "List.unique_sort",
    "flatten": "List.concat",
    **{name: f"Misc.{name}" for name in ("a_cmp", "makelist", "split", "basename", "time_of_day", "isSubstring")},
    "fmap": "List.fmap",
    "`": "Ms.`",
    "++": "Ms.++",
    "--": "Ms.--",
    "**": "Ms.**",
    "%": "Ms.%",
    "//": "Ms.//",
    "==": "Ms.==",
    "!=": "Ms.!=",
    "<><>": "Ms.!=",
    "<<": "Ms.<<",
    "<<=": "Ms.<<=",
    "<<==": "Ms.<<=",
    ">>": "Ms.>>",
    ">>=": "Ms.>>=",
    ">>==": "Ms.>>=",
    "cf": "Ms.cf",
    "size": "Ms.size",
    "random": "Ms.random",
    "ext_col": "Ms.ext_col",
    "ext_ms": "Ms.ext_ms",
    "filter": "Ms.filter",
    "ms_to_col": "Ms.ms_to_col",
    "ms_to_list": "Ms.ms_to_list",
    "list_to_ms": "Ms.list_to_ms",
    "sort_ms": "Ms.sort_ms",
    "legal_ms": "Ms.legal_ms",
    "mkstr_ms": "Ms.mkstr_ms",
    "mapfilter": "List.mapfilter",
    "predlist": "List.predlist",
    "vector": "Vector.fromList",
    "openConnection": "ConnManagementLayer.openConnection",
    "acceptConnection": "ConnManagementLayer.acceptConnection",
    "closeConnection": "ConnManagementLayer.closeConnection",
    "send": "ConnManagementLayer.send",
    "receive": "ConnManagementLayer.receive",
    "canReceive": "ConnManagementLayer.canReceive",
    "stringEncode": "ConnManagementLayer.stringEncode",
    "stringDecode": "ConnManagementLayer.stringDecode",
    "integerEncode": "ConnManagementLayer.integerEncode",
    "integerDecode": "ConnManagementLayer.integerDecode",
    "@": "Time.@",
    "@+": "Time.@+",
    "@++": "Time.@++",
    "+++": "Time.+++",
    "ms": "Time.ms",
    "time": "Time.time",
    "step": "Time.step",
    "revAppend": "List.revAppend",
    **{
        name: f"ModelTime.{name}"
        for name in (
            "fromInt", "fromIntInf", "fromString", "toString", "toReal", "maketime", "add", "sub", "mult", "lt",
            "leq", "cmp",
        )
    },
    **{
        name: f"Random.{name}"
        for name in (
            "bernoulli", "binomial", "uniform", "discrete", "normal", "exponential", "poisson", "erlang", "chisq",
            "student", "gamma", "beta", "weibull", "rayleigh",
        )
    },
}  # fmt: skip
"""Short name -> full name."""

QUALIFIED: dict[str, str] = {
    "General.!": "Ref.!",
    "General.:=": "Ref.:=",
    "List.^^": "List.@",
    "Real.real": "Real.fromInt",
    "Char.str": "String.str",
    "ModelTime.time": "Time.time",
    "ModelTime.@": "Time.@",
    **{f"TMS.{name}": f"Time.{name}" for name in ("ms", "+++", "@+", "@++")},
    **{f"ListUtils.{name}": f"List.{name}" for name in (
        "mem", "remdupl", "rm", "rmall", "pos", "contains", "contains_all", "intersect", "union", "listsub", "ins",
        "ins_new", "fmap", "mapfilter", "predlist",
    )},
    "ListUtils.split": "Misc.split",
    "Misc.filter": "Ms.filter",
    "Misc.flatten": "List.concat",
    "Misc.sort": "List.sort",
    "Misc.unique_sort": "List.unique_sort",
}  # fmt: skip
"""Qualified names that stand for another full name; all other qualified names stand for themselves."""

STRUCTURE_ALIASES: dict[str, str] = {
    "LargeInt": "IntInf",
    "Int31": "Int",
    "Position": "Int",
    "LargeReal": "Real",
    "Real64": "Real",
    "Word31": "Word",
    "SMLTime": "Time",
    "Real.Math": "Math",
    "LargeReal.Math": "Math",
    "Real64.Math": "Math",
}
"""Other names of structures."""

HIDDEN: frozenset[str] = frozenset(
    {
        *(full for full in TOP_LEVEL.values() if full.split(".")[0] in ("Ms", "Ref", "Time", "Random")),
        "Time.token@+", "Time.token@++",
        *(f"List.{name}" for name in (
            "mem", "remdupl", "rm", "rmall", "pos", "contains", "contains_all", "intersect", "union", "listsub", "ins",
            "ins_new", "sort", "unique_sort", "fmap", "mapfilter", "predlist",
        )),
    }
)  # fmt: skip
"""Full names that no net can write; it has the short ones."""

_OTHER_STRUCTURES = """
Array2 BinIO CharVector CharArray ArraySlice VectorSlice CharVectorSlice CharArraySlice IEEEReal IO Int32 Int64
LargeWord SMLofNJ StringCvt Unix Posix Socket Word32 Word64 Word8Array Word8VectorSlice CPN'Time CPN'Replications
Replications Comms CPN'Sim CPN'NetCapture CPN'Monitors CPN'Env CPN'Settings CPN'StreamIO Cpn
"""

UTILITIES = frozenset(
    {
        "ArrayQSort", "AtomTable", "Base64", "BitArray", "CharMap", "DynamicArray", "Format", "GetOpt",
        "IOUtil", "IntHashTable", "ParserComb", "PathUtil", "PrimeSizes", "PropList", "Rand",
        "RealOrderStats", "Scan", "SplayTree", "TimeLimit", "URef", "UnivariateStats", "WordHashTable",
    }
)  # fmt: skip
"""Structures of the utility library of SML/NJ that are not there; the others are in `library`."""

STRUCTURES: frozenset[str] = frozenset(
    {
        *_OTHER_STRUCTURES.split(),
        *UTILITIES,
        *STRUCTURE_ALIASES,
        *(name.split(".")[0] for name in BUILTINS if "." in name and name not in HIDDEN),
        "General",
        "ListUtils",
        "TMS",
    }
)
"""Structures of the library."""

_INTERNAL = frozenset(
    {s for s in STRUCTURES if s.startswith("CPN'")} | {"Replications", "Comms", "Cpn", "Output"}
)
"""Structures of CPN Tools itself, of which it is not known here what they have."""

ABSENT_VALUES: frozenset[str] = frozenset(
    {f"Date.{name}" for name in (
        "Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec", "Mon", "Tue", "Wed", "Thu",
        "Fri", "Sat", "Sun", "Date",
    )}
    | {f"IEEEReal.{name}" for name in (
        "TO_NEAREST", "TO_NEGINF", "TO_POSINF", "TO_ZERO", "NAN", "INF", "ZERO", "NORMAL", "SUBNORMAL", "LESS",
        "EQUAL", "GREATER", "UNORDERED",
    )}
    | {f"IO.{name}" for name in (
        "NO_BUF", "LINE_BUF", "BLOCK_BUF", "BlockingNotSupported", "RandomAccessNotSupported",
        "NonblockingNotSupported",
    )}
    | {f"StringCvt.{name}" for name in ("BIN", "OCT", "DEC", "HEX", "SCI", "FIX", "GEN", "EXACT")}
    | {f"{name}.maxLen" for name in ("CharVector", "CharArray", "Word8Vector", "Word8Array")}
    | {f"{name}.wordSize" for name in ("Word8", "Word32", "LargeWord")}
    | {f"Int32.{name}" for name in ("minInt", "maxInt", "precision")}
    | {"Array2.RowMajor", "Array2.ColMajor", "INetSock.inetAF", "Unix.W_EXITED", "Posix.Process.W_EXITED"}
    | {f"Posix.FileSys.{name}" for name in ("stdin", "stdout", "stderr")}
)  # fmt: skip
"""What else the library of SML/NJ has and pn2code has not: values, constructors, exceptions."""

UNSUPPORTED_NAMES: frozenset[str] = frozenset({"inst", "use"})
"""Top-level names of CPN Tools that are not supported; a net may declare its own."""

INFIX: dict[str, tuple[int, str]] = {
    **dict.fromkeys(("@",), (9, "left")),
    **dict.fromkeys(("`",), (8, "left")),
    **dict.fromkeys(("*", "/", "div", "mod", "**", "//", "%", "@+", "@++"), (7, "left")),
    **dict.fromkeys(("+", "-", "^", "++", "--", "+++"), (6, "left")),
    **dict.fromkeys(("::",), (5, "right")),
    **dict.fromkeys(("^^",), (5, "left")),
    **dict.fromkeys(("=", "<>", "<", ">", "<=", ">="), (4, "left")),
    **dict.fromkeys((":=", "o"), (3, "left")),
    **dict.fromkeys(
        ("==", "!=", "<><>", "<<", "<<=", "<<==", ">>", ">>=", ">>=="), (3, "left")
    ),
    **dict.fromkeys(("before", "::=", "+=", "-=", "*="), (0, "left")),
}  # fmt: skip
"""Operators that are infix at the start: precedence (9 binds tightest) and associativity."""


def _datatype(name: str, generics: int, *constructors: tuple[str, Type | None]) -> DatatypeDec:
    made = tuple(
        (Constructor(c, name, tag, argument is not None, len(constructors)), argument)
        for tag, (c, argument) in enumerate(constructors)
    )
    return DatatypeDec(name, generics, made, None)


_MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")

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
    "Date.month": _datatype("Date.month", 0, *((name, None) for name in _MONTHS)),
    "Date.weekday": _datatype(
        "Date.weekday", 0, *((d, None) for d in ["Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun"])
    ),
}
"""The built-in data types by name; constructors of those with a qualified name are in that structure only."""

FALSE, TRUE = (c for c, _ in DATATYPES["bool"].constructors)
NIL, CONS = (c for c, _ in DATATYPES["list"].constructors)

_EXCEPTIONS: tuple[tuple[str, Type | None], ...] = (
    ("Match", None),
    ("Bind", None),
    ("Div", None),
    ("Overflow", None),
    ("Subscript", None),
    ("Empty", None),
    ("Size", None),
    ("Chr", None),
    ("Domain", None),
    ("Option", None),
    ("Span", None),
    ("Fail", STRING),
    ("Subtract", None),
    ("no_singleton", None),
    ("CPN'Error", STRING),
    ("UnequalLengths", None),
    ("Io", record({"name": STRING, "function": STRING, "cause": EXN})),
    ("SysErr", tuple_of(STRING, TCon("option", (TCon("OS.syserror"),)))),
    ("Path", None),
    ("InvalidArc", None),
    ("Time", None),
    ("Date", None),
    ("Unordered", None),
    *(
        (name, None)
        for name in (
            "Bernoulli", "Binomial", "Uniform", "Discrete", "Normal", "Exponential", "Poisson", "Erlang", "Chisq",
            "Student", "Gamma", "Beta", "Weibull", "Rayleigh",
        )
    ),
    ("ClosedStream", None),
    ("IOError", STRING),
    ("InternalError", STRING),
    ("InvalidDataExn", None),
)  # fmt: skip

EXCEPTIONS: dict[str, tuple[Constructor, Type | None]] = {
    name: (Constructor(name, "exn", tag, argument is not None, 0), argument)
    for tag, (name, argument) in enumerate(_EXCEPTIONS)
}
"""The built-in exceptions: constructor and argument type. Tags of a net's own exceptions start at
`FIRST_EXCEPTION_TAG`.
"""

QUALIFIED_EXCEPTIONS: dict[str, str] = {
    "IO.Io": "Io",
    "IO.ClosedStream": "ClosedStream",
    "CPN'StreamIO.IOError": "IOError",
    "OS.SysErr": "SysErr",
    "OS.Path.Path": "Path",
    "OS.Path.InvalidArc": "InvalidArc",
    "Time.Time": "Time",
    "Date.Date": "Date",
    "IEEEReal.Unordered": "Unordered",
    "ListPair.UnequalLengths": "UnequalLengths",
    "ConnManagementLayer.InvalidDataExn": "InvalidDataExn",
    "Option.Option": "Option",
    "List.Empty": "Empty",
    **{
        f"General.{name}": name
        for name in (
            "Match", "Bind", "Div", "Overflow", "Subscript", "Size", "Chr", "Domain", "Span", "Fail",
        )
    },
}  # fmt: skip
"""Exceptions that have a qualified name."""

TOP_LEVEL_EXCEPTIONS: frozenset[str] = frozenset(
    {
        "Match", "Bind", "Div", "Overflow", "Subscript", "Empty", "Size", "Chr", "Domain", "Option", "Span", "Fail",
        "Subtract", "no_singleton", "CPN'Error", "InternalError",
        "Bernoulli", "Binomial", "Uniform", "Discrete", "Normal", "Exponential", "Poisson", "Erlang", "Chisq",
        "Student", "Gamma", "Beta", "Weibull", "Rayleigh",
    }
)  # fmt: skip
"""Exceptions that have a short name."""

FIRST_EXCEPTION_TAG = 100

_ABSTRACT = (
    "TextIO.instream", "TextIO.outstream", "OS.FileSys.dirstream", "OS.Process.status", "OS.syserror", "Time.time",
    "Timer.real_timer", "Timer.cpu_timer", "Date.date", "Random.rand", "Word8.word", "Word8Vector.vector",
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
    "Int.int": "int", "Real.real": "real", "String.string": "string", "Char.char": "char", "Bool.bool": "bool",
    "LargeInt.int": "IntInf.int", "General.unit": "unit", "General.exn": "exn", "General.order": "order",
    "List.list": "'a list", "Option.option": "'a option", "ModelTime.time": "time", "Vector.vector": "'a vector",
    "Array.array": "'a array", "Word.word": "word", "Substring.substring": "substring", "String.char": "char",
    "Char.string": "string", "TextIO.vector": "string", "TextIO.elem": "char", "SMLTime.time": "Time.time",
       "Int31.int": "int", "Position.int": "int", "LargeReal.real": "real", "Math.real": "real",
}  # fmt: skip
"""Names for other types; their arguments are `'a`, `'b`."""

NO_EQUALITY: frozenset[str] = frozenset(
    {"exn", "substring", "TextIO.instream", "TextIO.outstream", "OS.FileSys.dirstream", "Random.rand", "Date.date",
     "Timer.real_timer", "Timer.cpu_timer"}
)  # fmt: skip
"""Type constructors whose values have no equality (functions have none either). `real` has: CPN Tools patched it in."""

LITERAL_TYPES: tuple[TCon, ...] = (INT, INTINF)
"""What an integer literal may be; int when nothing decides."""
