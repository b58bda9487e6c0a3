"""The values of CPN ML expressions, beside those that the real engine gave."""

from __future__ import annotations

from pathlib import Path

from pn2code.diagnostics import NOWHERE, Diagnostics, SourceText
from pn2code.engine_comparison.finding import AGREES, Finding, State, differs
from pn2code.ml.core.types import STRING
from pn2code.ml.elaborate import Elaborator
from pn2code.net.check import check
from pn2code.net.link import link
from pn2code.reading.cpn import read
from pn2code.semantics.evaluation.effects import Effects, outside
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.values.data import MlException


def compare_expressions(suite: Path) -> dict[str, Finding]:
    """`ml-expressions.tsv`, in the declarations of `ml-expressions.cpn`: expression -> finding."""
    d = Diagnostics()
    document = read(suite / "ml-expressions.cpn", d)
    net = link(document, d) if document is not None else None
    typed = check(net, d, partial=True) if net is not None else None
    if typed is None or typed.elaborator is None:
        return {}
    elaborator = typed.elaborator
    evaluator = Evaluator(elaborator.program())
    found = {}
    for line in (suite / "ml-expressions.tsv").read_text(encoding="utf-8").splitlines():
        expression, _, expected = line.partition("\t")
        if "=> " in expected and not expected.startswith("ERR"):
            # the tab stands where the expression had its first `=>`
            rest, _, expected = expected.rpartition("=> ")
            expression = f"{expression} => {rest}"
        found[expression] = _compare(elaborator, evaluator, expression.strip(), expected.strip())
    return found


def _compare(elaborator: Elaborator, evaluator: Evaluator, text: str, expected: str) -> Finding:
    typed = elaborator.expression(SourceText(text, NOWHERE), (STRING,), expected_name="STRING")
    if typed is None:
        ours = "ERR compile"
    else:
        try:
            ours = str(evaluator.value(typed[1])).replace("\n", "\\n")
        except MlException as raised:
            ours = f"ERR raised {raised.name}"
    same = expected.startswith(ours) if ours.startswith("ERR") else ours == expected
    if same:
        return AGREES
    if typed is not None and outside(Effects(evaluator.program), typed[1]):
        return Finding(State.RANDOM, "it is drawn, or depends on the clock")
    return differs(f"{ours} instead of {expected}")
