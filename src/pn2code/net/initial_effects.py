"""Initial markings that change references: CPN Tools evaluates them more often than once, in an order of its own.

With `fun tick () = (inc counter; !counter)` the only place of a net, with the marking 1`(tick ()), begins with 2 in the
engine, which has evaluated it once to check the net; of several places the last comes first, and places of a fusion set
are evaluated once more. How often the editor checks a net is up to its user, so such a marking has no value of its own.
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.diagnostics import Diagnostics
from pn2code.ml.core.terms import Builtin, Exp, Program, RecBind, Symbol, ValBind, Var
from pn2code.ml.core.types import TCon, TFun, TRecord, Type
from pn2code.net.codes import INITIAL_EFFECT
from pn2code.net.typed import TypedPage
from pn2code.net.uses import pattern_variables, walk

_READING = frozenset({"Ref.!", "Ref.ref"})
_ARRAYS = frozenset({"update", "copy", "copyVec", "modify", "modifyi"})
_CELLS = frozenset({"ref", "array"})


def warn(program: Program, pages: Iterable[TypedPage], d: Diagnostics) -> None:
    """Warn of such initial markings."""
    bodies: dict[Symbol, Exp] = {}
    for dec in program.declarations:
        if isinstance(dec, ValBind):
            bodies.update(dict.fromkeys(pattern_variables(dec.pattern), dec.value))
        elif isinstance(dec, RecBind):
            bodies.update(dec.bindings)
    for page in pages:
        for place in page.places:
            if place.initial is None:
                continue
            changed = _changed(place.initial[0], bodies)
            if changed is not None:
                d.warning(
                    INITIAL_EFFECT,
                    f"the initial marking of `{place.name}` may change the reference `{changed.name}`: CPN Tools "
                    "evaluates it several times before a run begins, so that the net begins with other tokens there",
                    place.origin,
                    hint="give the tokens without a counter, or let a transition put them",
                )


def _changed(root: Exp, bodies: dict[Symbol, Exp]) -> Symbol | None:
    """A declared reference or array that evaluating an expression may assign."""
    found: Symbol | None = None
    assigns = False
    seen: set[Symbol] = set()
    todo = [root]
    while todo:
        for e in walk(todo.pop()):
            if isinstance(e, Builtin):
                assigns = assigns or _assigns(e.name)
            elif isinstance(e, Var) and e.symbol not in seen:
                seen.add(e.symbol)
                if e.symbol in bodies:
                    if found is None and _holds_cell(e.symbol.type):
                        found = e.symbol
                    elif isinstance(e.symbol.type, TFun):
                        todo.append(bodies[e.symbol])
    return found if assigns else None


def _assigns(name: str) -> bool:
    structure, _, member = name.partition(".")
    return (structure == "Ref" and name not in _READING) or (
        structure == "Array" and member in _ARRAYS
    )


def _holds_cell(t: Type) -> bool:
    match t:
        case TCon(name, arguments):
            return name in _CELLS or any(map(_holds_cell, arguments))
        case TRecord(fields):
            return any(_holds_cell(part) for _, part in fields)
    return False
