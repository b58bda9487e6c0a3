"""What CPN ML evaluates and a script does not: it has a value where it is used, CPN ML where it is written.

    let val y = 10 div x in if x = 0 then 0 else y end
    ->  if x = 0 then 0 else 10 div x       and `10 div x` is owed: in CPN ML it is computed in any case

What is owed is computed beforehand (`computed(10 div x) and ..`, `compute 10 div x`), unless it cannot fail, or what
is evaluated anyway computes it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from pn2code.base.frozen import frozen
from pn2code.robot_scripts.failing import Known
from pn2code.robot_scripts.ir import Chain, Line, Node, Repeat
from pn2code.robot_scripts.operations import logical_not
from pn2code.robot_scripts.values import (
    conjunction,
    disjunction,
)
from pn2code.tdl import tree as t
from pn2code.tdl.paths import children, expressions_of

Path = tuple[tuple[t.Expression, bool], ...]
"""Conditions, and whether they hold: where something is evaluated."""


@frozen
class Owed:
    """An expression that CPN ML computes where some conditions hold."""

    path: Path
    exp: t.Expression

    def under(self, path: Path) -> Owed:
        """The same inside other conditions."""
        return Owed((*path, *self.path), self.exp)

    @property
    def condition(self) -> t.Expression:
        """Where it is computed."""
        return conjunction([e if holds else logical_not(e) for e, holds in self.path])

    def as_condition(self) -> t.Expression:
        """A condition that computes it, and is true."""
        skipped = [logical_not(e) if holds else e for e, holds in self.path]
        return disjunction([*skipped, t.CallExpression("computed", (self.exp,))])


class Done:
    """What has been evaluated."""

    def __init__(self, expressions: Iterable[t.Expression] = ()) -> None:
        self._paths: dict[t.Expression, list[frozenset[tuple[t.Expression, bool]]]] = {}
        for e in expressions:
            self.add(e)

    def copy(self) -> Done:
        """The same, to go on with."""
        new = Done()
        new._paths = {e: list(paths) for e, paths in self._paths.items()}
        return new

    def add(self, e: t.Expression, path: Path = ()) -> None:
        """An expression is evaluated where some conditions hold."""
        for owed in evaluated(e):
            self._paths.setdefault(owed.exp, []).append(frozenset((*path, *owed.path)))

    def __contains__(self, owed: Owed) -> bool:
        path = frozenset(owed.path)
        return any(known <= path for known in self._paths.get(owed.exp, ()))


def evaluated(e: t.Expression) -> Iterator[Owed]:
    """All parts of an expression that are evaluated with it, and where."""
    match e:
        case t.Binary("and" | "or" as operator, left, right):
            yield from evaluated(left)
            yield from (o.under(((left, operator == "and"),)) for o in evaluated(right))
        case t.Conditional(condition, then, otherwise):
            yield from evaluated(condition)
            yield from (o.under(((condition, True),)) for o in evaluated(then))
            yield from (o.under(((condition, False),)) for o in evaluated(otherwise))
        case t.Binary() | t.Unary() | t.CallExpression() | t.Field():
            for part in children(e):
                yield from evaluated(part)
            yield Owed((), e)
        case _:
            return


def open_of(owed: Iterable[Owed], value: t.Expression | None, known: Known) -> list[Owed]:
    """What of it may fail, and is not evaluated with a value."""
    done = Done() if value is None else Done([value])
    out: list[Owed] = []
    for o in owed:
        there = known
        for condition, holds in o.path:
            there = there.with_condition(condition, holds)
        if o not in done and there.fails_itself(o.exp) and o not in out:
            out.append(o)
    return out


def statements(owed: Iterable[Owed]) -> list[Node]:
    """Statements that compute it."""
    out: list[Node] = []
    for o in owed:
        line = Line(t.Compute((o.exp,)))
        out.append(Chain(((o.condition, (line,)),), None) if o.path else line)
    return out


def without_repetition(
    nodes: Sequence[Node], before: Iterable[t.Expression], after: Iterable[t.Expression]
) -> list[Node]:
    """The nodes without what they compute although something evaluates it before any other effect.

    Args:
        nodes: statements.
        before: expressions that were evaluated before them.
        after: those that are evaluated next.
    """
    left = _forward(nodes, Done(before), ())
    return _merged(_backward(left, Done(after), ())[0])


def _backward(nodes: Sequence[Node], later: Done, path: Path) -> tuple[list[Node], Done]:
    """Without what is evaluated later; and what is evaluated from the first node on, before an effect."""
    out: list[Node] = []
    for node in reversed(nodes):
        match node:
            case Line(t.Compute((e,))):
                if Owed(path, e) in later:
                    continue
                later.add(e, path)
            case Line(statement):
                later = _of(expressions_of(statement), path)
            case Chain(((test, then),), otherwise):
                yes, after_yes = _backward(then, later.copy(), (*path, (test, True)))
                no, after_no = _backward(otherwise or (), later.copy(), (*path, (test, False)))
                if not yes and not no:
                    continue
                if not (_only_computes(yes) and _only_computes(no)):
                    after_yes = after_no = Done()
                later = after_yes.copy()
                for e, paths in after_no._paths.items():
                    later._paths.setdefault(e, []).extend(paths)
                later.add(test, path)
                node = Chain(((test, tuple(yes)),), tuple(no) or None)
            case Repeat(condition, body):
                node = Repeat(condition, tuple(_backward(body, Done(), ())[0]))
                later = _of([] if condition is None else [condition], path)
            case _:
                pass
        out.append(node)
    return out[::-1], later


def _of(expressions: Iterable[t.Expression], path: Path) -> Done:
    done = Done()
    for e in expressions:
        done.add(e, path)
    return done


def _only_computes(nodes: Iterable[Node]) -> bool:
    return all(
        isinstance(n.statement, t.Compute)
        if isinstance(n, Line)
        else isinstance(n, Chain)
        and all(_only_computes(b) for _, b in n.branches)
        and _only_computes(n.otherwise or ())
        for n in nodes
    )


def _forward(nodes: Sequence[Node], done: Done, path: Path) -> list[Node]:
    """Without what was evaluated before."""
    out: list[Node] = []
    for node in nodes:
        match node:
            case Line(t.Compute((e,))) if Owed(path, e) in done:
                continue
            case Line(statement):
                for e in expressions_of(statement):
                    done.add(e, path)
            case Chain(((test, then),), otherwise):
                if not (_only_computes(then) and _only_computes(otherwise or ())):
                    done.add(test, path)  # others may still be left out
                yes = _forward(then, done.copy(), (*path, (test, True)))
                no = _forward(otherwise or (), done.copy(), (*path, (test, False)))
                if not yes and not no:
                    continue
                node = Chain(((test, tuple(yes)),), tuple(no) or None)
            case Repeat(condition, body):
                node = Repeat(condition, tuple(_forward(body, Done(), ())))
            case _:
                pass
        out.append(node)
    return out


def _merged(nodes: Iterable[Node]) -> list[Node]:
    """With one statement for what is computed one after the other."""
    out: list[Node] = []
    for node in nodes:
        match node:
            case Chain(((test, then),), otherwise):
                node = Chain(
                    ((test, tuple(_merged(then))),), tuple(_merged(otherwise or ())) or None
                )
            case Repeat(condition, body):
                node = Repeat(condition, tuple(_merged(body)))
            case Line(t.Compute(values)):
                if (
                    out
                    and isinstance(last := out[-1], Line)
                    and isinstance(last.statement, t.Compute)
                ):
                    out[-1] = Line(t.Compute((*last.statement.values, *values)))
                    continue
            case _:
                pass
        out.append(node)
    return out
