"""The parser's loop over the LALR tables that lark has computed.

Lark's own loop looks rules up by value and makes an object for every token, which took half of the time of checking a
net. This one does the same on the lexer's tokens.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import chain
from typing import Any, Protocol

from pn2code.ml.parsing.tables import Automaton, Rule, Tables

_END = "$END"
_NO_TOKEN: tuple[None] = (None,)

Children = list[Any]
Callback = Callable[[Children], Any]


class Token(Protocol):
    """What the loop has to know of a token."""

    @property
    def kind(self) -> str:
        """Its terminal."""


class SyntaxProblem(Exception):
    """A token cannot stand where it stands.

    Args:
        token: the token; None at the end of the text.
        accepts: kinds of tokens that could stand there; `$END` for the end.
    """

    def __init__(self, token: Any, accepts: frozenset[str]) -> None:
        super().__init__()
        self.token = token
        self.accepts = accepts


class Loop:
    """Parses with tables.

    Args:
        automaton: has `rows`, `starts` and `ends`.
        rules: of each rule its size, what makes its value of the values of its parts (None: the only part itself), and
            the symbol on its left side.
    """

    def __init__(
        self, automaton: Automaton | Tables, rules: Sequence[tuple[int, Callback | None, str]]
    ) -> None:
        self._rows = automaton.rows
        self._starts = automaton.starts
        self._ends = automaton.ends
        self._rules = rules

    @staticmethod
    def of(tables: Tables, builder: object) -> Loop:
        """One whose builder has a method for each rule of the grammar, which gets the list of its parts."""
        return Loop(tables, [(r.size, _callback(r, builder), r.origin) for r in tables.rules])

    def parse(self, tokens: Sequence[Token], start: str) -> Any:
        """What the reductions make of a text.

        Raises:
            SyntaxProblem: it is not one.
        """
        rows, rules = self._rows, self._rules
        end_state = self._ends[start]
        states: list[int] = [self._starts[start]]
        row = rows[states[0]]
        values: list[Any] = []
        for token in chain(tokens, _NO_TOKEN):
            kind = token.kind if token is not None else _END
            while True:
                action = row.get(kind)
                if action is None:
                    raise SyntaxProblem(token, self._accepts(states, end_state))
                if action >= 0:
                    states.append(action)
                    values.append(token)
                    row = rows[action]
                    break
                size, callback, origin = rules[~action]
                if size == 1:
                    states.pop()
                    if callback is not None:
                        values[-1] = callback([values[-1]])
                else:
                    first = len(values) - size
                    children = values[first:]
                    del values[first:]
                    del states[first + 1 :]
                    assert callback is not None
                    values.append(callback(children))
                target = rows[states[-1]][origin]
                states.append(target)
                row = rows[target]
                if target == end_state and token is None:
                    return values[-1]
        raise AssertionError("the end of the text is shifted nowhere")

    def _accepts(self, states: Sequence[int], end_state: int) -> frozenset[str]:
        """The kinds of tokens that can follow."""
        row = self._rows[states[-1]]
        return frozenset(k for k in row if k.isupper() and self._can_follow(k, states, end_state))

    def _can_follow(self, kind: str, states: Sequence[int], end_state: int) -> bool:
        stack = list(states)
        while True:
            action = self._rows[stack[-1]].get(kind)
            if action is None:
                return False
            if action >= 0:
                return True
            size, _, origin = self._rules[~action]
            if size:
                del stack[-size:]
            stack.append(self._rows[stack[-1]][origin])
            if kind == _END and stack[-1] == end_state:
                return True


def _callback(rule: Rule, builder: object) -> Callback | None:
    """What makes a rule's value of the values of its parts; None: the only part itself."""
    if rule.is_passed and rule.size == 1 and not rule.spliced:
        return None
    make: Callback = getattr(builder, rule.name) if rule.name else _as_it_is
    if rule.is_passed:
        make = _passed(make)
    return _spliced(make, frozenset(rule.spliced)) if rule.spliced else make


def _as_it_is(children: Children) -> Children:
    return children  # no copy: long repetitions are made part by part


def _passed(make: Callback) -> Callback:
    def passed(children: Children) -> Any:
        return children[0] if len(children) == 1 else make(children)

    return passed


def _spliced(make: Callback, spliced: frozenset[int]) -> Callback:
    """The parts of repetitions (which are lists) become parts of the node."""

    def splice(children: Children) -> Any:
        parts: Children = []
        for number, part in enumerate(children):
            if number not in spliced:
                parts.append(part)
            elif parts:
                parts += part
            else:
                parts = part  # nobody else has it; long repetitions begin with all before
        return make(parts)

    return splice
