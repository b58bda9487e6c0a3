"""The checks of a cell's channel model: which net is explored for which question, and what the answer means.

for answer in check_channel_model(partition, storage, Limits(), d): ...
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Partition
from pn2code.channel_model import by_cell, by_turns
from pn2code.channel_model.compose import compose
from pn2code.channel_model.faults import SAYS, Fault
from pn2code.channel_model.places import ChannelModel, Crashes
from pn2code.channel_model.rules import Rules
from pn2code.channel_model.run_text import RunText
from pn2code.channel_model.skeleton import Skeleton, Topology, topology
from pn2code.diagnostics import Diagnostics
from pn2code.lowering.nets.packing import choose
from pn2code.verify.answers import basis
from pn2code.verify.answers.properties import Verdict
from pn2code.verify.answers.reasons import clause
from pn2code.verify.controller import messages
from pn2code.verify.controller.premises import COUNTED, IN_TURNS
from pn2code.verify.controller.rival_transitions import hasty
from pn2code.verify.controller.running import chunks
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Approximation, Limits, Reduction
from pn2code.verify.exploring.programs import Sizes
from pn2code.verify.exploring.result import Exploration

MOST_STATES = 2_000_000
"""Of one exploration, if the user sets no limit."""
MOST_IN_TURNS = 4_000_000
"""The same where the sides are looked at in turns."""
MOST_TRACES = 16
FILES_FROM = 300_000
"""Of a cell with its medium: then it is asked what the cell as it runs says of its files (`by_cell`)."""
LARGE = 20_000
"""States of the cell as it runs: with its medium it has four to twelve times as many, so it is asked at once."""
QUICK_STATES = 2_000
"""Of a cell: beyond that it pays to have the compiler work longer."""
MOST_ALIKE = 6
"""Names of others for which an exchange stands."""
WHOLE = "the cell with its medium"
CRASHES = Crashes(supervisor=1, robots=1)
"""Of each side, in the exchange."""


@frozen
class Evidence:
    """A run that shows a fault, or a deadlock (None): its lines in words, and how many steps it has in the net."""

    fault: Fault | None
    steps: int
    lines: tuple[str, ...]


@frozen
class Answer:
    """The answer to one question.

    Args:
        check: "medium of the cell", "exchange with robot1".
        says: the question in words.
        answer: yes (it holds), no, inconclusive.
        why: why it is inconclusive, or what fails that `evidence` does not show; "" else.
        nodes, arcs, seconds: of the exploration; `places`, `transitions`: of its net.
        assumes: what the answer rests on.
        reduced: whether `nodes` and `arcs` are those of the reduced space of `by_turns`, or of one of the cell without
            its medium (`by_cell`).
        swarm: what a swarm of searches has seen (`Exploration.swarm`); None: there was none.
    """

    check: str
    says: str
    answer: Verdict
    why: str
    nodes: int
    arcs: int
    places: int
    transitions: int
    seconds: float
    assumes: str
    evidence: tuple[Evidence, ...]
    reduced: bool = False
    swarm: Mapping[str, Any] | None = None

    @property
    def rests_on(self) -> str | None:
        """What has to be seen for this answer: a word of `basis`; None: there is no answer."""
        return {"yes": basis.ARCS, "no": basis.RUN}.get(self.answer)

    def row(self) -> dict[str, Any]:
        """For programs."""
        return {
            "check": self.check,
            "says": self.says,
            "answer": self.answer,
            "why": self.why or None,
            "nodes": self.nodes,
            "arcs": self.arcs,
            "places": self.places,
            "transitions": self.transitions,
            "reduced": self.reduced,
            "swarm": None if self.swarm is None else dict(self.swarm),
            "seconds": round(self.seconds, 3),
            "assumes": self.assumes,
            "rests_on": self.rests_on,
            "evidence": [
                {
                    "fault": None if e.fault is None else e.fault.name.lower(),
                    "says": "a deadlock" if e.fault is None else SAYS[e.fault],
                    "steps": e.steps,
                    "run": list(e.lines),
                }
                for e in self.evidence
            ],
        }


@frozen
class Run:
    """How to explore: limits, who gets errors, what else is wished."""

    limits: Limits
    d: Diagnostics
    options: ExploreOptions = ExploreOptions(quick=True)


WHOLE_PART = 0.6
"""Of the time, what the cell with its medium may take."""


def check_channel_model(
    partition: Partition,
    storage: Mapping[str, str],
    limits: Limits,
    d: Diagnostics,
    *,
    rules: Rules | None = None,
    crashes: Crashes = CRASHES,
    cell_states: int | None = 0,
    most: int | None = None,
    options: ExploreOptions | None = None,
    shown: by_cell.Shown | None = None,
    running_states: int = 0,
) -> Iterator[Answer]:
    """All checks of a cell; none if it has no channels.

    Args:
        partition: the cell.
        storage: as for `Game`.
        limits: of each exploration.
        d: gets the errors.
        rules: of the protocol; None: as it is implemented.
        crashes: in the exchanges.
        cell_states: of the cell's own net; None: too many to explore it with its medium.
        most: of them with its medium that are looked at; None: as many as the limits permit.
        options: who is told of the progress, and who may interrupt; None: nobody.
        shown: what the checks of the supervisor have shown of the files already; None: nothing.
        running_states: of the cell as it runs, as many as have been seen.
    """
    rules = rules or Rules()
    run = Run(limits, d, replace(options or ExploreOptions(), quick=True))
    if not partition.channels:
        return
    if cell_states is not None:
        fitting = replace(run.options, quick=cell_states <= QUICK_STATES)
        ends = [n for n in (limits.max_states, most) if n is not None]
        part = limits.deadline.share(WHOLE_PART)  # the exchanges are small
        own_limits = replace(limits, max_states=min(ends, default=None), deadline=part)
        own_run = replace(run, limits=own_limits, options=fitting)
        yield whole(partition, storage, own_run, rules, shown, running_states)
    else:
        yield too_large()
    alike: dict[Topology, list[int]] = {}
    for owner in partition.owners[1:]:
        alike.setdefault(topology(partition, owner.index), []).append(owner.index)
    if limits.swarm is not None:
        # An exchange is small: it is explored as a whole, and what limits a search is no limit of it.
        alone = replace(limits, swarm=None, max_states=None, memory=None)
        run = replace(run, limits=alone)
    for kind, owners in alike.items():
        if kind != Topology(0, 0, 0, 0):
            yield exchange(partition, owners[0], run, rules, crashes, owners[1:])


def whole(
    partition: Partition,
    storage: Mapping[str, str],
    run: Run,
    rules: Rules,
    shown: by_cell.Shown | None = None,
    running_states: int = 0,
) -> Answer:
    """The cell's own net with its medium; no side crashes. The last two arguments: as for `check_channel_model`."""
    net = compose(partition, rules, Crashes(life_cycle=False))
    assumes = "no side crashes"
    if net.net.timed:
        assumes += (
            "; messages take no model time, and time does not advance while something can happen"
        )

    def explored(made: ChannelModel, limits: Limits, choices: str) -> Answer:
        return _explored(
            WHOLE,
            _ASKED,
            made,
            storage,
            replace(run, limits=limits),
            assumes,
            judged=bool(partition.final_places),
            choices=choices,
            carried=partition,
        )

    def full(limits: Limits) -> Answer:
        found = explored(net, limits, _choices(partition))
        if found.answer != "yes" or not any(hasty(partition)):
            return found
        made = compose(partition, rules, Crashes(life_cycle=False), hasty=True)
        found = explored(made, limits, _choices(partition, is_hasty=True))
        if found.answer != "no":
            return found
        return replace(found, answer="inconclusive", why=_HASTY, evidence=())

    if run.limits.swarm is not None:
        return explored(net, run.limits, _choices(partition))
    first, most = run.limits.turns_from, run.limits.max_states or MOST_STATES
    if first is None or partition.net.timed or not partition.final_places:
        return full(run.limits)
    if shown is not None and not by_cell.why_not(partition, rules):
        return _by_cell(shown, assumes, 0.0)
    is_too_large = running_states > min(LARGE, most)
    if not by_cell.why_not(partition, rules) and (is_too_large or min(first, most) > FILES_FROM):
        if not is_too_large:
            part = full(replace(run.limits, max_states=FILES_FROM))
            if part.answer != "inconclusive" or part.why != _incomplete("states"):
                return part
        began = time.perf_counter()
        limit = max(run.limits.max_states or MOST_IN_TURNS, running_states)
        limits = replace(run.limits, max_states=limit)
        found = by_cell.shown(partition, rules, storage, limits, run.options)
        if found is not None:
            return _by_cell(found, assumes, time.perf_counter() - began)
    if most <= first:
        return full(run.limits)
    part = full(replace(run.limits, max_states=first))
    if part.answer != "inconclusive" or part.why != _incomplete("states"):
        return part
    return _in_turns(partition, storage, run, rules, assumes) or full(run.limits)


_HASTY = (
    "a script that looks for one of several messages while they come may take a transition although an earlier one is "
    "possible, and that may do harm"
)

_OF_CELL = (
    "files are not looked at one by one: in the cell as it runs no channel holds a second message before the first one "
    "has been taken, so that no file does (docs/reductions.md)"
)


def _by_cell(shown: by_cell.Shown, assumes: str, seconds: float) -> Answer:
    """The "yes" that follows from the cell as it runs."""
    how = [assumes, _OF_CELL, IN_TURNS, *([COUNTED] if shown.is_counted else [])]
    return _reduced(shown, seconds, "; ".join(how))


def _reduced(shown: by_cell.Shown, seconds: float, assumes: str) -> Answer:
    """The "yes" of a space that is not the whole one."""
    return Answer(
        check=WHOLE,
        says=_ASKED,
        answer="yes",
        why="",
        nodes=shown.nodes,
        arcs=shown.arcs,
        places=shown.places,
        transitions=shown.transitions,
        seconds=seconds,
        assumes=assumes,
        evidence=(),
        reduced=True,
    )


_ASKED = (
    "no message is lost, taken twice, torn, refused or overwritten, and the cell can come to its end from every "
    "state"
)


def _in_turns(
    partition: Partition, storage: Mapping[str, str], run: Run, rules: Rules, assumes: str
) -> Answer | None:
    """A "yes" that the reduced space gives; None: it does not."""
    began = time.perf_counter()
    limits = replace(
        run.limits,
        max_states=run.limits.max_states or MOST_IN_TURNS,
        graph=True,
        traces=0,
        approximation=None,
        reductions=(),
    )
    found = by_turns.in_turns(partition, rules, storage, limits, run.options, Diagnostics())
    if found is None or messages.examine(partition, found[1], run.d).answer != "yes":
        return None
    made, seen = found
    shown = by_cell.Shown.of(made.net, seen)
    return _reduced(shown, time.perf_counter() - began, f"{assumes}; {IN_TURNS}")


def _choices(partition: Partition, *, is_hasty: bool = False) -> str:
    """Lines for the explorer: of what is enabled, each program does what comes first in the documented order."""
    lines: list[str] = []
    for owner in range(len(partition.owners)):
        own = (i for i, o in enumerate(partition.transition_owner) if o == owner)
        lines += chunks(f"{'choose' if owner else 'first'} {owner + 1}", own)
    if is_hasty:
        lines += chunks("meek", (t for t, is_shared in hasty(partition) if is_shared))
    return "".join(f"{line}\n" for line in lines)


def too_large() -> Answer:
    """Of a cell that was not explored to the end by itself."""
    why = "the state space of the cell itself was not explored completely"
    return Answer(WHOLE, "", "inconclusive", why, 0, 0, 0, 0, 0.0, "no side crashes", ())


def exchange(
    partition: Partition,
    owner: int,
    run: Run,
    rules: Rules,
    crashes: Crashes = CRASHES,
    alike: Sequence[int] = (),
) -> Answer:
    """The exchange between the supervisor and a side, with crashes of both; `alike`: others, for which it stands."""
    skeleton = Skeleton(partition, owner)
    net = compose(skeleton.partition, rules, crashes, skeleton.extra)
    name = partition.owners[owner].name
    rounds = f"{skeleton.rounds} exchange{'s' * (skeleton.rounds != 1)}"
    assumes = (
        f"commands and answers as far as {name}'s files allow them, {rounds} a session, "
        f"at most {crashes.supervisor} crash{'es' * (crashes.supervisor != 1)} of the supervisor and "
        f"{crashes.robots} of {name}, {crashes.all_sessions} session{'s' * (crashes.all_sessions != 1)}"
    )
    others = [
        c.file
        for c in partition.channels
        if not {owner, *alike}.isdisjoint((c.writer, c.reader)) and 0 not in (c.writer, c.reader)
    ]
    if others:
        assumes += f"; no crash harms messages of {', '.join(others)}, between two robots"
    return _explored(
        f"the exchange with {name}{_and_alike([partition.owners[i].name for i in alike])}",
        "whichever side crashes and is started again, at whatever time: no message is lost without a crash, none is "
        "taken twice or in another session, no flag is taken without its own data, and both sides end or go on in the "
        "new session",
        net,
        {},
        run,
        assumes,
        judged=True,
    )


def _and_alike(names: Sequence[str]) -> str:
    """The others for which an exchange stands, in parentheses."""
    if not names:
        return ""
    shown = [*names[:MOST_ALIKE]]
    if len(names) > MOST_ALIKE:
        shown.append(f"{len(names) - MOST_ALIKE} more")
    listed = " and ".join(filter(None, (", ".join(shown[:-1]), shown[-1])))
    return f" (and with {listed}, whose messages are of the same kinds)"


def _explored(
    check: str,
    says: str,
    net: ChannelModel,
    storage: Mapping[str, str],
    run: Run,
    assumes: str,
    *,
    judged: bool,
    choices: str = "",
    carried: Partition | None = None,
) -> Answer:
    """`carried`: the cell whose messages have to have a form that the codecs can write and read."""
    began = time.perf_counter()
    is_swarm = run.limits.swarm is not None
    mine = replace(
        run.limits,
        max_states=run.limits.max_states or (None if is_swarm else MOST_STATES),
        graph=True,
        traces=MOST_TRACES,
        approximation=Approximation.BITSTATE if is_swarm else None,
        reductions=tuple(r for r in run.limits.reductions if r is Reduction.TIME),
    )
    sizes = Sizes(choose(net.net, [[] for _ in net.net.places], {}))
    of_ends = _question(net) if judged else _TO_THE_END
    if is_swarm:
        of_ends = _NO_DEADLOCK if judged else ""
    with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
        options = replace(
            run.options,
            traces=Path(folder),
            sizes=sizes,
            questions=f"{choices}{of_ends}? bound {net.verdict} 0 0\n",
            evidence=Path(folder),
            ending=(0, 1) if judged else (0,),
        )
        found = explore(net.net, storage, mine, run.d, options)
        runs = () if found is None else tuple(_evidence(net, storage, found, judged))
    answer, why = _verdict(net, found, runs, judged)
    if carried is not None and found is not None and answer == "yes":
        sent = messages.examine(carried, found, run.d)  # the writer's place has kept its index
        if sent.answer == "no":
            several = len(sent.wrong)
            more = f"; {several:,} messages cannot be sent" if several > 1 else ""
            answer, why = "no", sent.says + more
        elif sent.answer == "unknown":
            answer, why = "inconclusive", "the values of its messages are not known"
    return Answer(
        check=check,
        says=says,
        answer=answer,
        why=why,
        nodes=found.nodes if found else 0,
        arcs=found.arcs if found else 0,
        places=len(net.net.places),
        transitions=len(net.net.transitions),
        seconds=time.perf_counter() - began,
        assumes=assumes,
        evidence=runs,
        swarm=found.swarm if found else None,
    )


_NO_DEADLOCK = "dead\nnot 0\n? invariant 1\n"
"""What a swarm is asked, which knows no graph: whether something can happen in each marking."""
_TO_THE_END = "true\n? initially 0\n"
"""A question without which the first fault would answer all of them, and end the exploration."""


def _question(net: ChannelModel) -> str:
    """Whether an end, or a verdict, can be reached from everywhere: AG EF."""
    lines = ["dead", *(f"enabled {t}" for t in net.ends)]
    last = 0
    for i in range(1, len(net.ends) + 1):
        lines.append(f"or {last} {i}")
        last = len(lines) - 1
    lines += [f"ef {last}", f"ag {last + 1}", f"? initially {last + 2}"]
    return "\n".join(lines) + "\n"


def _evidence(
    net: ChannelModel, storage: Mapping[str, str], found: Exploration, judged: bool
) -> Iterator[Evidence]:
    """The shortest run to each fault, and one to a deadlock, or to where no end can be reached from."""
    teller = RunText(net, storage)
    seen: set[Fault | None] = set() if judged else {None}
    of_ends, of_faults = found.answers[:-1], found.answers[-1:]
    kept = [(trace.steps, trace.file) for trace in found.traces]
    # Other dead markings may have had all the room.
    kept += [(a["steps"], Path(a["trace"])) for a in of_faults if a["trace"]]
    if found.swarm is not None:  # of it is asked what is dead
        kept += [(a["steps"], Path(a["trace"])) for a in of_ends if a["trace"]]
    for steps, trace in sorted(kept, key=lambda run: run[0]):
        lines, fault = teller.told(trace)
        if fault not in seen:
            seen.add(fault)
            yield Evidence(fault, steps, lines)
    # Nothing is asked of the ends of a cell without final places: it is made to go on for ever.
    for answer in of_ends:
        if answer["answer"] == "no" and None not in seen and answer["trace"]:
            lines, _ = teller.told(Path(answer["trace"]))
            yield Evidence(
                None, answer["steps"], (*lines[:-1], "and from here no end can be reached")
            )


_STUCK = "an end cannot be reached from every state"


def _incomplete(why: str) -> str:
    return f"the exploration is not complete: {clause(why)}"


def _verdict(
    net: ChannelModel, found: Exploration | None, runs: tuple[Evidence, ...], judged: bool
) -> tuple[Verdict, str]:
    if found is None or found.error is not None:
        return "inconclusive", "it could not be explored"
    if runs:
        return "no", ""
    if found.swarm is not None:  # without a run it is not believed
        return "inconclusive", _incomplete(found.why)
    if found.fired[net.ending]:
        return "no", "there is a fault of the exchange, but no run to it was kept"
    if judged and found.dead_count:
        return "no", _STUCK
    if not found.complete:
        return "inconclusive", _incomplete(found.why)
    if judged and any(a["answer"] != "yes" for a in found.answers[:-1]):
        return "no", _STUCK
    return "yes", ""
