"""Compiled explorers in tests: the whole graph of a net, next to that of the reference token game.

`Explorers.open(folder)` compiles the runtime once; `agrees` explores a net both ways and compares markings, binding
elements, and what is said of the graph with `helpers.graph_facts`, which follows the definitions word by word.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from helpers import linker
from helpers.compiled import QUICK, RUNTIME, WARNINGS
from helpers.compiled import SHARED as AS_ELSEWHERE
from helpers.graph_facts import Facts
from pn2code.base.resources import cnative_folder
from pn2code.diagnostics import Diagnostics
from pn2code.emission import c_flags
from pn2code.emission.runtime import HOSTS
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.graph import StateSpace, state_space
from pn2code.semantics.game.marking import binding_to_json, place_to_json
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.verify.exploring.programs import Sizes, generated

SANITIZERS = ("-g1", "-O0", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
THREADS = ("-g1", "-O0", "-fsanitize=thread")
SECONDS = 600
"""Ends what hangs."""
LIBRARY = "libnet.so"
SHARED = ("-shared", *linker.QUICK)
OTHER_HOSTS = tuple(name for name in HOSTS if name != "explore")


def explorer_test(folder: Path, name: str, parts: Sequence[str], *flags: str) -> Path:
    """A program of `cnative/tests` with some sources of the explorer, and nothing else of it.

    Args:
        folder: where it is put.
        name: of its own source.
        parts: `store` is `explore_store.c`.
        flags: more of them for the compiler.
    """
    compiler = shutil.which("gcc") or shutil.which("cc")
    assert compiler is not None
    root = cnative_folder()
    sources = [
        root / "tests" / f"{name}.c",
        *(next(root.rglob(f"src/**/explore_{p}.c")) for p in parts),
    ]
    command = [compiler, *WARNINGS, "-O1", "-pthread", *flags]
    command += [f"-I{root / 'include'}", f"-I{root / 'src'}"]
    program = folder / name
    objects = [str(folder / f"{name}-{source.stem}.o") for source in sources]
    # One by one: what was compiled before is remembered.
    steps = [["-c", str(s), "-o", o] for s, o in zip(sources, objects, strict=True)]
    for step in (*steps, [*objects, "-o", str(program)]):
        done = subprocess.run([*command, *step], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    return program


@dataclass(frozen=True, slots=True)
class Explored:
    """What an explorer has said: its report, its exit code, with `--write-graph` the graph, its lines of progress."""

    report: dict[str, Any]
    code: int
    nodes: tuple[str, ...] = ()
    arcs: tuple[tuple[int, int, str], ...] = ()
    lines: tuple[str, ...] = ()
    progress: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Explorers:
    """A folder with the explorer, and how nets are compiled: each as a shared library that it finds when it starts."""

    folder: Path
    compiler: str
    flags: tuple[str, ...]
    host: Path
    seconds: float = SECONDS

    @staticmethod
    def of(compiled: Path, folder: Path, flags: tuple[str, ...] = QUICK) -> Explorers:
        """With what `open` compiled elsewhere by these flags, and nets in a folder of one's own."""
        made = Explorers._at(folder, flags)
        return replace(made, host=compiled / "host")

    @staticmethod
    def _at(folder: Path, flags: tuple[str, ...]) -> Explorers:
        compiler = shutil.which("gcc") or shutil.which("cc")
        assert compiler is not None
        return Explorers(folder, compiler, flags, folder / "host")

    @staticmethod
    def open(folder: Path, flags: tuple[str, ...] = QUICK) -> Explorers:
        """Compile the explorer."""
        made = Explorers._at(folder, flags)
        host = made.host
        host.mkdir(parents=True)
        source = cnative_folder() / "src"
        sources = [f for f in sorted(source.rglob("*.c")) if not f.name.startswith(OTHER_HOSTS)]
        (host / "stub.c").write_text("char pn_net[1];\n")
        made._run(host, *SHARED, "stub.c", "-o", LIBRARY)
        shared = {f"pn_{name}" for name in RUNTIME}
        for part in sources:
            if part.stem in shared:
                made._compiled(host, part)
            else:
                made._run(host, "-c", str(part))
        objects = [str(f) for f in sorted(host.glob("*.o"))]
        made._run(host, "-rdynamic", *objects, LIBRARY, "-lm", "-o", "explore")
        others = [f for f in objects if not Path(f).name.startswith("explore")]
        walker = cnative_folder() / "tests" / "walk.c"
        made._run(host, "-rdynamic", str(walker), *others, LIBRARY, "-lm", "-o", "walk")
        return made

    def _compiled(self, folder: Path, source: Path) -> None:
        """A source of the runtime, in the words of `helpers.compiled.Workshop`: its objects are the same."""
        self._do(folder, WARNINGS, "-c", str(source), "-o", f"{source.stem}.o")

    def _run(self, folder: Path, *arguments: str) -> None:
        self._do(folder, (c_flags.STANDARD, *c_flags.FLOATS), *arguments)

    def _do(self, folder: Path, language: Sequence[str], *arguments: str) -> None:
        command = [self.compiler, *language, *AS_ELSEWHERE, *self.flags]
        command += [f"-I{cnative_folder() / 'include'}", "-I.", *arguments]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr[-3000:]

    def build(self, flat: FlatNet, sizes: Sizes, name: str) -> Path:
        """A folder with a compiled net."""
        d = Diagnostics()
        files = generated(flat, {}, sizes, d)
        assert files is not None, [(e.message, e.origin.describe()) for e in d.errors]
        folder = self.folder / name
        folder.mkdir(exist_ok=True)
        for file in files:
            (folder / file.path).write_text(file.text)
        self.compile_net(folder)
        return folder

    def compile_net(self, folder: Path) -> None:
        """The library of a net. Without sanitizers `tcc` makes it, where it is there and accepts the net."""
        tiny = shutil.which("tcc") if self.flags == QUICK else None
        if tiny is not None:
            command = [tiny, "-w", "-shared", c_flags.STANDARD, *c_flags.FLOATS, *self.flags]
            command += [f"-I{cnative_folder() / 'include'}", f"-I{folder}", "net.c", "-o", LIBRARY]
            if not subprocess.run(command, cwd=folder, capture_output=True, check=False).returncode:
                return
        self._run(folder, "-c", "net.c")
        self._run(folder, *SHARED, "net.o", "-o", LIBRARY)

    def explore(
        self,
        flat: FlatNet,
        *options: object,
        name: str = "net",
        width: int = 1,
        sizes: Sizes | None = None,
        reads: bool = True,
    ) -> Explored:
        """Explore a net, with more room where places turn out to hold more, as `pn2code verify` does.

        Args:
            flat: the net.
            options: of the explorer.
            name: of its folder.
            width: least width of the counters of packed places; 0: no place is packed.
            sizes: what its places hold at first, if that is known.
            reads: whether the lines of the graph are read.
        """
        run = self.run if reads else self.said
        sizes = sizes or wide(Sizes.start(flat, {}), width)
        while True:
            found = run(self.build(flat, sizes, name), *options)
            error = found.report["error"]
            if not error or error["kind"] not in ("capacity", "memory"):
                return found
            index = error["place"] if error["kind"] == "capacity" else None
            larger = sizes.larger(None if index is None else flat.places[index].name)
            assert larger is not None, error
            sizes = larger

    def run(self, folder: Path, *options: object) -> Explored:
        """Run the explorer of a compiled net, and read what it says."""
        said = self.said(folder, *options)
        nodes: list[str] = []
        arcs: list[tuple[int, int, str]] = []
        for line in said.lines:
            entry = json.loads(line)
            if "node" in entry:
                assert entry["node"] == len(nodes) + 1
                nodes.append(node_key(entry["t"], entry["marking"]))
            else:
                element = element_key(entry["t"], entry["transition"], entry["binding"])
                arcs.append((entry["from"] - 1, entry["to"] - 1, element))
        return replace(said, nodes=tuple(nodes), arcs=tuple(arcs))

    def said(self, folder: Path, *options: object) -> Explored:
        """Run the explorer of a compiled net; the graph is there as lines only."""
        graph = folder / "graph.jsonl"
        graph.unlink(missing_ok=True)
        command = [str(self.host / "explore"), *map(str, options)]
        done = subprocess.run(
            [*command, "--write-graph", str(graph)],
            capture_output=True,
            text=True,
            check=False,
            timeout=self.seconds,
            # What an explorer has goes with its process.
            env={
                **os.environ,
                "LD_LIBRARY_PATH": str(folder),
                "ASAN_OPTIONS": "detect_leaks=0",
            },
        )
        found = [word for word in ("Sanitizer", "runtime error") if word in done.stderr]
        assert not found, done.stderr[-5000:]
        assert done.stdout, f"code {done.returncode}: {done.stderr[-3000:]}"
        text = graph.read_text(encoding="utf-8") if graph.exists() else ""
        lines = (
            text.rstrip("\n").split("\n") if text else []
        )  # in strings there are other line ends
        progress = tuple(x for x in done.stderr.splitlines() if x.startswith("{"))
        return Explored(json.loads(done.stdout), done.returncode, (), (), tuple(lines), progress)


def wide(sizes: Sizes, width: int) -> Sizes:
    """With counters of at least that width; 0: no place is packed."""
    widths = {p: max(w, width) if width else 0 for p, w in sizes.packing.width.items()}
    return replace(sizes, packing=replace(sizes.packing, width=widths, default=width))


def node_key(time: float, marking: Mapping[str, Any]) -> str:
    """A marking as text; equal ones are equal."""
    return json.dumps([float(time), marking], sort_keys=True)


def element_key(time: float, transition: str, binding: Mapping[str, Any]) -> str:
    """A binding element with its time as text; equal ones are equal."""
    return json.dumps([float(time), transition, binding], sort_keys=True)


def reference(flat: FlatNet, most: int) -> StateSpace | GameError:
    """By the token game, up to so many markings; or the exception of an inscription."""
    try:
        game = Game(flat, {}, files=Files(None))
        return state_space(game, max_nodes=most)
    except GameError as error:
        return error


def agrees(
    explorers: Explorers,
    flat: FlatNet,
    *options: object,
    width: int = 4,
    nodes: int = 250,
    arcs: int = 2500,
) -> str:
    """Compare; gives "same", "exception" or "large" (more than that), and fails on a difference."""
    try:
        Game(flat, {}, files=Files(None))
    except GameError:
        return "exception"  # in an initial marking: there is nothing to explore
    transitions = ",".join(str(t.index) for t in flat.transitions)
    told = ("--bindings", transitions) if transitions else ()
    found = explorers.explore(flat, "--max-states", nodes, *told, *options, width=width)
    report = found.report
    if report["why"] in ("states", "seconds") or report["arcs"] > arcs:
        assert report["why"] == "complete" or found.code == 3
        return "large"
    space = reference(flat, 2 * nodes)
    if isinstance(space, GameError):
        assert report["why"] == "error", f"only the token game fails: {space}\n{report}"
        assert found.code == 1
        return "exception"
    if report["why"] == "error":
        assert not space.complete, f"only the compiled net fails: {report['error']}"
        return "large"
    assert report["complete"], (report["why"], report["error"])
    assert (report["nodes"], report["arcs"]) == (len(space.nodes), len(space.arcs))
    compare_graph(flat, space, found)
    compare_facts(flat, space, report)
    return "same"


def compare_graph(flat: FlatNet, space: StateSpace, found: Explored) -> None:
    """Markings and binding elements."""
    game = Game(flat, {}, files=Files(None))
    nodes = []
    for marking in space.nodes:
        texts = {
            p.name: place_to_json(game.colours, p.colset, marking.places[p.index])
            for p in flat.places
        }
        nodes.append(node_key(marking.time, texts))
    times = {arc.source: game.advance_time(space.nodes[arc.source]).time for arc in space.arcs}
    arcs = Counter(
        (
            nodes[arc.source],
            nodes[arc.target],
            element_key(
                times[arc.source],
                flat.transitions[arc.element.transition].name,
                binding_to_json(arc.element),
            ),
        )
        for arc in space.arcs
    )
    assert Counter(found.nodes) == Counter(nodes)
    theirs = Counter((found.nodes[a], found.nodes[b], element) for a, b, element in found.arcs)
    assert theirs == arcs
    if flat.transitions:
        told = found.report["bindings"]
        of_net = {(a.element.transition, _text(binding_to_json(a.element))) for a in space.arcs}
        assert of_net == {(int(t), _text(b)) for t, all_ in told.items() for b in all_}
        assert sum(map(len, told.values())) == len(of_net), "a binding twice"


def _text(binding: object) -> str:
    return json.dumps(binding, sort_keys=True)


def compare_facts(flat: FlatNet, space: StateSpace, report: Mapping[str, Any]) -> None:
    """All that is said of the graph."""
    arcs = [(a.source, a.target, a.element.transition) for a in space.arcs]
    facts = Facts(len(space.nodes), len(flat.transitions), arcs)
    graph = report["graph"]
    assert report["dead_count"] == len(space.dead) == len(report["dead"])
    assert report["fired"] == facts.fired()
    assert (graph["scc_nodes"], graph["scc_arcs"]) == facts.components()
    assert graph["home_count"] == len(facts.home())
    assert graph["initial_is_home"] == (0 in facts.home())
    assert graph["live"] == facts.live()
    assert graph["fairness"] == facts.fairness()
    assert report["depth"] == facts.depth()
    colours = Game(flat, {}, files=Files(None)).colours
    for place, said in zip(flat.places, report["bounds"], strict=True):
        counted = []
        for marking in space.nodes:
            rows = place_to_json(colours, place.colset, marking.places[place.index])
            own: Counter[str] = Counter()
            for row in rows:
                own[json.dumps(row[1])] += row[0]
            counted.append(own)
        sizes = [own.total() for own in counted]
        values = {value for own in counted for value in own}
        assert (said["lower"], said["upper"]) == (min(sizes), max(sizes)), place.name
        most = {v: max(own[v] for own in counted) for v in values}
        least = {v: n for v in values if (n := min(own[v] for own in counted))}
        assert multiset(said["upper_multiset"]) == most, place.name
        assert multiset(said["lower_multiset"]) == least, place.name


def multiset(rows: list[list[Any]]) -> dict[str, int]:
    """Coefficients by colour, of what the explorer says of bounds."""
    return {json.dumps(value): count for count, value in rows if count}
