"""Built-in functions on integers: `Int`, `IntInf` and `Word`, and reading them from text."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING

from pn2code.semantics.library.builtins_scan import from_string, scanner
from pn2code.semantics.library.functions import Function, checked, fail
from pn2code.semantics.values.data import MAX_BITS, Data, MlLimit, Value, int_text

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator
    from pn2code.semantics.evaluation.tasks import Task


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


def sign(x: float) -> int:
    """-1, 0 or 1; 0 for what is no number."""
    return (x > 0) - (x < 0)


def read_integer(text: str, base: int = 10) -> tuple[int, int] | None:
    """An integer at the start of a text, after blanks: it and the number of characters; None: there is none."""
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
    """Digits of a number to base 2, 8, 10 or 16, `~` for minus."""
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


def integers(
    structure: str, fit: Callable[[Evaluator, int], int]
) -> dict[str, tuple[int, Function]]:
    """The operations of `Int` or `IntInf`: by full name the number of curried arguments, and the function.

    `fit` checks a result.
    """

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
        "sign": lambda e, a: sign(a),
        # SML/NJ takes 0 for positive here, but not among unlimited integers
        "sameSign": lambda e, p: (
            (p[0] < 0) == (p[1] < 0) if structure == "Int" else sign(p[0]) == sign(p[1])
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
