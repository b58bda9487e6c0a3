"""Random nets of equal parts that work for one supervisor, and of parts that are equal but for one detail; and what is
true of their orbits, found by brute force.

text = family(Random(3))       # for `netbuilder`
compare(explorers, flat(text)) # "same": nodes, dead markings, bounds, transitions and runs are those of all markings
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Hashable, Iterator, Sequence
from random import Random

from helpers.explored import Explorers, reference
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.graph import StateSpace
from pn2code.semantics.game.marking import binding_to_json, place_to_json
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.trace.replay import replay
from pn2code.verify.exploring.find_instances import instances
from pn2code.verify.exploring.instances import Instances, Part
from pn2code.verify.exploring.limits import Reduction
from pn2code.verify.exploring.reductions import possible
from pn2code.verify.exploring.result import Exploration

Image = dict[int, int]
Key = tuple[str, ...]
HEAD = (
    "net Family",
    "  standard",
    "  colset LATE = int timed;",
    "  colset KIND = with drill | weld;",
    "  colset PAIR = product INT * KIND;",
    "  colset NUMBERS = list INT;",
    "  var n, m: INT; var u: UNIT; var q: PAIR; var kd: KIND; var ns: NUMBERS;",
    "  val P_HIGH = 100; val P_LOW = 10000;",
    "  globref last = 0;",
    "  fun next n = (n + 1) mod 2",
)


class _Family:
    """One net, line by line."""

    def __init__(self, r: Random, parts: int, *, odd: bool, timed: bool, nested: bool) -> None:
        self.r, self.parts = r, parts
        self.odd = r.randrange(parts) if odd else -1
        self.nested = nested
        self.number = "LATE" if timed else "INT"
        self.timed = timed
        self.what = r.choice(("guard", "priority", "constant", "token", "delay", "code", "page"))

    def text(self) -> str:
        """The whole net; the part that is odd differs in one detail."""
        r = self.r
        state = r.getstate()
        page = self.page("Robot", odd=False)
        r.setstate(state)
        other = self.page("Other", odd=True) if self.what == "page" and self.odd >= 0 else []
        lines = [*HEAD, "  page Top", "    place Zone = 1"]
        lines += [f"    place Stock = {r.choice((2, 3))}", "    place Done : INT"]
        late = r.random() < 0.3
        priority = " priority P_HIGH" if r.random() < 0.2 else ""
        for i in range(self.parts):
            odd = self.odd == i
            lines += self.supervisor(i, odd, late, priority)
            own = "Other" if odd and other else "Robot"
            lines.append(f"    subst R{i} = {own} (Go -> Go{i}, Ready -> Ready{i}, Zone -> Zone)")
        return "\n".join([*lines, *page, *other, *self.gripper()]) + "\n"

    def supervisor(self, i: int, odd: bool, late: bool, priority: str) -> Iterator[str]:
        """What it has for a part."""
        delay = " delay @+2" if self.timed and late else ""
        if odd and self.what == "delay" and self.timed:
            delay = " delay @+3"
        if odd and self.what == "priority":
            priority = " priority P_LOW"
        guard = " guard [n < 2]" if odd and self.what == "guard" else ""
        action = "next n" if not (odd and self.what == "code") else "1 - next n"
        yield f"    place Go{i} : {self.number}"
        yield f"    place Ready{i} : INT"
        yield f"    place Free{i} : INT = {2 if odd and self.what == 'token' else 1}`0"
        yield f"    trans Send{i}{delay}{priority}{guard} code input (n); output (m); action {action}"
        yield f"      in Free{i} : n"
        yield "      in Stock : u"
        yield f"      out Go{i} : m"
        yield f"    trans Take{i}"
        yield f"      in Ready{i} : n"
        yield f"      out Free{i} : {'1 - n' if odd and self.what == 'constant' else 'n'}"
        yield "      out Done : n"

    def page(self, name: str, *, odd: bool) -> list[str]:
        """What a part does, with places of many kinds."""
        r = self.r
        steps = r.randint(1, 3)
        kinds = [r.choice(("INT", "PAIR", "NUMBERS", "STRING")) for _ in range(steps)]
        lines = [f"  page {name}", f"    place Go port in : {self.number}"]
        lines += ["    place Ready port out : INT", "    place Zone port io : UNIT"]
        lines += [f"    place Step{i} : {k}" for i, k in enumerate(kinds)]
        taken = "n"
        source = "Go"
        zone = r.randrange(steps) if r.random() < 0.6 else None
        for i, k in enumerate(kinds):
            number = "String.size str" if taken == "str" else "n"
            put = {
                "INT": f"next ({number})",
                "PAIR": f"({number}, if {number} = 0 then drill else weld)",
                "NUMBERS": f"[{number}, 1]",
                "STRING": f"Int.toString ({number})",
            }[k]
            code = ""
            if r.random() < 0.3 and taken != "str":
                code = " code input (n); output (m); action (last := (!last + 1) mod 2; n)"
            low = " priority P_LOW" if r.random() < 0.2 else ""
            lines.append(f"    trans Do{i}{low}{code}")
            lines.append(f"      in {source} : {taken}")
            if zone == i:
                lines.append("      in Zone : u")
            if r.random() < 0.15:
                lines.append(f"      inhibit Step{r.randrange(i, steps)}")
            lines.append(f"      out Step{i} : {put}")
            if r.random() < 0.15:
                lines += [f"    trans Lose{i}", f"      in Step{i} : {_taken(k)}"]
                lines += ["      out Zone : ()"] if zone == i else []
            source, taken = f"Step{i}", _taken(k)
            if zone == i:
                lines += [
                    f"    place Held{i} : {k}",
                    f"    trans Free{i}",
                    f"      in Step{i} : {taken}",
                ]
                lines += ["      out Zone : ()", f"      out Held{i} : {taken}"]
                source = f"Held{i}"
        value = {"n": "n", "(n, kd)": "n", "n :: ns": "n", "str": "String.size str"}[taken]
        lines += ["    trans End", f"      in {source} : {taken}"]
        lines.append(f"      out Ready : {value + ' + 1' if odd else value}")
        if self.nested:
            lines += [f"    place Part{i} : INT" for i in range(2)]
            lines += [
                "    trans Grip",
                "      in Zone : u",
                "      inhibit Part0",
                "      inhibit Part1",
            ]
            lines += ["      inhibit Step0"] if r.random() < 0.7 else []
            lines += ["      out Part0 : 1", "      out Part1 : 1"]
            lines += [f"    subst G{i} = Gripper (At -> Part{i})" for i in range(2)]
        return lines

    def gripper(self) -> list[str]:
        """A part of a part."""
        if not self.nested:
            return []
        lines = ["  page Gripper", "    place At port io : INT", "    place Closed : INT"]
        return [*lines, "    trans Close", "      in At : n", "      out Closed : n"]


def _taken(kind: str) -> str:
    return {"INT": "n", "PAIR": "(n, kd)", "NUMBERS": "n :: ns", "STRING": "str"}[kind]


def family(r: Random) -> str:
    """A net of two to four parts."""
    parts = r.choice((2, 2, 3, 3, 4))
    odd = r.random() < 0.4
    timed = r.random() < 0.3
    nested = r.random() < 0.15
    made = _Family(r, 2 if nested else parts, odd=odd, timed=timed, nested=nested)
    return made.text().replace("  globref", "  var str: STRING;\n  globref")


# --- by brute force -------------------------------------------------------------------------------


def images(found: Instances) -> list[tuple[Image, Image]]:
    """All permutations of the group: of places, and of transitions, as far as they change something."""
    group: list[tuple[Image, Image]] = [({}, {})]
    for f in found.families:
        own = [_moved(f.parts, order) for order in itertools.permutations(range(len(f.parts)))]
        group = [(_then(a, x), _then(b, y)) for a, b in group for x, y in own]
    return group


def _moved(parts: Sequence[Part], order: Sequence[int]) -> tuple[Image, Image]:
    places: Image = {}
    transitions: Image = {}
    for part, to in zip(parts, order, strict=True):
        places.update(zip(part.places, parts[to].places, strict=True))
        transitions.update(zip(part.transitions, parts[to].transitions, strict=True))
    return places, transitions


def _then(first: Image, second: Image) -> Image:
    keys = {*first, *second}
    return {i: second.get(first.get(i, i), first.get(i, i)) for i in keys}


def keys_of(net: FlatNet, space: StateSpace) -> list[Key]:
    """Markings as texts, place by place; the time, and what references hold, last."""
    game = Game(net, {}, files=Files(None))
    held: dict[Hashable, int] = {}
    return [
        (
            *(
                json.dumps(place_to_json(game.colours, p.colset, m.places[p.index]))
                for p in net.places
            ),
            repr((m.time, held.setdefault(m.references, len(held)))),
        )
        for m in space.nodes
    ]


def turned(key: Key, places: Image) -> Key:
    """The marking after an exchange."""
    after = list(key)
    for i, to in places.items():
        after[to] = key[i]
    return tuple(after)


def compare(explorers: Explorers, net: FlatNet, *options: object, most: int = 1500) -> str:
    """Whether orbits are what the explorer says; "none": no part can be exchanged, "large", "exception"."""
    try:
        found = instances(net, {})
    except GameError:
        return "exception"
    if not found.families:
        return "none"
    space = reference(net, most)
    if not isinstance(space, GameError) and not space.complete:
        return "large"
    table = explorers.folder / "parts"
    table.write_text(found.text())
    stem = explorers.folder / "run."
    for old in explorers.folder.glob("run.*"):
        old.unlink()
    asked = ("--reduce", "symmetry", "--instances", table, "--trace-to", stem, "--traces", 20)
    said = explorers.explore(net, *asked, "--error-trace-to", stem, *options)
    report = said.report
    for run in sorted(explorers.folder.glob("run.*")):
        problem = replay(run, net)
        assert problem.ok, (run.read_text(), problem)
    if isinstance(space, GameError):
        assert report["why"] == "error", (space, report["error"])
        return "exception"
    assert report["complete"], report["error"]
    keys = keys_of(net, space)
    check_group(net, space, keys, found)
    orbits = _orbits(keys, found)
    assert report["nodes"] == len(set(orbits)), (report["nodes"], len(set(orbits)), len(keys))
    busy = {arc.source for arc in space.arcs}
    dead = {orbit for node, orbit in enumerate(orbits) if node not in busy}
    assert report["dead_count"] == len(dead)
    told = found.expanded(Exploration.of(net, report, 0.0))
    occurring = {arc.element.transition for arc in space.arcs}
    assert {i for i, n in enumerate(told.fired) if n} == occurring
    assert told.bounds is not None
    for p in net.places:
        counts = [len(m.places[p.index]) for m in space.nodes]
        own = told.bounds[p.index]
        assert (own.lower, own.upper) == (min(counts), max(counts)), p.name
    return "same"


def check_group(net: FlatNet, space: StateSpace, keys: Sequence[Key], found: Instances) -> None:
    """Whether exchanges map the state space to itself, arc by arc."""
    arcs = {
        (keys[a.source], a.element.transition, _text(a.element), keys[a.target]) for a in space.arcs
    }
    for f in found.families:
        for i in range(1, len(f.parts)):
            order = list(range(len(f.parts)))
            order[0], order[i] = i, 0
            places, transitions = _moved(f.parts, order)
            for a, t, binding, b in arcs:
                image = (turned(a, places), transitions.get(t, t), binding, turned(b, places))
                assert image in arcs, (f.names, net.transitions[t].name)


def _text(element: object) -> str:
    return json.dumps(binding_to_json(element), sort_keys=True)  # type: ignore[arg-type]


def _orbits(keys: Sequence[Key], found: Instances) -> list[Key]:
    group = images(found)
    return [min(turned(key, places) for places, _ in group) for key in keys]


def chosen_names(net: FlatNet, *reductions: Reduction) -> tuple[tuple[str, ...], Diagnostics]:
    """What is exchanged when these are asked for, and the warnings."""
    d = Diagnostics()
    return possible(net, reductions, d).symmetry_names(), d


def line(parts: int) -> str:
    """So many equal robots that take from one heap, pass through one zone, and rest."""
    lines = ["net Line", "  standard", "  var n: INT;", "  page Top", "    place Zone = 1"]
    for i in range(1, parts + 1):
        lines += [
            f"    place Free{i} : INT = 1`0",
            f"    subst R{i} = Robot (Free -> Free{i}, Zone -> Zone)",
        ]
    lines += ["  page Robot", "    place Free port io : INT", "    place Zone port io : UNIT"]
    lines += ["    place Ready : INT", "    place In : INT", "    place Done : INT"]
    lines += ["    trans Go code input (n); action ()", "      in Free : n", "      out Ready : n"]
    lines += ["    trans Enter", "      in Ready : n", "      in Zone", "      out In : n"]
    lines += ["    trans Leave", "      in In : n", "      out Zone", "      out Done : n"]
    return "\n".join(lines) + "\n"
