"""Properties are parsed without lark, but by its tables: the trees are those that lark makes."""

from __future__ import annotations

import os
import random
import subprocess
import sys
from pathlib import Path
from typing import Any

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput

from pn2code.properties.grammar import GRAMMAR, KEYWORDS
from pn2code.properties.loop import OPTIONS, Node, parsed

SIGNS = (
    "(",
    ")",
    "[",
    "]",
    "<",
    ">",
    "<=",
    ">=",
    "=",
    "==",
    "<>",
    ",",
    "->",
    "<->",
    "||",
    "&&",
    "!",
)
WORDS = (*KEYWORDS, *SIGNS, "3", "2.5", "Page'T", "P", '"x y"', "{\0\0}", "{", "$", "\n")
ATOMS = (
    "{\0}", "true", "dead", "enabled(P'T 2)", "fires(P'T, {\0\0})", 'tokens(P, "x y") >= 3', "3 < tokens(Q 1)",
    "initial", "tokens(P) <= tokens(Q)",
)  # fmt: skip
FORMS = (
    "({0})", "! ({0})", "AX ({0})", "F ({0})", "EX<P'T>({0})", "A[({0}) U {1}]", "({0} -> {1})", "{1} || {1} or {1}",
    "({0}) <-> {1}", "{1} U {1} W {1}", "{1} && ({0}) and {1}",
)  # fmt: skip
PROPERTIES = (
    "always {0}", "ctl {0}", "deadlock free except {0}", "ltl {0} assuming weak P'T 1, strong all, Q",
    "every {0} is followed by {1} within 2.5 time", "every {1} is followed by {1} assuming strong all",
    "bound 1 <= P'Q 1 <= 3", "mutex P 1, {1}, \"a b\"",
)  # fmt: skip


def formula(r: random.Random, depth: int) -> str:
    if not depth:
        return r.choice(ATOMS)
    return r.choice(FORMS).format(formula(r, depth - 1), r.choice(ATOMS))


def text(r: random.Random) -> str:
    made = r.choice(PROPERTIES).format(formula(r, r.randrange(5)), r.choice(ATOMS))
    words = made.split(" ")
    if r.random() < 0.4:
        words.insert(r.randrange(len(words) + 1), r.choice(WORDS))
    if r.random() < 0.1:
        words = r.choices(WORDS, k=r.randrange(5))
    return " ".join(words)


def shape(node: Any) -> tuple[object, ...]:
    """A node of either tree."""
    if isinstance(node, Tree):
        meta = node.meta
        place = () if meta.empty else (meta.start_pos, meta.end_pos)
        return str(node.data), place, [shape(c) for c in node.children]
    if isinstance(node, Node):
        place = () if node.start_pos < 0 else (node.start_pos, node.end_pos)
        return node.name, place, [shape(c) for c in node.children]
    kind = node.type if isinstance(node, Token) else node.kind
    return str(node), kind, node.start_pos, node.end_pos


def test_trees_are_those_of_lark() -> None:
    lark = Lark(GRAMMAR, parser="lalr", **OPTIONS)
    r = random.Random(7)
    read = 0
    for _ in range(1500):
        asked, start = text(r), r.choice(["start", "start", "start", "fair"])
        try:
            expected = shape(lark.parse(asked, start=start))
        except UnexpectedInput:
            expected = None
        found = parsed(asked, start)
        assert (shape(found) if found is not None else None) == expected, asked
        read += expected is not None
    assert 300 < read < 1400


def test_lark_is_not_loaded(root: Path, tmp_path: Path) -> None:
    """Where the tables are kept; what has been worked out anew keeps them."""
    said = []
    for _ in range(2):
        done = subprocess.run(
            [
                sys.executable,
                "-X",
                "importtime",
                "-m",
                "pn2code",
                "check",
                str(root / "examples/riveting"),
            ],
            env={**os.environ, "XDG_CACHE_HOME": str(tmp_path)},
            capture_output=True,
            text=True,
            check=True,
        )
        said.append([line for line in done.stderr.splitlines() if line.split()[-1] == "lark"])
    assert said[0]
    assert not said[1]
