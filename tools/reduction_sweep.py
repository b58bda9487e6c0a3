"""Nets of the collections with and without reductions: the same dead markings, and exactly as many orbits as there are.

    python -m tools.reduction_sweep [--states 300000] [--seconds 60] [--only TEXT] NET_OR_FOLDER ...

Exit code 1 if an answer differs. Orbits are counted by brute force (in Python, over the unfolded net) where the whole
space has at most `--orbits` markings.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import chain
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

import typer

from helpers.table_nets import Marking, Permutation, orbits
from pn2code.cli.nets import open_net
from pn2code.cli.options import Format
from pn2code.semantics.game.token_game import GameError
from pn2code.unfold.net import UnfoldedTransition, Unfolding
from pn2code.verify.exploring.elements import NotPossibleError, elements
from pn2code.verify.exploring.symmetry import Symmetries

REDUCTIONS = (("partial-order",), ("symmetry",), ("partial-order", "symmetry"))


def main() -> int:
    """One line for each net and reduction."""
    parser = argparse.ArgumentParser(prog="tools.reduction_sweep")
    parser.add_argument("--states", type=int, default=300_000)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--orbits", type=int, default=3000)
    parser.add_argument("--only", default="")
    parser.add_argument("nets", nargs="+", type=Path)
    given = parser.parse_args()
    bad = 0
    for net in _nets(given.nets, given.only):
        for line, is_wrong in _compare(net, given):
            print(f"{'WRONG' if is_wrong else 'ok   '} {net.name}: {line}", flush=True)
            bad += is_wrong
    return 1 if bad else 0


def _nets(paths: list[Path], only: str) -> Iterator[Path]:
    for path in paths:
        found = [path] if path.is_file() else sorted([*path.rglob("*.cpn"), *path.rglob("*.pnml")])
        yield from (p for p in found if only in str(p))


def _compare(net: Path, given: argparse.Namespace) -> Iterator[tuple[str, bool]]:
    began = time.perf_counter()
    try:
        flat = open_net(net, {}, Format.FULL).flat
        table = elements(flat, wants_symmetry=True)
    except (NotPossibleError, GameError) as why:
        yield f"not possible: {why}", False
        return
    except (SystemExit, typer.Exit):
        yield "no net", False
        return
    took = time.perf_counter() - began
    u = table.unfolding
    less = sum(table.irrelevant)
    names = ", ".join(table.symmetries.names()) if table.symmetries else ""
    sizes = f"{len(u.places)} counters, {len(u.transitions)} elements, {less} irrelevant"
    yield f"{sizes}, {names or 'no symmetry'}; {took:.1f} s", False
    whole = _verify(net, given)
    if not whole.get("complete"):
        yield f"whole: {whole.get('why', whole)}", whole.get("why") == "error"
    for reductions in REDUCTIONS:
        if ("symmetry" in reductions and not names) or (
            "partial-order" in reductions and u.has_priorities
        ):
            continue
        found = _verify(net, given, *reductions)
        yield _judge(whole, found, reductions, table.symmetries, u, given.orbits)


def _judge(
    whole: dict[str, Any],
    found: dict[str, Any],
    reductions: tuple[str, ...],
    symmetries: Symmetries | None,
    u: Unfolding,
    most: int,
) -> tuple[str, bool]:
    if not found.get("complete") or not whole.get("complete"):
        is_wrong = found.get("why") not in ("complete", "states", "seconds", "memory", "infinite")
        states = f"{whole.get('nodes')} -> {found.get('nodes')}"
        return f"{'+'.join(reductions)}: {found.get('why', found)}, {states}", is_wrong
    said = f"{'+'.join(reductions)}: {whole['nodes']} -> {found['nodes']}"
    said += f", dead {whole['dead_markings']} -> {found['dead_markings']}"
    dead = (whole["dead_markings"], found["dead_markings"])
    is_wrong = (
        found["reductions"] != list(reductions)
        or found["nodes"] > whole["nodes"]
        or (
            dead[0] != dead[1]
            if reductions == ("partial-order",)
            else bool(dead[0]) != bool(dead[1])
        )
    )
    if symmetries is not None and "symmetry" in reductions and whole["nodes"] <= most:
        space = all_markings(u)
        wanted = (
            orbits(space, generators(symmetries)),
            orbits(dead_markings(u, space), generators(symmetries)),
        )
        said += f"; by brute force {wanted[0]} orbits, {wanted[1]} of them dead"
        is_wrong = is_wrong or len(space) != whole["nodes"] or wanted[1] != found["dead_markings"]
        is_wrong = is_wrong or (reductions == ("symmetry",) and wanted[0] != found["nodes"])
    return said, is_wrong


def all_markings(u: Unfolding) -> set[Marking]:
    """All that can be reached."""
    enabled_in = _enabled_in(u)
    seen = {u.initial}
    todo = [u.initial]
    while todo:
        marking = todo.pop()
        enabled = list(enabled_in(marking))
        best = min((t.priority for t in enabled), default=0)
        for t in enabled:
            after = u.fire(marking, t)
            if t.priority == best and after not in seen:
                seen.add(after)
                todo.append(after)
    return seen


def dead_markings(u: Unfolding, space: set[Marking]) -> set[Marking]:
    """Those in which nothing is enabled."""
    enabled_in = _enabled_in(u)
    return {m for m in space if next(enabled_in(m), None) is None}


def _enabled_in(u: Unfolding) -> Callable[[Marking], Iterator[UnfoldedTransition]]:
    """What is enabled in a marking. Looked at are transitions of which one place is marked, or that need none."""
    readers: dict[int, int] = Counter(p for t in u.transitions for p in t.pre)
    free = [t for t in u.transitions if not t.pre]
    waiting: dict[int, list[UnfoldedTransition]] = {}
    for t in u.transitions:
        if t.pre:
            waiting.setdefault(min(t.pre, key=readers.__getitem__), []).append(t)

    def enabled(marking: Marking) -> Iterator[UnfoldedTransition]:
        own = (waiting.get(p, ()) for p, n in enumerate(marking) if n)
        return (t for t in chain(free, *own) if u.is_enabled(marking, t))

    return enabled


def generators(symmetries: Symmetries) -> list[Permutation]:
    """Of the whole group, as permutations of the counters."""
    found = [r.rotation for r in symmetries.rotations]
    found += [r.reflection for r in symmetries.rotations if r.reflection is not None]
    full = symmetries.full
    if full is None:
        return found
    index = {counter: i for i, counter in enumerate(full.counters)}
    last: dict[int, int] = {}
    for point, own in enumerate(full.classes):
        if own in last:
            move = {point: last[own], last[own]: point}
            found.append(
                tuple(
                    index[shape, tuple(move.get(p, p) for p in points)]
                    for shape, points in full.counters
                )
            )
        last[own] = point
    return found


def _verify(net: Path, given: argparse.Namespace, *reductions: str) -> dict[str, Any]:
    command = [sys.executable, "-m", "pn2code", "verify", str(net), "--json", "--no-graph"]
    command += ["--max-states", str(given.states), "--max-seconds", str(given.seconds)]
    command += ["--most-traces", "0", "--threads", "1"]
    command += [text for name in reductions for text in ("--reduce", name)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    try:
        found: dict[str, Any] = json.loads(done.stdout)
    except ValueError:
        return {"why": done.stderr.strip()[:300] or "nothing said"}
    return found


if __name__ == "__main__":
    sys.exit(main())
