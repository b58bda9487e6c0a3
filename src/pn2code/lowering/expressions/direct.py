"""Built-in functions that are one operation of the runtime or of C, or nothing at all."""

from __future__ import annotations

_INT = "+ - * ~ abs div mod quot rem < <= > >= min max sign compare toString toInt fromInt toLarge fromLarge"


_INTINF = _INT


_REAL = (
    "+ - * / ~ abs < <= > >= == != min max sign compare rem fromInt fromLargeInt floor ceil round trunc "
    "realFloor realCeil realRound realTrunc isNan isFinite posInf negInf toString"
)


_MATH = "pi e sqrt sin cos tan asin acos atan atan2 exp pow ln log10 sinh cosh tanh"


_STRING = "^ size sub substring concat explode implode str isPrefix isSuffix isSubstring compare < <= > >="


_CHAR = (
    "ord chr compare < <= > >= isDigit isAlpha isAlphaNum isSpace isUpper isLower toUpper toLower"
)


_LIST = (
    "@ null length rev revAppend take drop mem rm rmall contains contains_all union listsub concat "
    "remdupl intersect pos"
)


_MS = "++ -- ** == != << <<= >> >>= cf size"


_RANDOM = (
    "bernoulli binomial uniform discrete normal exponential poisson erlang chisq student gamma beta "
    "weibull rayleigh"
)


DIRECT = frozenset(
    f"{structure}.{name}"
    for structure, names in (
        ("Int", _INT), ("IntInf", _INTINF), ("Real", _REAL), ("Math", _MATH), ("String", _STRING),
        ("Char", _CHAR),
        ("List", _LIST), ("Ms", _MS), ("Random", _RANDOM), ("Bool", "not toString"), ("TextIO", "print"),
        ("Time", "step"), ("ModelTime", "fromInt fromIntInf toString toReal add sub mult lt leq cmp"),
    )
    for name in names.split()
)  # fmt: skip
"""Built-in functions that are one operation of the runtime or of C, on their operands side by side."""


SAME = frozenset(
    [
        "Ms.ms_to_list",
        "Ms.list_to_ms",
        "Int.toInt",
        "Int.fromInt",
        "IntInf.toLarge",
        "IntInf.fromLarge",
    ]
)
"""Built-in functions that give back their argument, as it is represented."""
