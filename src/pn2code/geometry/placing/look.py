"""`pn2code place`: the search for a placing of a cell's arms, and the proof of what it finds.

found = look(opened, Request(("robot2.base.x,y",)), limits, folder, d)
found.chosen                # Tried(candidate, proof); None: none was found, or none holds
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from pn2code.base.deadline import NEVER, CommandIsOverError, Deadline, TimeIsOverError
from pn2code.base.frozen import frozen
from pn2code.cell.config import CellConfig
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.activities import Doing
from pn2code.geometry.check import cell_of, cells_of, is_there
from pn2code.geometry.graph import CellGraph
from pn2code.geometry.legs import Planner
from pn2code.geometry.look_options import Options
from pn2code.geometry.placing.free import Free, moved, parse
from pn2code.geometry.placing.judging import Judge
from pn2code.geometry.placing.plan import Plan, parts_of
from pn2code.geometry.placing.proving import Proof, prove
from pn2code.geometry.placing.search import Candidate, Found, Search, Wish, unlike
from pn2code.geometry.reach_look import told
from pn2code.geometry.reach_map import Task
from pn2code.geometry.situations import Situations
from pn2code.geometry.words import numbers, reason, words
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import pose_of
from pn2code.verdict.opened import OpenNet
from pn2code.verdict.programs import partition_of
from pn2code.verify.exploring.limits import Limits

_UNLIKE = 100.0
"""Placings that are looked at as a whole differ by so many of the units in which they are written: 0.1 m, 10 deg."""
_ROUNDS = 3
"""What an arm has to do may depend on where it stands: so often the search begins again with what it then has to do."""
_SEARCHING = 0.6
"""Of the time that is left: for the search, before the proof."""


@frozen
class Request:
    """What is asked.

    Args:
        free: as `free.parse` reads it.
        layout: where arms stand at first; None: the first.
        around: m, the bounds of lengths that have none.
        wish: of the placing.
        seed, generations: of the search.
        tries: so many placings are looked at as a whole, until one holds.
    """

    free: tuple[str, ...]
    layout: str | None = None
    around: float = 1.0
    wish: Wish = Wish()
    seed: int = 1
    generations: int = 50
    tries: int = 6


@frozen(eq=False)
class Tried:
    """A placing that was looked at as a whole."""

    candidate: Candidate
    cell: RobotCell
    proof: Proof


@frozen
class Missed:
    """What is not reached from the placing that reaches most.

    Args:
        command: in words; pose: of the TCP in the world, in words.
        anywhere: whether some other placing that was looked at reaches it.
    """

    robot: str
    command: str
    pose: str
    anywhere: bool


@frozen(eq=False)
class Placed:
    """What is known.

    Args:
        config: the cell; cell: as it stands; free: what was chosen.
        found: by the search; tried: as a whole, in this order.
        missed: what cannot be reached, if nothing was found.
        open: why the arms may have more to do; "": they have not.
        unfinished: what there was no time for; "": nothing.
        regardless: what cannot be done wherever the arms stand that may be moved; "": nothing is known of that kind.
    """

    config: CellConfig
    layout: str
    cell: RobotCell
    free: tuple[Free, ...]
    found: Found
    tried: tuple[Tried, ...]
    missed: tuple[Missed, ...]
    open: str = ""
    unfinished: str = ""
    regardless: str = ""

    @property
    def chosen(self) -> Tried | None:
        """The one that holds."""
        return next((t for t in self.tried if t.proof.meets), None)


def look(
    opened: OpenNet,
    request: Request,
    limits: Limits,
    folder: Path,
    d: Diagnostics,
    stage: Callable[[str], None] = lambda _text: None,
) -> Placed | None:
    """Searches and proves; None after an error that was reported.

    Raises:
        FreeError: `request.free` names nothing of the cell.
        CommandIsOverError: the time of `limits` was over before anything was searched.
    """
    config = cell_of(opened, d)
    if config is None or not is_there(config, d):
        return None
    cells = cells_of(config, request.layout or config.layout or None, d)
    partition = partition_of(opened, config, d)
    if cells is None or partition is None:
        return None
    ((name, cell),) = cells
    free = parse(request.free, cell, request.around)
    deadline = limits.deadline
    with deadline.enforced(CommandIsOverError):
        graph = told(opened, config, partition, replace(limits, deadline=NEVER), d, stage)
    if graph is None:
        return None
    options = Options(folder, "place", opened.initial, None, stage)
    placing = _Placing(graph, cell, free, request, options, deadline)
    found, tried, missed = placing.run()
    return Placed(
        config, name, cell, free, found, tuple(tried), missed, placing.open, placing.unfinished,
        placing.regardless,
    )  # fmt: skip


class _Placing:
    """Rounds of searching and proving."""

    def __init__(
        self,
        graph: CellGraph,
        cell: RobotCell,
        free: tuple[Free, ...],
        request: Request,
        options: Options,
        deadline: Deadline = NEVER,
    ) -> None:
        self.graph, self.cell, self.free = graph, cell, free
        self.deadline, self.unfinished = deadline, ""
        self.request, self.options = request, options
        self.robots = tuple(dict.fromkeys(f.robot for f in free))
        self.open = self.regardless = ""

    def run(self) -> tuple[Found, list[Tried], tuple[Missed, ...]]:
        """The last round's answer."""
        with self.deadline.enforced(CommandIsOverError):
            tasks, plans, _ = self._tasks(self.cell)
        for round_ in range(_ROUNDS):
            judge = Judge(self.cell, tasks, plans, self.free)
            if self.regardless:
                try:
                    return self._searching(judge).none(), [], ()
                finally:
                    judge.close()
            try:
                found = self._search(judge)
                missed = () if found.ranked else self._missed(judge, found)
            finally:
                judge.close()
            tried = self._prove(found)
            is_proved = any(t.proof.meets for t in tried)
            if is_proved or self.unfinished or round_ == _ROUNDS - 1:
                break
            best = found.ranked[0] if found.ranked else found.nearest
            try:
                with self.deadline.enforced():
                    more = self._tasks(moved(self.cell, self.free, best.values))
            except TimeIsOverError:
                self.unfinished = "whether the arms have more to do from there was not looked at"
                break
            there, its_plans, is_whole = more
            # From there an arm may be told more than from where it stands, where it perhaps got stuck.
            new = there if is_whole else {r: _both(tasks[r], there[r]) for r in tasks}
            if all(_covers(tasks[r], new[r]) for r in tasks):
                break
            tasks = new
            plans = its_plans if is_whole else {r: plans[r].with_more(its_plans[r]) for r in plans}
        return found, tried, missed

    def _tasks(self, cell: RobotCell) -> tuple[dict[str, Task], dict[str, Plan], bool]:
        """What the arms have to reach and to do, and whether they get everywhere, so that this is all of it."""
        self.options.stage("looking where arms can be ...")
        moving = tuple(r.name for r in cell.moving)
        situations = Situations(self.graph, Doing(Planner(cell), cell), moving)
        situations.explore()
        self.open = reason(situations.why)
        legs = situations.doing.planner.legs
        if not self.regardless:
            self.regardless = self._regardless(situations)
        tasks = {r: Task.of(situations, cell.robot(r)) for r in self.robots}
        plans = {r: Plan.of(legs, r, parts_of(situations, r)) for r in self.robots}
        return tasks, plans, all(leg.fault is None for leg in legs)

    def _regardless(self, found: Situations) -> str:
        """A move of an arm that is not placed anew and that it can do from nowhere; "": there is none.

        Where it goes is its own affair. With no parts, and no sensors that see, an arm comes to such a move in each
        placing in which those that are placed can do all of theirs.
        """
        if self.cell.kinds or found.sees:
            return ""
        for leg in found.doing.planner.legs:
            if leg.fault is not None and leg.robot not in self.robots:
                return f"{leg.robot}, {words(leg.command)}: {leg.fault.message}"
        return ""

    def _searching(self, judge: Judge) -> Search:
        r = self.request
        return Search(
            judge,
            r.wish,
            seed=r.seed,
            generations=r.generations,
            stage=self.options.stage,
            deadline=self.deadline.share(_SEARCHING),
        )

    def _search(self, judge: Judge) -> Found:
        search = self._searching(judge)
        found = search.run()
        if search.is_unfinished:
            self.unfinished = "the search was broken off"
        return found

    def _prove(self, found: Found) -> list[Tried]:
        tried: list[Tried] = []
        for candidate in unlike(found.ranked[:5000], self.free, _UNLIKE)[: self.request.tries]:
            cell = moved(self.cell, self.free, candidate.values)
            try:
                with self.deadline.enforced():
                    proof = prove(self.graph, cell, self.options, self.request.wish, self.robots)
            except TimeIsOverError:
                proof = Proof("unknown", "the time was up before it was looked at as a whole")
                tried.append(Tried(candidate, cell, proof))
                what = "the best that was found was not looked at as a whole"
                self.unfinished = f"{self.unfinished}, and {what}" if self.unfinished else what
                break
            tried.append(Tried(candidate, cell, proof))
            if proof.meets:
                break
        return tried

    def _missed(self, judge: Judge, found: Found) -> tuple[Missed, ...]:
        values = judge.look(np.array([found.nearest.values]))
        out = []
        for robot, task in judge.tasks.items():
            if not task.groups:
                continue
            ok = values.robots[robot].reached[0]
            for i, group in enumerate(task.groups):
                if not ok[i]:
                    pose = numbers(pose_of(task.poses[group.stop - 1]))
                    out.append(Missed(robot, task.names[i], pose, bool(judge.reached[robot][i])))
        return tuple(out)


def _keys(task: Task) -> Mapping[tuple[float, ...], int]:
    """Its groups by their ends."""
    rows = np.concatenate([task.poses.reshape(-1, 16), task.carried, task.elbows[:, None]], axis=1)
    return {
        tuple(np.round(rows[[g.start, g.stop - 1]], 6).ravel().tolist()): i
        for i, g in enumerate(task.groups)
    }


def _covers(task: Task, other: Task) -> bool:
    return _keys(other).keys() <= _keys(task).keys()


def _both(task: Task, other: Task) -> Task:
    """What one or the other has to reach."""
    own = _keys(task)
    more = [i for key, i in _keys(other).items() if key not in own]
    poses, groups, names = task.poses, list(task.groups), list(task.names)
    shifts, angles = task.carried, task.elbows
    for i in more:
        part = other.poses[other.groups[i]]
        groups.append(slice(len(poses), len(poses) + len(part)))
        names.append(other.names[i])
        poses = np.concatenate([poses, part])
        shifts = np.concatenate([shifts, other.carried[other.groups[i]]])
        angles = np.concatenate([angles, other.elbows[other.groups[i]]])
    elbows = None if task.angles is None and other.angles is None else angles
    return Task(poses, tuple(groups), tuple(names), shifts, elbows)
