"""Constants of CPN ML as C: strings, integers of 64 bits and beyond."""

from __future__ import annotations


def c_bytes(text: str) -> str:
    """A string of CPN ML, whose characters are bytes, as a C string literal.

    Raises:
        UnicodeEncodeError: a character is none of the 256.
    """
    out = []
    for byte in text.encode("latin-1"):
        if chr(byte) in '"\\?':
            out.append(f"\\{chr(byte)}")
        elif chr(byte) == "\n":
            out.append("\\n")
        elif 32 <= byte < 127:
            out.append(chr(byte))
        else:
            out.append(f"\\{byte:03o}")
    return '"' + "".join(out) + '"'


def c_integer(value: int) -> str:
    """An int64_t constant, plain where it is small."""
    if -(2**31) < value < 2**31:
        return str(value)
    if value == -(2**63):
        return "INT64_MIN"
    return f"INT64_C({value})" if value >= 0 else f"-INT64_C({-value})"


def big_bytes(value: int) -> bytes:
    """An integer beyond 64 bits as pn_big.h keeps it."""
    count = (abs(value).bit_length() + 31) // 32
    header = 2 * count + (value < 0)
    return header.to_bytes(4, "little") + abs(value).to_bytes(4 * count, "little")


def c_big(value: int) -> str:
    """A pn_big_t."""
    if -(2**63) <= value < 2**63:
        return f"PN_BIG({c_integer(value)})"
    return f"PN_BIG_BYTES({c_bytes(big_bytes(value).decode('latin-1'))})"


def c_big_initialiser(value: int) -> str:
    """A pn_big_t that a static variable starts with."""
    return c_big(value).replace("PN_BIG", "PN_BIG_INIT", 1)
