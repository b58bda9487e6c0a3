"""Diagnostic codes of lowering, and the one way in which a construct is refused."""

from __future__ import annotations

from pn2code.diagnostics import Origin, Span
from pn2code.diagnostics.codes import register

UNSUPPORTED_FUNCTION_VALUE = register(
    "unsupported-function-value",
    "a function is stored or returned in a way the compiler cannot follow",
    "Functions may be passed to other functions and to `List.map`, `foldl` and their like, when it is known at "
    "compile "
    "time which function it is. A function in a list, in a reference, chosen by `if`, or returned by a "
    "recursive function is not.",
)
UNSUPPORTED_TYPE = register(
    "unsupported-type",
    "a value of a type that the compiler has no representation for",
    "References as values (other than `globref`s), exceptions as values, and types that stay unknown (`[]` that "
    "is never "
    "used at a type) have no C representation.",
)
UNSUPPORTED_BUILTIN = register(
    "unsupported-builtin",
    "a built-in function that the compiler does not implement",
    "The function is known to the type checker, but there is no C code for it yet.",
)
UNSUPPORTED_EXCEPTION = register(
    "unsupported-exception",
    "an exception that carries a value, or is used as a value",
    "Exceptions can be raised and handled by name. The argument of an exception cannot be looked at in a handler.",
)
UNSUPPORTED_EXPRESSION = register(
    "unsupported-expression",
    "an expression that the compiler does not implement",
    "The expression has a meaning in CPN ML, but there is no C code for it yet; the message says which.",
)
UNSUPPORTED_COLSET = register(
    "unsupported-colour-set-role",
    "a colour set that the compiler cannot handle in this role",
    "For example the number of the values of a subset, which is not known at compile time.",
)
STORAGE_COLSET = register(
    "storage-colour-set",
    "the storage table names something that is not a real colour set",
    '`[storage]` of cell.toml may say `NAME = "float32"` for a colour set of kind real.',
)
LITERAL_RANGE = register(
    "literal-out-of-range",
    "an integer literal that does not fit",
    "`int` has 31 bits in CPN Tools (~1073741824 to 1073741823); `IntInf.int` has 64 bits in compiled code.",
)


class UnsupportedError(Exception):
    """Lowering of one net element is given up; becomes one diagnostic. Never leaves `lowering`."""

    def __init__(self, code: str, message: str, at: Origin | Span, hint: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.at = at
        self.hint = hint
