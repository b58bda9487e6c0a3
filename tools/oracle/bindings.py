"""`./dev oracle --bindings`: generated transitions whose arcs and guards share variables: who refuses them?

    python -m tools.oracle --bindings [N [SEED]]   # 400 transitions; 0 when all verdicts are the same
    python -m tools.oracle --bindings --record     # asks again about those that are kept

Arcs have all kinds of patterns and expressions of all kinds of colour sets, one or several from a place, with and
without coefficients and delays; guards have equations. What the engine refuses has to be refused or warned of here, and
what it accepts must not be refused here, but for what it then cannot compile.
"""

from __future__ import annotations

import json
import random
import tempfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tools.oracle import engine

from helpers.netbuilder import cpn, load

KEPT = engine.ROOT / "tests" / "golden" / "engine_bindings.json"
TOGETHER = 40
"""Transitions in one net, each on a page of its own: an internal error keeps a page from being checked."""
WARNED = {"arcs-share-variables", "guard-equation-repeats"}
"""Warnings where the engine ends with an internal error, or takes variables for others."""
HEAD = """
net N
  standard
  colset E = with e1 | e2;
  colset P = product INT * INT;
  colset R = record a: INT * b: INT;
  colset L = list INT;
  colset U = union ua: INT + ub: P + uc;
  colset TP = product INT * INT timed;
  colset TI = int timed;
  colset TL = list INT timed;
  colset S = product E * E;
  colset Q = product INT * L;
  var a, b, c, d: INT; var u, v: E; var l, m: L; var p, q: P; var r: R; var s: S; var x: U;
  val four = 4;
  fun f n = n + 1;
  fun g (n: int) = 1`n;
  fun h (n, k) = n + k;
"""
PLACES = {
    "Pi": "INT", "Pp": "P", "Pr": "R", "Pl": "L", "Pu": "U", "Tp": "TP", "Ti": "TI", "Tl": "TL", "Ps": "S", "Pe": "E",
    "Pq": "Q",
}  # fmt: skip
UNTIMED = {"TP": "P", "TI": "INT", "TL": "L"}
GUARDS = (
    "a = b", "b = a", "c = a+b", "d = f c", "(a,b) = p", "a::l = m", "l = a::m", "u = v", "length l > 0",
    "h (a,b) = c", "a*a = 4", "a > b andalso c = d", "not (a=b)", "c = c + 1", "p = (a,b)", "#1 p = a", "#a r = b",
    "l = [a]", "x = ua a", "a = (a)", "f a = f b",
)  # fmt: skip

Item = tuple[list[tuple[str, str, str]], list[str]]
"""The arcs (kind, place, inscription) and the conditions of a transition."""


class Writer:
    """Writes transitions."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)

    def one(self, *choices: str) -> str:
        """One of them."""
        return self.random.choice(choices)

    def item(self) -> Item:
        """A transition with arcs from one or two places."""
        places = self.random.sample(list(PLACES), self.random.choice([1, 2, 2]))
        arcs = []
        for _ in range(self.random.choice([1, 2, 2, 2, 3, 3, 4])):
            kind = "both" if self.random.random() < 0.12 else "in"
            place = self.one(*places)
            arcs.append((kind, place, self.arc(PLACES[place])))
        return arcs, [self.guard() for _ in range(self.random.choice([0, 0, 0, 1, 1, 2]))]

    def arc(self, colset: str) -> str:
        """An input inscription."""
        which = self.random.random()
        if which < 0.55:
            return self.value(colset)
        if which < 0.95:
            number = 1 if which < 0.65 else 2 if which < 0.9 else 3
            return " ++ ".join(self.term(colset) for _ in range(number))
        if colset in UNTIMED and self.random.random() < 0.5:
            return f"{self.value(colset)}@+{self.one('1', 'a', 'b')}"
        if colset in UNTIMED:
            return f"({self.term(colset)})@+{self.one('1', 'a')} +++ ({self.term(colset)})@+2"
        return f"if {self.one('a>1', 'b=1')} then {self.term(colset)} else empty"

    def term(self, colset: str) -> str:
        """A value and its coefficient."""
        value = self.value(colset)
        is_closed = value.isalnum() or (value[0] in "[{" and value[-1] in "]}")
        is_closed = is_closed or (value[0] == "(" and value[-1] == ")" and value.count("(") == 1)
        which = self.random.random()
        number = "1" if which < 0.7 else "2" if which < 0.85 else None
        number = number or self.one("a", "b", "(a)", "(f a)", "four", "(size l)", "0")
        return f"{number}`{value if is_closed else f'({value})'}"

    def value(self, colset: str) -> str:
        """A value that binds, tests, or both."""
        is_whole = self.random.random() < 0.2
        a, b = self.number(), self.number()
        match UNTIMED.get(colset, colset):
            case "INT":
                return a
            case "P":
                return self.one("p", "q") if is_whole else f"({a},{b})"
            case "R":
                return "r" if is_whole else self.one(f"{{a={a},b={b}}}", f"{{b={a},a={b}}}")
            case "L":
                return self.list()
            case "U":
                return self.one("x", f"ua({a})", f"ub(({a},{b}))", "uc", "ua a", "ua b")
            case "E":
                return self.small()
            case "S":
                return "s" if is_whole else f"({self.small()},{self.small()})"
            case _:
                return f"({a},{self.list()})"

    def number(self) -> str:
        """An integer."""
        if self.random.random() < 0.9:
            return self.one("a", "b", "c", "d", "a", "b", "1", "four")
        return self.one("f a", "a+1", "f b", "(#1 p)")

    def small(self) -> str:
        """A value of the small colour set."""
        return self.one("u", "v", "u", "v", "e1")

    def list(self) -> str:
        """A list."""
        a = self.number()
        return self.one(
            "l", "m", f"{a}::l", f"{a}::m", f"[{a}]", f"[{a},{self.number()}]", "[]", "l^^[a]", "tl l", "a::rev m",
            "l^^m", "a::b::l", "b::l",
        )  # fmt: skip

    def guard(self) -> str:
        """A condition."""
        which = self.random.random()
        if which < 0.35:
            return f"{self.number()} {self.one('=', '=', '>', '<>')} {self.number()}"
        if which < 0.75:
            colset = self.one("INT", "INT", "INT", "P", "L", "E", "R")
            return f"{self.value(colset)} = {self.value(colset)}"
        return self.one(*GUARDS)


def text(items: Sequence[Item]) -> str:
    """A net with a page for each transition."""
    lines = [HEAD]
    for i, (arcs, guards) in enumerate(items):
        lines.append(f"  page G{i}")
        lines += [f"    place {p}{i} : {PLACES[p]}" for p in dict.fromkeys(p for _, p, _ in arcs)]
        lines.append(f"    trans T{i}")
        lines += [f"      guard [{', '.join(guards)}]"] if guards else []
        lines += [f"      {kind} {place}{i} : {inscription}" for kind, place, inscription in arcs]
    return "\n".join(lines)


def packs(items: Sequence[Any]) -> list[Sequence[Any]]:
    """Some together."""
    return [items[n : n + TOGETHER] for n in range(0, len(items), TOGETHER)]


def ask(items: Sequence[Item]) -> list[str]:
    """The first error of the engine for each, or an empty text."""
    with tempfile.TemporaryDirectory() as folder:
        paths = []
        for n, pack in enumerate(packs(items)):
            paths.append(Path(folder, f"n{n}.cpn"))
            paths[-1].write_bytes(cpn(text(pack)))
        answers = engine.check(paths)
    said = []
    for pack, answer in zip(packs(items), answers, strict=True):
        for i in range(len(pack)):
            found = [e["message"] for e in answer["errors"] if e["page"] == f"G{i}"]
            said.append(found[0].partition("\n")[0][:60] if found else "")
    return said


def ours(items: Sequence[Item]) -> list[tuple[str, list[str]]]:
    """For each `refused`, `warned` or `accepted`, and the codes."""
    found = []
    for pack in packs(items):
        _, d = load(text(pack))
        for i in range(len(pack)):
            own = [e for e in d.items if e.origin is not None and e.origin.page == f"G{i}"]
            codes = [e.code for e in own]
            is_refused = any(e in d.errors for e in own)
            is_warned = not WARNED.isdisjoint(codes)
            found.append(
                ("refused" if is_refused else "warned" if is_warned else "accepted", codes)
            )
    return found


def differs(said: str, verdict: str, codes: Sequence[str]) -> bool:
    """Whether the engine's verdict is another one than ours."""
    if said:
        return verdict == "accepted"
    return verdict == "refused" and set(codes).isdisjoint({"unbound-variable"})


def record() -> None:
    """Asks about what is kept."""
    kept = json.loads(KEPT.read_text(encoding="utf-8"))
    items = [([tuple(a) for a in arcs], guards) for arcs, guards, _ in kept]
    rows = [[*item, said] for item, said in zip(items, ask(items), strict=True)]
    write(rows)


def write(rows: Sequence[Any]) -> None:
    """A line each."""
    lines = [json.dumps(row) for row in rows]
    KEPT.write_text("[\n" + ",\n".join(lines) + "\n]\n", encoding="utf-8")


def main(arguments: Sequence[str]) -> int:
    """0 when all verdicts are the same."""
    if list(arguments) == ["--record"]:
        record()
        return 0
    number, seed = (*map(int, arguments), *(400, 1209)[len(arguments) :])
    writer = Writer(seed)
    items = [writer.item() for _ in range(number)]
    counts: Counter[str] = Counter()
    for item, said, (verdict, codes) in zip(items, ask(items), ours(items), strict=True):
        is_other = differs(said, verdict, codes)
        counts["differs" if is_other else f"{verdict} here, {'not ' * bool(said)}there"] += 1
        if is_other:
            print(f"{item}: {said or 'accepted'}; here {verdict} {codes}")
    print(f"{number} transitions: {dict(counts)}")
    return 1 if counts["differs"] else 0
