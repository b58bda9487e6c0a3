"""Cells that tend machines, as they run: the states that their checks look at, all of them and in turns.

python -m tools.bench.tending_cells --measure 2,4,6
python -m tools.bench.tending_cells --in-turns --measure 8,12
python -m tools.bench.tending_cells --counted --measure 8,12,50
python -m tools.bench.tending_cells --medium --measure 2,3
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))  # as pytest does

from tools.bench.tending import write

from pn2code.arms import Arms
from pn2code.cell.divide import divide
from pn2code.channel_model import check as medium
from pn2code.channel_model.rules import Rules
from pn2code.cli.nets import open_net
from pn2code.diagnostics import Diagnostics
from pn2code.verify.controller import control
from pn2code.verify.controller.control_types import Plan
from pn2code.verify.controller.premises import Premises
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits

COUNTED_FROM = 20_000
"""States before tokens are counted up to a limit."""


def looked(parts: int, limits: Limits, *, of_medium: bool) -> str:
    """One row of the table, from the second column on."""
    d = Diagnostics()
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        opened = open_net(write(Path(name), parts), {}, warnings=d)
        assert opened.config is not None
        partition = divide(opened.flat, opened.config, d)
        assert partition is not None
        options = ExploreOptions(quick=True)
        began = time.perf_counter()
        if of_medium:
            answer = medium.whole(
                partition, opened.storage, medium.Run(limits, d, options), Rules()
            )
            took = time.perf_counter() - began
            return f"{answer.nodes:,} | {answer.arcs:,} | {answer.answer} | | | {took:.0f}"
        plan = Plan(
            storage=opened.storage,
            order_decides=True,
            options=options,
            premises=Premises.of(partition, opened.config, {}),
            primitives=opened.config.primitives,
            arms=Arms.of(opened.config, d),
        )
        found = control.examine(partition, plan, limits, d)
        took = time.perf_counter() - began
    if found is None or found.found is None:
        return "? | ? | | | |"
    space = found.found
    said = " ".join(sorted({c.kind for c in found.checks}))
    states = f"{space.nodes:,}" if space.complete else f"more than {space.nodes:,}"
    return (
        f"{states} | {space.arcs:,} | {said} | {space.seconds:.1f} | {space.peak_mib} | {took:.0f}"
    )


def main() -> int:
    """Prints a table."""
    parser = argparse.ArgumentParser(prog="tools.bench.tending_cells")
    parser.add_argument("--measure", default="2,4", help="numbers of parts, with commas between")
    parser.add_argument(
        "--states", type=int, default=20_000_000, help="most states (default: %(default)s)"
    )
    parser.add_argument("--in-turns", action="store_true", help="not all states")
    parser.add_argument("--medium", action="store_true", help="the cell with its medium")
    parser.add_argument(
        "--counted", action="store_true", help="in turns, with tokens counted up to a limit"
    )
    given = parser.parse_args()
    print(
        "| parts | how | states | arcs | answers | seconds | MiB | with compiling, all spaces, s |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for parts in map(int, given.measure.split(",")):
        ways = (("all", None, None), ("in turns", 1, None))[given.in_turns :]
        if given.counted:
            ways = (("counted", given.states, COUNTED_FROM),)
        for how, turns_from, counts_from in ways:
            limits = Limits(
                max_states=given.states,
                threads=1,
                traces=0,
                turns_from=turns_from,
                counts_from=counts_from,
            )
            print(
                f"| {parts} | {how} | {looked(parts, limits, of_medium=given.medium)} |", flush=True
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
