"""From a question to all answers: the steps of `pn2code verify` between reading a net and printing what is known."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

from pn2code.base.deadline import NEVER, Deadline, TimeIsOverError
from pn2code.base.frozen import frozen
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics, Note, Origin
from pn2code.division import divided
from pn2code.net import guard_order
from pn2code.net.flat import FlatNet
from pn2code.robot_scripts.translate import lower_robots
from pn2code.semantics.game.errors import about_files
from pn2code.verdict import channel_model, closed, controller, other_orders, properties
from pn2code.verdict.asked import Asked, gather
from pn2code.verdict.opened import OpenNet
from pn2code.verdict.unfolded import askable
from pn2code.verify.answers import outcome
from pn2code.verify.answers.culprit import culprit
from pn2code.verify.answers.outcome import Counts
from pn2code.verify.answers.properties import Answer, Verdict, kind
from pn2code.verify.answers.reasons import clause, raises
from pn2code.verify.codes import REPORT_UNWRITABLE, STATE_ERROR, TRACE_UNWRITABLE
from pn2code.verify.controller import long_timers, short_timers
from pn2code.verify.controller.control_types import Control
from pn2code.verify.exploring import nondeterminism
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import REACHED, Limits
from pn2code.verify.exploring.programs import Sizes
from pn2code.verify.exploring.result import Exploration, OtherOrders
from pn2code.verify.exploring.result_rows import row as exploration_row
from pn2code.verify.report.never_text import never

MOST_COLOURS = 200
"""Of a multi-set bound, unless all is wanted: a place with a colour for each marking has millions."""

_KINDS = {"yes": "good", "no": "bad"}


NET_PART = 0.4
"""Of the time for a cell, what the closed net may take of it; it is the cell as it runs that counts."""
CELL_PART = 0.7
"""Of the rest, what the cell as it runs may take; then come the shared files."""


@dataclass(frozen=True, slots=True)
class Checks:
    """What is looked at besides the state space of the net, where it is the net of a cell.

    Args:
        controller: the supervisor against its execution scheme (docs/execution.md).
        channel_model: the cell together with its shared files (docs/protocol.md).
        graph: where the graph of the cell as it runs is written, for whoever goes through it; None: nowhere.
    """

    controller: bool = True
    channel_model: bool = True
    graph: Path | None = None


class Durations(Protocol):
    """How long commands and cycles take, as it is printed."""

    @property
    def lines(self) -> tuple[str, ...]:
        """For the screen."""

    def row(self) -> dict[str, Any]:
        """For programs."""


class InSpace(Protocol):
    """What is said of the arms in space, as it is printed."""

    @property
    def kinds(self) -> tuple[str, ...]:
        """How each answer came out."""

    @property
    def lines(self) -> tuple[str, ...]:
        """For the screen."""

    @property
    def reasons(self) -> tuple[str, ...]:
        """What is wrong or not known."""

    @property
    def text(self) -> str:
        """All of it."""

    def row(self) -> dict[str, Any]:
        """For programs."""


@frozen
class Looked:
    """What was explored; the runs that properties have led to have no names yet.

    Args:
        found: the state space.
        control: the cell as it runs; None: the net is no cell.
        more: answers to properties about bindings.
        channel_model: the checks of the shared files.
    """

    found: Exploration
    control: Control | None
    more: Sequence[Answer]
    channel_model: channel_model.Answers


@frozen
class Said:
    """All that is known.

    Args:
        net, storage: as for `Game`, which plays the runs again.
        found: the state space.
        answers: to properties.
        control: the checks of a supervisor.
        channel_model: those of the shared files.
        errors: how many errors of the net are said besides.
        deadline: when it is over no run is played any more.
        config: of the cell; None: the net is none.
        durations: what was measured of the commands; None: it was not asked for.
        geometry: what is said of the arms in space; None: it was not asked for.
    """

    net: FlatNet
    storage: Mapping[str, str]
    found: Exploration
    answers: Sequence[Answer]
    control: Control | None
    channel_model: channel_model.Answers
    errors: int = 0
    deadline: Deadline = NEVER
    config: CellConfig | None = None
    durations: Durations | None = None
    geometry: InSpace | None = None

    @property
    def kinds(self) -> list[str]:
        """How each answer came out, "good", "bad" or "open": supervisor, files, properties, arms in space."""
        return [
            *(check.kind for check in (self.control.checks if self.control else ())),
            *(_KINDS.get(a.answer, "open") for a in self.channel_model),
            *map(kind, self.answers),
            *(self.geometry.kinds if self.geometry is not None else ()),
        ]

    @property
    def counts(self) -> Counts:
        """How many came out how."""
        return Counts.of(self.kinds, self.errors, asked=bool(self.answers))

    @property
    def verdict(self) -> Verdict:
        """The worst answer: where no property is asked, whether all markings were seen counts as well."""
        return outcome.verdict(self.found, self.counts)

    @property
    def notes(self) -> tuple[str, ...]:
        """What is no failure, and to be said: of the closed net in CPN Tools; beside a yes what never occurs."""
        apart = outcome.closed_net(self.net, self.found)
        found = never(self.net, self.found, self.control) if self.verdict == "yes" else None
        seldom = (found.sentence,) if found is not None and found.transitions else ()
        return (*seldom, *((apart,) if apart else ()))

    def row(self) -> dict[str, Any]:
        """As plain data: what `pn2code verify --json` prints (docs/verify.md)."""
        row = exploration_row(self.net, self.found)
        row["guard_order"] = guard_order.rows(self.net)
        if self.answers:
            row["properties"] = [a.row() for a in self.answers]
        if self.control is not None:
            row["controller"] = [c.row() for c in self.control.checks]
            row["cell"] = self.control.row()
        if self.channel_model:
            row["medium"] = [a.row() for a in self.channel_model]
        row["notes"] = list(self.notes)
        if self.durations is not None:
            row["durations"] = self.durations.row()
        if self.geometry is not None:
            row["geometry"] = self.geometry.row()
        return row


def question(
    opened: OpenNet, texts: Sequence[str], file: Path | None, d: Diagnostics, *, found: bool
) -> Asked:
    """What is asked about a net or cell; what is wrong with it, or with the cell, is reported.

    Args:
        opened: the net.
        texts: properties as text.
        file: a file of properties; None: the one beside the net, if there is one.
        d: gets the errors and warnings.
        found: whether those of the file beside the net and of the cell count.
    """
    partition = divided(opened.flat, opened.config, d)
    if partition is not None and opened.config is not None:
        # What is said of a cell is said of its programs: without them there is nothing to say.
        programs = lower_robots(partition, opened.config, d)
        if programs is not None:
            short_timers.warn(partition, opened.config, d)
            long_timers.warn(partition, opened.config, d)
    asked = gather(opened, texts, file, d, found=found)
    nondeterminism.warn(opened.flat, d)
    return asked if opened.config is None else replace(asked, partition=partition)


def look(
    opened: OpenNet,
    asked: Asked,
    limits: Limits,
    options: ExploreOptions,
    folder: Path,
    d: Diagnostics,
    checks: Checks = Checks(),
    own_options: ExploreOptions | None = None,
) -> Looked | None:
    """Explores everything that the answers need; None after an error that was reported.

    Args:
        opened: the net.
        asked: what is asked of it.
        limits: of each exploration.
        options: of all explorations.
        folder: where traces go.
        d: gets the errors.
        checks: what is looked at in a cell.
        own_options: those of the exploration of the net itself, where it has more.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
        ValueError: a cell without its partition; what is found of the net alone must not be said of it.
    """
    cell = asked.partition
    if cell is None and opened.config is not None:
        raise ValueError("what is said of a cell needs who runs what in it")
    options = replace(options, initial=opened.initial)
    own_options = None if own_options is None else replace(own_options, initial=opened.initial)
    # What the places hold is worked out once for all explorations of the net.
    with suppress(TimeIsOverError), limits.deadline.enforced():
        sizes = Sizes.start(opened.flat, opened.storage)
        options = replace(options, sizes=sizes)
        own_options = replace(own_options, sizes=sizes) if own_options is not None else None
    asks_control = bool(checks.controller or asked)
    is_cell = cell is not None and (asks_control or checks.channel_model)
    part = replace(limits, deadline=limits.deadline.share(NET_PART)) if is_cell else limits
    may_unfold = opened.config is None and limits.unfolds and limits.approximation is None
    why_not = _why_not_unfolded(opened, limits) if may_unfold else None
    if why_not == "":
        part = replace(limits, deadline=limits.deadline.share(askable.EXPLORING))
    of_net = own_options or options
    if cell is not None and is_cell and of_net.covering and of_net.sizes is not None:
        of_net = replace(of_net, heaps=_open_channels(cell, of_net.sizes))
    if cell is not None:
        of_net = replace(of_net, ending=asked.endings_of_net(of_net.ending))
    may_count = is_cell and properties.are_of_states(asked)
    found = closed.explored(opened, part, of_net, d, may_count=may_count, partition=cell)
    if found is None:
        return None
    if may_unfold and found.why in REACHED:
        from pn2code.verdict.unfolded import look as unfolded  # its methods take time to load

        found = unfolded.look(opened, asked, found, limits, own_options or options, why_not)
    # The closed net of a cell has its answers before the cell takes all the time.
    soon = other_orders.look(opened, found, part, options) if is_cell else found
    if cell is not None:
        # What is asked of its programs needs the graph: markings are forgotten where there is no memory for it only.
        limits = replace(limits, sweeps=False if limits.sweeps is False else None)
        options = replace(options, needs_graph=True)
    control: Control | None = None
    if cell is not None and asks_control:
        options.stage("exploring the cell as its programs run ...")
        has_more = checks.channel_model
        part = replace(limits, deadline=limits.deadline.share(CELL_PART)) if has_more else limits
        control = controller.look(
            opened,
            cell,
            found,
            part,
            options,
            folder,
            d,
            asked.plain,
            checks.graph,
            checks=checks.controller,
        )
    more = properties.of_bindings(asked, opened, found, limits, options, d, control)
    seen: channel_model.Answers = ()
    if cell is not None and checks.channel_model:
        options.stage("exploring the cell together with its shared files ...")
        looked = control if checks.controller else None
        seen = channel_model.look(opened, cell, found, limits, options, d, looked)
    if not is_cell or (soon.orders is not None and soon.orders.why == "seconds"):
        soon = other_orders.look(opened, found, limits, options)
    return Looked(soon, control, more, seen)


def _why_not_unfolded(opened: OpenNet, limits: Limits) -> str | None:
    """Why the unfolded net cannot be asked where a limit of time ends the exploration, a part of which is kept for it.

    "": it can; None: there is no such limit, or no time to find out.
    """
    with suppress(TimeIsOverError), limits.deadline.enforced():
        return None if limits.deadline.left is None else askable.why_not(opened.flat)
    return None


def _open_channels(cell: Partition, sizes: Sizes) -> frozenset[int]:
    """The channels in which the structure of the net bounds no messages: a file holds one."""
    return frozenset(c.place for c in cell.channels) - set(sizes.bounds or ())


def conclude(
    looked: Looked,
    opened: OpenNet,
    asked: Asked,
    limits: Limits,
    folder: Path,
    d: Diagnostics,
    checks: Checks = Checks(),
) -> Said:
    """All answers; runs have got readable names in `folder`, and have been looked at again."""
    found, control = looked.found, looked.control
    answers = properties.answered(
        asked, opened, found, looked.more, folder, stem(opened), limits.deadline, d, control
    )
    if found.orders is not None and found.orders.why:
        answers = tuple(_in_other_orders(a, found.orders) for a in answers)
    other_orders.tell(opened, found, d)
    if outcome.has_raised(found):
        _tell_error(opened, found, d)
    if found.graph is not None and len(found.traces) < min(limits.traces, found.dead_count):
        _unwritable("a dead marking", found, folder, d)
    if found.error and found.error.get("node") and limits.traces and found.error_trace is None:
        _unwritable("the marking in which an exception is raised", found, folder, d)
    return Said(
        opened.flat,
        opened.storage,
        found,
        answers,
        control if checks.controller else None,  # else it was looked at for properties only
        looked.channel_model,
        sum(e.code != REPORT_UNWRITABLE for e in d.errors),
        limits.deadline,
        opened.config,
    )


def _in_other_orders(a: Answer, orders: OtherOrders) -> Answer:
    """An answer where CPN Tools may stop: a run that shows something may be longer than what it does."""
    if not a.cell:
        is_open = kind(a) == "good" or orders.more
        why = clause("order")
        return replace(a, answer="inconclusive", why=why, evidence=None) if is_open else a
    of_net = None if a.net is None else replace(a, answer=a.net)
    is_open = of_net is not None and (kind(of_net) == "good" or orders.more)
    return (
        replace(a, net="inconclusive", net_why=clause("order"), net_evidence=None) if is_open else a
    )


@contextmanager
def trace_folder(folder: Path, *, wanted: bool, needed: bool) -> Iterator[Path]:
    """Makes the folder of the traces; an empty one that was made here is not left.

    Args:
        folder: where traces go.
        wanted: whether there may be any; if not, no folder is made.
        needed: whether it is an error that it cannot be made. Else what cannot be written into it will be said.

    Raises:
        OSError: it cannot be made, and is needed.
    """
    is_new = wanted and not folder.exists()
    if wanted:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError:
            if needed:
                raise
            is_new = False
    try:
        yield folder
    finally:
        if is_new:
            with suppress(OSError):  # there are traces in it
                folder.rmdir()


def stem(opened: OpenNet) -> str:
    """What the names of trace files begin with."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", opened.flat.name) or "net"


def _tell_error(opened: OpenNet, found: Exploration, d: Diagnostics) -> None:
    error, trace = found.error, found.error_trace
    assert error is not None
    index = error.get("transition")
    t = None if index is None else opened.flat.transitions[index]
    where = f"transition `{t.name}`" if t is not None else error["where"]
    says, origin = f"{where} {raises(error['message'])}", t.origin if t is not None else None
    notes: list[str | Note] = [error["where"]] if error["where"] and t is None else []
    exact = None
    if t is not None and trace is not None:
        exact = culprit(opened.flat, opened.storage, trace.file, t.index, error.get("binding"))
    if exact is not None:
        says, origin = exact.message, exact.origin
        notes += exact.notes()
    if error.get("binding"):
        values = ", ".join(f"{name} = {value}" for name, value in error["binding"].items())
        notes.append(f"the occurrence with {values}")
    elif t is not None and not outcome.is_everywhere(found):
        notes.append(
            guard_order.not_there(opened.flat, t.index)
            or "CPN Tools may see first that tokens are missing, or that another condition is false, and raise nothing"
        )
    if error.get("node") is None and found.swarm is None and found.sweep is None:
        notes.append("the run to it is not known: that needs memory, and stored markings")
    if trace is not None:
        notes.append(f"{trace.steps} steps lead to that marking: {trace.file}")
    report = d.error if outcome.is_everywhere(found) else d.warning
    report(
        STATE_ERROR,
        f"{says} in a reachable marking",
        origin or Origin(opened.flat.file),
        notes=notes,
        hint=about_files(says)
        or "`pn2code simulate` can reach it, too; guard the inscription, or handle the exception",
    )


def _unwritable(goal: str, found: Exploration, folder: Path, d: Diagnostics) -> None:
    d.warning(
        TRACE_UNWRITABLE,
        f"a trace to {goal} cannot be written into `{folder}`",
        Origin(str(folder)),
        hint=f"{properties.how_to_have_runs(found)}, or write none with `--most-traces 0`",
    )
