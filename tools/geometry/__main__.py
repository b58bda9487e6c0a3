"""`./dev geometry`: the examples' cells, with figures; shared-zone without its zone; random cells next to their runs.

./dev geometry                       a table of all examples (docs/benchmarks.md)
./dev geometry --pictures DIR        the pictures of docs/geometry.md
./dev geometry --pairs 400           pairs of moves a second of processor time: mostly far apart, and dense;
                                     --jobs 2: with two processes
./dev geometry --cells 40            random cells: two arms, half of them with tracks and a turntable, and an arm with
                                     a belt, a machine with door and clamp, and a table that turns; parts are
                                     stacked, tools changed, and sensors see the scene:
                                     what collides in PyBullet, or cannot be done
                                     with a part, is never said to be right; in
                                     each fourth of them an arm is placed anew, and what is proved of its
                                     new place is run as well; --large: instead of that each is looked at as if it had
                                     too many states, and the answers compared;
                                     --moving: cells of a belt, a turntable, a lift, a door, and an arm or an operator,
                                     with little room between what they sweep, which need not wait for each other
                                     --carrying: cells of two arms that both carry boxes, in half of them through a
                                     zone where people may be
"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from random import Random
from typing import Any
from unittest import mock

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.geometry.pairs import WORKLOADS, measured
from tools.geometry.unguarded import unguarded
from tools.geometry.wander import wander

from helpers.carrying_pairs import carrying_pair
from helpers.changing_cells import changing_cell
from helpers.machine_cells import machine_cell
from helpers.moving_cells import moving_cell
from helpers.netbuilder import cpn
from helpers.sighted_cells import sighted_cell
from helpers.two_arm_cells import two_arm_cell
from helpers.welding_cell import varied
from pn2code.cell.divide import divide
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.check import Geometry, examine
from pn2code.geometry.graph import CellGraph, explore_cell
from pn2code.geometry.pictures import draw
from pn2code.geometry.placing.look import Request, look
from pn2code.geometry.placing.search import Wish
from pn2code.geometry.report import text
from pn2code.robot.robot_cell import RobotCell
from pn2code.run.cell import run_cell
from pn2code.run.placed import run_placed
from pn2code.run.prepare import RunOptions
from pn2code.verdict.opened import read, with_inputs
from pn2code.verify.exploring.limits import Limits, cores

EXAMPLES = Path(__file__).parents[2] / "examples"
STEPS = 3_000
CELLS = (
    "minimal",
    "handover",
    "palletiser",
    "machining",
    "shared-zone",
    "tending",
    "welding",
    "assembly",
    "riveting",
)


def looked(cell: Path, traces: Path) -> Geometry:
    """All layouts of a cell."""
    d = Diagnostics()
    opened = read(cell, {}, d)
    assert opened is not None, [i.message for i in d]
    found = examine(with_inputs(opened, d), None, Limits(threads=cores()), traces, d)
    assert found is not None and not found.why, [i.message for i in d]
    return found


def looked_as_large(cell: Path, traces: Path) -> Geometry:
    """The same as if the cell had more states than are looked at: a net that does more decides (docs/geometry.md)."""

    def cut(
        partition: Partition,
        storage: Mapping[str, str],
        limits: Limits,
        *rest: Any,
        part: bool = False,
    ) -> CellGraph | None:
        few = limits if part else replace(limits, max_states=1)
        return explore_cell(partition, storage, few, *rest, part=part)

    with mock.patch("pn2code.geometry.check.explore_cell", cut):
        return looked(cell, traces)


def processor() -> float:
    """Seconds of this process and its children so far."""
    own, others = (resource.getrusage(w) for w in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return own.ru_utime + own.ru_stime + others.ru_utime + others.ru_stime


def table(folder: Path) -> int:
    """The examples, and shared-zone without its zone."""
    cells = {name: EXAMPLES / name for name in CELLS}
    cells["shared-zone without `Free`"] = folder / "unguarded"
    assert unguarded(EXAMPLES / "shared-zone", "Station", "Free", folder / "unguarded")
    print(
        "| cell | layout | states | moves | pairs of moves | distances | moves possible | arms apart | processor, s |"
    )
    print("|---|---|---|---|---|---|---|---|---|")
    wrong = 0
    for name, cell in cells.items():
        before = processor()
        found = looked(cell, folder / "runs" / name)
        seconds = processor() - before
        for x, _ in found.layouts:
            figures = f"{x.states:,} | {len(x.moves)} | {x.looked:,} | {x.queries:,}"
            took = f"{seconds:.1f}" if x is found.layouts[-1][0] else ""
            print(
                f"| {name} | {x.name} | {figures} | {x.of_moves} | {x.of_pairs} | {took} |",
                flush=True,
            )
        expected = "no" if "without" in name else "yes"
        helps = all(p.works for x, _ in found.layouts for p in x.proposals)
        if found.answer != expected or not helps:
            wrong += 1
            print(text([x for x, _ in found.layouts], full=False))
    return wrong


def pictures(folder: Path, to: Path) -> int:
    """The arms of shared-zone where they touch without the zone."""
    unguarded(EXAMPLES / "shared-zone", "Station", "Free", folder / "unguarded")
    for layout, cell in looked(folder / "unguarded", folder / "runs").layouts:
        draw(cell, layout.pairs, to, "touch")
    return 0


def speeds(count: int, jobs: int) -> int:
    """Pairs of moves a second of processor time, on two workloads, and seconds by the clock."""
    print(
        "| pairs | number | touch | not known | distances | a pair, ms | pairs a second | elapsed, s |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for workload in WORKLOADS:
        x = measured(workload, count, jobs)
        each = f"{1000.0 * x.seconds / x.pairs:.1f} | {x.pairs / x.seconds:.0f}"
        row = f"{workload} | {x.pairs} | {x.touching} | {x.open} | {x.distances:,} | {each} | {x.elapsed:.1f}"
        print(f"| {row} |", flush=True)
    return 0


def strolled(cell: Path, arms: RobotCell, seed: int, walks: int) -> str:
    """What happens on random walks of a cell; "": nothing."""
    d = Diagnostics()
    opened = read(cell, {}, d)
    assert opened is not None
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None
    graph = explore_cell(partition, opened.storage, Limits(), d)
    assert graph is not None
    for number in range(walks):
        met = wander(graph, arms, Random(f"{seed} {number}"), STEPS)
        if met:
            return met
    return ""


def ran(cell: Path, out: Path) -> str:
    """Why a run in PyBullet fails; "": it does not."""
    d = Diagnostics()
    result = run_cell(cell, RunOptions(out, looks=False, checked=False), d)
    assert result is not None, [i.message for i in d]
    return result.record.reason


def placed(cell: Path, robot: str, out: Path, seed: int, walks: int) -> tuple[str, str]:
    """What `place` says of another place of an arm ("yes": it is proved), and what happens there; "": nothing."""
    d = Diagnostics()
    opened = read(cell, {}, d)
    assert opened is not None
    wish = Wish("condition", limit=0.0)
    free = (f"{robot}.base.x,y,yaw=-200:200",)
    request = Request(free, None, 0.3, wish, seed, generations=3, tries=2)
    limits = Limits(threads=cores())
    found = look(with_inputs(opened, d), request, limits, out, d)
    assert found is not None, [i.message for i in d]
    if found.chosen is None:
        return "no", ""
    options = RunOptions(out / "run", looks=False, checked=False)
    record = run_placed(cell, found.chosen.cell, options, d)
    assert record is not None, [i.message for i in d]
    return "yes", record.reason or strolled(cell, found.chosen.cell, seed, walks)


def random_cell(number: int) -> tuple[str, str]:
    """In turns two arms, two arms with tracks and a turntable, a welding pair, and an arm between devices that move.

    Each other one of the last asks sensors that see the scene; of these each other one changes tools instead, with a
    second arm.
    """
    if number % 16 == 15:
        return changing_cell(Random(number))
    if number % 8 == 7:
        return sighted_cell(Random(number))
    if number % 4 == 3:
        return machine_cell(Random(number))
    if number % 4 == 2:
        return varied(Random(number))
    return two_arm_cell(Random(number), Random(f"axes {number}") if number % 4 else None)


def random_cells(
    folder: Path,
    count: int,
    seed: int,
    walks: int,
    *,
    is_run: bool,
    step: int = 1,
    large: bool = False,
    own: Callable[[Random], tuple[str, str]] | None = None,
) -> int:
    """Random cells next to runs of them in PyBullet, and random walks with moving arms."""
    said: dict[tuple[str, str], int] = {}
    wrong = 0
    for done, number in enumerate(range(seed, seed + step * count, step), 1):
        times = [processor()]
        net, toml = random_cell(number) if own is None else own(Random(number))
        cell = folder / str(number)
        cell.mkdir()
        (cell / "cell.cpn").write_bytes(cpn(net))
        (cell / "cell.toml").write_text(toml)
        found = looked(cell, folder / f"{number}.runs")
        times.append(processor())
        met = ran(cell, folder / f"{number}.run") if is_run else ""
        arms = found.layouts[0][1]
        met = met or strolled(cell, arms, number, walks)
        times.append(processor())
        key = (found.answer, "something" if met else "nothing")
        said[key] = said.get(key, 0) + 1
        if found.answer == "yes" and met:
            wrong += 1
            print(f"cell {number}: said yes, but {met}", flush=True)
        if large:
            as_large = looked_as_large(cell, folder / f"{number}.large")
            key = (f"{as_large.answer} (as a large cell)", "something" if met else "nothing")
            said[key] = said.get(key, 0) + 1
            if {as_large.answer, found.answer} == {"yes", "no"} or (
                as_large.answer == "yes" and met
            ):
                wrong += 1
                print(
                    f"cell {number}: {found.answer}, {as_large.answer} as a large cell; {met}",
                    flush=True,
                )
        elif number % 4 == 0 and own is None:
            robot = arms.robots[-1].name
            answer, there = placed(cell, robot, folder / f"{number}.place", number, walks)
            key = (f"{answer} to another place", "something" if there else "nothing")
            said[key] = said.get(key, 0) + 1
            if there:
                wrong += 1
                print(f"cell {number}: {robot} was placed, but {there}", flush=True)
        took = [after - before for before, after in pairwise((*times, processor()))]
        print(
            f"cell {number} ({done} of {count}): {found.answer}, {met or 'nothing happens'}; processor, s: "
            f"answer {took[0]:.1f}, runs {took[1]:.1f}, other answers {took[2]:.1f}; {wrong} wrong so far",
            flush=True,
        )
    for (answer, happens), often in sorted(said.items()):
        print(f"{often:4} cells: the answer is {answer}, in runs {happens} happens")
    return wrong


def main() -> int:
    """As the command line says."""
    parser = argparse.ArgumentParser(prog="./dev geometry", description=__doc__.split("\n")[0])
    parser.add_argument("--cells", type=int, default=0, metavar="N")
    parser.add_argument("--pairs", type=int, default=0, metavar="N", help="of each workload")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="processes for `--pairs`")
    parser.add_argument("--seed", type=int, default=1, metavar="K")
    parser.add_argument("--step", type=int, default=1, metavar="N", help="each Nth cell alone")
    parser.add_argument("--no-runs", dest="runs", action="store_false", help="random walks alone")
    parser.add_argument("--walks", type=int, default=5, metavar="N", help="of each random cell")
    parser.add_argument(
        "--large", action="store_true", help="random cells also as if they had too many states"
    )
    parser.add_argument("--moving", action="store_true", help="random cells of moving devices")
    parser.add_argument("--carrying", action="store_true", help="of two arms that both carry parts")
    parser.add_argument("--pictures", type=Path, metavar="DIR")
    options = parser.parse_args()
    if options.pairs:
        return speeds(options.pairs, options.jobs)
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        if options.cells:
            own = moving_cell if options.moving else carrying_pair if options.carrying else None
            return random_cells(
                Path(name),
                options.cells,
                options.seed,
                options.walks,
                is_run=options.runs,
                step=options.step,
                large=options.large,
                own=own,
            )
        if options.pictures:
            return pictures(Path(name), options.pictures)
        return table(Path(name))


if __name__ == "__main__":
    sys.exit(min(main(), 1))
