"""States per second beside SPIN and SNAKES, in one run: `./dev bench --states`.

    python -m tools.bench.states [--repeat 3] [--threads 1]

Prints a table. Each model is explored by `pn2code verify` (from the coloured net) and by the peers that can have it:
SPIN on the same net as Promela (`spin -a`, `gcc -O2 -DSAFETY -DNOREDUCE`, without partial order), SNAKES and pm4py on
small sizes (state_peers.py). Then comes what has no peer (state_rates.py). Compilation counts for neither, and of SPIN
only what it calls its elapsed time. The best of the repetitions of each counts: all else is other programs.

The aims in seconds were set on a machine on which SPIN is known to take so and so long. What a model would take there
is what it takes here, times SPIN's time there, divided by SPIN's time here.

`./dev bench --database-15` explores the distributed database of 15 managers once, completely: minutes, on all
processors, within 20 GiB.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tools.bench import state_peers, state_rates

ROOT = Path(__file__).resolve().parents[2]
SHARED = Path(os.environ.get("PN2CODE_SHARED", ROOT.parent / "shared"))
DATABASE = "corpus/nets/cpn-io+cpn-js/sample-cpn-models/DistributedDataBase/DistributedDataBase.cpn"


@dataclass(frozen=True, slots=True)
class Model:
    """A net, and the same in Promela.

    Args:
        name: what it is called in the table.
        net: below the shared folder.
        states, arcs: as known.
        settings: for `--set`.
        promela: below the shared folder; "": none.
        aim: how many times as fast as SPIN, None: no aim.
        most_seconds: at most so many on the machine of the aims, 0: no aim.
        spin_seconds: what SPIN takes there, 0: not known.
    """

    name: str
    net: str
    states: int
    arcs: int
    settings: tuple[str, ...] = ()
    promela: str = ""
    aim: float | None = None
    most_seconds: float = 0.0
    spin_seconds: float = 0.0


MODELS = (
    Model(
        "philosophers 14",
        "bench/phil14.cpn",
        4_782_969,
        52_081_218,
        (),
        "bench/phil14.promela",
        8.0,
        3.0,
        25.0,
    ),
    Model(
        "Kanban 5",
        "bench/kanban5.pnml",
        2_546_432,
        24_460_016,
        (),
        "bench/kanban5.promela",
        4.0,
        1.2,
        5.8,
    ),
    Model(
        "database 10",
        DATABASE,
        196_831,
        1_181_000,
        ("n=10",),
        "bench/db10.promela",
        3.5,
        0.15,
        0.54,
    ),
    Model("database 12", DATABASE, 2_125_765, 15_588_960, ("n=12",), most_seconds=3.0),
)
LARGE_MIB = 20 << 10


def database(n: int) -> Model:
    """Of n managers: its states and arcs are known from n."""
    states, arcs = 1 + n * 3 ** (n - 1), 2 * n * (1 + (n - 1) * 3 ** (n - 2))
    return Model(f"database {n}", DATABASE, states, arcs, (f"n={n}",))


def explore(model: Model, threads: int, *more: str) -> dict[str, Any]:
    """One exploration by pn2code, perhaps with further options; its figures."""
    command = [sys.executable, "-m", "pn2code", "verify", str(SHARED / model.net), "--json"]
    command += ["--no-graph", "--most-traces", "0", "--threads", str(threads), *more]
    for setting in model.settings:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0 or not done.stdout:
        raise SystemExit(f"bench: {model.name}: code {done.returncode}: {done.stderr}")
    found: dict[str, Any] = json.loads(done.stdout)
    if (found["nodes"], found["arcs"]) != (model.states, model.arcs):
        raise SystemExit(
            f"bench: {model.name}: {found['nodes']} states and {found['arcs']} arcs are wrong"
        )
    return found


def build_spin(model: Model, folder: Path) -> Path | None:
    """SPIN's verifier of a model; None without SPIN."""
    spin = shutil.which("spin")
    if spin is None or not model.promela:
        return None
    room = folder / model.name.replace(" ", "_")
    room.mkdir()
    subprocess.run(
        [spin, "-a", str(SHARED / model.promela)], cwd=room, check=True, capture_output=True
    )
    flags = ["-O2", "-DSAFETY", "-DNOREDUCE", "-DNOFAIR", "-w"]
    subprocess.run(["gcc", *flags, "-o", "pan", "pan.c"], cwd=room, check=True, capture_output=True)
    return room / "pan"


def run_spin(pan: Path, states: int) -> float:
    """Seconds of one search, as SPIN says: what it does before, such as making its table, does not count."""
    done = subprocess.run(
        [str(pan), "-m20000000", "-w24", "-E", "-c0"], capture_output=True, text=True, check=False
    )
    elapsed = re.search(r"elapsed time ([\d.e+]+) seconds", done.stdout)
    stored = re.search(r"([\d.e+]+) states, stored", done.stdout)
    if stored is None or abs(float(stored[1]) - states) > max(2.0, states * 1e-3):
        raise SystemExit(f"bench: SPIN stored {stored and stored[1]} states, not {states}")
    if elapsed is None:
        raise SystemExit("bench: SPIN does not say how long it took")
    return float(elapsed[1])


def rows(repeat: int, threads: int) -> list[Sequence[str]]:
    """The table."""
    table: list[Sequence[str]] = []
    slower = 1.0  # than the machine of the aims; of a model without SPIN: as for the one before it
    with tempfile.TemporaryDirectory(prefix="pn2code-bench-") as name:
        for model in MODELS:
            if not (SHARED / model.net).exists():
                print(f"bench: {model.net} is not there: left out", file=sys.stderr)
                continue
            pan = build_spin(model, Path(name))
            explore(model, threads)  # compiles
            ours: list[dict[str, Any]] = []
            theirs: list[float] = []
            for _ in range(repeat):  # in turn, so that other programs fall on both alike
                ours.append(explore(model, threads))
                if pan is not None:
                    theirs.append(run_spin(pan, model.states))
            best = min(ours, key=lambda found: found["seconds"])
            if theirs and model.spin_seconds > 0.0:
                slower = min(theirs) / model.spin_seconds
            table.append(_row(model, best, min(theirs) if theirs else None, slower))
            print(f"bench: {model.name}: {best['seconds']:.2f} s", file=sys.stderr)
    return table


def _row(model: Model, best: dict[str, Any], spin: float | None, slower: float) -> Sequence[str]:
    ratio = "-" if spin is None else f"{spin / best['seconds']:.1f}"
    return (
        model.name,
        f"{model.states:,} / {model.arcs:,}",
        f"{best['seconds']:.2f}",
        f"{best['states_per_second'] / 1e6:.2f}",
        f"{best['arcs'] / best['seconds'] / 1e6:.1f}",
        f"{best['bytes_per_state']:.1f}",
        f"{best['peak_mib']:.0f}",
        "-" if spin is None else f"{spin:.2f}",
        ratio,
        "-" if model.aim is None else f"{model.aim:g}",
        f"{best['seconds'] / slower:.2f}",
        f"{model.most_seconds:g}",
    )


def measure(repeat: int, threads: int) -> int:
    """Measure and print; 1 when an aim is missed on a machine that is not busy."""
    load = os.getloadavg()[0]
    print(f"{os.cpu_count()} cores; load at the start {load:.1f}\n")
    heads = ("model", "states / arcs", "s", "M states/s", "M arcs/s", "bytes a state", "MiB")
    heads += ("SPIN, s", "times", "target", "s there", "target")
    print("| " + " | ".join(heads) + " |")
    print("|" + "---|" * len(heads))
    table = rows(repeat, threads)
    for row in table:
        print("| " + " | ".join(row) + " |")
    print("\n| peer | model | states | states/s |\n|---|---|---|---|")
    for name, model_name, states, seconds in state_peers.all_of_them(SHARED):
        print(f"| {name} | {model_name} | {states:,} | {states / seconds:,.0f} |")
    state_rates.print_rates(SHARED, repeat)
    missed = [r for r in table if r[8] != "-" and r[9] != "-" and float(r[8]) < float(r[9])]
    missed += [r for r in table if float(r[10]) > float(r[11])]
    return int(bool(missed) and load < (os.cpu_count() or 1) / 2)


def measure_large(n: int, threads: int) -> int:
    """The database of n managers, once, completely; prints its figures. 1 when it takes more memory than it may."""
    model = database(n)
    load, began = os.getloadavg()[0], time.perf_counter()
    print(f"bench: {model.name}: {model.states:,} states, {model.arcs:,} arcs", file=sys.stderr)
    found = explore(model, threads, "--memory", str(LARGE_MIB))
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"{os.cpu_count()} cores; load at the start {load:.1f}\n")
    heads = (
        "model",
        "states / arcs",
        "threads",
        "s",
        "processor seconds",
        "M states/s",
        "M arcs/s",
    )
    print("| " + " | ".join((*heads, "bytes a state", "MiB")) + " |")
    print("|" + "---|" * (len(heads) + 2))
    row = (
        model.name,
        f"{found['nodes']:,} / {found['arcs']:,}",
        f"{found['threads']}",
        f"{found['seconds']:.0f}",
        f"{used.ru_utime + used.ru_stime:.0f}",
        f"{found['states_per_second'] / 1e6:.2f}",
        f"{found['arcs'] / found['seconds'] / 1e6:.1f}",
        f"{found['bytes_per_state']:.1f}",
        f"{found['peak_mib']:,.0f}",
    )
    print("| " + " | ".join(row) + " |")
    print(f"bench: {time.perf_counter() - began:.0f} s in all", file=sys.stderr)
    return int(found["peak_mib"] > LARGE_MIB)


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m tools.bench.states", description=__doc__)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    return measure(options.repeat, options.threads)


if __name__ == "__main__":
    sys.exit(main())
