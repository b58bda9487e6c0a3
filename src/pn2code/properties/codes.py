"""Diagnostic codes of properties."""

from __future__ import annotations

from pn2code.diagnostics.codes import register

SYNTAX = register(
    "property-syntax",
    "a property cannot be read",
    "The text is not a property of the language of docs/properties.md. It begins with a word that gives its kind: "
    "`deadlock free`, `bound`, `always`, `never`, `reachable`, `mutex`, `every .. is followed by ..`, `ctl` or `ltl`. "
    "Conditions on markings are CPN ML in braces: `always { size (Mark.Top'P 1) <= 3 }`.",
)
UNKNOWN_NAME = register(
    "property-unknown-name",
    "a property names a place or transition that the net does not have",
    "Places and transitions are named as in the state-space queries of CPN Tools: `Page'Place 1`, with blanks and "
    "other unusual characters written as `_`. The number is that of the page instance; it may be left out if the page "
    'has one instance. The path of a trace, in quotes, is possible as well: `"Top.Robot1.Accept"`.',
)
FORM = register(
    "property-form",
    "an operator of a property is used where it has no meaning",
    "Conditions on one marking (`always`, `never`, `reachable`, `mutex`, `except`) have no operators of time. In "
    "`ctl` each operator of time has a quantifier: `AG`, `EF`, `A[p U q]`. In `ltl` it has none: `G`, `F`, `X`, `p U "
    "q`; there, and in `every`, `fires(Page'Transition 1)` says what the next step is.",
)
FILE = register(
    "property-file",
    "a file of properties is wrong",
    "A file of properties is TOML with tables `[[property]]`: `name`, `says` (plain words), `holds` (the text), and "
    'optionally `expect = false` and `fair = ["strong Page\'T 1"]`. Names are unique. docs/properties.md has more.',
)
OUTSIDE = register(
    "property-outside",
    "a condition depends on more than the marking",
    "A condition in braces is evaluated in every marking, in no particular order. Its value must follow from the "
    "state alone (the contents of places, the values of references, and the model time): it may not draw random "
    "numbers, read files, count steps, or change references. Write it as a function of what places and references "
    "hold.",
)
EVIDENCE = register(
    "property-evidence",
    "a run does not show what it should",
    "Each run that the explorer gives as a reason for its answer is played again by the reference token game, and the "
    "property is evaluated on it by definition. If the two do not agree, one of them is wrong: this is a bug in "
    "pn2code, and the answer does not count.",
)
UNPLAYED = register(
    "property-unplayed",
    "a run could not be played again",
    "Each run that the explorer gives as a reason for its answer is played again by the reference token game. That is "
    "slower, and evaluates an expression only up to a limit of steps, depth and memory. A run beyond these limits is "
    "not looked at again: the answer is that of the explorer alone.",
)
