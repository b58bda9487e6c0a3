"""The report of a state space as one HTML file: readable without scripts and without a network."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from datetime import datetime
from typing import Any

import pn2code
from pn2code.base.deadline import NEVER, Deadline, TimeIsOverError
from pn2code.base.frozen import frozen
from pn2code.net.engine_names import EngineNames
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.token_game import GameError
from pn2code.trace.script import TraceRefusedError
from pn2code.verify.answers import basis
from pn2code.verify.answers.assumptions import assumed
from pn2code.verify.answers.outcome import (
    Counts,
    closed_net,
    error_text,
    good_of,
    header,
    is_everywhere,
    may_stop,
    order_text,
)
from pn2code.verify.answers.path import Step, steps
from pn2code.verify.answers.properties import Answer
from pn2code.verify.answers.properties import kind as kind_of
from pn2code.verify.controller.control_types import TITLES, Control
from pn2code.verify.exploring.result import Exploration, Trace
from pn2code.verify.exploring.result_rows import cut
from pn2code.verify.report import (
    control_text,
    html,
    properties_text,
    swarm_text,
    sweep_text,
    unfolded_text,
)
from pn2code.verify.report.text import bounded_places, left_out

MOST_STEPS = 200
"""Of a longer trace only the first steps are shown."""


@frozen
class _Player:
    """Plays runs once more, as long as there is time."""

    net: FlatNet
    storage: Mapping[str, str]
    deadline: Deadline

    def trace(self, trace: Trace) -> dict[str, Any]:
        """A run as the page shows it."""
        problem = ""
        shown: tuple[Step, ...] = ()
        try:
            with self.deadline.enforced():
                shown = steps(self.net, self.storage, trace.file, most=MOST_STEPS)
        except TimeIsOverError:
            problem = "The trace is not shown here: the time was up."
        except (TraceRefusedError, GameError, OSError) as error:
            problem = f"The trace cannot be shown: {error}"
        return {
            "node": trace.node,
            "file": trace.file,
            "steps": trace.steps,
            "shown": shown,
            "left": max(trace.steps - MOST_STEPS, 0) if not problem else 0,
            "problem": problem,
        }


def webpage(
    net: FlatNet,
    found: Exploration,
    storage: Mapping[str, str],
    written: datetime,
    answers: Sequence[Answer] = (),
    control: Control | None = None,
    channel_model: Sequence[Mapping[str, Any]] = (),
    subject: Sequence[tuple[str, str, str]] = (),
    remark: str = "",
    notes: Sequence[str] = (),
    counts: Counts | None = None,
    deadline: Deadline = NEVER,
) -> str:
    """The whole page.

    Args:
        net: the net.
        found: its state space.
        storage: as for `Game`, which repeats the traces.
        written: the date it carries.
        answers: of properties that were asked.
        control: the checks of a cell's supervisor.
        channel_model: its shared files, as rows: `name`, `said`, `remarks`, `answer`, `kind`, `runs` (lines each).
        subject: what was looked at: what it is, its name, its SHA-256 or value.
        counts: how all answers have come out; None: as these answers to properties.
        remark: why the subject lacks something; "": it does not.
        notes: what is no failure, and to be said beside a yes.
        deadline: when it is over no run is played any more.
    """
    player = _Player(net, storage, deadline)
    tables: dict[str, Sequence[Mapping[str, Any]]] = {
        "Properties": [_property(player, a) for a in answers],
        "Controller checks": list(control_text.rows(control)) if control else [],
        "Medium": list(channel_model),
    }
    counts = counts or Counts.of(map(kind_of, answers))
    fair = [f"`{a.about.name}`: {', '.join(a.about.fair)}" for a in answers if a.about.fair]
    return html.page(
        "report.html.j2",
        ("report.css",),
        title=net.name,
        file=net.file,
        version=pn2code.__version__,
        sha256=net.sha256,
        written=f"{written:%Y-%m-%d %H:%M}",
        what="Verification" if any(tables.values()) else "State space",
        verdicts=[
            *_summary(tables),
            *_verdicts(net, found, counts),
            *({"kind": "open", "text": x.replace("`", "")} for x in notes),
        ],
        tables=tables,
        subject=list(subject),
        remark=remark,
        assumed=[
            sentence.replace("`", "")
            for sentence in assumed(
                timed=net.timed,
                control=control is not None,
                channel_model=bool(channel_model),
                fair=fair,
            )
        ],
        statistics=list(_statistics(net, found)),
        bounds=_bounds(net, found),
        markings=list(_markings(found)),
        transitions=_transitions(net, found),
        traces=list(_traces(player, found)),
        controller_runs=list(_controller_runs(player, control)) if control else [],
        timed=net.timed,
    )


def _summary(tables: Mapping[str, Sequence[Mapping[str, Any]]]) -> Iterator[dict[str, str]]:
    """A line for each kind of question: how many are answered as they should be."""
    for title, rows in tables.items():
        if not rows:
            continue
        count = {kind: sum(row["kind"] == kind for row in rows) for kind in ("good", "bad", "open")}
        kind = "bad" if count["bad"] else "open" if count["open"] else "good"
        text = f"{title}: {good_of(count['good'], len(rows))}"
        if count["bad"]:
            text += f", {count['bad']} {'are' if count['bad'] > 1 else 'is'} not"
        if count["open"]:
            text += f", {count['open']} {'are' if count['open'] > 1 else 'is'} open"
        yield {"kind": kind, "text": f"{text}."}


def _property(player: _Player, a: Answer) -> dict[str, Any]:
    """A row of the table of properties, with the run that shows the answer."""
    found: dict[str, Any] = {
        "name": a.about.name,
        "said": properties_text.said(a),
        "remarks": properties_text.remarks(a),
        "answer": {"inconclusive": "not known"}.get(a.answer, a.answer),
        "kind": kind_of(a),
        "run": None,
    }
    if a.evidence is not None:
        loop = a.evidence.loop
        is_lasso = loop is not None and loop < a.evidence.steps
        trace = Trace(0, a.evidence.trace, a.evidence.steps)
        found["run"] = {
            **player.trace(trace),
            "heading": properties_text.heading(a),
            "loop": loop + 1 if is_lasso and loop is not None else None,
        }
    return found


def _controller_runs(player: _Player, control: Control) -> Iterator[dict[str, Any]]:
    for check, run, heading in control_text.runs(control):
        assert run.file is not None
        shown = {
            **player.trace(Trace(0, run.file, run.steps)),
            "heading": heading,
            "loop": None if run.loop is None else run.loop + 1,
        }
        yield {"name": TITLES[check.name], "run": shown}


def _verdicts(net: FlatNet, found: Exploration, counts: Counts) -> list[dict[str, str]]:
    said = []
    if found.complete:
        said.append(
            {
                "kind": "good",
                "text": f"Complete: every marking that can be reached was seen, {found.nodes:,} in all.",
            }
        )
    else:
        text = f"Partial: {header(net, found, counts)}"
        said.append({"kind": "open", "text": text})
    if found.swarm is not None:
        said.append({"kind": "open", "text": f"Swarm: {swarm_text.seen(found.swarm)}."})
    elif found.approximation is not None:
        kind, omitted = found.approximation["kind"], found.approximation["omission_probability"]
        text = f"Approximate ({kind}): the probability that a marking was omitted is about {omitted:.2g}."
        said.append({"kind": "open", "text": text})
    if found.sweep is not None:
        said.append({"kind": "good", "text": f"Swept: {sweep_text.known(found)}."})
    if found.reductions:
        said.append({"kind": "open", "text": f"Reduced by {', '.join(found.reductions)}."})
    if found.is_reduced:
        text = "Dead markings are preserved; anything that is not stated here is not known for the whole space."
        said.append({"kind": "open", "text": text})
    if found.symmetries:
        text = f"A node stands for all markings that are symmetric to it ({', '.join(found.symmetries)})."
        said.append({"kind": "open", "text": text})
    if found.error is not None:
        text = f"In a marking that can be reached {error_text(net, found).replace('`', '')}."
        said.append({"kind": "bad" if is_everywhere(found) else "open", "text": text})
    if may_stop(found):
        said.append({"kind": "open", "text": order_text(net, found).replace("`", "")})
    if apart := closed_net(net, found):
        said.append({"kind": "open", "text": apart.replace("`", "")})
    if found.dead_count:
        number = f"{found.dead_count:,} dead marking{'s' * (found.dead_count > 1)}"
        said.append({"kind": "open", "text": f"{number}: nothing is enabled there."})
    elif found.seen.markings:
        said.append({"kind": "good", "text": "No dead marking: something can always occur."})
    return said


def _statistics(net: FlatNet, found: Exploration) -> list[tuple[str, str]]:
    rows = [("Nodes", f"{found.nodes:,}")]
    if not found.is_reduced:
        rows.append(("Arcs", f"{found.arcs:,}"))
    if found.graph is not None:
        rows.append(("Strongly connected components", f"{found.graph.scc_nodes:,}"))
        rows.append(("Arcs between components", f"{found.graph.scc_arcs:,}"))
    return [
        *rows,
        *((f"{name}: complete?", f"{what}.") for name, what in basis.complete(found)),
        *((name, f"{what}.") for name, what in unfolded_text.rows(net, found)),
        ("Depth", f"{found.depth:,}"),
        ("Exploration", f"{found.seconds:.2f} s, {found.states_per_second:,.0f} markings/s"),
        ("Compilation", f"{found.compile_seconds:.1f} s"),
        ("Threads", f"{found.threads}"),
        (
            "Memory",
            f"{found.bytes_per_state:.1f} bytes a marking, {found.peak_mib:,.0f} MiB at most",
        ),
    ]


def _bounds(net: FlatNet, found: Exploration) -> list[dict[str, Any]]:
    if found.bounds is None:
        return []
    rows = []
    for name, place in bounded_places(net):
        own = found.bounds[place.index]
        rows.append(
            {
                "name": name,
                "lower": own.lower,
                "upper": own.upper,
                "lower_multiset": _multiset(
                    own.lower_written(place.colset), own.lower_multiset, own.lower_colours
                ),
                "upper_multiset": _multiset(
                    own.upper_written(place.colset), own.upper_multiset, own.upper_colours
                ),
            }
        )
    return rows


def _multiset(written: str | None, found: Sequence[tuple[int, Any]] | None, colours: int) -> str:
    text = written or ""
    if found is not None and cut(found, colours) is not None:
        text += f"\n({left_out(len(found), colours)})".replace("`", "")
    return text


def _markings(found: Exploration) -> list[tuple[str, str]]:
    rows = []
    if found.graph is not None:
        every = found.graph.home_count == found.nodes
        rows.append(
            ("Home markings", "all" if every else _listed(found.graph.home_count, found.graph.home))
        )
    dead = _listed(found.dead_count, found.dead)
    if not found.dead_count and not found.seen.markings:
        dead = "none was seen" if found.told else "not known"
    rows.append(("Dead markings", dead))
    return rows


def _listed(count: int, first: tuple[int, ...]) -> str:
    if count == 0:
        return "none"
    some = ", ".join(map(str, first[:12]))
    more = ", ..." if count > len(first[:12]) else ""
    return f"{count:,}" + (f" (nodes {some}{more})" if some else "")


def _transitions(net: FlatNet, found: Exploration) -> list[dict[str, Any]]:
    names = EngineNames(net)
    live = set(found.live_transitions())
    fairness = found.graph.fairness if found.graph else None
    rows = []
    for index, arcs in enumerate(found.fired):
        is_dead = arcs == 0 and found.knows_dead_transitions
        kind = (
            ("dead" if found.seen.markings else "not seen")
            if is_dead
            else "live"
            if index in live
            else ""
        )
        rows.append(
            {
                "name": names.transition(index),
                "arcs": "" if found.is_reduced or not found.told else f"{arcs:,}",
                "kind": kind,
                "fairness": fairness[index]
                if fairness
                else "no infinite sequence"
                if found.graph
                else "",
            }
        )
    return sorted(rows, key=lambda row: str(row["name"]))


def _traces(player: _Player, found: Exploration) -> Iterator[dict[str, Any]]:
    for trace in found.traces:
        yield {**player.trace(trace), "goal": trace.dead, "then": ""}
    if found.error_trace is not None:
        goal = found.error_trace.raising
        then = f"Then {error_text(player.net, found).replace('`', '')}."
        yield {**player.trace(found.error_trace), "goal": goal, "then": then}
