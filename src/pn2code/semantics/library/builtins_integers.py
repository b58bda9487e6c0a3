"""Built-in functions on integers: `Int`, `IntInf` and `Word`, and reading them from text."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING

from pn2code.ml.library.builtin_table_sized import INTEGERS, WORDS
from pn2code.semantics.library.builtins_scan import from_string, scanner
from pn2code.semantics.library.functions import Function, checked, fail
from pn2code.semantics.values.data import MAX_BITS, Data, MlLimit, Value, int_text, some

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


def _plausible_in_word(c: str) -> bool:
    return c in "0123456789abcdefABCDEFwWxX \t\n\v\f\r"


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
        # What a scanner gives is a task.
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
            (p[0] < 0) == (p[1] < 0) if structure != "IntInf" else sign(p[0]) == sign(p[1])
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


def _read_digits(text: str, base: int) -> tuple[int, int] | None:
    """A word at the start of a text, after blanks: it and the number of characters."""
    digits = {2: "01", 8: "0-7", 10: "0-9", 16: "0-9a-fA-F"}[base]
    prefix = "0w?[xX]|0w" if base == 16 else "0w"
    found = re.match(rf"[ \t\n\v\f\r]*(?:(?:{prefix})(?=[{digits}]))?([{digits}]+)", text)
    return None if found is None else (int(found[1], base), found.end())


def words(structure: str, bits: int) -> dict[str, tuple[int, Function]]:
    """The operations on words of a size: by full name the number of curried arguments, and the function."""
    mask = 2**bits - 1
    large = 2 ** WORDS["Word32"] - 1

    def signed(w: int) -> int:
        return w - mask - 1 if w >> (bits - 1) else w

    def read(e: Evaluator, text: str, base: int = 16) -> tuple[int, int] | None:
        found = _read_digits(text, base)
        if found is not None and found[0] > mask:
            raise fail("Overflow")
        return found

    def scan(e: Evaluator, radix: Data, reader: Value, stream: Value) -> Task:
        base = BASES[radix.name]
        # What a scanner gives is a task.
        return scanner(lambda e, text: read(e, text, base), _plausible_in_word)(e, reader, stream)  # type: ignore[no-any-return]

    operations: dict[str, Function] = {
        "fromInt": lambda e, a: a & mask,
        "fromLargeInt": lambda e, a: a & mask,
        "toInt": lambda e, w: checked(e, w),
        "toIntX": lambda e, w: checked(e, signed(w)),
        "toLargeInt": lambda e, w: w,
        "toLargeIntX": lambda e, w: signed(w),
        **dict.fromkeys(("toLarge", "toLargeWord"), lambda e, w: w & large),
        **dict.fromkeys(("toLargeX", "toLargeWordX"), lambda e, w: signed(w) & large),
        **dict.fromkeys(("fromLarge", "fromLargeWord"), lambda e, w: w & mask),
        "~": lambda e, w: -w & mask,
        "+": lambda e, p: (p[0] + p[1]) & mask,
        "-": lambda e, p: (p[0] - p[1]) & mask,
        "*": lambda e, p: (p[0] * p[1]) & mask,
        "div": lambda e, p: p[0] // _nonzero(p[1]),
        "mod": lambda e, p: p[0] % _nonzero(p[1]),
        "andb": lambda e, p: p[0] & p[1],
        "orb": lambda e, p: p[0] | p[1],
        "xorb": lambda e, p: p[0] ^ p[1],
        "notb": lambda e, w: w ^ mask,
        "<<": lambda e, p: (p[0] << min(p[1], bits)) & mask,
        ">>": lambda e, p: p[0] >> p[1],
        "~>>": lambda e, p: (signed(p[0]) >> p[1]) & mask,
        "min": lambda e, p: min(p),
        "max": lambda e, p: max(p),
        "toString": lambda e, w: digits_text(w, 16),
        "fromString": from_string(read),
    }
    return {
        **{f"{structure}.{name}": (1, f) for name, f in operations.items()},
        f"{structure}.fmt": (2, lambda e, radix, w: digits_text(w, BASES[radix.name])),
        f"{structure}.scan": (3, scan),
    }


def fitting(bits: int) -> Callable[[Evaluator, int], int]:
    """Checks a result of integers of a size."""
    end = 2 ** (bits - 1)

    def fit(e: Evaluator, i: int) -> int:
        if not -end <= i < end:
            raise fail("Overflow")
        return i

    return fit


def sized_integers(structure: str, bits: int) -> dict[str, tuple[int, Function]]:
    """The operations on integers of a size.

    As in the engine, the smallest one is not divided by -1, even where only the remainder is asked for.
    """
    found = integers(structure, fitting(bits))
    smallest, refusal = -(2 ** (bits - 1)), "Div" if bits == 32 else "Overflow"

    def dividing(f: Function) -> Function:
        def function(e: Evaluator, p: tuple[int, int]) -> int:
            if p[0] == smallest and p[1] == -1:
                raise fail(refusal)
            return int(f(e, p))

        return function

    names = [f"{structure}.{name}" for name in ("div", "mod", "quot", "rem")]
    return {**found, **{name: (1, dividing(found[name][1])) for name in names}}


def constants() -> dict[str, Value]:
    """The limits of numbers of a fixed size, by full name."""
    found: dict[str, Value] = {f"{name}.wordSize": bits for name, bits in WORDS.items()}
    for name, bits in INTEGERS.items():
        found |= {
            f"{name}.precision": some(bits),
            f"{name}.minInt": some(-(2 ** (bits - 1))),
            f"{name}.maxInt": some(2 ** (bits - 1) - 1),
        }
    return found
