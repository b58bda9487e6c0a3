"""`./dev forgery`: real runs, in whose traces one thing is changed, one at a time: `pn2code replay` must refuse each.

Traces: runs of the examples' cells, of the simulators, and those that `verify` gives with its answers. A change that is
accepted must say the same as the run (tools/forgery/judge.py). Prints what is accepted and does not, and a table; exit
code 1 if there is one.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.forgery.forgeries import forgeries
from tools.forgery.judge import WRONG, Judge
from typer.testing import CliRunner

from pn2code.cli.main import app

EXAMPLES = Path(__file__).parents[2] / "examples"
CELLS = ("riveting", "sorting", "shared-zone", "timed", "palletiser")
NETS = ("philosophers/philosophers.cpn", "timed/timed.cpn", "riveting/cell.cpn")
RESULTS = (
    "refused",
    "same",
    "name",
    "rest unknown",
    "moved",
    "another order",
    "accepted",
    "crash",
)


def _done(*arguments: object, codes: tuple[int, ...] = (0,)) -> None:
    result = CliRunner().invoke(app, [str(a) for a in arguments])
    assert result.exit_code in codes, result.output


def traces(folder: Path, only: str) -> Iterator[tuple[str, Path, Path]]:
    """Of each run: a name, its trace, and the net or cell."""
    for name in (c for c in CELLS if only in f"run of {c}"):
        out, cell = folder / name, EXAMPLES / name
        _done("run", cell, "--backend", "fake", "--no-pictures", "--unchecked", "--out", out)
        (trace,) = (p for p in out.glob("*.trace.jsonl") if p.stem != "supervisor.trace")
        yield f"run of {name}", trace, cell
    for name in NETS:
        engines = ("compiled", "reference")
        for engine in (e for e in engines if only in f"{e} simulation of {name}"):
            trace = folder / f"{Path(name).stem}.{engine}.jsonl"
            options = ("--steps", 80, "--seed", 3, "--quiet", "--engine", engine)
            _done("simulate", EXAMPLES / name, *options, "--trace", trace)
            yield f"{engine} simulation of {name}", trace, EXAMPLES / name
    found = folder / "found"
    net = EXAMPLES / NETS[0]
    _done(
        "verify",
        net,
        "--property",
        "ltl G F fires(Table'Put_down)",
        "--traces",
        found,
        codes=(0, 1),
    )
    for trace in sorted(found.glob("*.jsonl")):
        yield f"verify: {trace.name}", trace, net


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="./dev forgery", description=__doc__)
    parser.add_argument(
        "--most", type=int, help="at most so many of each trace, drawn with a fixed seed"
    )
    parser.add_argument("--only", default="", help="traces whose name contains this")
    options = parser.parse_args()
    count: Counter[tuple[str, str]] = Counter()
    names = []
    with tempfile.TemporaryDirectory(prefix="pn2code-") as room:
        for name, trace, net in traces(Path(room), options.only):
            if options.only not in name:
                continue
            names.append(name)
            judge = Judge(trace, net)
            found = list(forgeries(judge.text))
            if options.most is not None and len(found) > options.most:
                found = random.Random(name).sample(found, options.most)
            for forgery in found:
                result, why = judge.verdict(forgery)
                count[name, result] += 1
                if result in WRONG:
                    print(f"{name}: {forgery.what}: {result} {why}", flush=True)
            print(f"{name}: {len(found)}", file=sys.stderr)
    print(f"\n| trace | {' | '.join(RESULTS)} |\n|---{'|---' * len(RESULTS)}|")
    for name in names:
        print(f"| {name} | {' | '.join(str(count[name, r]) for r in RESULTS)} |")
    wrong = sum(n for (_, result), n in count.items() if result in WRONG)
    print(f"\n{sum(count.values())} changes, {wrong} unnoticed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
