# ruff: noqa: E501  (tables: one entry a line)
"""Numbers of a fixed size: words and checked integers, the same functions for each size; a table as in `builtin_table`."""

from __future__ import annotations

WORDS: dict[str, int] = {"Word": 31, "Word8": 8, "Word32": 32, "Word64": 64}
"""Structures of words -> their number of bits. `Word31` and `LargeWord` are other names."""

INTEGERS: dict[str, int] = {"Int32": 32, "Int64": 64}
"""Structures of integers that are checked, besides `Int` -> their number of bits."""


def word_type(structure: str) -> str:
    """The type of the words of a structure."""
    return "word" if structure == "Word" else f"{structure}.word"


WORD_BITS: dict[str, int] = {word_type(name): bits for name, bits in WORDS.items()}
"""Types of words -> their number of bits."""

_WORD = """
-- words of BITS bits
NAME.wordSize : int ; BITS
NAME.fromInt : int -> NUMBER ; modulo 2 to the power of BITS
NAME.toInt : NUMBER -> int ; raises Overflow
NAME.toIntX : NUMBER -> int ; the highest bit is the sign; raises Overflow
NAME.fromLargeInt : IntInf.int -> NUMBER ; modulo 2 to the power of BITS
NAME.toLargeInt : NUMBER -> IntInf.int ; the same number
NAME.toLargeIntX : NUMBER -> IntInf.int ; the highest bit is the sign
NAME.toLarge : NUMBER -> Word32.word ; modulo 2 to the power of 32
NAME.toLargeX : NUMBER -> Word32.word ; the highest bit is the sign
NAME.fromLarge : Word32.word -> NUMBER ; modulo 2 to the power of BITS
NAME.toLargeWord : NUMBER -> Word32.word ; as toLarge
NAME.toLargeWordX : NUMBER -> Word32.word ; as toLargeX
NAME.fromLargeWord : Word32.word -> NUMBER ; as fromLarge
NAME.~ : NUMBER -> NUMBER ; negation, modulo 2 to the power of BITS
NAME.+ : NUMBER * NUMBER -> NUMBER ; sum, modulo 2 to the power of BITS
NAME.- : NUMBER * NUMBER -> NUMBER ; difference, modulo 2 to the power of BITS
NAME.* : NUMBER * NUMBER -> NUMBER ; product, modulo 2 to the power of BITS
NAME.div : NUMBER * NUMBER -> NUMBER ; quotient; raises Div
NAME.mod : NUMBER * NUMBER -> NUMBER ; remainder; raises Div
NAME.andb : NUMBER * NUMBER -> NUMBER ; bitwise and
NAME.orb : NUMBER * NUMBER -> NUMBER ; bitwise or
NAME.xorb : NUMBER * NUMBER -> NUMBER ; bitwise exclusive or
NAME.notb : NUMBER -> NUMBER ; bitwise negation
NAME.<< : NUMBER * word -> NUMBER ; shifted left
NAME.>> : NUMBER * word -> NUMBER ; shifted right
NAME.~>> : NUMBER * word -> NUMBER ; shifted right, copies of the highest bit come in
NAME.< : NUMBER * NUMBER -> bool ; less
NAME.<= : NUMBER * NUMBER -> bool ; less or equal
NAME.> : NUMBER * NUMBER -> bool ; greater
NAME.>= : NUMBER * NUMBER -> bool ; greater or equal
NAME.compare : NUMBER * NUMBER -> order ; three-way comparison
NAME.min : NUMBER * NUMBER -> NUMBER ; the smaller
NAME.max : NUMBER * NUMBER -> NUMBER ; the larger
NAME.toString : NUMBER -> string ; hexadecimal
NAME.fmt : StringCvt.radix -> NUMBER -> string ; digits to a base
NAME.fromString : string -> NUMBER option ; hexadecimal
NAME.scan : StringCvt.radix -> ('a -> (char * 'a) option) -> 'a -> (NUMBER * 'a) option ; reads a number from a stream
"""

_INTEGER = """
-- integers of BITS bits
NAME.+ : NUMBER * NUMBER -> NUMBER ; sum; raises Overflow
NAME.- : NUMBER * NUMBER -> NUMBER ; difference; raises Overflow
NAME.* : NUMBER * NUMBER -> NUMBER ; product; raises Overflow
NAME.~ : NUMBER -> NUMBER ; negation; raises Overflow
NAME.abs : NUMBER -> NUMBER ; absolute value; raises Overflow
NAME.div : NUMBER * NUMBER -> NUMBER ; quotient rounded down; raises Div
NAME.mod : NUMBER * NUMBER -> NUMBER ; remainder with the sign of the divisor; raises Div
NAME.quot : NUMBER * NUMBER -> NUMBER ; quotient rounded towards zero; raises Div
NAME.rem : NUMBER * NUMBER -> NUMBER ; remainder with the sign of the dividend; raises Div
NAME.< : NUMBER * NUMBER -> bool ; less
NAME.<= : NUMBER * NUMBER -> bool ; less or equal
NAME.> : NUMBER * NUMBER -> bool ; greater
NAME.>= : NUMBER * NUMBER -> bool ; greater or equal
NAME.min : NUMBER * NUMBER -> NUMBER ; the smaller
NAME.max : NUMBER * NUMBER -> NUMBER ; the larger
NAME.sign : NUMBER -> int ; ~1, 0 or 1
NAME.sameSign : NUMBER * NUMBER -> bool ; whether both are below zero, or none is
NAME.compare : NUMBER * NUMBER -> order ; three-way comparison
NAME.toString : NUMBER -> string ; decimal, with ~ for minus
NAME.fromString : string -> NUMBER option ; after blanks, an optional sign and digits; raises Overflow
NAME.toInt : NUMBER -> int ; the same number; raises Overflow
NAME.fromInt : int -> NUMBER ; the same number
NAME.toLarge : NUMBER -> IntInf.int ; the same number
NAME.fromLarge : IntInf.int -> NUMBER ; the same number; raises Overflow
NAME.maxInt : NUMBER option ; 2 to the power of BITS - 1, less one
NAME.minInt : NUMBER option ; the smallest
NAME.precision : int option ; SOME BITS
NAME.fmt : StringCvt.radix -> NUMBER -> string ; digits to a base, with ~ for minus
NAME.scan : StringCvt.radix -> ('a -> (char * 'a) option) -> 'a -> (NUMBER * 'a) option ; reads a number from a stream
"""


def _of(table: str, name: str, number: str, bits: int) -> str:
    return table.replace("NAME", name).replace("NUMBER", number).replace("BITS", str(bits))


SIZED_TABLE = "".join(
    [
        *(_of(_WORD, name, word_type(name), bits) for name, bits in WORDS.items()),
        *(_of(_INTEGER, name, f"{name}.int", bits) for name, bits in INTEGERS.items()),
    ]
)
