"""The built-in environment of CPN ML: what exists, at which type, and what it means.

`BUILTINS` maps each full name (`List.map`, `Int.+`, `Ms.++`) to its type scheme and a one-line meaning; the
evaluator and the compiler implement exactly these names. `TOP_LEVEL` says which short names stand for them
at top level (`map`, `^^`, `time`),
`OVERLOADED` which short names stand for one of several, chosen by type (`+` is `Int.+`, `Real.+` or `IntInf.+`).
`COLSET_MEMBERS` are the functions of a colour set's own structure (`INT.all()` is `Colset.all` at `INT`).

Not in the tables: the constructors (`true`, `nil`, `::`, `SOME`, ... are `core.Con`, see `datatypes.DATATYPES`),
`empty` and `nil` (both the empty `core.ListExp`), and exceptions (`exceptions.EXCEPTIONS`).

In types, `time` stands for the type of model time: `IntInf.int`, or `real` in a net with a real clock.
"""

from __future__ import annotations

from pn2code.ml.library.builtin_table import COLSET_TABLE, TABLE
from pn2code.ml.library.builtin_table_absent import ABSENT_TABLE
from pn2code.ml.library.builtin_table_library import LIBRARY_TABLE
from pn2code.ml.library.builtin_table_sized import INTEGERS, SIZED_TABLE, WORDS
from pn2code.ml.library.schemes import BuiltinInfo


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
    **_read(SIZED_TABLE),
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


_WHOLE = ("Int", "IntInf", *INTEGERS)
_NUMBERS = ("Int", "Real", "IntInf", *INTEGERS)
_ORDERED = ("Int", "Real", "IntInf", "String", "Char", *INTEGERS, *WORDS)

OVERLOADED: dict[str, tuple[str, ...]] = {
    **{op: tuple(f"{s}.{op}" for s in (*_NUMBERS, *WORDS)) for op in ("+", "-", "*", "~")},
    "abs": tuple(f"{s}.abs" for s in _NUMBERS),
    **{op: tuple(f"{s}.{op}" for s in (*_WHOLE, *WORDS)) for op in ("div", "mod")},
    **{op: tuple(f"{s}.{op}" for s in _ORDERED) for op in ("<", "<=", ">", ">=")},
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
    "canreceive": "ConnManagementLayer.canreceive",
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
    "LargeWord": "Word32",
    "SMLTime": "Time",
    "CPN'Time": "ModelTime",
    "Real.Math": "Math",
    "LargeReal.Math": "Math",
    "Real64.Math": "Math",
}
"""Other names of structures."""

HIDDEN: frozenset[str] = frozenset(
    {
        *(full for full in TOP_LEVEL.values() if full.split(".")[0] in ("Ms", "Ref", "Time", "Random")),
        "Time.token@+", "Time.token@++",
        *(f"ConnManagementLayer.{name}" for name in (
            "stringEncode", "stringDecode", "integerEncode", "integerDecode",
        )),
        *(f"List.{name}" for name in (
            "mem", "remdupl", "rm", "rmall", "pos", "contains", "contains_all", "intersect", "union", "listsub", "ins",
            "ins_new", "sort", "unique_sort", "fmap", "mapfilter", "predlist",
        )),
    }
)  # fmt: skip
"""Full names that no net can write; it has the short ones."""

_OTHER_STRUCTURES = """
BinIO CharArray CharArraySlice IEEEReal IO
SMLofNJ StringCvt Unix Posix Socket Word8ArraySlice CPN'Replications
Replications Comms CPN'Sim CPN'NetCapture CPN'Monitors CPN'Env CPN'Settings CPN'StreamIO Cpn
"""

UTILITIES = frozenset({"IOUtil"})
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
    {s for s in STRUCTURES if s.startswith("CPN'") and s not in STRUCTURE_ALIASES}
    | {"Replications", "Comms", "Cpn", "Output"}
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
    | {"CharArray.maxLen"}
    | {"INetSock.inetAF", "Unix.W_EXITED", "Posix.Process.W_EXITED"}
    | {f"Posix.FileSys.{name}" for name in ("stdin", "stdout", "stderr")}
)  # fmt: skip
"""What else the library of SML/NJ has and pn2code has not: values, constructors, exceptions."""

ABSENT_FUNCTORS: frozenset[str] = frozenset(
    {
        *("ArrayQSortFn", "BSearchFn", "DynamicArrayFn", "GraphSCCFn", "Hash2TableFn"),
        *("IntervalSetFn", "KeywordFn", "MonoArrayFn"),
    }
)
"""Functors that CPN Tools has and pn2code has not."""

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
