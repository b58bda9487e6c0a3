"""Built-in functions on numbers: `Int`, `IntInf`, `Real`, `Math`, `Word`, and reading numbers from streams."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.library.builtins_scan import from_string, missing, scanner
from pn2code.semantics.values.data import (
    MAX_BITS,
    NONE,
    Data,
    MlException,
    MlLimit,
    Value,
    exception,
    int_text,
    order,
    real_digits,
    real_text,
)

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator
    from pn2code.semantics.evaluation.tasks import Task

Function = Callable[..., Any]


def fail(name: str, argument: Value | None = None) -> MlException:
    """The built-in exception of that name, to be raised."""
    return MlException(exception(name, argument))


# --- integers ----------------------------------------------------------------------------------


def checked(e: Evaluator, i: int) -> int:
    """The same number as an `int`; raises Overflow beyond its bits."""
    if not e.min_int <= i <= e.max_int:
        raise fail("Overflow")
    return i


def _nonzero(i: int) -> int:
    if i == 0:
        raise fail("Div")
    return i


def _quot(a: int, b: int) -> int:
    q = abs(a) // abs(_nonzero(b))
    return q if (a < 0) == (b < 0) else -q


def _power(base: int, exponent: int) -> int:
    if exponent >= 0:
        _fitting_bits(base.bit_length() * exponent if abs(base) > 1 else 0)
        return int(base**exponent)
    _nonzero(base)
    return 0  # as SML/NJ has it, also for 1 and ~1


def _fitting_bits(bits: int) -> None:
    if bits > MAX_BITS:
        raise MlLimit(f"a number of about {bits:,} bits, more than {MAX_BITS:,}")


def _shifted(p: tuple[int, int]) -> int:
    _fitting_bits(p[0].bit_length() + p[1])
    return p[0] << p[1]


def _sign(x: float) -> int:
    return (x > 0) - (x < 0)


def read_integer(text: str, base: int = 10) -> tuple[int, int] | None:
    """An integer at the start of a text, after blanks: it and the number of characters."""
    digits = "0123456789abcdef"[:base]
    prefix = "(?:0[xX](?=[0-9a-fA-F]))?" if base == 16 else ""
    found = re.match(rf"[ \t\n\v\f\r]*([~+-]?){prefix}([{digits}]+)", text, re.IGNORECASE)
    if found is None:
        return None
    number = int(found[2], base)
    return (-number if found[1] in ("~", "-") else number), found.end()


BASES = {"BIN": 2, "OCT": 8, "DEC": 10, "HEX": 16}
"""The bases of `StringCvt.radix`."""


def digits_text(number: int, base: int) -> str:
    """Digits of a number to a base, `~` for minus."""
    text = format(abs(number), {2: "b", 8: "o", 10: "d", 16: "X"}[base])
    return f"~{text}" if number < 0 else text


def _plausible_in_number(c: str) -> bool:
    return c in "0123456789abcdefABCDEFxX~+- \t\n\v\f\r"


def _written_in(structure: str) -> Function:
    """`Int.fmt`, whose digits are capital letters, or `IntInf.fmt`, whose are small."""

    def function(e: Evaluator, radix: Data, a: int) -> str:
        text = digits_text(a, BASES[radix.name])
        return text.lower() if structure == "IntInf" else text

    return function


def _integers(
    structure: str, fit: Callable[[Evaluator, int], int]
) -> dict[str, tuple[int, Function]]:
    """The operations of `Int` or `IntInf`; `fit` checks a result."""

    def read(e: Evaluator, text: str, base: int = 10) -> tuple[int, int] | None:
        found = read_integer(text, base)
        return None if found is None else (fit(e, found[0]), found[1])

    def scan(e: Evaluator, radix: Data, reader: Value, stream: Value) -> Task:
        base = BASES[radix.name]
        return scanner(lambda e, text: read(e, text, base), _plausible_in_number)(e, reader, stream)  # type: ignore[no-any-return]

    operations: dict[str, Function] = {
        "+": lambda e, p: fit(e, p[0] + p[1]),
        "-": lambda e, p: fit(e, p[0] - p[1]),
        "*": lambda e, p: fit(e, p[0] * p[1]),
        "~": lambda e, a: fit(e, -a),
        "abs": lambda e, a: fit(e, abs(a)),
        # Python's // and % round down, as SML's div and mod do
        "div": lambda e, p: fit(e, p[0] // _nonzero(p[1])),
        "mod": lambda e, p: fit(e, p[0] % _nonzero(p[1])),
        "quot": lambda e, p: fit(e, _quot(p[0], p[1])),
        "rem": lambda e, p: fit(e, p[0] - p[1] * _quot(p[0], p[1])),
        "min": lambda e, p: min(p[0], p[1]),
        "max": lambda e, p: max(p[0], p[1]),
        "sign": lambda e, a: _sign(a),
        # SML/NJ takes 0 for positive here, but not among unlimited integers
        "sameSign": lambda e, p: (
            (p[0] < 0) == (p[1] < 0) if structure == "Int" else _sign(p[0]) == _sign(p[1])
        ),
        "toString": lambda e, a: int_text(a),
        "fromString": from_string(read),
        "toLarge": lambda e, a: a,
        "fromLarge": lambda e, a: fit(e, a),
        "toInt": lambda e, a: checked(e, a),
        "fromInt": lambda e, a: a,
        "pow": lambda e, p: fit(e, _power(p[0], p[1])),
    }
    return {
        **{f"{structure}.{name}": (1, f) for name, f in operations.items()},
        f"{structure}.fmt": (2, _written_in(structure)),
        f"{structure}.scan": (3, scan),
    }


def _log2(number: int) -> int:
    if number <= 0:
        raise fail("Domain")
    return number.bit_length() - 1


UNBOUNDED: dict[str, Function] = {
    "divMod": lambda e, p: divmod(p[0], _nonzero(p[1])),
    "quotRem": lambda e, p: (_quot(p[0], p[1]), p[0] - p[1] * _quot(p[0], p[1])),
    "log2": lambda e, a: _log2(a),
    "orb": lambda e, p: p[0] | p[1],
    "xorb": lambda e, p: p[0] ^ p[1],
    "andb": lambda e, p: p[0] & p[1],
    "notb": lambda e, a: ~a,
    "<<": lambda e, p: _shifted(p),
    "~>>": lambda e, p: p[0] >> p[1],
}
"""Operations that only `IntInf` has."""


# --- words -------------------------------------------------------------------------------------

WORD_BITS = 31
_MASK = 2**WORD_BITS - 1


def _signed(w: int) -> int:
    return w - 2**WORD_BITS if w >> (WORD_BITS - 1) else w


def _read_word(e: Evaluator, text: str) -> tuple[int, int] | None:
    found = re.match(
        r"[ \t\n\v\f\r]*(?:0w(?=[0-9a-fA-F])|0?w?[xX](?=[0-9a-fA-F]))?([0-9a-fA-F]+)", text
    )
    if found is None:
        return None
    number = int(found[1], 16)
    if number > _MASK:
        raise fail("Overflow")
    return number, found.end()


WORDS: dict[str, Function] = {
    "fromInt": lambda e, a: a & _MASK,
    "fromLargeInt": lambda e, a: a & _MASK,
    "toInt": lambda e, w: checked(e, w),
    "toIntX": lambda e, w: _signed(w),
    "toLargeInt": lambda e, w: w,
    "toLargeIntX": lambda e, w: _signed(w),
    "+": lambda e, p: (p[0] + p[1]) & _MASK,
    "-": lambda e, p: (p[0] - p[1]) & _MASK,
    "*": lambda e, p: (p[0] * p[1]) & _MASK,
    "div": lambda e, p: p[0] // _nonzero(p[1]),
    "mod": lambda e, p: p[0] % _nonzero(p[1]),
    "andb": lambda e, p: p[0] & p[1],
    "orb": lambda e, p: p[0] | p[1],
    "xorb": lambda e, p: p[0] ^ p[1],
    "notb": lambda e, w: w ^ _MASK,
    "<<": lambda e, p: (p[0] << min(p[1], WORD_BITS)) & _MASK,
    ">>": lambda e, p: p[0] >> p[1],
    "~>>": lambda e, p: (_signed(p[0]) >> p[1]) & _MASK,
    "min": lambda e, p: min(p),
    "max": lambda e, p: max(p),
    "toString": lambda e, w: digits_text(w, 16),
    "fromString": from_string(_read_word),
}


def _comparisons(structure: str) -> dict[str, tuple[int, Function]]:
    operations: dict[str, Function] = {
        "<": lambda e, p: p[0] < p[1],
        "<=": lambda e, p: p[0] <= p[1],
        ">": lambda e, p: p[0] > p[1],
        ">=": lambda e, p: p[0] >= p[1],
        "compare": lambda e, p: order(p[0], p[1]),
    }
    return {f"{structure}.{name}": (1, f) for name, f in operations.items()}


# --- reals -------------------------------------------------------------------------------------


def divide(a: float, b: float) -> float:
    """IEEE division: by zero it is infinite, or not a number."""
    if b != 0:
        return a / b
    if a == 0 or math.isnan(a):
        return math.nan
    return math.copysign(math.inf, a) * math.copysign(1.0, b)


def one_nan(function: Function) -> Function:
    """The function, with `math.nan` for what is no number: tokens are found by identity, and this is the only one."""

    def known(e: Evaluator, argument: Any) -> Any:
        result = function(e, argument)
        return math.nan if type(result) is float and math.isnan(result) else result

    return known


def _rounded(how: Callable[[float], int]) -> Function:
    return lambda e, x: checked(e, how(_whole(x)))


def _ceiling(x: float) -> int:
    """The integer that SML/NJ's `ceil` gives: its sum rounds, so that 3.0000000000000004 is 3 and 1E~20 is 0."""
    return -1 - math.floor(-1.0 - x)


def _rounded_real(how: Callable[[float], int]) -> Function:
    def function(e: Evaluator, x: float) -> float:
        # What is rounded to zero has no sign there; a zero keeps its own.
        return float(how(x)) if math.isfinite(x) and x != 0.0 else x

    return function


def _compare_reals(e: Evaluator, p: tuple[float, float]) -> Data:
    if math.isnan(p[0]) or math.isnan(p[1]):
        raise fail("Unordered")
    return order(p[0], p[1])


def _is_negative(x: float) -> bool:
    """By the sign bit, which what is no number has: processors make it so."""
    return math.isnan(x) or math.copysign(1.0, x) < 0


def _sign_of_real(e: Evaluator, x: float) -> int:
    if math.isnan(x):
        raise fail("Domain")
    return _sign(x)


def _smaller(p: tuple[float, float]) -> float:
    return p[0] if p[0] < p[1] or math.isnan(p[1]) else p[1]


def _larger(p: tuple[float, float]) -> float:
    return p[0] if p[0] > p[1] or math.isnan(p[1]) else p[1]


def _remainder(a: float, b: float) -> float:
    if math.isinf(a) or b == 0:
        return math.nan
    # Where nothing remains, the zero has the sign of the divisor.
    return math.fmod(a, b) or math.copysign(0.0, b)


_BLANKS_AND_SIGN = r"[ \t\n\v\f\r]*([~+-]?)"
_DIGITS = r"(?:[0-9]+(?:\.[0-9]+)?|\.[0-9]+)(?:[eE]([~+-]?[0-9]+))?"
_ANY = re.compile(
    rf"{_BLANKS_AND_SIGN}(?:({_DIGITS.replace('([~', '(?:[~')})|(inf(?:inity)?)|(nan))",
    re.IGNORECASE,
)
_FINITE = re.compile(_BLANKS_AND_SIGN + f"({_DIGITS})")


def read_real(text: str) -> tuple[float, int] | None:
    """A real at the start of a text, after blanks, in SML's or C's way, also what is not finite: it and the number
    of characters."""
    found = _ANY.match(text)
    if found is None:
        return None
    if found[4]:
        return math.nan, found.end()
    number = float(found[2].replace("~", "-")) if found[2] else math.inf
    return (-number if found[1] in ("~", "-") else number), found.end()


def _read_real(e: Evaluator, text: str) -> tuple[Value, int] | None:
    """As `Real.scan`: what is not finite is not written there, and exponents are integers."""
    found = _FINITE.match(text)
    if found is None:
        return None
    digits = (found[3] or "").lstrip("+-~0")
    if digits:
        checked(e, 10**20 if len(digits) > 20 else int(digits))
    number = float(found[2].replace("~", "-"))
    return (-number if found[1] in ("~", "-") else number), found.end()


def format_real(e: Evaluator, how: Data, x: float) -> str:
    """`Real.fmt`.

    Raises:
        MlException: Size, for a number of digits that is not possible; Overflow, for one that is too large; Fail, for
            `EXACT`, which SML/NJ has not got.
    """
    if how.name == "EXACT":
        raise fail("Fail", "RealFormat: fmtReal: EXACT not supported")
    wanted: Any = how.argument
    digits: Any = wanted.argument if isinstance(wanted, Data) else None
    if digits is not None and digits < (1 if how.name == "GEN" else 0):
        raise fail("Size")
    if not math.isfinite(x) or how.name == "GEN":
        return real_text(x, 12 if digits is None else digits)
    places = 6 if digits is None else digits
    sign = "~" if _is_negative(x) else ""
    return sign + (_fixed if how.name == "FIX" else _scientific)(e, abs(x), places)


def _fixed(e: Evaluator, x: float, places: int) -> str:
    """So many digits behind the point; zeros behind those that SML/NJ finds."""
    digits, exponent = real_digits(x, places, behind=True) if x else ("0", 0)
    digits = "0" * -exponent + digits
    size = max(exponent, 0) + 1  # of the whole part
    text = digits[:size].ljust(size, "0")
    if not places:
        return text
    text += "." + digits[size : size + places]
    return text + missing(e, "0", checked(e, size + 1 + places), text)


def _scientific(e: Evaluator, x: float, places: int) -> str:
    """So many digits behind the point and an exponent; SML/NJ loses some of the zeros behind the last of 15 digits."""
    checked(e, places + 1)
    digits, exponent = real_digits(x, places + 1) if x else ("0", 0)
    text = digits[:1] + "." * bool(places) + digits[1 : places + 1]
    zeros = places - len(digits) + 1
    zeros -= len(text) if x else 0
    return text + missing(e, "0", len(text) + max(zeros, 0), text) + f"E{int_text(exponent)}"


_MODES: dict[str, Callable[[float], int]] = {
    "TO_NEAREST": round,
    "TO_NEGINF": math.floor,
    "TO_POSINF": math.ceil,
    "TO_ZERO": math.trunc,
}


def _whole(x: float) -> float:
    if math.isnan(x):
        raise fail("Domain")
    if math.isinf(x):
        raise fail("Overflow")
    return x


def _mantissa(x: float) -> tuple[int, float]:
    """`Real.toManExp`, a record in the order exp, man."""
    man, exp = math.frexp(x)
    return exp, man


def _from_mantissa(p: tuple[int, float]) -> float:
    try:
        return math.ldexp(p[1], p[0])
    except OverflowError:
        return math.copysign(math.inf, p[1])


def _parts(x: float) -> tuple[float, float]:
    """`Real.split`, a record in the order frac, whole."""
    if math.isinf(x):
        return math.nan, x  # the engine takes the one from the other
    if math.isnan(x):
        return x, x
    whole = x if x == 0.0 else math.trunc(x) + 0.0
    return x - whole, whole


def _check_float(x: float) -> float:
    if math.isinf(x):
        raise fail("Overflow")
    if math.isnan(x):
        raise fail("Div")
    return x


def _real_of(i: int) -> float:
    try:
        return float(i)
    except OverflowError:
        return math.inf if i > 0 else -math.inf


REALS: dict[str, Function] = {
    "+": lambda e, p: p[0] + p[1],
    "-": lambda e, p: p[0] - p[1],
    "*": lambda e, p: p[0] * p[1],
    "/": lambda e, p: divide(p[0], p[1]),
    "~": lambda e, a: -a,
    "abs": lambda e, a: abs(a),
    "==": lambda e, p: p[0] == p[1],
    "!=": lambda e, p: p[0] != p[1],
    "min": lambda e, p: _smaller(p),
    "max": lambda e, p: _larger(p),
    "sign": _sign_of_real,
    "compare": _compare_reals,
    "rem": lambda e, p: _remainder(p[0], p[1]),
    "fromInt": lambda e, a: float(a),
    "fromLargeInt": lambda e, a: _real_of(a),
    "floor": _rounded(math.floor),
    "ceil": _rounded(_ceiling),
    "round": _rounded(round),
    "trunc": _rounded(math.trunc),
    "realFloor": _rounded_real(math.floor),
    "realCeil": _rounded_real(math.ceil),
    "realRound": _rounded_real(round),
    "realTrunc": lambda e, x: math.trunc(x) + 0.0 if math.isfinite(x) else x,
    "isNan": lambda e, a: math.isnan(a),
    "isFinite": lambda e, a: math.isfinite(a),
    "toString": lambda e, a: real_text(a),
    "fromString": from_string(_read_real),
    "*+": lambda e, p: p[0] * p[1] + p[2],
    "*-": lambda e, p: p[0] * p[1] - p[2],
    "?=": lambda e, p: p[0] == p[1] or math.isnan(p[0]) or math.isnan(p[1]),
    "unordered": lambda e, p: math.isnan(p[0]) or math.isnan(p[1]),
    "signBit": lambda e, a: _is_negative(a),
    "sameSign": lambda e, p: _is_negative(p[0]) == _is_negative(p[1]),
    "copySign": lambda e, p: math.copysign(p[0], -1.0 if _is_negative(p[1]) else 1.0),
    "isNormal": lambda e, a: math.isfinite(a) and abs(a) >= sys.float_info.min,
    "toManExp": lambda e, a: _mantissa(a),
    "fromManExp": lambda e, p: _from_mantissa(p),
    "split": lambda e, a: _parts(a),
    "realMod": lambda e, a: _parts(a)[0],
    "nextAfter": lambda e, p: math.nextafter(p[0], p[1]),
    "checkFloat": lambda e, a: _check_float(a),
    "toLarge": lambda e, a: a,
}


def _quiet(name: str) -> Function:
    """A function of C's mathematics library with C's answers where Python raises exceptions."""
    function: Callable[[float], float] = getattr(math, name)

    def quiet(e: Evaluator, x: float) -> float:
        try:
            return function(x)
        except ValueError:
            return math.nan  # outside the domain
        except OverflowError:
            return -math.inf if name == "sinh" and x < 0 else math.inf

    return quiet


def _logarithm(function: Callable[[float], float]) -> Function:
    def quiet(e: Evaluator, x: float) -> float:
        if x == 0:
            return -math.inf
        return function(x) if x > 0 else math.nan

    return quiet


def power(a: float, b: float) -> float:
    """C's `pow`, but where SML says that there is no number."""
    if math.isnan(b) or (math.isinf(b) and abs(a) == 1):
        return math.nan
    try:
        return math.pow(a, b)
    except OverflowError:
        return -math.inf if a < 0 and math.fmod(b, 2) in (1.0, -1.0) else math.inf
    except ValueError:
        if a == 0 and b < 0:
            odd = math.fmod(b, 2) in (1.0, -1.0)
            return math.copysign(math.inf, a) if odd else math.inf
        return math.nan


MATHEMATICS: dict[str, Function] = {
    **{
        name: _quiet(name)
        for name in ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "exp", "sinh", "cosh", "tanh")
    },
    "ln": _logarithm(math.log),
    "log10": _logarithm(math.log10),
    "atan2": lambda e, p: math.atan2(p[0], p[1]),
    "pow": lambda e, p: power(p[0], p[1]),
}  # fmt: skip


CONSTANTS: dict[str, Value] = {
    "Math.pi": math.pi,
    "Math.e": math.e,
    "Real.posInf": math.inf,
    "Real.negInf": -math.inf,
    "Real.radix": 2,
    "Real.precision": 53,
    "Real.maxFinite": sys.float_info.max,
    "Real.minPos": math.ulp(0.0),
    "Real.minNormalPos": sys.float_info.min,
    "IntInf.precision": NONE,
    "IntInf.minInt": NONE,
    "IntInf.maxInt": NONE,
    "Word.wordSize": WORD_BITS,
}

FUNCTIONS: dict[str, tuple[int, Function]] = {
    **_integers("Int", checked),
    **_integers("IntInf", lambda e, i: i),
    **{
        name: f
        for structure in ("Int", "IntInf", "Real", "Word", "String", "Char", "Time")
        for name, f in _comparisons(structure).items()
    },
    **{f"IntInf.{name}": (1, f) for name, f in UNBOUNDED.items()},
    **{f"Word.{name}": (1, f) for name, f in WORDS.items()},
    "Word.fmt": (2, lambda e, radix, w: digits_text(w, BASES[radix.name])),
    **{f"Real.{name}": (1, one_nan(f)) for name, f in REALS.items()},
    "Real.toInt": (
        2,
        lambda e, mode, x: checked(e, (_MODES | {"TO_POSINF": _ceiling})[mode.name](_whole(x))),
    ),
    "Real.toLargeInt": (2, lambda e, mode, x: _MODES[mode.name](_whole(x))),
    "Real.fromLarge": (2, lambda e, mode, x: x),
    "Real.fmt": (2, format_real),
    "Real.scan": (2, scanner(_read_real, lambda c: c in "0123456789.~+-eEinfatyINFATY \t\n\v\f\r")),
    **{f"Math.{name}": (1, one_nan(f)) for name, f in MATHEMATICS.items()},
}
"""Full name -> number of curried arguments, function."""
