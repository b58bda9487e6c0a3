"""Built-in functions on vectors of bytes (tuples of Python ints), and CPN Tools' encodings."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.library.builtins_integers import read_integer
from pn2code.semantics.library.functions import checked, fail
from pn2code.semantics.values.data import Value, int_text

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator

Function = Callable[..., Any]
Bytes = tuple[int, ...]


def _text(data: Bytes) -> str:
    return "".join(map(chr, data))


def _bytes(text: str) -> Bytes:
    return tuple(map(ord, text))


def _sub(p: tuple[Bytes, int]) -> int:
    if not 0 <= p[1] < len(p[0]):
        raise fail("Subscript")
    return p[0][p[1]]


def _integer(e: Evaluator, data: Bytes) -> Value:
    found = read_integer(_text(data), 10)
    if found is None:
        raise fail("InvalidDataExn")
    return checked(e, found[0])


CONSTANTS: dict[str, Value] = {"Word8Vector.maxLen": 2**24 - 1}

FUNCTIONS: dict[str, tuple[int, Function]] = {
    "Byte.byteToChar": (1, lambda e, byte: chr(byte)),
    "Byte.charToByte": (1, lambda e, c: ord(c)),
    "Byte.bytesToString": (1, lambda e, data: _text(data)),
    "Byte.stringToBytes": (1, lambda e, text: _bytes(text)),
    "Word8Vector.length": (1, lambda e, data: len(data)),
    "Word8Vector.sub": (1, lambda e, p: _sub(p)),
    "Word8Vector.fromList": (1, lambda e, items: items),
    "Word8Vector.concat": (1, lambda e, parts: tuple(byte for part in parts for byte in part)),
    "ConnManagementLayer.stringEncode": (1, lambda e, text: _bytes(text)),
    "ConnManagementLayer.stringDecode": (1, lambda e, data: _text(data)),
    "ConnManagementLayer.integerEncode": (1, lambda e, number: _bytes(int_text(number))),
    "ConnManagementLayer.integerDecode": (1, _integer),
}
"""Full name -> number of curried arguments, function."""
