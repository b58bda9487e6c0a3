"""What evaluating an expression may do besides giving a value: draw random numbers, read or write references, count.

    effects = effects_of(net.program)
    Effect.DRAW in effects.of(arc.inscription.value)

A safe guess from the text: a function that is mentioned counts as applied, both branches of an `if` as taken.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from enum import Enum
from functools import cache
from operator import attrgetter
from typing import Any

from pn2code.ml.core import terms as core
from pn2code.net.flat import FlatNet

Found = frozenset["Effect"]


class Effect(Enum):
    """What an evaluation may do."""

    DRAW = "draws random numbers"
    LOOK = "looks at the surroundings (files, clocks)"
    READ = "reads a reference"
    WRITE = "changes a reference"
    COUNT = "asks for the number of steps"


NONE: Found = frozenset()
_DRAW = ("Random.",)
_DRAWING = frozenset({"Colset.ran", "Ms.random"})
_LOOK = (
    "TextIO.", "BinIO.", "OS.FileSys.", "OS.Process.", "Posix.", "Timer.", "Time.now", "Date.", "CommandLine.",
    "ConnManagementLayer.",
)  # fmt: skip
_WRITTEN_ONLY = frozenset(
    {"TextIO.print", "TextIO.output", "TextIO.flushOut", "TextIO.stdOut", "TextIO.closeOut"}
)
_CREATING = frozenset(
    {"Ref.ref", "Array.array", "Array.fromList", "Array.tabulate", "Array.maxLen"}
)
_ARRAY_WRITING = frozenset(
    {"Array.update", "Array.copy", "Array.copyVec", "Array.modify", "Array.modifyi"}
)
_LEAVES = frozenset({"type", "span", "inst", "colset", "constructor"})
OUTSIDE = frozenset({Effect.DRAW, Effect.LOOK})
"""What makes a value depend on more than the net."""


def effects_of_builtin(name: str) -> Found:
    """The effects of a function of the built-in environment."""
    if name in _DRAWING or name.startswith(_DRAW):
        return frozenset({Effect.DRAW})
    reads = name.startswith("Colset.") and ".input" in name
    if reads or (name.startswith(_LOOK) and name not in _WRITTEN_ONLY):
        return frozenset({Effect.LOOK})
    if name == "Time.step":
        return frozenset({Effect.COUNT})
    if name in _CREATING:
        return NONE
    if name == "Ref.!" or (name.startswith("Array.") and name not in _ARRAY_WRITING):
        return frozenset({Effect.READ})
    if name.startswith("Ref.") or name in _ARRAY_WRITING:
        return frozenset({Effect.READ, Effect.WRITE})
    return NONE


_latest: tuple[tuple[core.Program, Effects], ...] = ()
"""Programs that were asked about last."""
_MOST = 4


def effects_of(program: core.Program) -> Effects:
    """Those of a program, which many ask for in turn."""
    global _latest
    for known, effects in _latest:
        if known is program:
            return effects
    made = Effects(program)
    _latest = ((program, made), *_latest[: _MOST - 1])
    return made


class Effects:
    """The effects of all expressions of a net."""

    def __init__(self, program: core.Program) -> None:
        self._of_symbol: dict[int, Found] = {}
        self._of_term: dict[int, tuple[object, Found]] = {}
        for declaration in program.declarations:
            match declaration:
                case core.ValBind(pattern, value):
                    self._bind(pattern, value)
                case core.RecBind(bindings):
                    # The functions of a group may call each other: what one does, all may do.
                    found = self._looked_up(declaration)
                    for symbol, _ in bindings:
                        self._of_symbol[symbol.uid] = found

    def _bind(self, pattern: core.Pat, value: core.Exp, around: Found = NONE) -> None:
        """Notes what each variable of a pattern may do: of a tuple of functions, each has effects of its own.

        Args:
            pattern: a pattern.
            value: what it is matched with.
            around: the effects of what stands before it in a `let`, which all its variables may have.
        """
        match pattern, value:
            case _, core.Let(declarations, body):
                self._bind(pattern, body, around | self._looked_up(declarations))
            case core.PRecord(parts), core.RecordExp(fields):
                values = dict(fields)
                for label, part in parts:
                    self._bind(part, values[label], around)
            case _:
                found = around | self._looked_up(value)
                for symbol in _symbols(pattern):
                    self._of_symbol[symbol.uid] = found

    def of(self, *nodes: Any) -> Found:
        """The effects of pieces of the core language; None counts as nothing."""
        if len(nodes) != 1:
            return NONE.union(*(self.of(node) for node in nodes))
        (node,) = nodes
        if node is None:
            return NONE
        # Many ask for those of the same term; as long as it is kept here no other one has its number.
        known = self._of_term.get(id(node))
        if known is None:
            known = self._of_term[id(node)] = node, self._looked_up(node)
        return known[1]

    def _looked_up(self, node: Any) -> Found:
        """Those of a piece, by what is known of symbols now."""
        found: set[Effect] = set()
        todo: list[Any] = [node]
        while todo:
            item = todo.pop()
            kind = item.__class__
            if isinstance(item, tuple):
                todo += item
            elif (parts := _parts(kind)) is not None:
                todo += parts(item)
            elif kind is core.Builtin:
                found |= effects_of_builtin(item.name)
            elif kind is core.Symbol:
                found |= self._of_symbol.get(item.uid, NONE)
        return frozenset(found)


def outside(effects: Effects, *nodes: Any) -> bool:
    """Whether the values of any of these depend on more than the net; a `FlatNet` stands for all its texts."""
    parts: list[Any] = []
    for node in nodes:
        parts.extend(texts(node) if isinstance(node, FlatNet) else (node,))
    return bool(effects.of(*parts) & OUTSIDE)


def texts(net: FlatNet) -> Iterator[Any]:
    """All initial markings and inscriptions."""
    yield from (p.initial[0] for p in net.places if p.initial)
    for t in net.transitions:
        yield from (t.guards, t.delay, t.code.action if t.code else None)
        yield from (a.inscription.value for a in t.arcs if a.inscription)


@cache
def _parts(kind: type) -> Callable[[Any], Sequence[Any]] | None:
    """What gives the parts of a term in which others are; None for what has none, or has effects itself."""
    if kind.__module__ != core.__name__ or kind in (core.Builtin, core.Symbol):
        return None
    slots: Iterable[str] = kind.__slots__  # type: ignore[attr-defined]  # terms have slots
    names = tuple(name for name in slots if name not in _LEAVES)
    match names:
        case ():
            return None
        case (name,):
            return lambda item: (getattr(item, name),)
        case _:
            return attrgetter(*names)


def _symbols(pattern: core.Pat) -> list[core.Symbol]:
    """The symbols that a pattern binds."""
    found: list[core.Symbol] = []
    todo: list[Any] = [pattern]
    while todo:
        item = todo.pop()
        if isinstance(item, core.Symbol):
            found.append(item)
        elif isinstance(item, tuple):
            todo.extend(item)
        elif type(item).__module__ == core.__name__:
            todo.extend(getattr(item, name) for name in item.__slots__ if name not in _LEAVES)
    return found
