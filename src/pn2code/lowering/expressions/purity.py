"""Which built-in functions read or change something besides giving a value: one table for the whole compiler."""

from __future__ import annotations

IMPURE = frozenset(
    [f"Ref.{op}" for op in ("!", ":=", "+=", "-=", "*=", "::=", "inc", "dec")]
    + ["TextIO.print", "Ms.random", "Colset.ran"]
)
"""Built-in functions whose order of evaluation matters."""

IMPURE_PREFIXES = ("Random.", "TextIO.", "prim.do_")
"""And whole families of them."""


def is_impure_builtin(name: str) -> bool:
    """Whether the built-in function reads or changes something."""
    return name in IMPURE or name.startswith(IMPURE_PREFIXES)
