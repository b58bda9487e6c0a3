"""Syntax tree -> a flat list of instructions: jumps instead of blocks.

The checker follows paths in it, the interpreter runs it.

`while c loop wait 1 s end loop` is

    0  BranchUnless(c, 3)
    1  Do(wait 1 s)
    2  Jump(0)
    3  End
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import field, replace

from pn2code.base.frozen import frozen, record
from pn2code.diagnostics import Span
from pn2code.tdl import tree as t


@frozen
class Do:
    """A statement that is executed where it stands."""

    statement: t.Simple
    span: Span


@frozen
class Jump:
    """Go on at `target`; `written` if a person wrote the `goto` or `exit` (else the end of a block)."""

    target: int
    span: Span
    written: bool = False


@frozen
class BranchUnless:
    """Go on at `target` unless the condition holds."""

    condition: t.Expression
    target: int
    span: Span


@frozen
class BranchIf:
    """Go on at `target` if the condition holds (`exit when`)."""

    condition: t.Expression
    target: int
    span: Span


@frozen
class CallProcedure:
    """Run a procedure, then go on behind."""

    name: str
    span: Span


@frozen
class End:
    """The end of the body; `written` for `return`."""

    span: Span
    written: bool = False


Instruction = Do | Jump | BranchUnless | BranchIf | CallProcedure | End


@frozen
class Body:
    """The code of the program or a procedure; `labels` give positions.

    Args:
        along: the positions in loops that come to their end, as each turn takes an item from a list; but not those of
            other loops within them.
    """

    instructions: tuple[Instruction, ...]
    labels: dict[str, int]
    along: frozenset[int] = frozenset()

    def next(self, at: int) -> tuple[int, ...]:
        """Where control may go from an instruction (calls go on behind)."""
        match self.instructions[at]:
            case Jump(target):
                return (target,)
            case BranchUnless(condition, target) | BranchIf(condition, target):
                if isinstance(condition, t.Value):
                    taken = (condition.value is True) == isinstance(self.instructions[at], BranchIf)
                    return (target,) if taken else (at + 1,)
                return (at + 1, target)
            case End():
                return ()
            case Do(t.Stop()):
                return ()
            case _:
                return (at + 1,)

    def reachable(self) -> set[int]:
        """The positions that can be reached from the beginning."""
        seen = {0}
        todo = [0]
        while todo:
            for n in self.next(todo.pop()):
                if n not in seen:
                    seen.add(n)
                    todo.append(n)
        return seen


@record
class _Flattener:
    code: list[Instruction] = field(default_factory=list)
    labels: dict[str, int] = field(default_factory=dict)
    gotos: list[tuple[int, str]] = field(default_factory=list)
    exits: list[list[int]] = field(default_factory=list)
    along: set[int] = field(default_factory=set)
    others: set[int] = field(default_factory=set)

    def emit(self, instruction: Instruction) -> int:
        self.code.append(instruction)
        return len(self.code) - 1

    def patch(self, at: int, target: int) -> None:
        instruction = self.code[at]
        assert isinstance(instruction, Jump | BranchUnless | BranchIf)
        self.code[at] = replace(instruction, target=target)

    def block(self, body: Iterable[t.Statement]) -> None:
        for s in body:
            self.statement(s)

    def statement(self, s: t.Statement) -> None:
        match s:
            case t.If(branches, otherwise):
                ends = []
                for i, b in enumerate(branches):
                    skip = self.emit(BranchUnless(b.condition, 0, b.condition.span))
                    self.block(b.body)
                    if i + 1 < len(branches) or otherwise is not None:
                        ends.append(self.emit(Jump(0, b.span)))
                    self.patch(skip, len(self.code))
                self.block(otherwise or ())
                for e in ends:
                    self.patch(e, len(self.code))
            case t.While(condition, body):
                start = self.emit(BranchUnless(condition, 0, condition.span))
                self.loop(body, start, s.span, is_along=_is_along(condition, body))
                self.patch(start, len(self.code))
            case t.Loop(body):
                self.loop(body, len(self.code), s.span)
            case t.Exit(condition):
                at = self.emit(
                    BranchIf(condition, 0, s.span) if condition else Jump(0, s.span, True)
                )
                if self.exits:
                    self.exits[-1].append(at)
                else:  # reported by the checker
                    self.patch(at, at + 1)
            case t.Label(name):
                self.labels.setdefault(name, len(self.code))
            case t.Goto(label):
                self.gotos.append((self.emit(Jump(0, s.span, True)), label.name))
            case t.Call(procedure):
                self.emit(CallProcedure(procedure.name, s.span))
            case t.Return():
                self.emit(End(s.span, True))
            case _:
                self.emit(Do(s, s.span))

    def loop(
        self, body: tuple[t.Statement, ...], start: int, span: Span, *, is_along: bool = False
    ) -> None:
        self.exits.append([])
        outside, self.along, self.others = (self.along, self.others), set(), set()
        self.block(body)
        self.emit(Jump(start, span))
        own = set(range(start, len(self.code))) - self.along - self.others
        inside = (self.along, self.others)
        self.along, self.others = outside
        self.along |= inside[0] | (own if is_along else set())
        self.others |= inside[1] | (set() if is_along else own)
        for e in self.exits.pop():
            self.patch(e, len(self.code))


def flatten(body: Iterable[t.Statement], span: Span) -> Body:
    """The code of a body. A `goto` without its label (reported by the checker) leads to the end."""
    f = _Flattener()
    f.block(body)
    end = f.emit(End(span))
    for at, label in f.gotos:
        f.patch(at, f.labels.get(label, end))
    return Body(tuple(f.code), f.labels, frozenset(f.along))


def _is_along(condition: t.Expression, body: Sequence[t.Statement]) -> bool:
    """`while count_of(l) <> 0 loop .. l := rest_of(l) .. end loop`, where nothing else changes the list."""
    match condition:
        case t.Binary("<>", t.CallExpression("count_of", (t.Name(name),)), t.Value(0)):
            pass
        case _:
            return False
    shorter = t.Assign(t.Target(name), t.CallExpression("rest_of", (t.Name(name),)))
    changed = 0
    for s in walk(body):
        match s:
            case t.Assign(target):
                changed += target.name == name
            case t.Read() | t.Label() | t.Goto() | t.Call():
                return False
    return changed == 1 and shorter in body


def walk(body: Iterable[t.Statement]) -> Iterator[t.Statement]:
    """All statements, those in blocks included, in order of the text."""
    for s in body:
        yield s
        match s:
            case t.If(branches, otherwise):
                for b in branches:
                    yield from walk(b.body)
                yield from walk(otherwise or ())
            case t.While(_, inner) | t.Loop(inner):
                yield from walk(inner)
            case _:
                pass
