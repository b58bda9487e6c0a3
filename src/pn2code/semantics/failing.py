"""One wording for what goes wrong in a net while it is played, simulated, explored or generated.

failed("the guard of `T`", "Div")      # "the guard of `T` raised the exception `Div`"
report_failure(d, message, origin)     # the diagnostic: with the place in the net, and what to do
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from pn2code.diagnostics import Diagnostics, Note, Origin, Span
from pn2code.semantics.codes import RUNTIME_ERROR

_RAISED = "raised the exception"
_HINT = (
    "keep it from being evaluated there (a guard, an `if`), or handle the exception (`e handle Div => 0`); "
    "`pn2code simulate` makes such runs, and `pn2code explain runtime-error` says more"
)


def failed(doing: str, exception: str) -> str:
    """The message about an exception of CPN ML.

    Args:
        doing: what was evaluated, as a subject.
        exception: as CPN ML prints it.
    """
    return f"{doing} {_RAISED} `{exception}`"


def stopped(doing: str, error: str) -> str:
    """The same about what a compiled program says: the name of an exception, or of other things why in words."""
    is_name = error.replace(".", "_").isidentifier()
    return failed(doing, error) if is_name else f"{doing} cannot go on: {error}"


def of_transition(name: str, *, is_bound: bool) -> str:
    """What was evaluated where the explorer and the simulator know no more: for `stopped`."""
    return f"{'the occurrence' if is_bound else 'the search for bindings'} of `{name}`"


def with_binding(name: str, binding: Mapping[str, str] | None) -> str:
    """A transition and the texts of its variables, as a note begins."""
    values = ", ".join(f"{k} = {v}" for k, v in (binding or {}).items())
    return f"transition `{name}`" + (f" with {values}" if values else "")


def report_failure(
    d: Diagnostics,
    message: str,
    origin: Origin,
    span: Span | None = None,
    notes: Iterable[Note | str] = (),
) -> None:
    """As a diagnostic.

    Args:
        d: gets it.
        message: what `failed` or `stopped` gives, or another one.
        origin: the net element.
        span: the text in it that raised an exception, when that is known.
        notes: how it is reached.
    """
    at = [Note(f"raised by `{' '.join(span.text.split())}`", span.origin)] if span else []
    hint = _HINT if _RAISED in message else ""
    d.error(RUNTIME_ERROR, message, origin, notes=[*at, *notes], hint=hint)
