"""States per second beside SPIN and SNAKES, in one run: `./dev bench --states`.

    python -m tests.bench.states [--repeat 3] [--threads 1]

Prints a table. Each model is explored by `pn2code verify` (from the coloured net) and by the peers that can have it:
SPIN on the same net as Promela (`spin -a`, `gcc -O2 -DSAFETY -DNOREDUCE`, without partial order), SNAKES on a small
size. Compilation counts for neither. The best of the repetitions of each counts: all else is other programs.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

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
    """

    name: str
    net: str
    states: int
    arcs: int
    settings: tuple[str, ...] = ()
    promela: str = ""
    aim: float | None = None


MODELS = (
    Model(
        "philosophers 14",
        "bench/phil14.cpn",
        4_782_969,
        52_081_218,
        (),
        "bench/phil14.promela",
        8.0,
    ),
    Model(
        "Kanban 5", "bench/kanban5.pnml", 2_546_432, 24_460_016, (), "bench/kanban5.promela", 4.0
    ),
    Model("database 10", DATABASE, 196_831, 1_181_000, ("n=10",), "bench/db10.promela", 3.5),
    Model("database 12", DATABASE, 2_125_765, 15_588_960, ("n=12",)),
)


def explore(model: Model, threads: int) -> dict[str, Any]:
    """One exploration by pn2code; its figures."""
    command = [sys.executable, "-m", "pn2code", "verify", str(SHARED / model.net), "--json"]
    command += ["--no-graph", "--most-traces", "0", "--threads", str(threads)]
    for setting in model.settings:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"bench: {model.name}: {done.stderr}")
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
    """Seconds of one search."""
    began = time.perf_counter()
    done = subprocess.run(
        [str(pan), "-m20000000", "-w24", "-E", "-c0"], capture_output=True, text=True, check=False
    )
    seconds = time.perf_counter() - began
    stored = re.search(r"([\d.e+]+) states, stored", done.stdout)
    if stored is None or abs(float(stored[1]) - states) > max(2.0, states * 1e-3):
        raise SystemExit(f"bench: SPIN stored {stored and stored[1]} states, not {states}")
    return seconds


def run_snakes(size: int) -> tuple[int, float]:
    """States and seconds of philosophers in SNAKES."""
    from snakes.nets import (  # type: ignore[import-untyped]
        Expression,
        MultiArc,
        PetriNet,
        Place,
        StateGraph,
        Transition,
        Variable,
    )

    net = PetriNet("philosophers")
    net.globals["n"] = size
    for name in ("think", "fork", "c1", "c2", "eat"):
        net.add_place(Place(name, list(range(size)) if name in ("think", "fork") else []))
    p, after = Variable("p"), Expression("(p + 1) % n")
    for name, source, fork, target in (
        ("a1", "think", "q == p", "c1"),
        ("b1", "think", "q == (p + 1) % n", "c2"),
        ("a2", "c1", "q == (p + 1) % n", "eat"),
        ("b2", "c2", "q == p", "eat"),
    ):
        net.add_transition(Transition(name, Expression(fork)))
        net.add_input(source, name, p)
        net.add_input("fork", name, Variable("q"))
        net.add_output(target, name, p)
    net.add_transition(Transition("fin"))
    net.add_input("eat", "fin", p)
    net.add_output("think", "fin", p)
    net.add_output("fork", "fin", MultiArc([p, after]))
    began = time.perf_counter()
    graph = StateGraph(net)
    graph.build()
    return len(graph), time.perf_counter() - began


def rows(repeat: int, threads: int) -> list[Sequence[str]]:
    """The table."""
    table: list[Sequence[str]] = []
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
            table.append(_row(model, best, min(theirs) if theirs else None))
            print(f"bench: {model.name}: {best['seconds']:.2f} s", file=sys.stderr)
    return table


def _row(model: Model, best: dict[str, Any], spin: float | None) -> Sequence[str]:
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
    )


def measure(repeat: int, threads: int) -> int:
    """Measure and print; 1 when an aim is missed on a machine that is not busy."""
    load = os.getloadavg()[0]
    print(f"{os.cpu_count()} cores; load at the start {load:.1f}\n")
    heads = ("model", "states / arcs", "s", "M states/s", "M arcs/s", "bytes a state", "MiB")
    heads += ("SPIN, s", "times", "aim")
    print("| " + " | ".join(heads) + " |")
    print("|" + "---|" * len(heads))
    table = rows(repeat, threads)
    for row in table:
        print("| " + " | ".join(row) + " |")
    states, seconds = run_snakes(5)
    print(f"\nSNAKES, philosophers 5: {states} states, {states / seconds:,.0f} states/s")
    missed = [r for r in table if r[8] != "-" and r[9] != "-" and float(r[8]) < float(r[9])]
    return int(bool(missed) and load < (os.cpu_count() or 1) / 2)


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench.states", description=__doc__)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    return measure(options.repeat, options.threads)


if __name__ == "__main__":
    sys.exit(main())
