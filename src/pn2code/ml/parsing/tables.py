"""The tables of the CPN ML parser: computed by lark from `grammar.lark` once for each user, then kept.

Lark takes half a second for them, and a tenth to be loaded at all; so it is not even imported where they are kept
(`private_folder`). They are kept as JSON: a damaged file is computed anew.
"""

from __future__ import annotations

import hashlib
import json
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from pn2code.base.private_folder import private_folder, write_whole

STARTS = ["program", "expression", "expressions", "layered", "code"]
_FORM = 1
"""Of the kept file; to be counted up when it changes."""


class Rule(NamedTuple):
    """A rule of the grammar, as the parser's loop needs it.

    Args:
        origin: the symbol on its left side.
        size: number of symbols on the right side.
        name: which method of the tree builder makes its node; "" for repetitions (`*`, `+`), whose parts become parts
            of the rule around.
        is_passed: whether a single part stands for the node.
        spliced: which parts are repetitions.
    """

    origin: str
    size: int
    name: str
    is_passed: bool
    spliced: list[int]


class Automaton(NamedTuple):
    """An LALR automaton.

    Args:
        rows: of each state: terminal or symbol -> next state if not negative, else ~number of a rule to reduce by.
        starts, ends: by start symbol.
    """

    rows: list[dict[str, int]]
    starts: dict[str, int]
    ends: dict[str, int]


class Tables(NamedTuple):
    """An automaton (`rows`, `starts`, `ends`), and its rules by number."""

    rows: list[dict[str, int]]
    starts: dict[str, int]
    ends: dict[str, int]
    rules: list[Rule]


def tables() -> Tables:
    """Those of `grammar.lark`."""
    grammar = Path(__file__).with_name("grammar.lark").read_text(encoding="utf-8")
    folder = private_folder()
    if folder is None:
        return _computed(grammar)
    digest = hashlib.sha256(f"{_FORM}\n{grammar}".encode()).hexdigest()[:16]
    kept = folder / f"cpnml-{digest}.json"
    with suppress(OSError, ValueError, TypeError, KeyError):
        found = json.loads(kept.read_bytes())
        rules = [Rule(*rule) for rule in found["rules"]]
        return Tables(found["rows"], found["starts"], found["ends"], rules)
    made = _computed(grammar)
    with suppress(OSError):
        write_whole(kept, json.dumps(made._asdict(), separators=(",", ":")).encode())
    return made


def _computed(grammar: str) -> Tables:
    from lark import Lark
    from lark.lexer import Lexer

    class NoLexer(Lexer):
        """Lark's lexer is not used: its tables are."""

        def __init__(self, lexer_conf: object) -> None:
            pass

        def lex(self, data: Any) -> Any:  # type: ignore[override]  # it is never called
            """Never called."""
            return data

    lark: Any = Lark(
        grammar,
        parser="lalr",
        lexer=NoLexer,
        start=STARTS,
        keep_all_tokens=True,
        maybe_placeholders=False,
    )
    states, rules = automaton(lark)
    return Tables(*states, [_rule(rule) for rule in rules])


def automaton(lark: Any) -> tuple[Automaton, list[Any]]:
    """The automaton of a parser that lark has made, and lark's rules by number."""
    from lark.parsers.lalr_analysis import Shift

    table = lark.parser.parser.parser.parse_table
    numbers = {state: n for n, state in enumerate(table.states)}
    rules: dict[Any, int] = {}
    rows: list[dict[str, int]] = []
    for actions in table.states.values():
        row = {}
        for kind, (action, argument) in actions.items():
            if action is Shift:
                row[kind] = numbers[argument]
            else:
                row[kind] = ~rules.setdefault(argument, len(rules))
        rows.append(row)
    starts = {start: numbers[state] for start, state in table.start_states.items()}
    ends = {start: numbers[state] for start, state in table.end_states.items()}
    return Automaton(rows, starts, ends), list(rules)


def _rule(rule: Any) -> Rule:
    origin = rule.origin.name
    return Rule(
        origin,
        len(rule.expansion),
        "" if origin.startswith("_") else rule.alias or origin,
        bool(rule.options.expand1 and not rule.alias),
        [n for n, symbol in enumerate(rule.expansion) if symbol.name.startswith("_")],
    )
