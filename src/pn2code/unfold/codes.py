"""Diagnostic codes of unfolding."""

from pn2code.diagnostics.codes import register

UNSUPPORTED_UNFOLDING = register(
    "unsupported-unfolding",
    "the net has something that a place/transition net cannot express",
    "A place/transition net has neither time nor code segments, and the result of an inscription must depend only on "
    "its variables, not on random numbers, references or files.",
)
UNFOLDING_TOO_LARGE = register(
    "unfolding-too-large",
    "the unfolded net has too many places or transitions",
    "Unfolding makes a place for each colour that may come into a place, and a transition for each binding. With "
    "large or unbounded colour sets there are too many: a counter without a limit never ends.",
)
UNFOLDING_FAULT = register(
    "unfolding-fault",
    "an inscription raises an exception for a binding",
    "Unfolding looks at all bindings for which the colours may be there, even if there are not enough tokens at the "
    "same time. For one of them an inscription raises an exception or gives an illegal colour. If that binding can "
    "become enabled, the net has a mistake; the unfolded net does not have the transition.",
)
