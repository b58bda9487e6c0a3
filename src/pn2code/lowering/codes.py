"""Diagnostic codes of lowering, and the one way in which a construct is refused."""

from __future__ import annotations

from pn2code.diagnostics import Origin, Span
from pn2code.diagnostics.codes import register

UNSUPPORTED_TYPE = register(
    "unsupported-type",
    "a value of a type that the compiler has no representation for",
    "All types of CPN ML have a C representation, including functions, references and exceptions; some types that "
    "only the library of CPN Tools has do not.",
)
UNSUPPORTED_BUILTIN = register(
    "unsupported-builtin",
    "a built-in function that the compiler does not implement",
    "The function is known to the type checker, but there is no C code for it yet.",
)
UNSUPPORTED_EXPRESSION = register(
    "unsupported-expression",
    "an expression that the compiler does not implement",
    "The expression has a meaning in CPN ML, but there is no C code for it yet; the message says which.",
)
UNSUPPORTED_COLSET = register(
    "unsupported-colour-set-role",
    "a colour set that the compiler cannot handle in this role",
    "An example is the number of values of a subset, which is not known at compile time.",
)
OUTSIDE_MARKING = register(
    "unsupported-outside-marking",
    "a property looks at more than the marking",
    "A property is evaluated in every reachable marking. Random numbers, files and the number of steps are not part "
    "of a marking: the answer would depend on the run to it.",
)
STORAGE_COLSET = register(
    "storage-colour-set",
    "the storage table names something that is not a real colour set",
    '`[storage]` of cell.toml may say `NAME = "float32"` for a colour set of kind real.',
)


class UnsupportedError(Exception):
    """Lowering of one net element is given up; becomes one diagnostic. Never leaves `lowering`."""

    def __init__(self, code: str, message: str, at: Origin | Span, hint: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.at = at
        self.hint = hint
