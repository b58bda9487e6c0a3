"""What a deployed supervisor takes of a machine, and two things that it must not do, read off its objects.

    python -m pn2code.toolchain.footprint generated/riveting        # or `make footprint` in that folder

The supervisor's own sources are compiled once more, as its Makefile compiles them, and gcc writes the stack that each
function takes and what it calls (`-fcallgraph-info=su`). From that comes the deepest stack, and that no function can
call itself, directly or through others. The runtime's functions that walk values (`WALKERS`) can, once for each level
of a value; how many levels there are at most is in `manifest.json`, and so often their stack counts. Of a recursive
datatype there is no such number: then this is recursion like any other. Calls through pointers lead to the functions
that `INDIRECT` names for the caller; a caller without a rule, or a function whose address is taken and that no rule
names, is an error.
"""

from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from pn2code.base.frozen import frozen

HEAP = frozenset(("malloc", "calloc", "realloc", "free", "aligned_alloc", "reallocarray", "strdup"))
MOST_LINES = 60
"""Of a function of the supervisor."""
POINTER = "__indirect_call"
INDIRECT: Mapping[str, str] = {
    r"main": r"sup_run_(cell|alone)|pn_file_allow",
    r"sup_(find|fire)_one|sup_play": r"\w+_enumerate|\w+_fire|pn_marking_collect",
    r"\w+_enumerate": r"keep_first",
    r"sup_next_time": r"pn_next_time",
    r"pn_next_time": r"thresholds",
    r"pn_marking_init": r"set_up|\w+_init",
    r"pn_is_legal|is_legal_part": r"is_\w+",
    r"compare\w*": r"pn_real_order|real_order_of_lt|real_differs",
    r"pn_multiset_\w+|packed_\w+": r"number_of\w*|colour_of\w*",
    r"pn_text_\w+": r"flush\w*",
    r"pn_port_changes": r"on_change",
    r"pn_files_open|clean_channels|discard\w*|clean\w*|await_stale_peers": r"on_notice",
    r"sup_run_cell|cycle|look_at_peers?|accept_message|publish\w*": r"files_\w+",
    r"read_channels?|clear_consumed|run_\w+|stop_\w+": r"files_\w+",
}
"""Who calls through pointers, and which functions: names of functions, as regular expressions."""
WALKERS = re.compile(
    r"(pn_(mkstr|json|is_legal|narrow|relocate|type_\w+|encode\w*|decode\w*)"
    r"|(mkstr|json|compare|is_legal|narrow|relocate|encode|decode)_(part|record|list|union|ref)s?|compare)"
)
"""Functions of the runtime's `value` that call themselves only with a type that the one they have got is made of."""
STARTED_ELSEWHERE = frozenset(("on_signal", "main"))
"""Called by the system, not by the program."""

_NODE = re.compile(r'^node: \{ title: "([^"]+)" label: "([^"]*)"')
_RELOCATION = re.compile(r"\bR_\w+?_(\w+)\s+(?:\.text\.)?(\w+)")
_EDGE = re.compile(r'^edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"')
_STACK = re.compile(r"\\n(\d+) bytes \((static|dynamic|dynamic,bounded)\)")


class FootprintError(Exception):
    """It cannot be found out; the message says why."""


@frozen
class Graph:
    """What functions call.

    Args:
        calls: by function, the functions that it calls, of the program or of the C library.
        stack: by function of the program, bytes.
        unbounded: functions whose stack depends on a value.
        walks: rings of functions that walk values, each drawn together to one with this name.
    """

    calls: Mapping[str, frozenset[str]]
    stack: Mapping[str, int]
    unbounded: tuple[str, ...]
    walks: tuple[str, ...] = ()

    def with_walks(self, levels: int) -> Graph:
        """With the rings of `WALKERS` drawn together, each of which takes its stack once a level; 0: as it is."""
        if levels == 0:
            return self
        below = {name: self.reached(name, inside=False) for name in self.calls}
        ring_of: dict[str, str] = {}
        rings: set[str] = set()
        for name in sorted(self.calls):
            ring = tuple(sorted(n for n in below[name] if name in below.get(n, ())))
            if ring and all(map(_is_walker, ring)):
                title = f"{' + '.join(map(_plain, ring))} (at most {levels} times)"
                ring_of[name] = title
                rings.add(title)
        calls: dict[str, set[str]] = {}
        stack: dict[str, int] = {}
        for name, called in self.calls.items():
            title = ring_of.get(name, name)
            known = {ring_of.get(n, n) for n in called} - ({title} if title in rings else set())
            calls.setdefault(title, set()).update(known)
            times = levels if title in rings else 1
            stack[title] = stack.get(title, 0) + times * self.stack.get(name, 0)
        walks = tuple(sorted(rings))
        return Graph({k: frozenset(v) for k, v in calls.items()}, stack, self.unbounded, walks)

    def cycle(self) -> tuple[str, ...]:
        """Functions that call each other in a ring; () if there is none."""
        done: set[str] = set()
        for first in sorted(self.calls):
            path: list[str] = []
            waiting: list[tuple[str, bool]] = [(first, False)]
            while waiting:
                name, is_left = waiting.pop()
                if is_left:
                    done.add(path.pop())
                    continue
                if name in path:
                    return tuple(path[path.index(name) :])
                if name in done:
                    continue
                path.append(name)
                waiting.append((name, True))
                waiting += [(other, False) for other in sorted(self.calls.get(name, ()))]
        return ()

    def deepest(self, start: str) -> tuple[int, tuple[str, ...]]:
        """The most bytes from a function on, and the calls that take them; of a graph without cycles."""
        known: dict[str, tuple[int, tuple[str, ...]]] = {}

        def visit(name: str) -> tuple[int, tuple[str, ...]]:
            if name not in known:
                below = [visit(other) for other in sorted(self.calls.get(name, ()))]
                most, path = max(below, key=lambda one: one[0], default=(0, ()))
                known[name] = (self.stack.get(name, 0) + most, (name, *path))
            return known[name]

        return visit(start)

    def reached(self, start: str, *, inside: bool = True) -> frozenset[str]:
        """All that a function calls, at last; itself only if it does, where that is wanted (not `inside`)."""
        found: set[str] = set()
        waiting = [start] if inside else list(self.calls.get(start, ()))
        while waiting:
            name = waiting.pop()
            if name not in found:
                found.add(name)
                waiting += self.calls.get(name, ())
        return frozenset(found)


def read_graph(notes: str, addresses: frozenset[str], linked: frozenset[str]) -> Graph:
    """The graph of a program.

    Args:
        notes: what gcc has written, all files.
        addresses: functions whose address is taken.
        linked: names of the functions in the program; others were left out.

    Raises:
        FootprintError: a call through a pointer leads nobody knows where.
    """
    calls: dict[str, set[str]] = {}
    stack: dict[str, int] = {}
    unbounded: list[str] = []
    pointing: set[str] = set()
    for line in notes.splitlines():
        if node := _NODE.match(line):
            name = _name(node[1])
            if (found := _STACK.search(node[2])) and _plain(name) in linked:
                stack[name] = max(int(found[1]), stack.get(name, 0))
                calls.setdefault(name, set())
                if found[2] == "dynamic":
                    unbounded.append(name)
        elif edge := _EDGE.match(line):
            caller, callee = _name(edge[1]), _name(edge[2])
            if _plain(caller) in linked:
                if callee == POINTER:
                    pointing.add(caller)
                else:
                    calls.setdefault(caller, set()).add(callee)
    called_by_pointer: set[str] = set()
    for caller in sorted(pointing):
        rules = [to for who, to in INDIRECT.items() if re.fullmatch(who, _plain(caller))]
        targets = {
            n
            for n in stack
            if _plain(n) in addresses and any(re.fullmatch(to, _plain(n)) for to in rules)
        }
        if not rules:
            raise FootprintError(f"`{caller}` calls through a pointer, and nothing says what")
        calls[caller] |= targets
        called_by_pointer.update(map(_plain, targets))
    lost = (addresses & linked) - called_by_pointer - STARTED_ELSEWHERE
    if lost:
        raise FootprintError(f"nothing says who calls {', '.join(sorted(lost))} through a pointer")
    return Graph({k: frozenset(v) for k, v in calls.items()}, stack, tuple(unbounded))


def _name(title: str) -> str:
    """A function as the graph knows it: one of a file with its name, `pn_text.c:grow`."""
    file, _, name = title.rpartition(":")
    return f"{Path(file).name}:{name}" if file else name


def _is_walker(name: str) -> bool:
    """Whether it is one of `WALKERS`; a function of the net may have such a name, but stands in another file."""
    return name.startswith("pn_") and WALKERS.fullmatch(_plain(name)) is not None


def _plain(name: str) -> str:
    """As it is written in C."""
    return name.rpartition(":")[2].split(".")[0]


def long_functions(source: str) -> Iterator[tuple[str, int]]:
    """Functions with more lines than they may have, and how many; of C whose bodies begin and end at the margin."""
    lines = source.splitlines()
    at: int | None = None
    for i, line in enumerate(lines):
        if line == "{":
            at = i
        elif line == "}" and at is not None:
            head = " ".join(lines[max(at - 3, 0) : at])
            if i - at + 1 > MOST_LINES:
                yield re.findall(r"(\w+)\(", head)[0], i - at + 1
            at = None


def _in_code(listing: str) -> Iterator[str]:
    """Functions whose address an instruction takes that is no call and no jump."""
    instruction = ""
    for line in listing.splitlines():
        if found := _RELOCATION.search(line):
            if instruction[:1] not in ("c", "j"):
                yield found[2]
        elif "\t" in line:
            instruction = line.split("\t")[1]


def _in_tables(relocations: str) -> Iterator[str]:
    """Functions whose address is in constants or variables; the tables of a `switch` have distances, no addresses."""
    for section in relocations.split("RELOCATION RECORDS FOR ")[1:]:
        if not section.startswith(("[.text", "[.eh_frame")):
            yield from (
                name for kind, name in _RELOCATION.findall(section) if not kind.endswith("PC32")
            )


def _said(folder: Path, *command: str) -> str:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise FootprintError(f"{shlex.join(command)}: {done.stderr.strip()[-1500:]}")
    return done.stdout


@frozen
class Footprint:
    """What was found of a supervisor. Bytes, where nothing else is said."""

    text: int
    constants: int
    data: int
    bss: int
    arena: int
    stack: int
    path: tuple[str, ...]
    functions: int
    cycle: tuple[str, ...]
    walks: tuple[str, ...]
    unbounded: tuple[str, ...]
    heap: tuple[str, ...]
    library: tuple[str, ...]
    long: tuple[tuple[str, int], ...]

    @property
    def ram(self) -> int:
        """Data and the deepest stack, without what the C library takes for itself."""
        return self.data + self.bss + self.stack

    @property
    def is_good(self) -> bool:
        """No recursion but once a level of a value, no heap, a stack that is the same for all values, no function that
        is too long.
        """
        return not (self.cycle or self.unbounded or self.heap or self.long)

    def report(self) -> str:
        """The file `footprint.txt`."""

        def listed(found: tuple[str, ...]) -> str:
            return ", ".join(found) if found else "none"

        return "\n".join(
            (
                "What ./supervisor takes, as it is compiled here (`make footprint`); without the C library's own:",
                "",
                f".text                       {self.text:>12,} bytes, {self.functions} functions",
                f"constants                   {self.constants:>12,} bytes (.rodata, .data.rel.ro)",
                f"RAM                         {self.ram:>12,} bytes",
                f"  .data                     {self.data:>12,}",
                f"  .bss                      {self.bss:>12,}, of which arena {self.arena:,} (see cell_config.c)",
                f"  deepest stack             {self.stack:>12,}: {' > '.join(self.path)}",
                f"recursion                   {listed(self.cycle)}",
                f"  once a level of a value   {listed(self.walks)}",
                f"stack that depends on data  {listed(self.unbounded)}",
                f"heap (malloc, free, ...)    {listed(self.heap)}",
                f"functions over {MOST_LINES} lines     {listed(tuple(f'{n} ({k})' for n, k in self.long))}",
                f"of the C library            {listed(self.library)}",
                "",
            )
        )


def measure(folder: Path) -> Footprint:
    """What the supervisor in a generated folder takes; its program must have been built.

    Raises:
        FootprintError: it cannot be found out.
    """
    commands = _said(folder, "make", "-s", "-n", "-W", "net.h", "supervisor").splitlines()
    compiled = [shlex.split(c.lstrip("@")) for c in commands if " -c -o " in c]
    notes: list[str] = []
    addresses: set[str] = set()
    with tempfile.TemporaryDirectory(prefix="pn2code-") as room:
        for i, command in enumerate(compiled):
            out = Path(room) / f"{i}.o"
            command[command.index("-o") + 1] = str(out)
            _said(folder, *command, "-fcallgraph-info=su", "-fstack-usage")
            notes.append(out.with_suffix(".ci").read_text())
            addresses.update(
                _in_code(_said(folder, "objdump", "-dr", "--no-show-raw-insn", str(out)))
            )
            addresses.update(_in_tables(_said(folder, "objdump", "-r", str(out))))
    symbols = [line.split() for line in _said(folder, "nm", "supervisor").splitlines()]
    linked = frozenset(_plain(s[2]) for s in symbols if len(s) == 3 and s[1] in "tT")
    used = sorted(s[1].split("@")[0] for s in symbols if len(s) == 2 and s[0] == "U")
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    graph = read_graph("\n".join(notes), frozenset(addresses), linked)
    functions = len(graph.stack)
    graph = graph.with_walks(int(manifest.get("nesting", 0)))
    cycle = graph.cycle()
    stack, path = (0, ()) if cycle else graph.deepest("main")
    sections = {
        words[0]: int(words[1])
        for line in _said(folder, "size", "-A", "supervisor").splitlines()
        if len(words := line.split()) == 3 and words[0].startswith(".")
    }
    sources = [Path(folder / c[-1]).read_text(encoding="utf-8") for c in compiled]
    return Footprint(
        text=sections.get(".text", 0),
        constants=sum(sections.get(n, 0) for n in (".rodata", ".data.rel.ro")),
        data=sections.get(".data", 0),
        bss=sections.get(".bss", 0),
        arena=_arena(_said(folder, "nm", "-S", "supervisor")),
        stack=stack,
        path=path,
        functions=functions,
        cycle=cycle,
        walks=graph.walks,
        unbounded=graph.unbounded,
        heap=tuple(n for n in used if n in HEAP),
        library=tuple(n for n in used if n not in HEAP),
        long=tuple((n, k) for s in sources for n, k in long_functions(s)),
    )


def _arena(symbols: str) -> int:
    """Bytes of the arena, of what `nm -S` prints; 0: there is none."""
    found = [line.split() for line in symbols.splitlines()]
    return sum(int(s[1], 16) for s in found if len(s) == 4 and s[3] == "s_arena")


def main() -> int:
    """Writes `footprint.txt` into the folder that is named; 0 if nothing that must not be was found."""
    folder = Path(sys.argv[1])
    try:
        found = measure(folder)
    except FootprintError as problem:
        print(f"footprint: {problem}", file=sys.stderr)
        return 2
    (folder / "footprint.txt").write_text(found.report(), encoding="utf-8")
    print(found.report(), end="")
    return 0 if found.is_good else 1


if __name__ == "__main__":
    raise SystemExit(main())
