"""Random nets of processes that share places and references, many in one file, for reductions by transitions.

`concurrent(seed, count)` is a net in the short form of `netbuilder`. `Start` of one of its pages takes the only token
of `Pick`, so that its graph is the union of those of the pages, and one compilation checks all of them. Each page
has two to four processes, whose transitions also take, put, test, inhibit and clear places that they share, have
guards, code segments, conditional and several terms, and priorities; some read and change references. All graphs
are finite: what goes back takes from a budget. With `counters` transitions also change the only tokens of places,
numbers and pairs, in ways of which some commute.
"""

from __future__ import annotations

from random import Random

_HEAD = """net Concurrent
  standard
  colset S = int with 0..2;
  colset L = list S;
  var x, y, z: S;
  var l: L;
  colset C = int with ~60..60;
  colset CS = product C * S;
  var n, m, k: C;
  var a, b: S;
  val first = ref 0;
  val other = ref 0;
  fun next i = (i + 1) mod 3;
  fun bump (c : int ref, i) = (c := (!c + i + 1) mod 3; next i);
  fun some i = if i = 0 then [] else [i];
"""
_SHARED = ("UNIT", "UNIT", "S", "S", "L")
_CODE = (
    "code input (x); output (y); action next x",
    "code input (x); output (y); action 2 - x",
    "code input (x); output (y); action x",
)
_CHANGING = (
    "code input (x); output (y); action bump (first, x)",
    "code input (x); output (y); action bump (other, x)",
)
_READING = (
    "code input (x); output (y); action (x + !first) mod 3",
    "code input (x); output (y); action (x + !other) mod 3",
)
_BECOMES = (
    *("$ + 1", "$ - 1", "$ - x", "x + $", "$ + 2", "$", "$"),
    *(
        "Int.max ($, x)",
        "Int.max ($, 2)",
        "Int.min ($, 1)",
        "2",
        "2",
        "1",
        "2 - $",
        "2 * $",
        "$ - $",
    ),
)
"""What may become of the number on a counter."""


class _Page:
    def __init__(self, r: Random, number: int, counters: int = 0) -> None:
        self.counters = counters
        self.r = r
        self.number = number
        self.lines: list[str] = []
        self.start: list[str] = []
        self.shared: list[tuple[str, str]] = []
        rare = 0.1 if counters else 0.35
        self.has_priorities = r.random() < rare
        self.has_references = r.random() < rare
        self.count = 0

    def text(self) -> str:
        r = self.r
        self.lines = [f"  page N{self.number}", "    place Pick fusion Pick = 1"]
        for i in range(r.randint(1, 3)):
            colset = r.choice(_SHARED)
            self._place(f"G{i}", colset, r.choice((0, 0, 1, 1, 2)))
            self.shared.append((f"G{i}", colset))
        for i in range(self.counters):
            pair = i % 2 == 1
            self.lines.append(f"    place K{i} : {'CS' if pair else 'C'}")
            first = r.randint(0, 2)
            self.start.append(
                f"K{i} : 1`({first}, {r.randint(0, 2)})" if pair else f"K{i} : {first}"
            )
        bodies: list[str] = []
        for k in range(r.randint(2, 4)):
            bodies += self._process(k)
        start = ["    trans Start", "      in Pick : ()", *(f"      out {s}" for s in self.start)]
        return "\n".join([*self.lines, *start, *bodies]) + "\n"

    def _place(self, name: str, colset: str, tokens: int) -> None:
        self.lines.append(f"    place {name} : {colset}")
        value = {"UNIT": "()", "S": str(self.r.randint(0, 2)), "L": "[1, 2]"}[colset]
        if tokens:
            self.start.append(f"{name} : {tokens}`{value}")

    def _process(self, k: int) -> list[str]:
        r = self.r
        length = r.randint(2, 4)
        for i in range(length):
            self._place(f"P{k}_{i}", "S", r.choice((1, 1, 2)) if i == 0 else 0)
        self._place(f"B{k}", "UNIT", r.choice((0, 1, 1)))
        found: list[str] = []
        for i in range(length - 1):
            for _ in range(r.choice((1, 1, 2))):
                found += self._transition(f"P{k}_{i}", f"P{k}_{i + 1}", [])
        if r.random() < 0.4:
            found += self._transition(f"P{k}_{length - 1}", f"P{k}_0", [f"in B{k} : ()"])
        return found

    def _transition(self, here: str, there: str, more: list[str]) -> list[str]:
        r = self.r
        head = f"    trans T{self.count}"
        self.count += 1
        out = "x"
        guard = r.choice(("", "", "", "[x < 2]", "[x <> 1]"))
        if self.has_references and r.random() < 0.3:
            guard = r.choice(("[!first < 2]", "[!other = x]"))
        arcs = [f"in {here} : x", *more]
        for _ in range(r.choice((0, 1, 1, 2) if not self.counters else (0, 0, 0, 0, 1))):
            arcs += self._touch(*r.choice(self.shared))
        if self.counters and r.random() < 0.8:
            i = r.randrange(self.counters)
            more_guard, counting = self._count(f"K{i}", "n", is_pair=i % 2 == 1)
            arcs += counting
            if i + 1 < self.counters and r.random() < 0.3:
                arcs += self._count(f"K{i + 1}", r.choice("mmn"), is_pair=i % 2 == 0)[1]
            guard = guard or more_guard
        code = ""
        if r.random() < 0.4:
            kinds = _CODE if not self.has_references else r.choice((_CODE, _CHANGING, _READING))
            code, out = r.choice(kinds), "y"
        arcs.append(
            f"out {there} : {out}"
            if r.random() < 0.9
            else f"out {there} : if x = 0 then empty else 1`{out}"
        )
        if guard:
            head += f" guard {guard}"
        if self.has_priorities and r.random() < 0.5:
            head += f" priority {r.choice((100, 1000, 10000))}"
        return [f"{head} {code}".rstrip(), *(f"      {a}" for a in dict.fromkeys(arcs))]

    def _count(self, place: str, n: str, *, is_pair: bool) -> tuple[str, list[str]]:
        """A guard and arcs at the place of a counter."""
        r = self.r
        guard = r.choice(("", "", "", "", f"[{n} < 3]", f"[{n} <> 1]"))
        if r.random() < 0.15:
            shown = (
                f"({r.choice((n, '1'))}, {r.choice(('a', '0'))})" if is_pair else r.choice((n, "1"))
            )
            return guard if n in shown else "", [f"both {place} : {shown}"]
        if r.random() < 0.15:
            one = r.choice((0, 1))
            taken = f"({one}, a)" if is_pair else str(one)
            put = r.choice((taken, f"({one + 1}, a)" if is_pair else str(one + 1)))
            return "", [f"in {place} : {taken}", f"out {place} : {put}"]
        becomes = r.choice(_BECOMES).replace("$", n)
        if not is_pair:
            return guard, [f"in {place} : {n}", f"out {place} : {becomes}"]
        other = r.choice(("a", "a", "a", "1", "next a", "x"))
        return guard, [f"in {place} : ({n}, a)", f"out {place} : 1`({becomes}, {other})"]

    def _touch(self, place: str, colset: str) -> list[str]:
        r = self.r
        how = r.choice(("in", "in", "out", "out", "both", "swap", "inhibit", "reset"))
        value = {"UNIT": "()", "S": r.choice(("x", "z", "1", "next x")), "L": "l"}[colset]
        if colset == "L":
            if how == "in":
                return [f"in {place} : z :: l", f"out {place} : l"]
            if how in ("out", "swap"):
                return [f"in {place} : l", f"out {place} : some x ^^ l"]
            if how == "both":
                return [f"both {place} : l"]
        if how in ("inhibit", "reset"):
            return [f"{how} {place}"]
        if how == "swap":
            return [f"in {place} : {value}", f"out {place} : {value if value != 'z' else '2'}"]
        if how == "out":
            return [f"out {place} : {'1' if value == 'z' else value}"]
        if how == "in" and r.random() < 0.2:
            value = f"2`{value}"
        elif how == "in" and colset == "S" and r.random() < 0.2:
            value = "if x = 1 then 1`2 else empty"
        return [f"{how} {place} : {value}"]


def concurrent(seed: int, count: int, counters: int = 0) -> str:
    """A file with so many nets, each with so many counters."""
    pages = [_Page(Random(f"concurrent {seed} {i}"), i, counters).text() for i in range(count)]
    return _HEAD + "".join(pages)
