"""The token game against the full state spaces that the real CPN Tools engine gave for 54 tiny nets."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from helpers.engine import engine_arcs, engine_nodes, our_arcs, our_nodes
from pn2code.diagnostics import NOWHERE, Diagnostics, SourceText
from pn2code.diagnostics.render import report
from pn2code.ml.core.types import STRING
from pn2code.net.check import _Checker
from pn2code.net.front import load
from pn2code.net.link import link
from pn2code.reading.cpn import read
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.game.graph import state_space
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.data import MlException

pytestmark = pytest.mark.shared

DIFFERENT = {
    "E20_same_colour": "of equal colours we take the latest stamp, the engine one at random",
    "E31b_discrete": "a random delay",
    "E34_nonlinear": "the engine has a bug with (x, x); we follow the mathematical rule",
}
MAX_NODES = 300


def test_state_spaces(shared: Path) -> None:
    wrong, compared = [], 0
    for file in sorted((shared / "semantics-suite").glob("*.json")):
        recorded = json.loads(file.read_text(encoding="utf-8"))
        same, why = compare(file.with_suffix(".cpn"), recorded)
        compared += 1
        if same and file.stem in DIFFERENT:
            wrong.append(f"{file.stem} agrees now: remove it from DIFFERENT")
        if not same and file.stem not in DIFFERENT:
            wrong.append(f"{file.stem}: {why}")
    assert compared >= 54
    assert not wrong, "\n".join(wrong)


def compare(path: Path, recorded: dict[str, Any]) -> tuple[bool, str]:
    """Whether we say of the net what the engine said, and if not, what is different."""
    d = Diagnostics()
    net = load(path, d)
    if net is None or not recorded["accepted"]:
        same = (net is not None) == recorded["accepted"]
        return same, f"accepted by us: {net is not None}\n{report(d)}"
    graph = recorded["graph"]
    try:
        game = Game(net)
        space = state_space(game, max_nodes=MAX_NODES)
    except GameError as error:
        return graph is None, str(error)
    if graph is None:
        return not space.complete, "the engine gives no state space, we do"
    ours, theirs = set(our_nodes(game, space)), set(engine_nodes(net, graph).values())
    if ours != theirs:
        return False, f"only ours: {ours - theirs}\nonly theirs: {theirs - ours}"
    arcs, their_arcs = our_arcs(game, space), engine_arcs(net, graph)
    return arcs == their_arcs, f"only ours: {arcs - their_arcs}\nonly theirs: {their_arcs - arcs}"


UNSUPPORTED = ("Time.now",)
"""Functions that the front end says it does not support."""


def test_expressions(shared: Path) -> None:
    """The values of some 120 expressions."""
    folder = shared / "semantics-suite"
    d = Diagnostics()
    document = read(folder / "ml-expressions.cpn", d)
    assert document is not None
    net = link(document, d)
    assert net is not None
    elaborator = _Checker(net, d, {}, 31, compute).elaborator
    # its colour set SUB is rejected, by the real engine as well
    assert [e.code for e in d.errors] == ["subset-bare-fn"], report(d)
    evaluator = Evaluator(elaborator.program())
    wrong, compared = [], 0
    for line in (folder / "ml-expressions.tsv").read_text(encoding="utf-8").splitlines():
        expression, _, expected = line.partition("\t")
        if "=> " in expected and not expected.startswith("ERR"):
            # the tab stands where the expression had its first `=>`
            rest, _, expected = expected.rpartition("=> ")
            expression = f"{expression} => {rest}"
        if any(word in expression for word in UNSUPPORTED):
            continue
        compared += 1
        found = outcome(elaborator, evaluator, expression)
        failed_alike = found.startswith("ERR") and expected.startswith(found)
        if not failed_alike and found != expected.strip():
            wrong.append(f"{expression} gives {found}, not {expected}")
    assert compared > 110
    assert not wrong, "\n".join(wrong)


def outcome(elaborator: Any, evaluator: Evaluator, expression: str) -> str:
    """The value as text, `ERR raised NAME`, or `ERR compile`."""
    text = SourceText(expression.strip(), NOWHERE)
    typed = elaborator.expression(text, (STRING,), expected_name="STRING")
    if typed is None:
        return "ERR compile"
    try:
        return str(evaluator.value(typed[1])).replace("\n", "\\n")
    except MlException as raised:
        return f"ERR raised {raised.name}"
