# ruff: noqa: E501 - rows of texts
"""Sheets of transitions whose inscriptions are random CPN ML over the whole library and all kinds of colour sets.

A case has places and a transition of its own, as in `helpers.random_declarations`: it takes tokens by variables, patterns
and computed multi-sets, and puts what expressions of these variables give, by all the operations on multi-sets, where
that is legal. Guards, delays, priorities, code segments, inhibitor and reset arcs are there now and then. An expression
that raises an exception gives a literal instead.
"""

from __future__ import annotations

from pathlib import Path
from random import Random

from tools.oracle.answers import Here
from tools.oracle.texts import NET, Texts

from helpers.netbuilder import write
from helpers.random_declarations import Case, Sheet
from helpers.random_unions import Union
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.types import BOOL, INT, Type, list_of

HEAD = NET + "".join(
    f"\n  {line}"
    for line in (
        "globref count = 0;",
        "fun bump n = (count := (!count + n) mod 7; !count);",
        "fun copies (n, x) = if n <= 0 then empty else 1`x ++ copies (n - 1, x);",
        "fun choose p (a, b) = if p then a else b;",
        "val P_HIGH = 100; val P_NORMAL = 1000; val P_LOW = 10000;",
    )
)
_LONGEST = 250


class Inscriptions:
    """Makes sheets. The folder is for the net with the declarations."""

    def __init__(self, folder: Path) -> None:
        self.here = Here(write(HEAD, folder / "Inscriptions.cpn"))
        self.colsets = {name: c for name, c in self.here.program.colsets.items() if "'" not in name}
        variables = "".join(
            f"\n  var {', '.join(f'{v}{name}' for v in 'vwx')} : {name};" for name in self.colsets
        )
        self.head = HEAD.strip() + variables

    def sheet(self, number: int, size: int) -> _InscriptionSheet:
        """Sheet number so-and-so, with so many cases."""
        cases = tuple(self.case(i) for i in range(number * size, (number + 1) * size))
        return _InscriptionSheet(cases, self.head)

    def case(self, number: int) -> Case:
        """Case number so-and-so."""
        return Case(number, "inscriptions", (), tuple(self._written(number).elements()))

    def union(self, number: int, size: int) -> Union:
        """The same cases as nets of a union (`helpers.random_unions`): each occurs alone, and twice at most."""
        who = f"\n  colset WHO = int with 0..{size - 1};\n"
        pages = [self._written(number * size + i).page(i) for i in range(size)]
        return Union(number, "timed", self.head + who, tuple(pages))

    def _written(self, number: int) -> _Writer:
        one = _Writer(Random(f"inscriptions {number}"), number, self)
        one.write()
        return one


class _InscriptionSheet(Sheet):
    """With other declarations."""

    __slots__ = ("head",)

    def __init__(self, cases: tuple[Case, ...], head: str) -> None:
        object.__setattr__(self, "cases", cases)
        object.__setattr__(self, "head", head)

    def text(self, *only: int) -> str:
        cases = [c for c in self.cases if not only or c.number in only]
        elements = [f"    {line}" for c in cases for line in c.elements]
        return "\n".join([self.head, "  page Top", *elements]) + "\n"


class _Scoped(Texts):
    """Texts that may mention variables of the net."""

    def __init__(self, r: Random, colsets: dict[str, Colset]) -> None:
        super().__init__(r, colsets)
        self.scope: list[tuple[str, Type]] = []

    def of(self, t: Type, depth: int) -> str:
        known = [name for name, own in self.scope if own == t]
        if known and self.r.random() < 0.4:
            return self.r.choice(known)
        return super().of(t, depth)

    def value(self, t: Type, depth: int) -> str:
        known = [name for name, own in self.scope if own == t]
        if known and self.r.random() < 0.4:
            return self.r.choice(known)
        return super().value(t, depth)


class _Writer:
    """Writes one case."""

    def __init__(self, r: Random, number: int, made: Inscriptions) -> None:
        self.r = r
        self.n = number
        self.here = made.here
        self.colsets = made.colsets
        self.texts = _Scoped(r, made.colsets)
        self.places: list[tuple[str, Colset, str]] = []
        self.transition: list[str] = []

    def chance(self, p: float) -> bool:
        return self.r.random() < p

    # --- expressions

    def accepted(self, t: str, text: str, names: list[str]) -> bool:
        """Whether an expression of the variables has that type."""
        if len(text) > _LONGEST or "\n" in text:
            return False
        parameters = ", ".join(f"{name} : {name[1:]}" for name in names) or "_ : unit"
        said = self.here.say(f"let fun f ({parameters}) = ({text}) : {t} in true end")
        return said.kind == "value"

    def literal(self, colset: Colset) -> str:
        """A legal colour."""
        kept, self.texts.scope = self.texts.scope, []
        for _ in range(200):
            text = self.texts.value(colset.type, 1)
            said = self.here.say(f"{colset.name}.legal ({text})") if len(text) < 80 else None
            if said is not None and said.kind == "value" and said.detail == "true":
                self.texts.scope = kept
                return f"({text})"
        self.texts.scope = kept
        return f"(hd ({colset.name}.all ()))"

    def expression(self, t: Type, name: str, otherwise: str, depth: int = 3) -> str:
        """Of the variables in scope; never an exception."""
        for _ in range(20):
            text = self.texts.of(t, depth)
            if self.accepted(name, text, [n for n, _ in self.texts.scope]):
                return f"(({text}) handle _ => {otherwise})"
        return otherwise

    def colour(self, colset: Colset) -> str:
        """A colour of the variables, which may be illegal."""
        return self.expression(colset.type, colset.name, self.literal(colset))

    def legal(self, colset: Colset) -> str:
        """A legal colour of the variables."""
        text = self.colour(colset)
        return f"(let val y = {text} in if {colset.name}.legal y then y else {self.literal(colset)} end)"

    def boolean(self) -> str:
        return self.expression(BOOL, "bool", self.r.choice(("true", "true", "false")))

    def number(self, most: int) -> str:
        return f"(abs (({self.expression(INT, 'int', '1', 2)} mod 1000)) mod {most + 1})"

    def multiset(self, colset: Colset, depth: int = 2) -> str:
        """Without stamps."""
        r, name = self.r, colset.name
        below = depth - 1
        if depth <= 0:
            return f"{r.choice(('1', '2', '0', self.number(3)))}`{self.legal(colset)}"
        match r.randrange(14):
            case 0:
                return f"({self.multiset(colset, below)} ++ {self.multiset(colset, below)})"
            case 1:
                x = self.multiset(colset, below)
                return f"(({x}) ++ {self.multiset(colset, below)} -- ({x}))"
            case 2:
                return f"({r.choice(('0', '2', '3'))} ** ({self.multiset(colset, below)}))"
            case 3:
                return f"(if {self.boolean()} then {self.multiset(colset, below)} else empty)"
            case 4:
                return f"(case {self.number(2)} of 0 => {self.multiset(colset, below)} | 1 => [] | _ => 1`{self.literal(colset)})"
            case 5:
                return f"(let val y = {self.legal(colset)} in 1`y ++ 2`y end)"
            case 6:
                return f"(List.filter {name}.legal [{self.colour(colset)}, {self.colour(colset)}])"
            case 7:
                return f"(ext_col (fn y => y) ({self.multiset(colset, below)}))"
            case 8:
                return f"(List.tabulate ({self.number(3)}, fn _ => {self.legal(colset)}))"
            case 9:
                return f"(copies ({self.number(3)}, {self.legal(colset)}))"
            case 10:
                return f"(choose {self.boolean()} ({self.multiset(colset, below)}, {self.multiset(colset, below)}))"
            case 11:
                return f"({self.expression(list_of(colset.type), f'{name} list', 'nil', 2)}; 1`{self.literal(colset)})"
            case 12:
                return f"(List.filter {name}.legal {self.expression(list_of(colset.type), f'{name} list', 'nil', 2)})"
            case _:
                return f"1`{self.legal(colset)}"

    # --- elements

    def place(self, colset: Colset, initial: str = "") -> str:
        name = f"P{self.n}{'abcdefgh'[len(self.places)]}"
        self.places.append((name, colset, initial))
        return name

    def elements(self) -> list[str]:
        """What is on the page, in the short form of `netbuilder`."""
        places = [
            f"place {name} : {colset.name}{f' = {initial}' if initial else ''}"
            for name, colset, initial in self.places
        ]
        return [*places, f"trans T{self.n}", *(f"  {line}" for line in self.transition)]

    def page(self, number: int) -> str:
        """A page of its own in a union; its first transition puts the initial marking."""
        lines = [
            "place Pick fusion Pick : UNIT = 1`()",
            *(f"place {name} fusion {name} : WHO" for name in ("On", "Fuel")),
            *(f"place {name} : {colset.name}" for name, colset, _ in self.places),
            "trans Start",
            *(
                f"  {arc}"
                for arc in ("in Pick : ()", f"out On : {number}", f"out Fuel : 2`{number}")
            ),
            *(f"  out {name} : {initial}" for name, _, initial in self.places if initial),
            f"trans T{self.n}",
            *(f"  {line}" for line in self.transition),
            f"  in Fuel : {number}",
        ]
        return "\n".join([f"  page N{number}", *(f"    {line}" for line in lines)]) + "\n"

    def write(self) -> None:
        r = self.r
        lines: list[str] = []
        for _ in range(r.choice((1, 1, 2))):
            lines += self.taken()
        clauses: list[str] = []
        if self.chance(0.4):
            clauses.append(f"guard [{self.boolean()}]")
        if self.chance(0.25):
            clauses.append(f"delay @+ {self.number(3)}")
        if self.chance(0.2):
            clauses.append(f"priority {r.choice(('P_HIGH', 'P_LOW', '~5', 'P_NORMAL - 1'))}")
        if self.chance(0.35):
            clauses.append(self.code())
        for _ in range(r.choice((1, 1, 2))):
            lines.append(self.put())
        if self.chance(0.15):
            colset = self.any()
            initial = "" if self.chance(0.6) else f"2`{self.literal(colset)}"
            lines.append(f"{r.choice(('inhibit', 'reset'))} {self.place(colset, initial)} :")
        self.transition = [*clauses, *lines]

    def any(self) -> Colset:
        return self.r.choice(list(self.colsets.values()))

    def taken(self) -> list[str]:
        """An input arc, and its variables come into scope."""
        r, colset = self.r, self.any()
        known = {n for n, _ in self.texts.scope}
        fresh = [f"{v}{colset.name}" for v in "vwx" if f"{v}{colset.name}" not in known]
        literals = [self.literal(colset) for _ in range(3)]
        stamp = f"@{r.randint(0, 2)}" if colset.timed and self.chance(0.5) else ""
        joint = " +++ " if stamp else " ++ "
        coefficients = [r.choice((1, 1, 2, 3)) for _ in literals]
        initial = joint.join(f"{n}`{x}{stamp}" for n, x in zip(coefficients, literals, strict=True))
        if r.randrange(6) == 0:  # computed, all of it
            self.texts.scope, kept = [], self.texts.scope
            if not stamp:
                initial = f"({initial}) ++ {self.multiset(colset, 1)}"
            self.texts.scope = kept
        place = self.place(colset, initial)
        word = "in" if self.chance(0.85) else "both"
        x = fresh[0] if fresh else f"v{colset.name}"
        how = r.randrange(7)
        if fresh:
            self.texts.scope.append((x, colset.type))
        match how:
            case 0:
                return [f"{word} {place} : 2`{x}"]
            case 1 if len(fresh) > 1:
                self.texts.scope.append((fresh[1], colset.type))
                return [f"{word} {place} : 1`{x} ++ 1`{fresh[1]}"]
            case 2:
                return [
                    f"in {place} : {x}",
                    f"in {place} : {r.choice(('1', '2', '0'))}`{literals[0]}",
                ]
            case 3:
                return [
                    f"in {place} : {x}",
                    f"in {place} : if {self.boolean()} then 1`{literals[1]} else empty",
                ]
            case 4:
                return [f"in {place} : {x}", f"in {place} : {self.multiset(colset, 1)}"]
        return [f"{word} {place} : {x}"]

    def put(self) -> str:
        """An output arc."""
        r, colset = self.r, self.any()
        place = self.place(colset)
        if not colset.timed or self.chance(0.4):
            return f"out {place} : {self.multiset(colset)}"
        match r.randrange(4):
            case 0:
                return f"out {place} : 1`{self.legal(colset)}@+{self.number(3)}"
            case 1:
                return f"out {place} : 1`{self.legal(colset)}@+1 +++ 2`{self.literal(colset)}@+{self.number(2)}"
            case 2:
                return f"out {place} : ({self.multiset(colset, 1)}) @+ {self.number(3)}"
        return f"out {place} : {self.legal(colset)}@+{r.randint(0, 3)}"

    def code(self) -> str:
        """A code segment."""
        inputs = [n for n, _ in self.texts.scope]
        head = f"input ({', '.join(inputs)}); " if inputs else ""
        colset = self.any()
        known = {n for n, _ in self.texts.scope}
        fresh = [f"{v}{colset.name}" for v in "xwv" if f"{v}{colset.name}" not in known]
        change = self.r.choice(
            (
                "bump 1",
                f"bump {self.number(3)}",
                "count := 3",
                "if !count > 3 then count := 0 else ()",
            )
        )
        if not fresh or self.chance(0.3):
            return f"code {head}action (ignore ({change}))"
        value = self.legal(colset)
        self.texts.scope.append((fresh[0], colset.type))
        form = self.r.randrange(3)
        if form == 0:
            return f"code {head}output ({fresh[0]}); action (ignore ({change}); {value})"
        if form == 1:
            return f"code {head}output ({fresh[0]}); action let val old = !count val () = ignore ({change}) in if old = !count then {value} else {self.literal(colset)} end"
        return f"code {head}output ({fresh[0]}); action {value}"
