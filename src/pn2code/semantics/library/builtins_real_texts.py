"""Reals as text: reading them (`Real.fromString`, `scan`) and writing them in a style (`Real.fmt`)."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any

from pn2code.semantics.library.builtins_scan import missing
from pn2code.semantics.library.functions import checked, fail
from pn2code.semantics.values.data import Data, Value, int_text, real_digits, real_text

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator


def is_negative(x: float) -> bool:
    """By the sign bit, which what is no number has: processors make it so."""
    return math.isnan(x) or math.copysign(1.0, x) < 0


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


def scan_real(e: Evaluator, text: str) -> tuple[Value, int] | None:
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
    sign = "~" if is_negative(x) else ""
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
