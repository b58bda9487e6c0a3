"""A family of equal robots: k of them take parts from one stock, work in one zone, and report to one supervisor.

    python -m tools.bench.equal_robots --robots 4 FILE.cpn      # the net
    python -m tools.bench.equal_robots --measure 2,3,4,5,6      # markings with and without exchanging equal robots

Each robot is an instance of one page, with channels of its own, and code segments; the supervisor has a transition for
each robot that sends it out, and one that takes its report. The zone is shared.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from tools.bench.tending import cpn, verified

_HEAD = """
net robots
  standard
  var n, m: INT;
  page Top
    place Zone = 1
    place Stock = {parts}
    place Done : INT
"""
_OF_ROBOT = """
    place Free{i} = 1
    place Go{i} : INT
    place Ready{i} : INT
    trans Send{i} code input (); output (n); action 5
      in Free{i}
      in Stock
      out Go{i} : n
    trans Take{i}
      in Ready{i} : n
      out Free{i}
      out Done : n
    subst R{i} = Robot (Go -> Go{i}, Ready -> Ready{i}, Zone -> Zone)
"""
_ROBOT = """
  page Robot
    place Go port in : INT
    place Ready port out : INT
    place Zone port io : UNIT
    place Busy : INT
    place There : INT
    place Left : INT
    trans Accept
      in Go : n
      out Busy : n
    trans Enter code input (n); output (m); action n + 1
      in Busy : n
      in Zone
      out There : m
    trans Leave
      in There : n
      out Zone
      out Left : n
    trans Report
      in Left : n
      out Ready : n
"""


def net(robots: int, parts: int) -> bytes:
    """The `.cpn` file."""
    own = [_OF_ROBOT.format(i=i) for i in range(1, robots + 1)]
    texts = (_HEAD.format(parts=parts), *own, _ROBOT)
    return cpn("\n".join(text.strip("\n") for text in texts))


def main() -> int:
    """Writes a net, or prints a table."""
    parser = argparse.ArgumentParser(prog="tools.bench.equal_robots")
    parser.add_argument("--robots", type=int, default=3)
    parser.add_argument("--parts", type=int, default=12, help="in the stock (default: %(default)s)")
    parser.add_argument("--measure", default="", help="numbers of robots, with commas between")
    parser.add_argument("--states", type=int, default=20_000_000, help="most markings")
    parser.add_argument("file", type=Path, nargs="?")
    given = parser.parse_args()
    if given.file is not None:
        given.file.write_bytes(net(given.robots, given.parts))
    if given.measure:
        print("| robots | reduction | markings | dead | seconds | MiB |")
        print("|---|---|---|---|---|---|")
    for robots in map(int, given.measure.split(",")) if given.measure else ():
        with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
            file = Path(name) / "robots.cpn"
            file.write_bytes(net(robots, given.parts))
            for options in ((), ("--reduce", "symmetry")):
                limit = ("--max-states", str(given.states), "--most-traces", "0")
                found = verified(file, *limit, *options)
                size = f"{found['nodes']:,}"
                size = size if found["complete"] else f"more than {size}"
                dead = found["dead_markings"] if found["complete"] else "?"
                used = ", ".join(found["reductions"]) or "none"
                print(
                    f"| {robots} | {used} | {size} | {dead} | {found['seconds']:.2f} "
                    f"| {found['peak_mib']} |",
                    flush=True,
                )
    return 0


if __name__ == "__main__":
    sys.exit(main())
