"""The expressions of the semantics suite in compiled code: the values that CPN Tools gave."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from helpers.compiled import Workshop, lowered, run
from helpers.netbuilder import flat
from pn2code.diagnostics import NOWHERE, Diagnostics, SourceText
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import STRING
from pn2code.net.check import check
from pn2code.net.flat import FlatNet, Form
from pn2code.net.link import link
from pn2code.reading.cpn import read

pytestmark = pytest.mark.cc

NET = 'net Suite\n  standard\n  place P : STRING = 1`""'
LEFT_OUT = (
    "ran()", "random", "uniform", "discrete", "exponential", "normal", "poisson", "time()",
    "Time.now()", "IntInf.pow(2,70)",
)  # fmt: skip
"""Words of expressions whose values are not always the same, and what is beyond 64 bits."""

Typed = list[tuple[str, core.Exp, str]]


def typed_expressions(folder: Path) -> tuple[core.Program, Typed]:
    """The declarations, and text, expression and expected value of each expression that is accepted."""
    d = Diagnostics()
    document = read(folder / "ml-expressions.cpn", d)
    assert document is not None
    linked = link(document, d)
    assert linked is not None
    checked = check(linked, d, partial=True)
    assert checked is not None and checked.elaborator is not None
    found = []
    for line in (folder / "ml-expressions.tsv").read_text(encoding="utf-8").splitlines():
        text, _, expected = line.partition("\t")
        if "=> " in expected and not expected.startswith("ERR"):
            rest, _, expected = expected.rpartition("=> ")
            text = f"{text} => {rest}"
        if any(word in text for word in LEFT_OUT) or expected.startswith("ERR compile"):
            continue
        typed = checked.elaborator.expression(
            SourceText(text.strip(), NOWHERE), (STRING,), expected_name="STRING"
        )
        if typed is not None:
            found.append((text.strip(), typed[1], expected.strip()))
    return checked.elaborator.program(), found


def net_of(program: core.Program, part: Typed) -> FlatNet:
    base = flat(NET)
    [place] = base.places
    places = tuple(
        replace(place, index=i, name=f"Top.P{i}", short=f"P{i}", initial=(exp, Form.TOKEN))
        for i, (_, exp, _) in enumerate(part)
    )
    return replace(base, program=program, places=places)


def outcomes(program: core.Program, part: Typed, workshop: Workshop, name: str) -> list[str]:
    """The values; those that stop all others by themselves."""
    net = net_of(program, part)
    ir, d = lowered(net, capacity={p.name: 1 for p in net.places})
    line: dict[str, object] = {"error": d.errors[0].message if d.errors else ""}
    if ir is not None:
        [line] = run(workshop.build(ir, workshop.folder / name, "walk", "-O0"), 1, 0)
    if "error" not in line:
        return [line["marking"][p.name][0][1] for p in net.places]  # type: ignore[index]
    if len(part) == 1:
        return [f"ERR raised {line['error']}"]
    middle = len(part) // 2
    first = outcomes(program, part[:middle], workshop, f"{name}0")
    return first + outcomes(program, part[middle:], workshop, f"{name}1")


def test_values(shared: Path, fast_workshop: Workshop) -> None:
    program, expressions = typed_expressions(shared / "semantics-suite")
    assert len(expressions) > 80
    # Those that ought to raise an exception are nets of their own; if others do, the net they are in is divided.
    found: list[str] = [""] * len(expressions)
    alone = [i for i, (_, _, expected) in enumerate(expressions) if expected.startswith("ERR")]
    for part in [[i for i in range(len(expressions)) if i not in alone], *([i] for i in alone)]:
        values = outcomes(program, [expressions[i] for i in part], fast_workshop, f"part{part[0]}")
        for i, value in zip(part, values, strict=True):
            found[i] = value
    wrong = [
        f"{text} gives {ours!r}, not {expected!r}"
        for (text, _, expected), ours in zip(expressions, found, strict=True)
        if ours.replace("\n", "\\n") != expected
        and not (ours.startswith("ERR") and expected.startswith(ours))
    ]
    assert not wrong, "\n".join(wrong)
