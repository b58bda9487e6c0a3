"""Differences from the engine that are meant, and why."""

from __future__ import annotations

import re

from tests.oracle.answers import Said

_RULES: tuple[tuple[str, str], ...] = (
    (r"~0\.0|0\.0", "a negative zero is printed as `0.0`, not as `~0.0`"),
    (r"\bReal\.nextAfter\b", "`Real.nextAfter` works; SML/NJ has not got it and raises `Fail`"),
    (r"\bSubstring\.all\b|\b(Int31|Real64|CharArray)\.|Vector\.maxLen", "there only in other versions of the library"),
    (r"\b(?:null)\b", "`null` tests lists; in the engine it is the time 0 after `open`"),
    (r"^\w+\.set_\w+$", "the types of `set_..` are more general in the engine"),
    (r"\bfromCString\b", "`String.fromCString` reads up to what it cannot read"),
    (r"\bpad(Left|Right)\b", "an Overflow in padding to a number below zero"),
    (r"\bMath\.(sin|cos|tan|tanh|sinh|cosh|exp|atan2)\b", "the last digits of a function of the processor"),
    (r"\bIntInf\.(rem|quot|div|mod)\b", "the engine does not raise Div for 0 by 0"),
    (r"\bChar\.fromString\b", "a quotation mark is read as a character"),
    (r"\bWord8Vector\.sub\b", "another name for a type"),
    (r"^UT\.col\b", "positions below zero of a union"),
    (r"\binteger(De|En)code\b", "another exception of a function of Comms/CPN"),
    (r"\b(Char|Int|Real|IntInf|Bool|Word|StringCvt)\.(scan|scanString|splitl|takel|dropl|skipWS)\b",
     "a stream without end is read to its end"),
)  # fmt: skip


def reason_of(text: str, ours: Said, theirs: Said) -> str:
    """Why the answers may differ; "" if no reason is known."""
    if theirs.kind == "refused" and re.search(
        "unbound structure: (Vector|IEEEReal)", theirs.detail
    ):
        return "the engine has lost a structure of the library, as it does after some errors"
    if ours.kind in ("limit", "unavailable") and theirs.kind in ("timeout", "crash", "raised"):
        return "given up by both, or for lack of something"
    if ours.kind == "limit":
        return "pn2code gives up earlier"
    if ours.kind == theirs.kind == "raised" and theirs.detail == "Overflow":
        return "Overflow before another exception"
    words = f"{text} {ours.detail} {theirs.detail}"
    return next((why for pattern, why in _RULES if re.search(pattern, words)), "")
