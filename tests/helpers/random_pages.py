"""Random pages of a robot, and their scripts beside them: messages and variables of all kinds,
ranges that are narrower than what is taken, ways that conditions choose, priorities, commands with arguments.

    page = random_page(Random(7))
    difference(folder, page)          # "": the script does what its page does; None: the page has no script
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from random import Random

from helpers.robots import Cell
from helpers.scripts import checked
from pn2code.conform.robot import explore
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.marking import place_from_json
from pn2code.semantics.game.token_game import Game, GameError

MOST = 400
"""States of a page and its script that are compared; those of the nets go on for ever."""

_NO_DIFFERENCE = ("which holds one", "illegal colour", "endless loop", "the duration ", " speed ")
"""Deviations that are the page's own fault, as `verify` says: it sends on before its message has been taken
(`channels`), it puts what is not in the colour set of a place, it goes round for ever, or it asks for what no robot can
carry out, a time or a speed that is negative (`non-blocking`)."""

_EXTRA = """
  colset SMALL = int with 0..3;
  colset TINY = int with 1..2;
  colset SHARE = real with 0.0..1.0;
  colset TWO = product SMALL * COLOUR;
  colset NEAR = product TINY * COLOUR;
  colset REC = record a : INT * b : BOOL;
  val P_HIGH = 100;  val P_LOW = 10000;
  fun rest (s : int) = ();
  val press = fn () => ();
  fun lineAt (p : POSE, v : real) = ();
  fun turn (p : POSE, v : int) = ();
  fun at w = {x = w, y = 0.0, z = 500.0, rx = 0.0, ry = 0.0, rz = 90.0};
  fun half a = a div 2;
  var r, r2 : SHARE;
  var tiny, tiny2 : TINY;
  var small, small2 : SMALL;
  var two : TWO;  var near : NEAR;
  var rec1 : REC;
  var c, c2 : COLOUR;  var w2 : REAL;  var t, t2 : STRING;  var b2 : BOOL;
"""
_PRIMITIVES = """rest = { command = "wait" }
press = { command = "tool", action = "press", duration_s = 1.0 }
lineAt = { command = "move_linear", frame = "world" }
turn = { command = "move_joint" }
"""

_VALUES: Mapping[str, tuple[object, ...]] = {
    "INT": (0, 1, 2, 5, -1),
    "SMALL": (0, 1, 3),
    "TINY": (1, 2),
    "BOOL": (True, False),
    "COLOUR": ("red", "green", "blue"),
    "REAL": (0.5, -0.0, 2.0),
    "SHARE": (0.25, 1.0),
    "STRING": ("", 'a"b', "x"),
    "TWO": ([0, "red"], [2, "blue"]),
    "NEAR": ([1, "red"], [2, "green"]),
    "REC": ({"a": 1, "b": True}, {"a": -2, "b": False}),
}
_TAKEN: Mapping[str, tuple[str, ...]] = {
    "INT": ("n", "n", "k", "small", "tiny", "1"),
    "SMALL": ("small", "n", "tiny", "2"),
    "TINY": ("tiny", "small2", "n", "1"),
    "BOOL": ("a", "b", "true"),
    "COLOUR": ("c", "c2", "red"),
    "REAL": ("w", "r", "w2"),
    "SHARE": ("r", "w"),
    "STRING": ("t", "t2", '"x"'),
    "TWO": ("two", "near", "(small, c)", "(tiny, c)", "(n, red)", "(1, c)"),
    "NEAR": ("near", "two", "(tiny, c)", "(n, c2)"),
    "REC": ("rec1", "{a = n, b = a}", "{a = small, b = b}", "{a = 1, b = b}"),
}
"""What an arc says: variables of the place's own colour set, of narrower and wider ones, constants, patterns."""
_IDLE: Mapping[str, str] = {
    "INT": "1`1", "SMALL": "1`1", "TINY": "1`1", "BOOL": "1`true", "COLOUR": "1`red", "REAL": "1`0.5",
    "SHARE": "1`0.5", "STRING": '1`"x"', "TWO": "1`(1, red)", "NEAR": "1`(1, red)",
    "REC": "1`{a = 1, b = true}",
}  # fmt: skip
_NAMES = {
    "int": ("n", "k", "small", "small2", "tiny", "tiny2"),
    "bool": ("a", "b"),
    "colour": ("c", "c2"),
    "real": ("w", "w2", "r"),
    "string": ("t", "t2"),
}


@dataclass(frozen=True)
class Page:
    """A page in the short form, its channels, and the messages that come, by channel."""

    text: str
    channels: tuple[str, ...]
    messages: Mapping[str, tuple[object, ...]]


class _Maker:
    def __init__(self, r: Random) -> None:
        self.r = r
        colsets = list(_VALUES)
        self.into = {f"x{i}": r.choice(colsets) for i in range(r.randint(1, 2))}
        self.out = {
            f"y{i}": r.choice(["INT", "INT", r.choice(colsets)]) for i in range(r.randint(1, 2))
        }
        self.control = {
            f"C{i}": r.choice(["UNIT", "UNIT", r.choice(colsets)]) for i in range(r.randint(1, 3))
        }
        self.control["C0"] = "UNIT"
        self.kept = {f"V{i}": r.choice(colsets) for i in range(r.randint(0, 2))}
        self.lines = ["place C0 = 1"]
        self.lines += [f"place {p} : {c}" for p, c in self.control.items() if p != "C0"]
        self.lines += [f"place {p} : {c} = {_IDLE[c]}" for p, c in self.kept.items()]
        for i in range(r.randint(1, 4)):
            self.transition(f"T{i}")

    def transition(self, name: str) -> None:
        r = self.r
        here = r.choice(list(self.control)) if name != "T0" else "C0"
        arcs: list[str] = []
        bound: set[str] = set()

        def take(kind: str, place: str, colset: str) -> str:
            taken = "()" if colset == "UNIT" else r.choice(_TAKEN[colset])
            arcs.append(f"{kind} {place} : {taken}")
            bound.update(_variables(taken))
            return taken

        take("in", here, self.control[here])
        for place, colset in self.into.items():
            if r.random() < 0.5:
                take("in", place, colset)
        changed = []
        for place, colset in self.kept.items():
            if r.random() < 0.5:
                is_changed = r.random() < 0.6
                take("in" if is_changed else "both", place, colset)
                changed += [place] if is_changed else []
        guard = (
            f" guard [{', '.join(self.truth(bound, 1) for _ in range(r.randint(1, 2)))}]"
            if r.random() < 0.4
            else ""
        )
        if guard and r.random() < 0.2:
            guard = guard[:-1] + f", small = {self.number(bound, 1)}]"
            bound.add("small")
        for place in changed:
            arcs.append(f"out {place} : {self.value(self.kept[place], bound)}")
        there = r.choice(list(self.control))
        value = self.value(self.control[there], bound)
        if r.random() < 0.25 and bound:
            other = r.choice(list(self.control))
            if other != there:
                test = self.truth(bound, 1)
                arcs.append(f"out {there} : if {test} then 1`({value}) else empty")
                arcs.append(
                    f"out {other} : if {test} then empty else 1`({self.value(self.control[other], bound)})"
                )
                there = ""
        if there:
            arcs.append(f"out {there} : {value}")
        for place, colset in self.out.items():
            if r.random() < 0.4:
                arcs.append(f"out {place} : {self.value(colset, bound)}")
        is_waiting = any(arc.startswith("in x") for arc in arcs)
        code = self.code(bound, is_needed=not is_waiting)  # else it would go round for ever
        priority = r.choice(["", "", "", " priority P_HIGH", " priority P_LOW"])
        self.lines.append(f"trans {name}{guard}{priority}{code}")
        self.lines += [f"  {arc}" for arc in arcs]

    def code(self, bound: set[str], *, is_needed: bool) -> str:
        r = self.r
        if not is_needed and r.random() < 0.5:
            return ""
        given = f"input ({', '.join(sorted(bound))}); " if bound else ""
        acts = r.choice(
            [
                "drill ()",
                "press ()",
                f"rest ({self.number(bound, 1)})",
                f"pause ({self.real(bound)})",
                f"moveJoint (at ({self.real(bound)}))",
                f"lineAt (at ({self.real(bound)}), {self.real(bound)})",
                f"turn (at 300.0, {self.number(bound, 1)})",
                f"(if {self.truth(bound, 1)} then drill () else press ())",
                f"let val h = {self.number(bound, 1)} in (press (); if h > 1 then rest h else ()) end",
            ]
        )
        return f" code {given}action {acts}"

    # --- expressions ---------------------------------------------------------------------------

    def named(self, bound: set[str], kind: str) -> list[str]:
        return [x for x in _NAMES[kind] if x in bound]

    def number(self, bound: set[str], depth: int) -> str:
        r = self.r
        own = self.named(bound, "int") or ["1", "2"]
        own += ["#a rec1"] * ("rec1" in bound) + ["#1 two"] * ("two" in bound)
        if depth == 0 or r.random() < 0.4:
            return r.choice([*own, *own, "0", "1", "2", "3"])
        a, b = self.number(bound, depth - 1), self.number(bound, depth - 1)
        return r.choice(
            [f"({a} + {b})", f"({a} - {b})", f"({a} * {b})", f"half ({a})", f"({a} mod 3)", f"({a} div {b})",
             f"(if {self.truth(bound, depth - 1)} then {a} else {b})", f"Int.max ({a}, {b})",
             f"(case {a} of 0 => {b} | _ => 1)"]
        )  # fmt: skip

    def real(self, bound: set[str]) -> str:
        own = self.named(bound, "real") or ["1.5"]
        a = self.r.choice([*own, "0.5", f"Real.fromInt ({self.number(bound, 1)})"])
        return self.r.choice([a, a, f"({a} * 2.0)", f"({a} - 1.0)", f"({a} / 2.0)"])

    def truth(self, bound: set[str], depth: int) -> str:
        r = self.r
        forms = [
            f"{self.number(bound, depth)} {r.choice(['<', '>=', '=', '<>'])} {self.number(bound, 0)}"
        ]
        forms += [
            f"{x} {r.choice(['=', '<>'])} {r.choice(['red', 'green'])}"
            for x in self.named(bound, "colour")
        ]
        forms += self.named(bound, "bool")
        forms += [f"{x} {r.choice(['<', '>='])} 0.5" for x in self.named(bound, "real")]
        forms += [f'{x} = "x"' for x in self.named(bound, "string")]
        forms += ["#b rec1"] * ("rec1" in bound) + ["#2 two = red"] * ("two" in bound)
        one = r.choice(forms)
        if depth and r.random() < 0.3:
            return f"({one} {r.choice(['andalso', 'orelse'])} {r.choice(forms)})"
        return f"not ({one})" if r.random() < 0.15 else one

    def value(self, colset: str, bound: set[str]) -> str:
        r = self.r
        match colset:
            case "UNIT":
                return "()"
            case "INT" | "SMALL" | "TINY":
                return self.number(bound, 1)
            case "BOOL":
                return r.choice(["true", self.truth(bound, 1)])
            case "COLOUR":
                return r.choice(
                    [
                        *self.named(bound, "colour"),
                        "blue",
                        f"if {self.truth(bound, 0)} then red else green",
                    ]
                )
            case "REAL" | "SHARE":
                return self.real(bound)
            case "STRING":
                own = r.choice([*self.named(bound, "string"), '"x"'])
                return r.choice([own, f'({own} ^ "y")'])
            case "TWO" | "NEAR":
                whole = [x for x in ("two", "near") if x in bound]
                return r.choice(
                    [*whole, f"({self.number(bound, 1)}, {self.value('COLOUR', bound)})"]
                )
        return r.choice([*(["rec1"] if "rec1" in bound else []),
                         f"{{a = {self.number(bound, 1)}, b = {self.truth(bound, 1)}}}"])  # fmt: skip

    def made(self) -> Page:
        r = self.r
        channels = [f"{x} in {c}" for x, c in self.into.items()] + [
            f"{y} out {c}" for y, c in self.out.items()
        ]
        used = "\n".join(self.lines)
        # A channel that nothing touches is none.
        for name in (*self.into, *self.out):
            if f" {name} :" not in used:
                kind = "in" if name in self.into else "out"
                colset = {**self.into, **self.out}[name]
                taken = r.choice(_TAKEN[colset]) if kind == "in" else self.value(colset, set())
                self.lines += [
                    f"trans U{name} code action drill ()",
                    "  both C0 : ()",
                    f"  {kind} {name} : {taken}",
                ]
        # One of each: nobody keeps the other side from sending a second one too early.
        messages = {x: (r.choice(_VALUES[c]),) for x, c in self.into.items()}
        return Page("\n".join(self.lines), tuple(channels), messages)


def _variables(taken: str) -> set[str]:
    known = {x for names in _NAMES.values() for x in names} | {"two", "near", "rec1"}
    for mark in "(){},=":
        taken = taken.replace(mark, " ")
    return {x for x in taken.split() if x in known}


def random_page(r: Random) -> Page:
    """A page."""
    return _Maker(r).made()


def difference(folder: Path, page: Page) -> str | None:
    """What the script does that its page does not, or not: "": nothing; None: the page has no script."""
    extra = _EXTRA + "".join(f"  var m{c.split()[0]} : {c.split()[2]};\n" for c in page.channels)
    cell = Cell(folder, page.text, page.channels, extra=extra, primitives=_PRIMITIVES)
    if cell.ir is None or any(x.startswith("error") for x in cell.messages):
        return None
    net = cell.partition.net
    colsets = {p.name: p.colset for p in net.places}
    initial = {}
    for name, values in page.messages.items():
        place = f"Top.Supervisor.Source_{name}"
        counted = [[values.count(v), v] for i, v in enumerate(values) if v not in values[:i]]
        initial[place] = place_from_json(colsets[place], counted)
    assert cell.config is not None
    game = Game(net, cell.config.storage, initial=initial, files=Files(None))
    try:
        found = explore(cell.partition, cell.config, 1, checked(cell.text), game, most=MOST)
    except GameError as error:
        return f"the game: {error}"
    why = found.deviation or ""
    return (
        ""
        if not why or any(x in why for x in _NO_DIFFERENCE)
        else f"{why}\n{found.way}\n{cell.body}"
    )
