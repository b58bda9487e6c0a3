"""What one look at a cell as it runs is about, the same for all explorations that it takes."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.verify.controller.control_questions import asked_of_orders, of_cell, of_orders
from pn2code.verify.controller.control_types import MOST_WRITTEN, Plan
from pn2code.verify.controller.poses import Bad, Poses
from pn2code.verify.controller.running import Running
from pn2code.verify.exploring import nondeterminism
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits, Reduction
from pn2code.verify.exploring.programs import Generated, Sizes
from pn2code.verify.exploring.result import Exploration

CELL_PART = 0.8
"""Of the time, what the exploration may take that most answers come from."""


@dataclass(frozen=True, eq=False)
class Setting:
    """What is explored, how, and what is asked.

    Args:
        partition, plan, d: as for `control.examine`.
        limits: of an exploration that may take all of the time.
        part: the same of one after which there is time left to see how the cell comes to what is wrong.
        running: the net of the cell as it runs.
        poses: what arms are told; None: nothing is known of arms.
        options: of an exploration of that net, with all questions about the cell.
        at_once: the questions about orders among these; empty: they are asked apart.
        closed: the state space of the closed net, if it is known.
        folder: for what need not be kept.
        made: what was generated for that net.
    """

    partition: Partition
    plan: Plan
    limits: Limits
    part: Limits
    running: Running
    poses: Poses | None
    options: ExploreOptions
    at_once: str
    closed: Exploration | None
    folder: Path
    made: Generated
    d: Diagnostics

    @property
    def unkept(self) -> ExploreOptions:
        """The options of an exploration whose evidence is not what the user is shown of properties."""
        return replace(self.options, evidence=self.folder)

    def whole(self, limits: Limits, options: ExploreOptions) -> Exploration | None:
        """Explores all states of the cell, and writes their graph, if it is wanted."""
        graph = self.plan.graph
        own = replace(options, graph=graph, graph_limit=None if graph is None else MOST_WRITTEN)
        return explore(self.running.net, self.plan.storage, limits, self.d, own)

    def orders_of(self, limits: Limits) -> Exploration | None:
        """Explores all orders in which the supervisor may take its binding elements."""
        questions = of_orders(self.running, self.plan.firings)
        own = replace(self.unkept, questions=questions, stem="orders")
        return explore(self.running.net, self.plan.storage, limits, self.d, own)

    def with_moves(self, moves: Sequence[Bad], *, first: bool = True) -> Exploration | None:
        """Explores the net in which these moves are seen: the cell, or if not `first` all orders."""
        other = Running.of(self.partition, (), moves)
        lines = other.lines(first=True)
        own = replace(
            self.unkept,
            sizes=self.made.sizes or self.options.sizes,  # its places are those of the cell
            generated=Generated(),
            questions="".join(f"{x}\n" for x in lines)
            if first
            else of_orders(other, self.plan.firings),
            predicates=(),
            stem="reach" if first else "orders",
            quick=True,
        )
        return explore(other.net, self.plan.storage, self.limits, self.d, own)


@contextmanager
def set_up(
    partition: Partition,
    plan: Plan,
    limits: Limits,
    d: Diagnostics,
    closed: Exploration | None,
    running: Running,
    poses: Poses | None,
) -> Iterator[Setting]:
    """The setting; its folder is there as long as it is used."""
    limits = replace(
        limits,
        approximation=None,
        graph=True,
        reductions=(Reduction.TIME,) if partition.net.timed else (),
    )
    made = Generated()
    # To look for a choice in a state that draws random numbers would draw others.
    is_asked_at_once = not nondeterminism.draws(running.net)
    at_once = f"orders\n{asked_of_orders(plan.firings)}" if is_asked_at_once else ""
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        options = replace(
            plan.options,
            sizes=Sizes.start(running.net, plan.storage),
            generated=made,
            traces=Path(name),
            bindings=tuple(t.index for t in poses.moving) if poses else (),
            whole=(*(c.place for c in partition.channels), *(poses.places if poses else ())),
            graph=None,
            questions=of_cell(running, plan) + at_once,
            predicates=plan.properties.predicates,
            evidence=plan.evidence or Path(name),
            stem="cell",
        )
        part = replace(limits, deadline=limits.deadline.share(CELL_PART))
        yield Setting(
            partition,
            plan,
            limits,
            part,
            running,
            poses,
            options,
            at_once,
            closed,
            Path(name),
            made,
            d,
        )
