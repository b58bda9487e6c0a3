"""The registry of diagnostic codes.

Each code is declared once, in the table of the package that uses it, by `register`; `pn2code
explain CODE` prints the explanation. Each code has at least one test that triggers it.
"""

from __future__ import annotations

from pn2code.base.frozen import frozen


@frozen
class Code:
    """A code, a title of a few words, and an explanation of some sentences with an example.

    Args:
        is_answer: whether it says how a verification has come out: then cell.toml cannot accept it.
    """

    code: str
    title: str
    explanation: str
    is_answer: bool = False


_REGISTRY: dict[str, Code] = {}


def register(code: str, title: str, explanation: str, *, is_answer: bool = False) -> str:
    """Declare a code; returns it. Declaring one twice with other words is a bug."""
    entry = Code(code, title, explanation, is_answer)
    if _REGISTRY.get(code, entry) != entry:
        raise ValueError(f"diagnostic code {code!r} is declared twice")
    _REGISTRY[code] = entry
    return code


def require_code(code: str) -> Code:
    """The declaration of a code; KeyError (a bug in pn2code) when there is none."""
    return _REGISTRY[code]


def all_codes() -> list[Code]:
    """All declared codes, sorted."""
    return [_REGISTRY[c] for c in sorted(_REGISTRY)]
