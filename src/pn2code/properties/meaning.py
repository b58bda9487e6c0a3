"""Properties in terms of a flat net: places and transitions by index, conditions by number.

What is asked (`Invariant`, `Bound`, `Branching`, `Linear`, `Response`) is all that the explorer and the judge know of.
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Origin
from pn2code.ml.core import terms as core
from pn2code.net.predicate import Predicate


@frozen
class Atom:
    """Something true or false of a node, or (`fires`) of the arc that is taken next.

    Args:
        kind: "true", "dead", "initial", "pred", "enabled", "fires", "fires so".
        number: of "pred" in `Properties.predicates`, of "enabled" and "fires" in `FlatNet.transitions`, of "fires so"
            (with a condition on the binding) in `Properties.steps`.
    """

    kind: str
    number: int = -1


@frozen
class Op:
    """An operator with its operands, named as in `tree.Operation`.

    Args:
        operator: its name.
        parts: its operands.
        step: of "EX" and "AX" by one transition: its index; else -1.
    """

    operator: str
    parts: tuple[Formula, ...]
    step: int = -1


Formula = Atom | Op

_BOOLEAN = frozenset({"not", "and", "or", "implies", "iff"})

TRUE = Atom("true")
DEAD = Atom("dead")


def negation(f: Formula) -> Formula:
    """The opposite; of an opposite what it is the opposite of."""
    if isinstance(f, Op) and f.operator == "not":
        return f.parts[0]
    return Op("not", (f,))


def conjunction(*parts: Formula) -> Formula:
    """All of them."""
    return _joined("and", parts) if parts else TRUE


def disjunction(*parts: Formula) -> Formula:
    """One of them."""
    return _joined("or", parts) if parts else Op("not", (TRUE,))


def _joined(operator: str, parts: tuple[Formula, ...]) -> Formula:
    """As a balanced tree, so that nobody has to recurse deeply."""
    if len(parts) == 1:
        return parts[0]
    middle = len(parts) // 2
    return Op(operator, (_joined(operator, parts[:middle]), _joined(operator, parts[middle:])))


def looks_at_steps(f: Formula) -> bool:
    """Whether `fires` is in it: then it says something of a step, not of a node."""
    if isinstance(f, Atom):
        return f.kind in ("fires", "fires so")
    return any(map(looks_at_steps, f.parts))


def atoms(f: Formula) -> Iterator[Atom]:
    """All in a formula."""
    if isinstance(f, Atom):
        yield f
        return
    for part in f.parts:
        yield from atoms(part)


@frozen
class StepCondition:
    """A condition on the binding of a transition.

    Args:
        transition: its index.
        text: as the author wrote it.
        exp: of type bool; its free symbols are variables of the transition that its code segment does not give.
    """

    transition: int
    text: str
    exp: core.Exp


@frozen
class Fairness:
    """An assumption: a transition (index) that is enabled infinitely often (strong), or from some point on (weak),
    occurs infinitely often."""

    strong: bool
    transition: int


@frozen
class Invariant:
    """In all nodes the condition holds.

    Args:
        condition: of one node, without operators of time.
        wanted: whether that is what the author says; False: that a node exists where it does *not* hold (`reachable`).
    """

    condition: Formula
    wanted: bool = True


@frozen
class Bound:
    """A place has at least `low` and at most `high` tokens in all nodes; None: no limit."""

    place: int
    low: int | None
    high: int | None


@frozen
class Branching:
    """The CTL formula holds in the initial node."""

    formula: Formula


@frozen
class Linear:
    """The LTL formula holds on all maximal paths that are fair."""

    formula: Formula
    fair: tuple[Fairness, ...] = ()


@frozen
class Response:
    """Each `first` is followed by a `second`, within so many firings, or units of time.

    The events are `Atom("fires", t)`, the step that is taken, or one of several such; or conditions on nodes: that
    such a node is entered.

    Args:
        of_commands: the net has no time, so that only the commands of its cell take some (`verify --durations`).
        of_integers: the clock of the net counts whole units, so that no wait of the closed net lies between two.
    """

    first: Formula
    second: Formula
    firings: int | None
    time: str | None
    of_commands: bool = False
    of_integers: bool = False

    @property
    def units(self) -> str:
        """The most that the clock of the closed net may go on: of 2.5 units those that an integer clock counts, 2."""
        assert self.time is not None
        return self.time.partition(".")[0] if self.of_integers else self.time


Asked = Invariant | Bound | Branching | Linear | Response


def simplest(asked: Asked) -> Asked:
    """The same question about single nodes, where it is one: such a node may decide it before all are known.

    Each node lies on a maximal path, so that `ltl G p` is about all nodes, unless only fair paths count.
    """
    match asked:
        case Branching(Op("AG", (p,))) | Linear(Op("G", (p,)), ()) if is_of_nodes(p):
            return Invariant(p)
        case Branching(Op("EF", (p,))) if is_of_nodes(p):
            return Invariant(negation(p), wanted=False)
        case Branching(Op("not", (Op("EF", (p,)),))) if is_of_nodes(p):
            return Invariant(negation(p))
        case Branching(Op("not", (Op("AG", (p,)),))) if is_of_nodes(p):
            return Invariant(p, wanted=False)
        case _:
            return asked


def is_of_nodes(f: Formula) -> bool:
    """Whether it is a condition on single nodes: without operators of time, and steps."""
    if isinstance(f, Atom):
        return not looks_at_steps(f)
    return f.operator in _BOOLEAN and all(map(is_of_nodes, f.parts))


def formulas(asked: Asked) -> tuple[Formula, ...]:
    """What a question is made of."""
    match asked:
        case Invariant(condition):
            return (condition,)
        case Branching(formula) | Linear(formula):
            return (formula,)
        case Response(first, second):
            return (first, second)
        case Bound():
            return ()


@frozen
class Property:
    """A property of a net.

    Args:
        name: unique.
        says: in plain words, "" if it was not said.
        holds: the text.
        kind: "deadlock", "bound", "always", "never", "reachable", "mutex", "response", "ctl", "ltl".
        expect: whether it is expected to be true.
        asked: its meaning.
        fair: the fairness that is assumed, as texts.
        origin: of the text.
        of_net: whether it is about the closed net alone, also where that is the net of a cell.
    """

    name: str
    says: str
    holds: str
    kind: str
    expect: bool
    asked: Asked
    fair: tuple[str, ...]
    origin: Origin
    of_net: bool = False


@frozen
class Properties:
    """All that is asked about a net; `predicates` and `steps`, conditions on markings and bindings, by number."""

    properties: tuple[Property, ...] = ()
    predicates: tuple[Predicate, ...] = ()
    steps: tuple[StepCondition, ...] = ()
