# ruff: noqa: E501 - rows of rules
"""Differences from the engine that are meant, and why.

A rule hides a difference only where the answers differ as it says: the kinds of both answers, and what is in the text.
`--all FILE` shows what each has hidden.
"""

from __future__ import annotations

import re

from tools.oracle.answers import Said

_RULES: tuple[tuple[str, str, str, str], ...] = (
    ("*", "raised", r"\bReal\.nextAfter\b", "`Real.nextAfter` works; SML/NJ has not got it and raises `Fail`"),
    ("*", "refused", r"\bSubstring\.all\b|\b(Int31|Real64|CharArray)\.|Vector\.maxLen", "there only in other versions of the library"),
    ("*", "refused", r"\bnull\b", "`null` tests lists; in the engine it is the time 0 after `open`"),
    ("value", "value", r"^null$", "`null` tests lists; in the engine it is the time 0 after `open`"),
    ("value", "value", r"^\w+\.set_\w+$", "the types of `set_..` are more general in the engine"),
    ("refused", "*", r"\.set_\w+ ", "the types of `set_..` are more general in the engine"),
    ("value", "value", r"\bString\.fromCString\b", "`String.fromCString` reads up to what it cannot read"),
    ("value", "value", r"\btoCString\b", "`toCString` has three octal digits"),
    ("value", "raised", r"\bpad(Left|Right)\b.*~10737", "an Overflow in padding to a number below zero"),
    ("raised", "*", r"\bIntInf\.(rem|quot|div|mod)\b", "the engine does not raise Div for 0 by 0"),
    ("value", "value", r"\bChar\.fromString\b", "a quotation mark is read as a character"),
    ("value", "value", r"\bIntInf\.xorb\b", "xorb that is ~(2^30), ~(2^60), ... is 0 in the engine"),
    ("raised", "value", r"\bUT\.col\b", "positions below zero of a union"),
    ("raised", "raised", r"\binteger(De|En)code\b", "another exception of a function of Comms/CPN"),
    ("raised", "value", r"\bVector\.update\b", "an index beyond the end of a vector is not noticed"),
    ("raised", "*", r"\b(Word32|LargeWord)\.toInt\b.*\.(fromInt|toLarge(Word)?X)\b", "the engine's compiler makes nothing of toInt after fromInt"),
    ("*", "*", r"\bReal\.(to|from)ManExp\b", "exponents of zero and of what is not finite"),
    ("value", "value", r"\bReal\.(split|realMod)\b.*(minPos|minNormalPos|E~)", "what is behind the point of the least reals is 0.0 in the engine"),
    ("value", "value", r"\bMath\.(atan|asin|sinh|tanh) \(?~?0\.0\b", "the sign of a zero"),
    ("value", "value", r"\bReal\.rem\b", "remainders of what is very different in size"),
    ("*", "*", r"\bMath\.\w+\b.*(1E10|10737|maxFinite|minPos|posInf|negInf)|\bMath\.\w+\b.*nan", "functions of the processor outside of its range"),
    ("limit", "*", r"\b(Char|Int|Real|IntInf|Bool|Word|StringCvt)\.(scan|scanString|splitl|takel|dropl|skipWS)\b",
     "a stream without end is read to its end"),
)  # fmt: skip
"""Kind here, kind there, what the text and the answers have, why."""
_NUMBER = re.compile(r"~?\d+(?:\.\d+)?(?:E~?\d+)?")


def reason_of(text: str, ours: Said, theirs: Said) -> str:
    """Why the answers may differ; "" if no reason is known."""
    if theirs.kind == "refused" and re.search(
        "unbound structure: (Vector|IEEEReal)", theirs.detail
    ):
        return "the engine has lost a structure of the library, as it does after some errors"
    if ours.kind in ("limit", "unavailable") and theirs.kind in ("timeout", "crash", "raised"):
        return "given up by both, or for lack of something"
    same = ours.kind == theirs.kind == "value" and ours.type == theirs.type
    if same and _near(ours.detail, theirs.detail):
        return "the last digits of a function of the processor"
    words = f"{text} {ours.detail} {theirs.detail}"
    for here, there, pattern, why in _RULES:
        fits = here in ("*", ours.kind) and there in ("*", theirs.kind)
        if fits and re.search(pattern, text if pattern.startswith("^") else words):
            return why
    if ours.kind == "limit":
        return "pn2code gives up earlier"
    if ours.kind == theirs.kind == "raised" and theirs.detail == "Overflow":
        return "Overflow before another exception"
    return ""


def _near(ours: str, theirs: str) -> bool:
    """Whether the texts are the same but for reals that are nearly so: SML/NJ has ten digits of a power."""
    if _NUMBER.split(ours) != _NUMBER.split(theirs):
        return False
    pairs = zip(_NUMBER.findall(ours), _NUMBER.findall(theirs), strict=True)
    return all(_close(*(float(x.replace("~", "-")) for x in pair)) for pair in pairs)


def _close(a: float, b: float) -> bool:
    return abs(a - b) <= 1e-8 * max(abs(a), abs(b))
