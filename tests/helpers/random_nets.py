# ruff: noqa: E501 - rows of texts
"""Whole nets at random, well-typed by construction, in the short text form of `netbuilder`.

`random_net(r)` takes any `random.Random`, also one that hypothesis controls. The nets have colour sets of all kinds,
patterns, coefficients, guards that test and that bind, conditional and several terms on arcs, delays, priorities, inhibitor, reset
and both-direction arcs, free variables over small colour sets, code segments, functions, fusion sets and a page used
several times. Values stay small, so that a walk goes on; exceptions are rare, but possible.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from random import Random


@dataclass(frozen=True, slots=True)
class Kind:
    """A colour set.

    Args:
        name: of the colour set.
        kind: "int", "range", "enum", "bool", "unit", "string", "real", "index", "product", "record", "list", "union", "subset".
        parts: its components: labels or constructors ("" for none) and their colour sets (None: a constructor alone).
        names: constructors of an enumeration; the word of an index.
        size: how many colours, if few; 0 for many.
        timed: whether tokens have stamps.
        base: of a subset.
    """

    name: str
    kind: str
    parts: tuple[tuple[str, Kind | None], ...] = ()
    names: tuple[str, ...] = ()
    size: int = 0
    timed: bool = False
    base: Kind | None = None

    @property
    def is_int(self) -> bool:
        """Whether its colours are integers."""
        return self.kind in ("int", "range") or (self.base is not None and self.base.is_int)

    @property
    def has_equality(self) -> bool:
        """Whether `=` is there for it."""
        return self.kind != "real" and all(p is None or p.has_equality for _, p in self.parts)


INT = Kind("INT", "int")
BOOL = Kind("BOOL", "bool", size=2)
UNIT = Kind("UNIT", "unit", size=1)
STRING = Kind("STRING", "string")
REAL = Kind("REAL", "real")
VARIABLES = ("v", "w", "x")


@dataclass(slots=True)
class Scope:
    """The variables that have a value where an expression stands."""

    bound: list[tuple[str, Kind]] = field(default_factory=list)

    def of(self, kind: Kind) -> list[str]:
        """Those of a colour set; integers go together."""
        if kind.is_int:
            return [n for n, k in self.bound if k.is_int]
        return [n for n, k in self.bound if k.name == kind.name]

    def add(self, name: str, kind: Kind) -> None:
        if (name, kind) not in self.bound:
            self.bound.append((name, kind))


@dataclass(frozen=True, slots=True)
class Place:
    """A place on the page that is written."""

    name: str
    kind: Kind


class Writer:
    """Writes one net; `helpers.random_unions` has one that writes many into a file."""

    def __init__(self, r: Random) -> None:
        self.r = r
        self.kinds: list[Kind] = [INT, BOOL, UNIT, STRING, REAL]
        self.functions: list[tuple[str, Kind, Kind]] = []
        self.lines: list[str] = [
            "net Random",
            "  standard",
            "  val P_HIGH = 100; val P_NORMAL = 1000; val P_LOW = 10000;",
        ]

    def chance(self, p: float) -> bool:
        return self.r.randrange(100) >= 100 - round(100 * p)

    # --- declarations

    def declare(self) -> None:
        for i in range(self.r.randint(2, 7)):
            self.kind(f"C{i}")
        for i in range(self.r.randint(0, 3)):
            self.function(f"f{i}")

    def component(self, small: bool = False) -> Kind:
        known = [k for k in self.kinds if not k.timed and (not small or 0 < k.size <= 6)]
        return self.r.choice(known)

    def kind(self, name: str) -> None:
        r = self.r
        what = r.choice(
            (
                "range",
                "enum",
                "index",
                "product",
                "record",
                "list",
                "union",
                "subset",
                "alias",
                "letters",
            )
        )
        parts: list[tuple[str, Kind | None]] = []
        names: tuple[str, ...] = ()
        size, base = 0, None
        match what:
            case "range":
                size = r.randint(2, 6)
                text, what = f"int with 0..{size - 1}", "range"
            case "enum":
                names = tuple(f"e{name}{c}" for c in "abcd"[: r.randint(1, 4)])
                text, size = "with " + " | ".join(names), len(names)
            case "index":
                size, names = r.randint(1, 4), (f"i{name}",)
                text = f"index {names[0]} with 0..{size - 1}"
            case "product":
                parts = [("", self.component()) for _ in range(r.randint(2, 3))]
                text = "product " + " * ".join(k.name for _, k in parts if k)
                size = _product(parts)
            case "record":
                labels = r.sample(("a", "b", "key", "z", "n1"), r.randint(1, 3))
                parts = [(label, self.component()) for label in labels]
                text = "record " + " * ".join(f"{label}: {k.name}" for label, k in parts if k)
                size = _product(parts)
            case "list":
                parts = [("", self.component())]
                text = f"list {parts[0][1].name}" if parts[0][1] else ""
            case "union":
                for i in range(r.randint(2, 4)):
                    parts.append(
                        (f"U{name}{i}", self.component() if i == 0 or self.chance(0.5) else None)
                    )
                text = "union " + " + ".join(f"{c}: {k.name}" if k else c for c, k in parts)
            case "subset":
                ranges = [
                    k
                    for k in self.kinds
                    if k.kind in ("range", "enum") and not k.timed and k.size > 1
                ]
                if not ranges:
                    return
                base = r.choice(ranges)
                chosen = sorted(r.sample(range(base.size), r.randint(1, base.size)))
                names = tuple(str(i) if base.kind == "range" else base.names[i] for i in chosen)
                text, size = f"subset {base.name} with [{', '.join(names)}]", len(names)
            case "letters":
                text, what = 'string with "a".."c" and 0..2', "letters"
            case _:
                of = self.component()
                timed = self.chance(0.5)
                text = of.name + (" timed" if timed else "")
                self.lines.append(f"  colset {name} = {text};")
                self.kinds.append(Kind(name, of.kind, of.parts, of.names, of.size, timed, of.base))
                self.variables(name)
                return
        timed = self.chance(0.2)
        self.lines.append(f"  colset {name} = {text}{' timed' if timed else ''};")
        self.kinds.append(Kind(name, what, tuple(parts), names, size, timed, base))
        self.variables(name)

    def variables(self, name: str) -> None:
        self.lines.append(f"  var {', '.join(f'{v}{name}' for v in VARIABLES)}: {name};")

    def function(self, name: str) -> None:
        takes, gives = self.component(), self.component()
        scope = Scope([("p", takes)])
        if takes.is_int and gives.is_int and self.chance(0.3):
            body = f"fun {name} (p : int) = if p <= 0 then {self.value(gives, Scope(), 1)} else {name} (p div 2)"
        elif takes.kind == "list" and gives.kind == "int":
            body = f"fun {name} nil = 0 | {name} (h :: t) = 1 + {name} t"
        else:
            body = f"fun {name} (p : {takes.name}) : {gives.name} = {self.value(gives, scope, 3)}"
        self.lines.append(f"  {body}")
        self.functions.append((name, takes, gives))

    # --- values

    def value(self, kind: Kind, scope: Scope, depth: int) -> str:
        """An expression; in parentheses where it needs them."""
        r = self.r
        known = scope.of(kind)
        if known and self.chance(0.5):
            chosen = r.choice(known)
            return self.fit(kind, chosen) if kind.is_int else chosen
        if depth > 0 and self.chance(0.5):
            made = self.compound(kind, scope, depth - 1)
            if made is not None:
                return made
        return self.plain(kind, scope, depth)

    def fit(self, kind: Kind, text: str) -> str:
        """An integer expression brought into the colour set."""
        if kind.kind == "range":
            return f"({text} mod {kind.size})"
        if kind.base is not None:
            return (
                f"(if {kind.name}.legal ({text}) then {text} else {kind.names[0]})"
                if self.chance(0.5)
                else kind.names[0]
            )
        return text if text.isidentifier() else f"(({text}) mod 50)"

    def plain(self, kind: Kind, scope: Scope, depth: int) -> str:
        r, below = self.r, depth - 1
        match kind.kind:
            case "int":
                return str(r.randint(0, 5)) if self.chance(0.8) else f"(~{r.randint(1, 5)})"
            case "range":
                return str(r.randrange(kind.size))
            case "bool":
                return r.choice(("true", "false"))
            case "unit":
                return "()"
            case "string":
                return r.choice(('""', '"a"', '"b"', '"x y"', '"\\n"'))
            case "letters":
                return r.choice(('""', '"a"', '"bc"', '"cc"'))
            case "real":
                return r.choice(("0.0", "1.5", "(~2.25)", "0.1"))
            case "enum" | "subset":
                return r.choice(kind.names)
            case "index":
                return f"({kind.names[0]} {r.randrange(kind.size)})"
            case "product":
                return f"({', '.join(self.value(k, scope, below) for _, k in kind.parts if k)})"
            case "record":
                given = [f"{label} = {self.value(k, scope, below)}" for label, k in kind.parts if k]
                r.shuffle(given)
                return "{" + ", ".join(given) + "}"
            case "list":
                inner = kind.parts[0][1]
                assert inner is not None
                return (
                    "["
                    + ", ".join(self.value(inner, scope, below) for _ in range(r.randint(0, 2)))
                    + "]"
                )
            case "union":
                constructor, of = r.choice(kind.parts)
                return f"({constructor} {self.value(of, scope, below)})" if of else constructor
        raise AssertionError(kind)

    def compound(self, kind: Kind, scope: Scope, depth: int) -> str | None:
        """Something that computes."""
        r = self.r

        def sub(k: Kind) -> str:
            return self.value(k, scope, depth)

        usable = [(f, t) for f, t, g in self.functions if g.name == kind.name]
        choice = r.randrange(9)
        if usable and choice < 3:
            f, takes = r.choice(usable)
            return f"({f} {self.argument(takes, scope, depth)})"
        if choice == 3:
            return f"(if {sub(BOOL)} then {sub(kind)} else {sub(kind)})"
        if choice == 4:
            return f"(let val y = {sub(kind)} in y end)" if not kind.is_int else None
        if choice == 5:
            return self.case(kind, scope, depth)
        if choice == 6:
            got = [(n, i, label) for n, k in scope.bound if k.kind in ("product", "record")
                   for i, (label, p) in enumerate(k.parts, 1) if p is not None and p.name == kind.name]  # fmt: skip
            if got:
                n, i, label = r.choice(got)
                return f"(#{label or i} {n})"
        match kind.kind:
            case "int" | "range" if kind.is_int:
                a, b = sub(INT), sub(INT)
                return self.fit(kind, r.choice((
                    f"{a} + {b}", f"{a} * {b}", f"{a} - {b}", f"Int.max ({a}, {b})", f"abs ({a})", f"String.size {sub(STRING)}",
                    f"{a} div 3", f"floor {sub(REAL)}", f"foldl (fn (a, b) => a + b) 0 [{a}, {b}]", f"length [{a}, {b}]", "IntInf.toInt (step ()) div 5",
                )))  # fmt: skip
            case "bool":
                equal = self.component()
                a, b = sub(INT), sub(INT)
                if equal.has_equality and self.chance(0.4):
                    return f"({self.typed(equal, scope, depth)} = {sub(equal)})"
                return r.choice((
                    f"({a} < {b})", f"({sub(BOOL)} andalso {sub(BOOL)})", f"({sub(BOOL)} orelse {sub(BOOL)})", f"(not {sub(BOOL)})",
                    f"({sub(STRING)} <= {sub(STRING)})", f"({sub(REAL)} < {sub(REAL)})", f"(List.exists (fn y => y > {a}) [{b}, 3])",
                ))  # fmt: skip
            case "string":
                shown = self.component()
                return r.choice((
                    f"(if String.size {sub(STRING)} > 5 then \"\" else {sub(STRING)} ^ {sub(STRING)})", f"(INT.mkstr {sub(INT)})",
                    f"({shown.name}.mkstr {self.typed(shown, scope, depth)})", f"(concat [{sub(STRING)}, \"-\"])" if depth < 2 else '"c"',
                    f"(Int.toString {sub(INT)})", f"(implode (rev (explode {sub(STRING)})))",
                ))  # fmt: skip
            case "real":
                return r.choice(
                    (
                        f"(real {sub(INT)})",
                        f"({sub(REAL)} / 2.0)",
                        f"(if {sub(REAL)} > 9.0 then 0.5 else 1.25)",
                        f"(Real.abs {sub(REAL)})",
                    )
                )
            case "enum" if kind.size:
                return f"({kind.name}.col ({sub(INT)} mod {kind.size}))"
            case "index":
                return f"({kind.names[0]} ({sub(INT)} mod {kind.size}))"
            case "list":
                inner = kind.parts[0][1]
                assert inner is not None
                some = self.typed(kind, scope, depth)
                return r.choice((
                    f"(if length {some} > 2 then [] else {sub(inner)} :: {sub(kind)})", f"(rev {some})", f"(List.filter (fn _ => {sub(BOOL)}) {some})",
                    f"(map (fn y => y) {some})", f"(List.take ({sub(kind)} ^^ {sub(kind)}, 0))", f"(List.drop ({some}, 0))",
                ))  # fmt: skip
        return None

    def typed(self, kind: Kind, scope: Scope, depth: int) -> str:
        """A value whose type is evident."""
        return f"({self.value(kind, scope, depth)} : {kind.name})"

    def argument(self, kind: Kind, scope: Scope, depth: int) -> str:
        return f"({self.value(kind, scope, depth)})"

    def case(self, kind: Kind, scope: Scope, depth: int) -> str | None:
        on = [
            (n, k)
            for n, k in scope.bound
            if k.kind in ("union", "enum", "list", "bool", "int", "range", "product")
        ]
        if not on:
            return None
        name, of = self.r.choice(on)
        rules: list[str] = []
        match of.kind:
            case "union":
                for i, (constructor, part) in enumerate(of.parts):
                    inner = Scope([*scope.bound, (f"y{i}", part)]) if part else scope
                    rules.append(
                        f"{constructor}{f' y{i}' if part else ''} => {self.value(kind, inner, depth)}"
                    )
            case "enum":
                rules = [
                    f"{of.names[0]} => {self.value(kind, scope, depth)}",
                    f"_ => {self.value(kind, scope, depth)}",
                ]
            case "list":
                part = of.parts[0][1]
                assert part is not None
                inner = Scope([*scope.bound, ("y0", part), ("y1", of)])
                rules = [
                    f"nil => {self.value(kind, scope, depth)}",
                    f"y0 :: y1 => {self.value(kind, inner, depth)}",
                ]
            case "bool":
                rules = [
                    f"true => {self.value(kind, scope, depth)}",
                    f"false => {self.value(kind, scope, depth)}",
                ]
            case "product":
                bound = [(f"y{i}", p) for i, (_, p) in enumerate(of.parts) if p]
                inner = Scope([*scope.bound, *bound])
                rules = [f"({', '.join(n for n, _ in bound)}) => {self.value(kind, inner, depth)}"]
            case _:
                rules = [
                    f"1 => {self.value(kind, scope, depth)}",
                    f"_ => {self.value(kind, scope, depth)}",
                ]
        return f"(case {name} of {' | '.join(rules)})"

    # --- arcs

    def multiset(self, kind: Kind, scope: Scope, free: bool) -> str:
        """An expression of an output arc."""
        r = self.r
        if free and 0 < kind.size <= 6 and kind.name.startswith("C") and self.chance(0.25):
            text = f"x{kind.name}"  # perhaps bound nowhere: any colour
        elif self.chance(0.1):
            text = (
                f"({self.value(BOOL, scope, 1)} andalso true)"
                if kind.kind == "bool"
                else self.value(kind, scope, 3)
            )
        else:
            text = self.value(kind, scope, 2)
        match r.randrange(8):
            case 0:
                return f"if {self.value(BOOL, scope, 2)} then 1`{text} else empty"
            case 1:
                return f"1`{text} ++ {r.randint(1, 2)}`{self.value(kind, scope, 1)}"
            case 2 if kind.timed:
                return f"1`{text}@+{r.randint(0, 3)}"
            case 3 if kind.timed:
                return f"{text}@+{self.delay(scope)}"
            case 4:
                return f"{r.randint(0, 2)}`{text}"
            case 5:
                return f"case {self.value(INT, scope, 1)} of 0 => 1`{text} | _ => empty"
            case 6:
                return f"if {self.value(BOOL, scope, 1)} then 1`{text} else 1`{self.value(kind, scope, 1)}"
            case _:
                return text if kind.timed or self.chance(0.6) else f"1`{text}"

    def delay(self, scope: Scope) -> str:
        return (
            f"(({self.value(INT, scope, 1)}) mod 4)"
            if self.chance(0.5)
            else str(self.r.randint(0, 4))
        )

    def pattern(self, kind: Kind, scope: Scope, depth: int) -> str:
        """A pattern of an input arc; binds variables of the net."""
        r = self.r
        if kind.name.startswith("C") and (depth <= 0 or self.chance(0.45)):
            name = f"{r.choice(VARIABLES)}{kind.name}"
            scope.add(name, kind)
            return name
        if kind.name in ("INT", "BOOL", "STRING", "UNIT", "REAL") and self.chance(0.85):
            name = f"{r.choice(VARIABLES)}{kind.name}"
            scope.add(name, kind)
            return name
        match kind.kind:
            case "product":
                return (
                    f"({', '.join(self.pattern(k, scope, depth - 1) for _, k in kind.parts if k)})"
                )
            case "record":
                return (
                    "{"
                    + ", ".join(
                        f"{label} = {self.pattern(k, scope, depth - 1)}"
                        for label, k in kind.parts
                        if k
                    )
                    + "}"
                )
            case "union":
                constructor, of = r.choice(kind.parts)
                return (
                    f"({constructor} {self.pattern(of, scope, depth - 1)})" if of else constructor
                )
            case "list":
                inner = kind.parts[0][1]
                assert inner is not None
                if self.chance(0.5):
                    return f"[{', '.join(self.pattern(inner, scope, depth - 1) for _ in range(r.randint(0, 2)))}]"
                rest = f"{r.choice(VARIABLES)}{kind.name}"
                head = self.pattern(inner, scope, depth - 1)
                scope.add(rest, kind)
                return f"{head} :: {rest}" if depth >= 2 else f"({head} :: {rest})"
            case "real":
                scope.add(f"v{kind.name}", kind)
                return f"v{kind.name}"
            case "index":
                return f"({kind.names[0]} {r.randrange(kind.size)})"
        return self.plain(kind, Scope(), 0)

    def input(self, kind: Kind, scope: Scope) -> str:
        r = self.r
        first = self.pattern(kind, scope, 2)
        inner = f"({first})" if "::" in first else first
        match r.randrange(10):
            case 0:
                return f"2`{inner}"
            case 1:
                known = list(scope.bound)
                second = self.pattern(kind, scope, 1)
                if _clash(first, second):  # CPN Tools does not find out how to bind them
                    scope.bound[:] = known
                    return f"1`{inner}"
                return f"1`{inner} ++ 1`({second})"
            case 2 if kind.timed:
                return f"{inner} @+ {r.randint(1, 2)}"
            case 3:
                return f"1`{inner}"
            case _:
                return first

    # --- pages

    def initial(self, kind: Kind) -> str:
        r = self.r
        if (
            0 < kind.size <= 8
            and kind.kind not in ("subset",)
            and not kind.timed
            and self.chance(0.3)
        ):
            return f"{kind.name}.all()"
        terms = []
        for _ in range(r.randint(0 if self.chance(0.2) else 1, 4)):
            stamp = f"@{r.randint(0, 3)}" if kind.timed and self.chance(0.5) else ""
            terms.append(f"{r.randint(1, 3)}`{self.value(kind, Scope(), 1)}{stamp}")
        if kind.timed and any("@" in t for t in terms):
            terms = [t if "@" in t else t + "@0" for t in terms]
            return " +++ ".join(terms)
        return " ++ ".join(terms)

    def transition(self, name: str, places: list[Place], indent: str) -> None:
        r = self.r
        scope = Scope()
        arcs: list[str] = []
        used: list[Place] = []
        for _ in range(r.randint(0 if self.chance(0.1) else 1, 3)):
            place = r.choice(places)
            word = "in" if self.chance(0.85) else "both"
            arcs.append(f"{word} {place.name} : {self.input(place.kind, scope)}")
            used.append(place)
        clauses: list[str] = []
        guards: list[str] = []
        if self.chance(0.25):
            guards.append(self.value(BOOL, scope, 2))
        if self.chance(0.2):
            kind = r.choice(
                [k for k in self.kinds if k.name.startswith("C") and k.has_equality] or [INT]
            )
            known = {n for n, _ in scope.bound}
            fresh = [v for v in VARIABLES if f"{v}{kind.name}" not in known]
            if fresh:
                text = self.value(kind, scope, 2)
                guards.append(f"{fresh[0]}{kind.name} = {text}")
                scope.add(f"{fresh[0]}{kind.name}", kind)
        if guards:
            clauses.append(f"guard [{', '.join(guards)}]")
        if self.chance(0.2):
            clauses.append(f"delay @+{self.delay(scope)}")
        if self.chance(0.15):
            clauses.append(f"priority {r.choice(('P_HIGH', 'P_LOW', 'P_NORMAL'))}")
        if self.chance(0.2):
            self.code(scope, clauses)
        for _ in range(r.randint(1, 3) if self.chance(0.8) else 0):
            place = r.choice(places)
            arcs.append(f"out {place.name} : {self.multiset(place.kind, scope, True)}")
        others = [p for p in places if p not in used]
        if others and self.chance(0.15):
            arcs.append(f"{r.choice(('inhibit', 'reset'))} {r.choice(others).name} :")
        self.lines.append(f"{indent}trans {name}")
        self.lines += [f"{indent}  {text}" for text in [*clauses, *arcs]]

    def code(self, scope: Scope, clauses: list[str]) -> None:
        """A code segment; its outputs are bound nowhere else."""
        known = {n for n, _ in scope.bound}
        kinds = self.r.sample(self.kinds, self.r.randint(0, min(2, len(self.kinds))))
        outputs = [(f"w{k.name}", k) for k in kinds if f"w{k.name}" not in known]
        inputs = [n for n, _ in scope.bound]
        inner = Scope(list(scope.bound))
        values = [self.value(k, inner, 2) for _, k in outputs]
        text = f"input ({', '.join(inputs)}); " if inputs else ""
        if outputs:
            text += f"output ({', '.join(n for n, _ in outputs)}); "
        action = f"({', '.join(values)})" if len(values) != 1 else values[0]
        clauses.append(f"code {text}action {action}")
        for n, k in outputs:
            scope.add(n, k)

    def net(self) -> str:
        r = self.r
        self.declare()
        for name in ("INT", "BOOL", "STRING", "UNIT", "REAL"):
            self.variables(name)
        with_sub = self.chance(0.3)
        self.lines.append("  page Top")
        places = []
        for i in range(r.randint(2, 5)):
            own = [k for k in self.kinds if k.name.startswith("C")] or self.kinds
            place = Place(f"P{i}", r.choice(own) if self.chance(0.8) else r.choice(self.kinds))
            places.append(place)
            self.lines.append(
                f"    place {place.name} : {place.kind.name} = {self.initial(place.kind)}"
            )
        fused = self.chance(0.25)
        if fused:
            kind = r.choice(self.kinds)
            initial = self.initial(kind)
            for i in (8, 9):
                places.append(Place(f"P{i}", kind))
                self.lines.append(f"    place P{i} fusion Shared : {kind.name} = {initial}")
        for i in range(r.randint(2, 5)):
            self.transition(f"T{i}", places, "    ")
        if with_sub:
            a, b = r.choice(places[:2]), r.choice(places[:2])
            for i in range(r.randint(1, 2)):
                self.lines.append(f"    subst S{i} = Sub (A -> {a.name}, B -> {b.name})")
            self.lines.append("  page Sub")
            self.lines.append(f"    place A port io : {a.kind.name}")
            self.lines.append(f"    place B port io : {b.kind.name}")
            inner = [Place("A", a.kind), Place("B", b.kind)]
            if self.chance(0.5):
                kind = r.choice(self.kinds)
                inner.append(Place("Own", kind))
                self.lines.append(f"    place Own : {kind.name} = {self.initial(kind)}")
            for i in range(r.randint(1, 2)):
                self.transition(f"U{i}", inner, "    ")
        return "\n".join(self.lines) + "\n"


def _clash(first: str, second: str) -> bool:
    """Whether two patterns share a variable, and each has others that it does not share."""
    names = re.compile(rf"\b(?:{'|'.join(VARIABLES)})(?:C\d+|[A-Z]+)\b")
    a, b = set(names.findall(first)), set(names.findall(second))
    return not (a.isdisjoint(b) or a <= b or b <= a)


def _product(parts: list[tuple[str, Kind | None]]) -> int:
    size = 1
    for _, k in parts:
        size *= k.size if k else 1
    return size if size <= 100 else 0


def random_net(r: Random) -> str:
    """A net."""
    return Writer(r).net()
