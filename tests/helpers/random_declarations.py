# ruff: noqa: E501 - rows of texts
"""Sheets of declarations and inscriptions: every type at every position, many small cases in one net.

`sheet(number, size)` takes cases `number * size`, `number * size + 1`, ...: case c is of type c modulo the types and at
a position that changes when all types are through, with random expressions. Each case has places and a transition of its
own, so one compilation checks all of a sheet, and `Sheet.text(only)` is the net of some of its cases.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from random import Random

from helpers.random_nets import BOOL, INT, REAL, STRING, UNIT, Kind, Scope, Writer

BIG = Kind("INTINF", "big")
MOMENT = Kind("TIME", "moment")
_HEAD = """
  colset D0 = unit with dot;
  colset D1 = bool with (no, yes);
  colset D2 = int with 0..5;
  colset D3 = int with ~3..3;
  colset D4 = intinf with ~9..9;
  colset D5 = real with 0.0..9.5;
  colset D6 = string with "a".."c" and 0..2;
  colset D7 = with red | green | blue;
  colset D8 = with only;
  colset D9 = index ix with 0..3;
  colset D10 = product INT * UNIT;
  colset D11 = product D7 * REAL * STRING;
  colset D12 = record a: INT * u: UNIT * b: BOOL;
  colset D13 = record x: D7;
  colset D14 = list INT;
  colset D15 = list UNIT;
  colset D16 = list D7 with 0..4;
  colset D17 = union Nil0 + Int0: INT + Unit0: UNIT + Pair0: D10;
  colset D18 = union No1 + Yes1;
  colset D19 = subset D2 with [1, 3];
  fun positive i = i > 0;
  colset D20 = subset INT by positive;
  colset D21 = D12;
  colset D22 = list D17;
  colset D23 = product UNIT * UNIT;
  colset D24 = union One1: UNIT;
  colset D25 = product D2 * BOOL;
  colset WRAP = list STRING;
  fun twice x = (x, x);
  fun first (x, _) = x;
  fun apply f x = f x;
  datatype 'a tree = Leaf | Knot of 'a tree * 'a * 'a tree;
  fun top Leaf d = d | top (Knot (_, x, _)) _ = x;
"""


def kinds() -> list[Kind]:
    """All colour sets, with what `Writer` wants to know of them."""
    colours = Kind("D7", "enum", names=("red", "green", "blue"), size=3)
    small = Kind("D2", "range", size=6)
    pair = Kind("D10", "product", (("", INT), ("", UNIT)))
    union = Kind("D17", "union", (("Nil0", None), ("Int0", INT), ("Unit0", UNIT), ("Pair0", pair)))
    record = (("a", INT), ("u", UNIT), ("b", BOOL))
    return [
        UNIT, BOOL, INT, BIG, MOMENT, REAL, STRING,
        Kind("D0", "enum", names=("dot",)),
        Kind("D1", "enum", names=("no", "yes")),
        small,
        Kind("D3", "subset", names=("(~3)", "0", "2"), base=INT),
        Kind("D4", "big"),
        Kind("D5", "real"),
        Kind("D6", "letters"),
        colours,
        Kind("D8", "enum", names=("only",), size=1),
        Kind("D9", "index", names=("ix",), size=4),
        pair,
        Kind("D11", "product", (("", colours), ("", REAL), ("", STRING))),
        Kind("D12", "record", record),
        Kind("D13", "record", (("x", colours),), size=3),
        Kind("D14", "list", (("", INT),)),
        Kind("D15", "list", (("", UNIT),)),
        Kind("D16", "list", (("", colours),)),
        union,
        Kind("D18", "union", (("No1", None), ("Yes1", None)), size=2),
        Kind("D19", "subset", names=("1", "3"), base=small),
        Kind("D20", "subset", names=("1", "2", "7"), base=INT),
        Kind("D21", "record", record),
        Kind("D22", "list", (("", union),)),
        Kind("D23", "product", (("", UNIT), ("", UNIT)), size=1),
        Kind("D24", "union", (("One1", UNIT),), size=1),
        Kind("D25", "product", (("", small), ("", BOOL)), size=12),
    ]  # fmt: skip


@dataclass(frozen=True, slots=True)
class Case:
    """One of them: its number, what it is about, its declarations, and what it has on the page."""

    number: int
    about: str
    declarations: tuple[str, ...]
    elements: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Sheet:
    """A net of cases."""

    cases: tuple[Case, ...]

    def text(self, *only: int) -> str:
        """The net; of some cases only, by their numbers."""
        cases = [c for c in self.cases if not only or c.number in only]
        own = [f"  {line}" for c in cases for line in c.declarations]
        elements = [f"    {line}" for c in cases for line in c.elements]
        head = ["net Sheet", "  standard", *_HEAD.strip("\n").splitlines()]
        variables = [
            f"  var {', '.join(f'{v}{k.name}' for v in 'vwx')}: {k.name};" for k in kinds()
        ]
        return "\n".join([*head, *variables, *own, "  page Top", *elements]) + "\n"


def sheet(number: int, size: int) -> Sheet:
    """Sheet number so-and-so, with so many cases."""
    return Sheet(tuple(case(i) for i in range(number * size, (number + 1) * size)))


def case(number: int) -> Case:
    """Case number so-and-so."""
    every = kinds()
    kind = every[number % len(every)]
    position = POSITIONS[number // len(every) % len(POSITIONS)]
    writer = _Cases(Random(f"declarations {number}"), number, kind)
    position(writer)
    return Case(
        number, f"{kind.name}: {position.__name__}", tuple(writer.own), tuple(writer.elements)
    )


class _Cases(Writer):
    """Writes one case."""

    def __init__(self, r: Random, number: int, kind: Kind) -> None:
        super().__init__(r)
        self.kinds = kinds()
        self.n = number
        self.k = kind
        self.own: list[str] = []
        self.elements: list[str] = []
        self.depth = number // 2000 % 3

    # --- expressions

    def plain(self, kind: Kind, scope: Scope, depth: int) -> str:
        r = self.r
        match kind.kind:
            case "big" if kind.name == "D4":
                return r.choice(("(IntInf.fromInt 3)", "(IntInf.fromInt ~7)", "(2 : IntInf.int)"))
            case "big":
                return r.choice(
                    (
                        "(IntInf.fromInt 3)",
                        "(IntInf.pow (10, 30))",
                        "(5 : IntInf.int)",
                        "(~ (IntInf.pow (7, 40)))",
                    )
                )
            case "moment":
                return r.choice(("(ModelTime.fromInt 3)", "(ModelTime.fromInt 0)"))
            case "real" if kind.name == "D5":
                return r.choice(("0.0", "1.5", "9.5"))
        return super().plain(kind, scope, depth)

    def compound(self, kind: Kind, scope: Scope, depth: int) -> str | None:
        """What leaves the colour set is not wanted here."""
        if kind.name in ("D5", "D16") and self.r.randrange(9) > 5:
            return None
        made = super().compound(kind, scope, depth)
        if made is not None and kind.name == "D5":
            return f"(if {kind.name}.legal {made} then {made} else 0.0)"
        if made is not None and kind.name == "D16":
            return f"(List.take ({made}, 0))"
        return made

    def pattern(self, kind: Kind, scope: Scope, depth: int) -> str:
        """Names are as in the head."""
        if kind.kind in ("big", "moment", "real") or (depth < 2 and self.chance(0.5)):
            name = f"{self.r.choice('vwx')}{kind.name}"
            scope.add(name, kind)
            return name
        return super().pattern(kind, scope, depth)

    def component(self, small: bool = False) -> Kind:
        known = [
            k
            for k in self.kinds
            if k.kind not in ("big", "moment") and (not small or 0 < k.size <= 6)
        ]
        return self.r.choice(known)

    def e(self, *bound: tuple[str, Kind]) -> str:
        """A value of the case's type."""
        return f"({self.value(self.k, Scope(list(bound)), self.depth)} : {self.k.name})"

    # --- pieces

    def declare(self, *lines: str) -> None:
        self.own += lines

    def place(self, name: str, kind: str, initial: str = "") -> str:
        self.elements.append(f"place {name}{self.n} : {kind}{f' = {initial}' if initial else ''}")
        return f"{name}{self.n}"

    def transition(self, *lines: str) -> None:
        self.elements += [f"trans T{self.n}", *(f"  {line}" for line in lines)]

    def puts(self, text: str, *clauses: str) -> None:
        """A transition that occurs once and puts something."""
        a, b = self.place("A", "UNIT", "1`()"), self.place("B", self.k.name)
        self.transition(*clauses, f"in {a} : ()", f"out {b} : {text}")

    def starts(self, initial: str, *clauses: str) -> None:
        """An initial marking, from which tokens are moved."""
        a, b = self.place("A", self.k.name, initial), self.place("B", self.k.name)
        self.transition(*clauses, f"in {a} : v{self.k.name}", f"out {b} : v{self.k.name}")


def _positions() -> list[Callable[[_Cases], None]]:
    def value_as_marking(c: _Cases) -> None:
        c.declare(f"val d{c.n} = {c.e()};")
        c.starts(f"d{c.n}")

    def value_counted(c: _Cases) -> None:
        c.declare(f"val d{c.n} = {c.e()};")
        c.starts(f"1`d{c.n} ++ 2`{c.e()}")

    def untyped_value(c: _Cases) -> None:
        c.declare(f"val d{c.n} = {c.plain(c.k, Scope(), 1)};")
        c.starts(f"2`d{c.n}")

    def value_taken(c: _Cases) -> None:
        c.declare(f"val d{c.n} = {c.e()};")
        a, b = c.place("A", c.k.name, f"1`d{c.n} ++ 1`{c.e()}"), c.place("B", "UNIT")
        c.transition(f"in {a} : d{c.n}", f"out {b} : ()")

    def value_taken_counted(c: _Cases) -> None:
        c.declare(f"val d{c.n} = {c.e()};")
        a, b = c.place("A", c.k.name, f"2`d{c.n}"), c.place("B", c.k.name)
        c.transition(f"in {a} : 1`d{c.n}", f"both {a} : 1`d{c.n}", f"out {b} : d{c.n}")

    def value_put(c: _Cases) -> None:
        c.declare(f"val d{c.n} = {c.e()};")
        c.puts(
            c.r.choice(
                (
                    f"d{c.n}",
                    f"1`d{c.n}",
                    f"1`d{c.n} ++ 1`{c.e()}",
                    f"if true then 1`d{c.n} else empty",
                )
            )
        )

    def value_of_values(c: _Cases) -> None:
        c.declare(
            f"val (d{c.n}, (g{c.n}, _)) = ({c.e()}, twice {c.e()});",
            f"val h{c.n} = [d{c.n}, g{c.n}];",
        )
        c.puts(c.r.choice((f"g{c.n}", f"hd h{c.n}", f"List.last h{c.n}", f"#1 (twice d{c.n})")))

    def computed_value(c: _Cases) -> None:
        c.declare(
            f"fun g{c.n} 0 = {c.e()} | g{c.n} (n : int) = g{c.n} (n - 1);",
            f"val d{c.n} = g{c.n} 2;",
        )
        c.starts(f"1`d{c.n}")

    def taken_expression(c: _Cases) -> None:
        text = c.e()
        a, b = c.place("A", c.k.name, f"1`{text}"), c.place("B", "UNIT")
        c.transition(f"in {a} : if true then 1`{text} else empty", f"out {b} : ()")

    def function(c: _Cases) -> None:
        takes = c.component()
        c.declare(f"fun f{c.n} (p : {takes.name}) : {c.k.name} = {c.e(('p', takes))};")
        given = f"({c.value(takes, Scope(), 1)} : {takes.name})"
        (c.puts if c.chance(0.5) else c.starts)(f"1`(f{c.n} {given})")

    def function_of_it(c: _Cases) -> None:
        c.declare(f"fun f{c.n} (p : {c.k.name}) = ({c.e(('p', c.k))}, p);")
        c.puts(f"#2 (f{c.n} {c.e()})")

    def function_by_cases(c: _Cases) -> None:
        pattern, names = "x", ["x", "x"]
        while len(set(names)) < len(names):
            scope = Scope()
            pattern = c.pattern(c.k, scope, 2)
            names = re.findall(r"[vwx][A-Z]\w*", pattern)
        c.declare(
            f"fun f{c.n} {pattern if pattern.isidentifier() else f'({pattern})'} = true{'' if pattern.isidentifier() and pattern[0] in 'vwx' else f' | f{c.n} _ = false'};"
        )
        a, b = c.place("A", c.k.name, c.e()), c.place("B", "BOOL")
        c.transition(f"in {a} : v{c.k.name}", f"out {b} : f{c.n} v{c.k.name}")

    def curried(c: _Cases) -> None:
        c.declare(f"fun f{c.n} (p : {c.k.name}) () q = if q then p else {c.e(('p', c.k))};")
        c.puts(f"f{c.n} {c.e()} () {c.value(BOOL, Scope(), 1)}")

    def let_bound(c: _Cases) -> None:
        c.puts(c.r.choice((
            f"let val y = {c.e()} in y end", f"let val y = {c.e()} val z = y in 1`z end", f"let val (y, z) = ({c.e()}, 3) in y end",
            f"let val y = {c.e()} in if true then 1`y else empty end", f"let val _ = {c.e()} in {c.e()} end",
        )))  # fmt: skip

    def let_in_marking(c: _Cases) -> None:
        c.starts(
            c.r.choice(
                (
                    f"let val y = {c.e()} in 1`y end",
                    f"1`(let val (y, _) = twice {c.e()} in y end)",
                    f"if true then 1`{c.e()} else 1`{c.e()}",
                )
            )
        )

    def pattern(c: _Cases) -> None:
        scope = Scope()
        taken = c.pattern(c.k, scope, 2)
        a, b = (
            c.place("A", c.k.name, " ++ ".join(f"1`{c.e()}" for _ in range(3))),
            c.place("B", c.k.name),
        )
        c.transition(f"in {a} : 1`({taken})", f"out {b} : {c.value(c.k, scope, c.depth)}")

    def guard_tests(c: _Cases) -> None:
        a, b = (
            c.place("A", c.k.name, " ++ ".join(f"1`{c.e()}" for _ in range(3))),
            c.place("B", c.k.name),
        )
        x, op = f"v{c.k.name}", c.r.choice(("=", "<>"))
        c.transition(
            f"guard [{c.e((x, c.k))} {op} {x}]"
            if c.k.has_equality
            else f"guard [{c.k.name}.lt ({x}, {c.e()})]",
            f"in {a} : {x}",
            f"out {b} : {x}",
        )

    def guard_binds(c: _Cases) -> None:
        c.puts(f"w{c.k.name}", f"guard [w{c.k.name} = {c.e()}]")

    def guard_with_value(c: _Cases) -> None:
        c.declare(f"val d{c.n} = {c.e()};")
        c.puts(f"w{c.k.name}", f"guard [w{c.k.name} = d{c.n}]")

    def code_output(c: _Cases) -> None:
        c.puts(f"w{c.k.name}", f"code output (w{c.k.name}); action {c.e()}")

    def code_outputs(c: _Cases) -> None:
        c.puts(f"w{c.k.name}", f"code output (w{c.k.name}, x{c.k.name}); action ({c.e()}, {c.e()})")

    def code_input(c: _Cases) -> None:
        x = f"v{c.k.name}"
        a, b = c.place("A", c.k.name, c.e()), c.place("B", c.k.name)
        c.transition(
            f"code input ({x}); output (w{c.k.name}); action {c.e((x, c.k))}",
            f"in {a} : {x}",
            f"out {b} : w{c.k.name}",
        )

    def code_of_value(c: _Cases) -> None:
        c.declare(f"val d{c.n} = {c.e()};")
        c.puts(f"w{c.k.name}", f"code output (w{c.k.name}); action d{c.n}")

    def code_for_its_effect(c: _Cases) -> None:
        c.declare(f"fun f{c.n} (x : {c.k.name}) = ();")
        c.puts(c.e(), f"code action (f{c.n} {c.e()})")

    def reference(c: _Cases) -> None:
        c.declare(f"globref r{c.n} = {c.e()};")
        c.puts(f"!r{c.n}", f"code action (r{c.n} := {c.e()})")

    def reference_read_first(c: _Cases) -> None:
        c.declare(f"val r{c.n} = ref {c.e()};")
        c.puts(
            f"w{c.k.name}",
            f"code output (w{c.k.name}); action let val y = !r{c.n} in (r{c.n} := {c.e()}; y) end",
        )

    def reference_within(c: _Cases) -> None:
        c.declare(f"val r{c.n} = ref (SOME {c.e()}, [{c.e()}]);")
        c.puts(
            f"case !r{c.n} of (SOME y, _) => 1`y | (NONE, ys) => ys",
            f"code action (r{c.n} := (NONE, [{c.e()}]))",
        )

    def reference_in_marking(c: _Cases) -> None:
        c.declare(f"val r{c.n} = ref {c.e()};")
        c.starts(f"1`(!r{c.n})")

    def reference_to_reference(c: _Cases) -> None:
        c.declare(f"val r{c.n} = ref (ref {c.e()});", f"val s{c.n} = !r{c.n};")
        c.puts(f"!s{c.n}", f"code action (!r{c.n} := {c.e()})")

    def local_reference(c: _Cases) -> None:
        c.puts(f"let val y = ref {c.e()} in (y := {c.e()}; !y) end")

    def array(c: _Cases) -> None:
        c.declare(f"val r{c.n} = Array.array (2, {c.e()});")
        c.puts(f"Array.sub (r{c.n}, 1)", f"code action (Array.update (r{c.n}, 1, {c.e()}))")

    def an_exception(c: _Cases) -> None:
        c.declare(f"exception X{c.n} of {c.k.name};")
        c.puts(f"((if true then raise X{c.n} {c.e()} else {c.e()}) handle X{c.n} y => y)")

    def exception_in_function(c: _Cases) -> None:
        c.declare(
            f"exception X{c.n};", f"fun f{c.n} 0 = raise X{c.n} | f{c.n} (_ : int) = {c.e()};"
        )
        c.puts(f"(f{c.n} 0 handle X{c.n} => f{c.n} 1)")

    def polymorphic(c: _Cases) -> None:
        c.puts(
            c.r.choice(
                (
                    f"first (twice {c.e()})",
                    f"apply (fn y => y) {c.e()}",
                    f"#2 (twice {c.e()})",
                    f"apply first ({c.e()}, 1)",
                )
            )
        )

    def data_type(c: _Cases) -> None:
        c.puts(
            c.r.choice(
                (
                    f"top (Knot (Leaf, {c.e()}, Leaf)) {c.e()}",
                    f"top Leaf {c.e()}",
                    f"getOpt (SOME {c.e()}, {c.e()})",
                    f"valOf (SOME {c.e()})",
                )
            )
        )

    def own_data_type(c: _Cases) -> None:
        c.declare(
            f"datatype t{c.n} = P{c.n} | Q{c.n} of {c.k.name} | S{c.n} of {c.k.name} * int;",
            f"val d{c.n} = Q{c.n} {c.e()};",
        )
        c.puts(f"case d{c.n} of P{c.n} => 1`{c.e()} | Q{c.n} y => 1`y | S{c.n} (y, _) => 1`y")

    def lists(c: _Cases) -> None:
        c.puts(c.r.choice((
            f"hd (rev [{c.e()}, {c.e()}])", f"List.nth (List.filter (fn _ => true) [{c.e()}], 0)", f"List.tabulate (2, fn _ => {c.e()})", f"map (fn y => y) [{c.e()}]",
            f"foldl (fn (y, _) => y) {c.e()} [{c.e()}]", f"#1 (hd (ListPair.zip ([{c.e()}], [1])))", f"Vector.sub (Vector.fromList [{c.e()}], 0)",
            f"List.concat [[{c.e()}], []]",
        )))  # fmt: skip

    def equal_in_lists(c: _Cases) -> None:
        a, b = c.place("A", "UNIT", "1`()"), c.place("B", "BOOL")
        x = c.e()
        texts = (
            f"mem [{x}] {c.e()}",
            f"contains [{x}] [{c.e()}]",
            f"length (remdupl [{x}, {c.e()}]) = 1",
            f"cf ({x}, [{c.e()}]) > 0",
            f"[{x}] == [{c.e()}]",
        )
        c.transition(
            f"in {a} : ()", f"out {b} : {c.r.choice(texts) if c.k.has_equality else 'true'}"
        )

    def multisets(c: _Cases) -> None:
        x = c.e()
        c.puts(
            c.r.choice(
                (
                    f"2`{x} -- 1`{x}" if c.k.has_equality else f"2`{x}",
                    f"(1`{x} ++ 1`{c.e()})",
                    f"3 ** (1`{x})",
                    f"[true] % {x}",
                    f"ext_col (fn y => y) (2`{x})",
                )
            )
        )

    def colour_functions(c: _Cases) -> None:
        k = c.k.name
        b = c.place("B", "WRAP")
        a = c.place("A", "UNIT", "1`()")
        x, y = c.e(), c.e()
        texts = [
            f"{k}.mkstr {x}",
            f"BOOL.mkstr ({k}.legal {x})",
            f"BOOL.mkstr ({k}.lt ({x}, {y}))",
            f"{k}.mkstr_ms (1`{x} ++ 2`{y})",
        ]
        c.transition(f"in {a} : ()", f"out {b} : [{', '.join(texts)}]")

    def delay(c: _Cases) -> None:
        test = f"{c.e()} = {c.e()}" if c.k.has_equality else f"{c.k.name}.lt ({c.e()}, {c.e()})"
        c.puts(c.e(), f"delay @+(if {test} then 1 else 2)")

    def record(c: _Cases) -> None:
        c.declare(f"val d{c.n} = {{one = {c.e()}, two = (), three = 3}};")
        c.puts(
            c.r.choice(
                (
                    f"#one d{c.n}",
                    f"let val {{one = y, ...}} = d{c.n} in y end",
                    f"(fn {{one, two = (), three = _}} => one) d{c.n}",
                )
            )
        )

    def function_value(c: _Cases) -> None:
        c.declare(
            f"val f{c.n} = fn (x : {c.k.name}) => x;", f"val g{c.n} = [f{c.n}, fn _ => {c.e()}];"
        )
        c.puts(
            c.r.choice(
                (
                    f"f{c.n} {c.e()}",
                    f"hd g{c.n} {c.e()}",
                    f"List.last g{c.n} {c.e()}",
                    f"(f{c.n} o f{c.n}) {c.e()}",
                )
            )
        )

    def captured(c: _Cases) -> None:
        c.declare(f"fun f{c.n} (x : {c.k.name}) = fn () => x;")
        c.puts(
            c.r.choice(
                (
                    f"f{c.n} {c.e()} ()",
                    f"let fun g () = {c.e()} in g () end",
                    f"let val y = {c.e()} fun g 0 = y | g n = g (n - 1) in g 2 end",
                )
            )
        )

    def discarded(c: _Cases) -> None:
        c.declare(f"val _ = {c.e()};", f"val _ = ignore {c.e()};")
        c.puts(f"(ignore {c.e()}; {c.e()})")

    def loops(c: _Cases) -> None:
        c.puts(
            f"let val i = ref 0 val y = ref {c.e()} in (while !i < 2 do (i := !i + 1; y := {c.e()}); !y) end"
        )

    def as_patterns(c: _Cases) -> None:
        c.puts(f"case ({c.e()}, {c.e()}) of all as (y as _, _) => if true then y else #2 all")

    def product_of_it(c: _Cases) -> None:
        k = c.k.name
        c.declare(f"colset P{c.n} = product {k} * {k};", f"var p{c.n} : P{c.n};")
        a, b, w = (
            c.place("A", f"P{c.n}", f"1`({c.e()}, {c.e()})"),
            c.place("B", k),
            c.place("C", f"P{c.n}"),
        )
        c.transition(f"in {a} : (v{k}, w{k})", f"out {b} : w{k}", f"out {w} : (w{k}, v{k})")

    def record_of_it(c: _Cases) -> None:
        k = c.k.name
        c.declare(f"colset R{c.n} = record k: {k} * z: UNIT;", f"var q{c.n} : R{c.n};")
        a, b = c.place("A", f"R{c.n}", f"1`{{z = (), k = {c.e()}}}"), c.place("B", k)
        c.transition(f"in {a} : q{c.n}", f"out {b} : #k q{c.n}")

    def union_of_it(c: _Cases) -> None:
        k = c.k.name
        c.declare(
            f"colset U{c.n} = union Of{c.n}: {k} + None{c.n};", f"val d{c.n} = Of{c.n} {c.e()};"
        )
        a, b = c.place("A", f"U{c.n}", f"1`d{c.n} ++ 1`None{c.n}"), c.place("B", f"U{c.n}")
        c.transition(f"in {a} : Of{c.n} v{k}", f"out {b} : Of{c.n} v{k}", f"out {b} : None{c.n}")

    def list_of_it(c: _Cases) -> None:
        k = c.k.name
        c.declare(f"colset L{c.n} = list {k};", f"var l{c.n} : L{c.n};")
        a, b, w = (
            c.place("A", f"L{c.n}", f"1`[{c.e()}, {c.e()}]"),
            c.place("B", k),
            c.place("C", f"L{c.n}"),
        )
        c.transition(
            f"in {a} : v{k} :: l{c.n}", f"out {b} : v{k}", f"out {w} : l{c.n} ^^ [{c.e()}]"
        )

    def timed_one(c: _Cases) -> None:
        k = c.k.name
        c.declare(f"colset M{c.n} = {k} timed;", f"var m{c.n} : M{c.n};")
        a, b = c.place("A", f"M{c.n}", f"1`{c.e()}@2 +++ 1`{c.e()}@0"), c.place("B", f"M{c.n}")
        c.transition("delay @+1", f"in {a} : m{c.n}", f"out {b} : m{c.n}@+{c.r.randint(0, 3)}")

    def subset_of_it(c: _Cases) -> None:
        k = c.k.name
        c.declare(
            f"fun t{c.n} (x : {k}) = true;",
            f"colset S{c.n} = subset {k} by t{c.n};",
            f"var s{c.n} : S{c.n};",
        )
        a, b = c.place("A", f"S{c.n}", f"1`{c.e()}"), c.place("B", k)
        c.transition(f"in {a} : s{c.n}", f"out {b} : s{c.n}")

    def inhibited(c: _Cases) -> None:
        c.declare(f"val d{c.n} = {c.e()};")
        a, b = c.place("A", "UNIT", "2`()"), c.place("B", c.k.name)
        c.transition(f"in {a} : ()", f"inhibit {b} :", f"out {b} : 2`d{c.n}")

    def reset(c: _Cases) -> None:
        a, b = c.place("A", c.k.name, f"2`{c.e()}"), c.place("B", c.k.name, f"1`{c.e()}")
        c.transition(f"in {a} : v{c.k.name}", f"reset {b} :", f"out {a} : empty")

    return [x for x in locals().values() if callable(x)]


POSITIONS = _positions()
CASES = len(POSITIONS) * len(kinds())
"""So many cases are every type at every position once."""
