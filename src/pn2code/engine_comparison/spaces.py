"""State spaces by the compiled explorer against the reports of the real engine, line by line.

    explored(corpus, "hglps+Petri-nets/atv/new_candy_machine.cpn")      # a Finding

Sizes, components, bounds of places and of their colours, home and dead markings, dead and live transitions, fairness:
the text of `pn2code verify` has to be the engine's, but for the date, the seconds, and the numbers that nodes have.
"""

from __future__ import annotations

import difflib
import json
import re
from collections.abc import Iterator
from pathlib import Path

from pn2code.diagnostics import Diagnostics
from pn2code.engine_comparison.finding import NOTHING, Finding, State, differs
from pn2code.net import front
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.evaluation.effects import Effects, outside
from pn2code.semantics.game.errors import GameError
from pn2code.verify.exploring.explore import explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import Exploration
from pn2code.verify.report.text import report

SECONDS = 300.0
"""Of processor time, for one net."""
_MOST_LINES = 4
_SECONDS = re.compile(r"     Secs:   \d+")
_NODES = re.compile(r"     (?:(\d+) )?\[([\d,]*)(?:,\.\.\.)?\]")
_NO_HOME = "     Initial Marking is not a home marking"
"""Of some nets the engine's report says no more of the home markings."""


def explored(corpus: Path, path: str) -> Finding:
    """Explores a net of the corpus of which the engine has a complete state space."""
    expected = json.loads((corpus / "expected" / f"{path}.json").read_text(encoding="utf-8"))
    if not expected["state_space"] or not expected.get("report"):
        return NOTHING
    d = Diagnostics()
    net = front.load(corpus / "nets" / path, d, compute=compute)
    if net is None:
        return NOTHING
    try:
        found = explore(net, {}, Limits(processor_seconds=SECONDS, traces=0), d)
    except GameError as error:
        return differs(error.message)
    if found is None:
        return differs("; ".join(e.message for e in d.errors[:2]))
    lines = list(_differences(expected["report"], report(net, found, None), found))
    if not lines:
        size = expected["state_space"]
        return Finding(State.AGREES, f"{size['nodes']} nodes, {size['arcs']} arcs")
    more = f"; and {len(lines) - _MOST_LINES} lines more" * (len(lines) > _MOST_LINES)
    note = "; ".join(" ".join(line.split()) for line in lines[:_MOST_LINES]) + more
    return Finding(State.RANDOM, note) if outside(Effects(net.program), net) else differs(note)


def _differences(theirs: str, ours: str, found: Exploration) -> Iterator[str]:
    """The lines that differ, `-` before the engine's, `+` before ours."""
    engine, own = list(_comparable(theirs)), list(_comparable(ours))
    if _NO_HOME in engine and found.graph is not None and not found.graph.initial_is_home:
        at = engine.index(_NO_HOME)
        own[at : at + 1] = [_NO_HOME]
    for line in difflib.unified_diff(engine, own, lineterm="", n=0):
        if line[0] in "+-" and not line.startswith(("+++", "---")):
            yield line


def _comparable(text: str) -> Iterator[str]:
    """From the statistics on: without seconds, and with the number of nodes instead of a list of them."""
    for line in text[text.index(" Statistics\n") :].rstrip().split("\n"):
        nodes = _NODES.fullmatch(line)
        if nodes is not None:
            yield f"     {nodes[1] or nodes[2].count(',') + 1} nodes"
        elif not _SECONDS.fullmatch(line):
            yield line.rstrip()
