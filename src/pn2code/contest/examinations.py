"""The examinations of the contest: what each asks of a net, as questions for the engine.

    asked(tables, "ReachabilityDeadlock", folder) -> [Asked("ReachabilityDeadlock", ...)]

Some are questions about every place or transition. They become one question where "one of them" is asked for, and
several where all of them are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.contest.formulas import Fireable, Formula, FormulaError, Op, Tokens, read
from pn2code.contest.implied import Implied
from pn2code.contest.tables import Tables
from pn2code.contest.temporal import check
from pn2code.contest.words import FORMULAS, GLOBAL

_FEW = 40
"""For the liveness of so many transitions the net is reduced."""


@frozen
class Part:
    """One question for the engine.

    Args:
        kind: "reach", "bound", "ctl" or "ltl": which methods can answer it.
        text: the question, after its number.
        formula: of time: the same, if the net may be reduced for it.
    """

    kind: str
    text: str
    formula: Formula | None = None


@frozen
class Asked:
    """One line of the result.

    Args:
        name: in the contest's words.
        parts: questions for the engine.
        decides: the answer of a part that decides at once; None: the answer is that of the only part.
        value: the value of the whole when a part decides; else it is the opposite.
        is_turned: with one part: whether the whole is the opposite of it.
        hints: questions with an answer each that decides at once, as `decides` does; another answer says nothing.
        formula: of time, of the kind `kind`; then there are no parts.
        kind: "ctl" or "ltl".
        at_home: with a home marking (home.py) the value is the opposite if these hints, by number, do not decide.
        why_not: it cannot be asked; why.
    """

    name: str
    parts: tuple[Part, ...] = ()
    decides: bool | None = None
    value: bool = True
    is_turned: bool = False
    hints: tuple[tuple[Part, bool], ...] = ()
    formula: Formula | None = None
    kind: str = ""
    at_home: tuple[int, ...] = ()
    why_not: str = ""


def asked(tables: Tables, examination: str, folder: Path) -> list[Asked]:
    """What an examination asks.

    Args:
        tables: the net.
        examination: its name.
        folder: with the XML files.

    Raises:
        FormulaError: a file cannot be read.
        KeyError: there is no such examination.
    """
    if examination in GLOBAL:
        return [_GLOBAL[examination](tables)]
    if examination not in FORMULAS:
        raise KeyError(examination)
    found = []
    for question in read(folder / f"{examination}.xml"):
        if question.formula is None:
            found.append(Asked(question.name, why_not=question.why_not))
            continue
        try:
            found.append(_of_formula(tables, examination, question.name, question.formula))
        except FormulaError as error:
            found.append(Asked(question.name, why_not=str(error)))
    return found


def _of_formula(tables: Tables, examination: str, name: str, f: Formula) -> Asked:
    if isinstance(f, Tokens):
        return Asked(name, (_part("bound", tables.bound(0, f)),))
    kind = "ltl" if examination.startswith("LTL") else "ctl"
    check(tables, kind, f)
    return Asked(name, formula=f, kind=kind)


def _part(kind: str, question: str) -> Part:
    return Part(kind, question.split(" ", 1)[1])


def _deadlock(tables: Tables) -> Asked:
    return Asked("ReachabilityDeadlock", (Part("reach", "reach dead"),))


def _one_safe(tables: Tables) -> Asked:
    """No place ever holds two tokens."""
    several = [f"not {tables.sum(dict.fromkeys(p, 1), 1)}" for p in tables.places.values() if p]
    return Asked("OneSafe", (_any(several),), is_turned=True)


def _quasi_live(tables: Tables) -> Asked:
    """Each transition can occur: asked of those that no other one implies."""
    parts = tuple(_can_occur(tables, name) for name in Implied(tables, again=False).asked())
    return Asked("QuasiLiveness", parts, decides=False, value=False)


def _live(tables: Tables) -> Asked:
    """Each transition can occur again and again: there is no deadlock, and each can occur at all.

    Asked of those that no other one implies; if each implies all others, it is enough that there is no deadlock.
    """
    dead = Part("reach", "reach dead")
    implied = Implied(tables, again=True)
    if tables.transitions and implied.is_one:
        return Asked("Liveness", (dead,), is_turned=True)
    names = implied.asked()
    parts = tuple(_can_always_occur(tables, name, len(names) <= _FEW) for name in names)
    hints = [(dead, True)] if tables.transitions else []
    first = Implied(tables, again=False).asked()
    occur = [(_can_occur(tables, name), False) for name in first]
    at_home = tuple(len(parts) + len(hints) + i for i in range(len(occur)))
    return Asked(
        "Liveness", parts, decides=False, value=False, hints=(*hints, *occur), at_home=at_home
    )


def _can_occur(tables: Tables, name: str) -> Part:
    return Part("reach", f"reach {_enabled(tables.transitions[name])}")


def _can_always_occur(tables: Tables, name: str, is_reduced: bool) -> Part:
    """That a transition is live; whether the net is reduced for it."""
    text = f"ctl AG EF {_enabled(tables.transitions[name])}"
    exists = Op("E", (Op("F", (Fireable((name,)),)),))
    return Part("ctl", text, Op("A", (Op("G", (exists,)),)) if is_reduced else None)


def _stable(tables: Tables) -> Asked:
    """One place holds as many tokens in all markings."""
    parts = []
    for places in tables.places.values():
        total = sum(tables.initial[p] for p in places)
        factors = dict.fromkeys(places, 1)
        same = f"and 2 {tables.sum(factors, total)} not {tables.sum(factors, total - 1)}"
        parts.append(Part("reach", f"reach not {same}"))
    return Asked("StableMarking", tuple(parts), decides=False, value=True)


_GLOBAL: dict[str, Callable[[Tables], Asked]] = {
    "ReachabilityDeadlock": _deadlock,
    "OneSafe": _one_safe,
    "QuasiLiveness": _quasi_live,
    "Liveness": _live,
    "StableMarking": _stable,
}


def _any(formulas: Sequence[str]) -> Part:
    return Part("reach", f"reach or {len(formulas)} {' '.join(formulas)}".rstrip())


def _enabled(transitions: Sequence[int]) -> str:
    return f"enabled {len(transitions)} {' '.join(map(str, transitions))}".rstrip()
