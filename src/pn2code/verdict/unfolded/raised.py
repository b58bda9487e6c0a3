"""Which inscription may raise an exception, of a net that is therefore not asked unfolded, and what can be done.

why(net, made)     # "the guard of transition `Top.T` (page `Top`): ... (`hd` may raise an exception); put ..."
"""

from __future__ import annotations

from collections.abc import Mapping

from pn2code.ml.core import terms as core
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.net.magnitudes import Magnitudes, RaisesIn
from pn2code.net.other_orders import Asking, Question
from pn2code.net.raising import Raising
from pn2code.net.uses import children, walk
from pn2code.verify.answers.reasons import OUTSIDE

_TOGETHER = "put both into one condition (`a andalso b`), or handle the exception"
_LARGER = (
    "add a condition that the value is one of the colour set, or give the variable a larger one"
)
_SMALLER = "give its places and variables colour sets with bounds, as `int with 0..9`"
_TOTAL = "handle the exception, or give the function a value for all arguments"


def why(net: FlatNet, made: Asking) -> str:
    """The first of what may be raised, in what, and what the user could change, as a clause."""
    question = (*made.questions, *made.left)[0]
    t = net.transitions[question.transition]
    text = _text(question.raises)
    where = f"{_part(net, t, question)} of transition `{t.name}` (page `{t.page}`)"
    if question.kind == "outside":
        return f"{where}: `{text}` {OUTSIDE}, which CPN Tools does not look at; {_LARGER}"
    what, is_overflow = _source(net, t, question.raises)
    advice = _SMALLER if is_overflow else _TOGETHER if question.kind == "order" else _TOTAL
    said = f"{where} may raise an exception in `{text}`: {what}"
    if question.kind == "order" and question.beside is not None:
        said += f", and CPN Tools may compute it before `{_text(question.beside)}`"
    return f"{said}; {advice}"


def _text(e: core.Exp) -> str:
    return " ".join(e.span.text.split())


def _part(net: FlatNet, t: FlatTransition, question: Question) -> str:
    for arc in t.arcs:
        terms = () if arc.inscription is None else arc.inscription.terms
        if any(question.condition is x.value for x in terms):
            return f"the arc between place `{net.places[arc.place].name}` and it,"
    return "the guard"


def _source(net: FlatNet, t: FlatTransition, e: core.Exp) -> tuple[str, bool]:
    """What raises it, and whether that is `Overflow`."""
    plain = Raising(net.program)
    if not plain.raise_in(e):
        sizes = Magnitudes(net).raising(t)
        inner = _innermost(e, sizes)
        return f"`{_text(_around(e, inner))}` may be too large (`Overflow`)", True
    bodies = _bodies(net.program)
    through: list[str] = []
    inner = _innermost(e, plain)
    while isinstance(inner, core.Var) and inner.symbol.uid in bodies:
        if inner.symbol.name in through:
            break
        through.append(inner.symbol.name)
        inner = _innermost(bodies[inner.symbol.uid], plain)
    calls = f"function `{through[-1]}` " if through else ""
    match inner:
        case core.Raise():
            return f"{calls or 'it '}has `{_text(inner)}`", False
        case core.Builtin(name):
            word = f"`{name.split('.')[-1]}`"
            return f"{calls}uses {word}" if calls else f"{word} does so for some values", False
        case core.Lambda() | core.Case() | core.Let():
            return f"{calls or 'it '}has patterns that do not match all values", False
    return f"{calls or 'it '}may do so", False


def _innermost(e: core.Exp, raising: RaisesIn) -> core.Exp:
    """The smallest part that may raise something."""
    while True:
        part = next((x for x in children(e) if raising.raise_in(x)), None)
        if part is None:
            return e
        e = part


def _around(e: core.Exp, inner: core.Exp) -> core.Exp:
    """What applies a function that stands there; else itself."""
    return next((x for x in walk(e) if any(y is inner for y in children(x))), inner)


def _bodies(program: core.Program) -> Mapping[int, core.Exp]:
    found: dict[int, core.Exp] = {}
    for declaration in program.declarations:
        match declaration:
            case core.ValBind(core.PVar(symbol), value):
                found[symbol.uid] = value
            case core.RecBind(bindings):
                found.update((symbol.uid, function) for symbol, function in bindings)
    return found
