"""The parser's loop over lark's LALR tables.

Lark computes the tables and the reductions; its own loop looks rules up by value and makes an object for every
token, which takes half of the time of checking a net. This one does the same on the lexer's tokens.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from lark import Lark
from lark.parsers.lalr_analysis import Shift

from pn2code.ml.lexer import Lexeme

_END = "$END"


class SyntaxProblem(Exception):  # noqa: N818  (reported by the caller)
    """A token cannot stand where it stands.

    Args:
        token: the token; None at the end of the text.
        accepts: kinds of tokens that could stand there; `$END` for the end.
    """

    def __init__(self, token: Lexeme | None, accepts: frozenset[str]) -> None:
        super().__init__()
        self.token = token
        self.accepts = accepts


Action = tuple[int, int, Callable[[list[Any]], Any] | None, str]
"""Next state if it is not negative; else size, callback and origin of a reduction."""


class Loop:
    """Parses with the tables of a `Lark` instance."""

    def __init__(self, lark: Lark) -> None:
        inner: Any = lark.parser
        self._table = inner.parser.parser.parse_table
        self._callbacks = inner.parser.parser.callbacks
        self._actions: dict[int, dict[str, Action]] = {}

    def _state(self, state: int) -> dict[str, Action]:
        """The actions of a state, converted when it is first met."""
        made: dict[str, Action] = {}
        for kind, (action, argument) in self._table.states[state].items():
            if action is Shift:
                made[kind] = (argument, 0, None, "")
            else:
                made[kind] = (
                    -1,
                    len(argument.expansion),
                    self._callbacks[argument],
                    argument.origin.name,
                )
        self._actions[state] = made
        return made

    def parse(self, tokens: Sequence[Lexeme], start: str) -> Any:
        """What the reductions make of a text.

        Raises:
            SyntaxProblem: it is not one.
        """
        actions = self._actions
        end_state = self._table.end_states[start]
        states: list[int] = [self._table.start_states[start]]
        values: list[Any] = []
        index, count = 0, len(tokens)
        while True:
            token = tokens[index] if index < count else None
            kind = token.kind if token is not None else _END
            state = states[-1]
            row = actions.get(state) or self._state(state)
            action = row.get(kind)
            if action is None:
                raise SyntaxProblem(token, self._accepts(states, end_state))
            target, size, callback, origin = action
            if callback is None:
                states.append(target)
                values.append(token)
                index += 1
                continue
            if size:
                children = values[-size:]
                del states[-size:]
                del values[-size:]
            else:
                children = []
            state = states[-1]
            row = actions.get(state) or self._state(state)
            target = row[origin][0]
            states.append(target)
            values.append(callback(children))
            if token is None and target == end_state:
                return values[-1]

    def _accepts(self, states: Sequence[int], end_state: int) -> frozenset[str]:
        """The kinds of tokens that can follow."""
        row = self._actions.get(states[-1]) or self._state(states[-1])
        return frozenset(k for k in row if k.isupper() and self._can_follow(k, states, end_state))

    def _can_follow(self, kind: str, states: Sequence[int], end_state: int) -> bool:
        stack = list(states)
        while True:
            row = self._actions.get(stack[-1]) or self._state(stack[-1])
            action = row.get(kind)
            if action is None:
                return False
            target, size, callback, origin = action
            if callback is None:
                return True
            if size:
                del stack[-size:]
            row = self._actions.get(stack[-1]) or self._state(stack[-1])
            stack.append(row[origin][0])
            if kind == _END and stack[-1] == end_state:
                return True
