"""What compiling a net costs by its size: `./dev bench --compile`.

One net is a ring of stations with a queue each: lists, records, code segments, a guard, and no two transitions alike,
so that none of them share a C function. In others all places are counters of coloured tokens, with a dozen kinds of
transitions, and with no two alike. Told of each size:
how long the generated C is, what generating and compiling it takes, and how fast the explorer is; in turn with `-O2`,
with what `c_flags` has for large nets, and with what explorers of large nets have. Processor time.

`--sizes` is another table: what the tools themselves do with nets of more and more transitions, for the explorer at
first and for a large space, for the simulator and for the deployed supervisor.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from random import Random

from tests.helpers.netbuilder import flat, write

from pn2code.diagnostics import Diagnostics
from pn2code.emission import c_flags
from pn2code.emission.output import OutputFile
from pn2code.simulate import programs as simulators
from pn2code.toolchain import programs as toolchain
from pn2code.verify.exploring import programs
from pn2code.verify.exploring.programs import Sizes

SIZES = (100, 200, 300, 600)
COUNTED = (66, 200)
LARGE_SIZES = (102, 201, 501, 1002)
"""Threes: of the stations of `ring`."""
STATES = 1_000_000
"""So many are explored, of each size; the ring has more."""
WAYS = (("-O2",), ("-O2", *c_flags.QUICKER), programs.LARGE.net)
COUNTED_WAYS = (("-O2",), programs.LARGE.net, programs.QUICK.net)


def ring(transitions: int) -> str:
    """A ring of stations, in the short form of the tests' nets.

    Args:
        transitions: how many the net has, at least; three a station.
    """
    stations = -(-transitions // 3)
    lines = [
        "net Stations", "  standard", "  colset KIND = with screw | nut | bolt;",
        "  colset ITEM = record id: INT * kind: KIND;", "  colset ITEMS = list ITEM;",
        "  colset NOTE = product INT * STRING;",
        "  var i, j: ITEM; var l: ITEMS; var n: INT; var s, t: STRING;",
        "  fun put (x : ITEM, nil) = [x]",
        "    | put (x : ITEM, y :: r) = if #id x < #id y then x :: y :: r else y :: put (x, r)",
        "  fun after k = case k of screw => nut | nut => bolt | _ => screw",
        "  fun turned (x : ITEM, k) = {id = (#id x + k) mod 4, kind = after (#kind x)}",
    ]  # fmt: skip
    moves = []
    for k in range(stations):
        first = (
            f" = 1`[{{id = {k % 4}, kind = nut}}, {{id = 3, kind = screw}}]"
            if k in (0, stations // 2)
            else " = 1`[]"
        )
        after = (k + 1) % stations
        lines += [
            f"  place Queue{k} : ITEMS{first}", f"  place Held{k} : ITEM", f"  place Done{k} : ITEM",
            f'  place Note{k} : NOTE = 1`(0, "{k}")',
        ]  # fmt: skip
        action = f"(turned (i, {k % 3}), Int.toString (n + {k}))"
        moves += [
            f"  trans Take{k}", f"    in Queue{k} : i :: l", f"    out Queue{k} : l", f"    out Held{k} : i",
            f"  trans Work{k} guard [#id i < {4 + k}] code input (i, n); output (j, s); action {action}",
            f"    in Held{k} : i", f"    out Done{k} : j",
            f"    in Note{k} : (n, t)", f"    out Note{k} : ((n + 1) mod 2, s)",
            f"  trans Pass{k}", f"    in Done{k} : i", f"    in Queue{after} : l",
            f"    out Queue{after} : if length l > {k % 5} then put (i, l) else l ^^ [i]",
        ]  # fmt: skip
    return "\n".join(lines + moves)


def counters(transitions: int, *, unlike: bool = False) -> str:
    """A ring in which tokens of two colours go round and change, with resources and numbers beside it.

    Args:
        transitions: how many.
        unlike: with constants that make no two of them alike.
    """
    random = Random(transitions)

    def own(text: str) -> str:
        """The same number below 4, in other words."""
        return f"{text} + {4 * random.randint(1, 1000)}" if unlike else text

    lines = [
        "net Counters", "  standard", "  colset K = int with 0..3;", "  colset C = with red | green | blue;",
        "  colset KC = product K * C;", "  var k, m: K; var c, e: C;",
        "  fun after c = case c of red => green | green => blue | blue => red",
    ]  # fmt: skip
    moves = []
    for i in range(transitions):
        begins = " = 1`(0, red) ++ 1`(1, green)" if i % 9 == 0 else ""
        guard = f"k <> {i % 4}" if i % 2 else "k < 3 orelse c = red"
        if unlike:
            guard = f"({guard}) andalso (k + {i}) * {random.randint(1, 9)} <> {random.randint(1000, 9999)}"
        lines.append(f"  place P{i} : KC{begins}")
        moves += [f"  trans T{i} guard [{guard}]", f"    in P{i} : (k, c)"]
        if i % 3 == 0:
            lines.append(f"  place R{i} : C = 1`red ++ 1`blue")
            moves += [f"    in R{i} : e", f"    out R{i} : after e"]
        if i % 3 == 1:
            lines.append(f"  place F{i} : K = 2`1 ++ 1`{i % 4}")
            moves += [f"    in F{i} : m", f"    out F{i} : ({own(f'm + k + {i % 4}')}) mod 4"]
        number = f"if c = red then ({own(f'k + {1 + i % 3}')}) mod 4 else k"
        colour = "after c" if i % 2 else "c"
        moves.append(f"    out P{(i + 1) % transitions} : ({number}, {colour})")
    return "\n".join(lines + moves)


def measure(repeat: int) -> int:
    """Prints the table; the least of the repetitions."""
    print(
        "| transitions | lines of C | generate, s | flags | compile, s | ms a transition | explore, s |"
    )
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory(prefix="pn2code-bench-") as cache:
        os.environ["XDG_CACHE_HOME"] = cache  # nothing is there, so that all is compiled
        for size in SIZES:
            _measure(ring(size), WAYS, repeat)
        for size in COUNTED:
            _measure(counters(size), COUNTED_WAYS, repeat)
            _measure(counters(size, unlike=True), COUNTED_WAYS, repeat)
    return 0


def measure_sizes(sizes: Sequence[int]) -> int:
    """Prints the compiler's time of every host as the tools call it, by the size of the net; one run each.

    Args:
        sizes: numbers of transitions.
    """
    kinds: dict[str, Callable[[int], str]] = {
        "lists, records, code, no two alike": ring,
        "coloured counters, no two alike": lambda n: counters(n, unlike=True),
        "coloured counters, 12 kinds": counters,
        "tokens `()`": plain,
    }
    print(
        "| net | transitions | host | lines of C | generate, s | compile, s | ms a transition |",
        "|---|---|---|---|---|---|---|",
        sep="\n",
    )
    for kind, written in kinds.items():
        for size in sizes:
            for host, found in _hosts(written(size)).items():
                lines, generated, compiled = found
                print(
                    f"| {kind} | {size} | {host} | {lines:,} | {generated:.1f} | {compiled:.2f} "
                    f"| {1000 * compiled / size:.1f} |",
                    flush=True,
                )
    return 0


def plain(transitions: int) -> str:
    """A ring of places and transitions without colours, two tokens going round, each transition with a neighbour."""
    lines = ["net Plain", "  standard"]
    lines += [f"  place P{i} : UNIT{' = 2`()' if i == 0 else ''}" for i in range(transitions)]
    for i in range(transitions):
        after = (i + 1) % transitions
        lines += [f"  trans T{i}", f"    in P{i} : ()", f"    out P{after} : ()"]
    return "\n".join(lines)


def _hosts(text: str) -> dict[str, tuple[int, float, float]]:
    """host -> lines of C, processor time of generating it, and of compiling it."""
    net = flat(text)
    found = {}
    start = time.process_time()
    made = programs.Generated()
    if not made.generate(net, {}, Sizes.start(net, {}), Diagnostics()):
        raise SystemExit("bench: the net cannot be generated")
    explorer = made.files
    generated = time.process_time() - start
    for name, host in (("explorer, first", programs.QUICK), ("explorer, large", made.host)):
        found[name] = (_lines(explorer), generated, _compiled_for(host, explorer))
    start = time.process_time()
    simulator = simulators.generated(net, {}, Diagnostics())
    generated = time.process_time() - start
    found["simulator"] = (_lines(simulator), generated, _compiled_for(simulators.HOST, simulator))
    with tempfile.TemporaryDirectory(prefix="pn2code-bench-") as name:
        file = write(text, Path(name) / "net.cpn")
        folder = Path(name) / "generated"
        command = [sys.executable, "-m", "pn2code", "generate", str(file), "-o", str(folder)]
        generated = _work(command, None)
        lines = (folder / "net.c").read_text(encoding="utf-8").count("\n")
        found["supervisor"] = (lines, generated, _work(["make", "-s", "net_own.o"], folder))
    return found


def _lines(files: tuple[OutputFile, ...] | None) -> int:
    if files is None:
        raise SystemExit("bench: the net cannot be generated")
    return sum(f.text.count("\n") for f in files)


def _compiled_for(host: toolchain.Host, files: tuple[OutputFile, ...]) -> float:
    """Processor time of the compiler for the net alone, with what a host's nets are compiled with."""
    compiler = toolchain.Compiler.find(host, Diagnostics())
    if compiler is None:
        raise SystemExit("bench: no C compiler")
    generated = "".join(f.text for f in files)
    own = tuple(f for f in host.flags if f != "-pthread")
    return _compile(files, (*own, *toolchain.net_flags(host, compiler, generated)))


def _measure(text: str, ways: tuple[tuple[str, ...], ...], repeat: int) -> None:
    net = flat(text)
    count = len(net.transitions)
    sizes = Sizes.start(net, {})
    start = time.process_time()
    files = programs.generated(net, {}, sizes, Diagnostics())
    generated = time.process_time() - start
    if files is None:
        raise SystemExit("bench: the net cannot be generated")
    lines = sum(f.text.count("\n") for f in files)
    compiled = [
        min(_compile(files, ("-DPN_MANY", *flags)) for _ in range(repeat)) for flags in ways
    ]
    explored = _explore(files, ways, repeat)
    for flags, of_compiler, of_explorer in zip(ways, compiled, explored, strict=True):
        print(
            f"| {count} | {lines:,} | {generated:.1f} | `{' '.join(flags)}` | {of_compiler:.1f} "
            f"| {1000 * of_compiler / count:.1f} | {of_explorer:.2f} |",
            flush=True,
        )


def _compile(files: tuple[OutputFile, ...], flags: tuple[str, ...]) -> float:
    """Processor time of the compiler for the net alone."""
    with tempfile.TemporaryDirectory(prefix="pn2code-bench-") as name:
        room = Path(name)
        runtime = programs.HOST.runtime()
        for f in (*runtime, *files):
            (room / f.path).parent.mkdir(parents=True, exist_ok=True)
            (room / f.path).write_text(f.text, encoding="utf-8")
        command = ["cc", *toolchain.FLAGS, *flags, "-Iruntime/include", "-I."]
        return _work([*command, "-c", "net.c"], room)


def _explore(
    files: tuple[OutputFile, ...], ways: tuple[tuple[str, ...], ...], repeat: int
) -> list[float]:
    """Processor time of the explorers, in turn."""
    hosts = [replace(programs.HOST, net=("-DPN_MANY", *flags)) for flags in ways]
    d = Diagnostics()
    with ExitStack() as stack:
        built = [stack.enter_context(toolchain.program(host, files, d)) for host in hosts]
        if any(program is None for program in built):
            raise SystemExit("bench: " + "; ".join(map(str, d)))
        options = ("--threads", "1", "--max-states", str(STATES))
        runs = [[_work([str(p), *options]) for p in built] for _ in range(repeat)]
    return [min(column) for column in zip(*runs, strict=True)]


def _work(command: list[str], folder: Path | None = None) -> float:
    """User and system time of a command, s; an explorer that is stopped by its limit ends with 3."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):
        raise SystemExit(f"bench: {command[0]}: {done.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
