"""The tree of a property's text: lark's tables in the loop of the CPN ML parser, so that lark need not be loaded.

    node = parsed(text, "start")     # None: it is no property; lark says what is wrong with it
    node.name, node.children         # "always", [Node("ml", ..)]

Loading lark takes a tenth of the time of checking a cell. The tree is the one that lark would make.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from functools import cache
from typing import Any, NamedTuple

from pn2code.base.private_folder import private_folder, write_whole
from pn2code.ml.parsing.lalr import Loop, SyntaxProblem
from pn2code.ml.parsing.tables import Automaton, automaton
from pn2code.properties.grammar import GRAMMAR

OPTIONS: dict[str, Any] = {
    "start": ["start", "fair"],
    "lexer": "basic",
    "propagate_positions": True,
    "maybe_placeholders": False,
}
"""How lark reads the grammar."""
_FORM = 1
"""Of the kept file; to be counted up when it changes."""


class Piece(str):
    """A token: its text, its terminal, and where it begins and ends."""

    __slots__ = ("end_pos", "kind", "start_pos")
    kind: str
    start_pos: int
    end_pos: int

    @property
    def outer(self) -> tuple[int, int]:
        """From where to where it takes up room in the text."""
        return self.start_pos, self.end_pos


class Node:
    """A node of the tree.

    Args:
        name: the method that makes something of it.
        children: its parts.
        start_pos, end_pos: where it begins and ends; -1: it has no parts.
        outer: the same with the parentheses around it.
    """

    __slots__ = ("children", "end_pos", "name", "outer", "start_pos")

    def __init__(self, name: str, children: list[Any]) -> None:
        self.name = name
        self.children = children
        self.start_pos = self.end_pos = -1
        self.outer = (-1, -1)


class Rule(NamedTuple):
    """What is made of the parts of a rule.

    Args:
        origin: the symbol on its left side.
        size: number of symbols on the right side.
        name: of its node.
        is_passed: whether a single part stands for the node.
        kept: the numbers of the parts that count (not those of words and signs).
        spliced: those of them that are repetitions, whose parts become parts of the node.
    """

    origin: str
    size: int
    name: str
    is_passed: bool
    kept: list[int]
    spliced: list[int]


class _Tables(NamedTuple):
    """All that lark has found out of the grammar.

    Args:
        automaton: its states.
        rules: by number.
        patterns: regular expressions, one after the other; a group for each terminal.
        words: by terminal: texts that are a terminal of their own.
        ignored: terminals that are passed over.
    """

    automaton: Automaton
    rules: list[Rule]
    patterns: list[str]
    words: dict[str, dict[str, str]]
    ignored: list[str]


def parsed(text: str, start: str) -> Node | None:
    """The tree of a text; None: it has none."""
    parser = _parser()
    pieces = parser.pieces(text)
    if pieces is None:
        return None
    try:
        node = parser.parse(pieces, start)
    except SyntaxProblem:
        return None
    assert isinstance(node, Node)
    return node


class _Parser(Loop):
    """The loop over these tables."""

    def __init__(self, tables: _Tables) -> None:
        made = ((r.size, _maker(r), r.origin) for r in tables.rules)
        super().__init__(tables.automaton, list(made))
        self._patterns = [re.compile(pattern) for pattern in tables.patterns]
        self._words = tables.words
        self._ignored = frozenset(tables.ignored)

    def pieces(self, text: str) -> list[Piece] | None:
        """The tokens of a text; None: a character belongs to none."""
        found: list[Piece] = []
        at = 0
        while at < len(text):
            match = next((m for p in self._patterns if (m := p.match(text, at))), None)
            if match is None:
                return None
            kind = match.lastgroup or ""
            if kind not in self._ignored:
                piece = Piece(match.group())
                piece.kind = self._words.get(kind, {}).get(piece, kind)
                piece.start_pos, piece.end_pos = at, match.end()
                found.append(piece)
            at = match.end()
        return found


def _maker(rule: Rule) -> Callable[[list[Any]], Any]:
    """What makes a rule's node of its parts."""
    name, is_passed, kept, spliced = rule.name, rule.is_passed, rule.kept, frozenset(rule.spliced)

    def make(parts: list[Any]) -> Any:
        own: list[Any] = []
        for number in kept:
            if number not in spliced:
                own.append(parts[number])
            elif own:
                own += parts[number].children
            else:
                own = parts[number].children  # nobody else has it; long repetitions begin so
        made = own[0] if is_passed and len(own) == 1 else Node(name, own)
        if isinstance(made, Node):
            _place(made, parts)
        return made

    return make


def _place(node: Node, parts: list[Any]) -> None:
    """A node begins with its first part and ends with its last one, parentheses around them included."""
    first, last = next(_outers(parts), None), next(_outers(reversed(parts)), None)
    if first is None or last is None:
        return
    if node.start_pos < 0:  # else it is the part within parentheses
        node.start_pos, node.end_pos = first[0], last[1]
    node.outer = first[0], last[1]


def _outers(parts: Iterable[Any]) -> Iterator[tuple[int, int]]:
    return (part.outer for part in parts if part.outer[0] >= 0)


@cache
def _parser() -> _Parser:
    folder = private_folder()
    if folder is None:
        return _Parser(_computed())
    digest = hashlib.sha256(f"{_FORM}\n{GRAMMAR}".encode()).hexdigest()[:16]
    kept = folder / f"property-{digest}.json"
    with suppress(OSError, ValueError, TypeError, KeyError):
        states, rules, *rest = json.loads(kept.read_bytes())
        return _Parser(_Tables(Automaton(*states), [Rule(*rule) for rule in rules], *rest))
    made = _computed()
    with suppress(OSError):
        write_whole(kept, json.dumps(made, separators=(",", ":")).encode())
    return _Parser(made)


def _computed() -> _Tables:
    from lark import Lark
    from lark.lexer import BasicLexer

    lark: Any = Lark(GRAMMAR, parser="lalr", **OPTIONS)
    states, rules = automaton(lark)
    lexer: Any = BasicLexer(lark.lexer_conf)
    scanner = lexer.scanner  # makes the callbacks, too
    words = {
        kind: {t.pattern.value: t.name for t in callback.scanner.terminals}
        for kind, callback in lexer.callback.items()
    }
    patterns = [pattern.pattern for pattern in scanner._mres]
    return _Tables(states, [_rule(r) for r in rules], patterns, words, sorted(lexer.ignore_types))


def _rule(rule: Any) -> Rule:
    symbols = list(enumerate(rule.expansion))
    kept = [n for n, symbol in symbols if not (symbol.is_term and symbol.filter_out)]
    return Rule(
        rule.origin.name,
        len(symbols),
        rule.alias or rule.origin.name,
        bool(rule.options.expand1 and not rule.alias),
        kept,
        [n for n, symbol in symbols if not symbol.is_term and symbol.name.startswith("_")],
    )
