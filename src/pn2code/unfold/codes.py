"""Diagnostic codes of unfolding."""

from pn2code.diagnostics.codes import register

UNSUPPORTED_UNFOLDING = register(
    "unsupported-unfolding",
    "the net has something that a place/transition net cannot express",
    "A place/transition net has neither time nor code segments, and what an inscription gives must depend on its "
    "variables alone: nothing random, no references, no files.",
)
UNFOLDING_TOO_LARGE = register(
    "unfolding-too-large",
    "the unfolded net has too many places or transitions",
    "Unfolding makes a place of each colour that can come into a place, and a transition of each binding. With large "
    "or unbounded colour sets these are too many: a counter without limit never ends.",
)
UNFOLDING_FAULT = register(
    "unfolding-fault",
    "an inscription raises an exception for a binding",
    "Unfolding looks at all bindings for which the colours can be there, whether or not enough tokens are there at "
    "the same time. For one of them an inscription raises an exception or gives an illegal colour. If that binding can "
    "become enabled, the net has a mistake; the unfolded net lacks the transition.",
)
