# ruff: noqa: E501 - rows of texts
"""Many small random nets in one file: the state space is the union of theirs, so one compilation checks all of them.

All share the declarations; each has a page of its own, `N0`, `N1`, ..., and pages below. Places are fused over all pages:
`Pick` has one token, and `Start` of a page takes it and puts the initial marking of that page. `Fuel` gets the number of the
page, perhaps several times, and without that nothing occurs; so from then on only this page can do anything, and other
places may belong to many pages. The number that `On` gets remains, so no marking is of two pages.

Union number 17 is the same on every machine, and so is each of its nets with and without the others.
"""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

from helpers.random_graphs import with_real_time
from helpers.random_nets import BOOL, INT, UNIT, VARIABLES, Kind, Place, Scope, Writer

STYLES = ("timed", "small", "untimed", "symmetric", "timed", "real")
"""Of unions, by their numbers.

"timed", "untimed", "real": everything, with a clock of integers, none, one of reals. "small": finite colour sets and no effects,
"symmetric": besides, nothing tells the colours of a colour set apart; both are for reductions.
"""
_SMALL = ("range", "enum", "index", "product", "record", "union", "subset", "alias")


@dataclass(frozen=True, slots=True)
class Union:
    """A file.

    Args:
        number: which.
        style: one of `STYLES`.
        head: the declarations.
        pages: of each net.
    """

    number: int
    style: str
    head: str
    pages: tuple[str, ...]

    def text(self, *only: int) -> str:
        """The file, or one with these nets only."""
        pages = [self.pages[i] for i in only] if only else self.pages
        text = self.head + "".join(pages)
        return with_real_time(text) if self.style == "real" else text


def page_of(name: str) -> int:
    """The number of the net that a place or transition belongs to, by its name."""
    first = name.partition(".")[0]
    return int(first[1:]) if first[:1] == "N" and first[1:].isdigit() else -1


def union(number: int, size: int) -> Union:
    """Union number so-and-so, with so many nets."""
    style = STYLES[number % len(STYLES)]
    kind = {"small": _Small, "symmetric": _Symmetric}.get(style, Everything)
    writer = kind(Random(number), style)
    writer.has_priorities = style != "small" or number % (2 * len(STYLES)) == 1
    writer.declarations()
    writer.lines.append(f"  colset WHO = int with 0..{size - 1};")
    head = "\n".join(writer.lines) + "\n"
    pages = []
    for i in range(size):
        writer.r, writer.lines = Random(number * 10_007 + i), []
        writer.page(i)
        pages.append("\n".join(writer.lines) + "\n")
    made = Union(number, style, head, tuple(pages))
    return _without_steps(made) if number % len(STYLES) == 0 else made


def _without_steps(union: Union) -> Union:
    """Nothing looks at the number of steps, which forbids to reduce by time."""
    look = "IntInf.toInt (step ())"
    pages = tuple(page.replace(look, "11") for page in union.pages)
    return Union(union.number, union.style, union.head.replace(look, "11"), pages)


class Everything(Writer):
    """Colour sets of all kinds, and all that inscriptions can do."""

    def __init__(self, r: Random, style: str) -> None:
        super().__init__(r)
        self.style = style
        self.lines[0] = "net Union"
        self.fuel = 0
        self.chosen: list[Kind] = []
        self.is_easy = False
        self.number = 0
        self.has_priorities = True
        self.members: list[str] = []
        """Fusion sets of all pages that the page has places of."""

    # --- declarations

    def declarations(self) -> None:
        for i in range(self.r.randint(8, 12)):
            self.kind(f"C{i}")
        self.more()
        for i in range(self.r.randint(2, 5)):
            self.function(f"f{i}")
        for name in ("INT", "BOOL", "STRING", "UNIT", "REAL"):
            self.variables(name)

    def kind(self, name: str) -> None:
        """Also of those that have stamps there is one without, where the net has no clock."""
        before = len(self.lines)
        super().kind(name)
        if self.style in ("timed", "real"):
            return
        self.lines[before:] = [text.replace(" timed;", ";") for text in self.lines[before:]]
        self.kinds = [
            Kind(k.name, k.kind, k.parts, k.names, k.size, False, k.base) for k in self.kinds
        ]

    def more(self) -> None:
        """Colour sets that `Writer` does not know, made out of those that it does."""
        r = self.r
        for name, text, kind in (
            ("K0", "bool with (no, yes)", Kind("K0", "enum", names=("no", "yes"), size=0)),
            ("K1", "unit with dot", Kind("K1", "enum", names=("dot",), size=0)),
            ("K2", "list INT with 0..2", Kind("K2", "list", (("", INT),))),
            ("K3", "subset INT by positive", Kind("K3", "subset", names=("1", "2", "7"), base=INT)),
            ("K4", "int with ~2..3", Kind("K4", "subset", names=("(~2)", "0", "3"), base=INT)),
        ):
            if not self.chance(0.6):
                continue
            if name == "K3":
                self.lines.append("  fun positive i = i > 0")
            is_timed = self.style in ("timed", "real") and r.random() < 0.3
            self.lines.append(f"  colset {name} = {text}{' timed' if is_timed else ''};")
            self.kinds.append(
                Kind(name, kind.kind, kind.parts, kind.names, kind.size, is_timed, kind.base)
            )
            self.variables(name)

    # --- pages

    def page(self, number: int) -> None:
        r = self.r
        self.number = number
        self.fuel = r.choice((0, 0, 3, 4, 4, 5))
        self.members = []
        self.lines.append(f"  page N{number}")
        own = [k for k in self.kinds if k.name[0] in "CK"]
        self.chosen = r.sample(own, min(len(own), r.choice((1, 2, 2, 3))))
        shared = [f"    place {name} fusion {name} : WHO" for name in ("On", "Fuel")]
        self.lines.append("    place Pick fusion Pick : UNIT = 1`()")
        self.lines += shared
        start = ["in Pick : ()", f"out On : {number}", f"out Fuel : {self.fuel or 1}`{number}"]
        places: list[Place] = []
        for i in range(r.randint(2, 4)):
            place = Place(f"P{i}", self.colours())
            pool = self.pooled(place.kind)
            places.append(place)
            self.place(place, f" fusion {pool}" if pool else "", start)
        if self.chance(0.15):
            kind = self.colours()
            initial = self.place(Place("P8", kind), f" fusion Shared{number}", start)
            self.lines.append(f"    place P9 fusion Shared{number} : {kind.name}{initial}")
            places += [Place("P8", kind), Place("P9", kind)]
        self.lines.append("    trans Start")
        self.lines += [f"      {arc}" for arc in start]
        for i in range(r.choice((1, 2, 3, 3, 4))):
            self.occurring(f"T{i}", places)
        if self.chance(0.15):
            a, b = r.choice(places[:2]), r.choice(places[:2])
            for i in range(r.randint(1, 2)):
                self.lines.append(f"    subst S{i} = Sub{number} (A -> {a.name}, B -> {b.name})")
            self.lines.append(f"  page Sub{number}")
            self.lines += shared
            inner = [Place("A", a.kind), Place("B", b.kind)]
            self.lines += [f"    place {p.name} port io : {p.kind.name}" for p in inner]
            if self.chance(0.5):
                inner.append(Place("Own", self.colours()))
                self.lines.append(f"    place Own : {inner[-1].kind.name}")
            self.occurring("U0", inner)

    def pooled(self, kind: Kind) -> str:
        """The fusion set of all pages that a place belongs to; "" if the place is the page's own."""
        free = [i for i in range(2) if f"Q{kind.name}{i}" not in self.members]
        if not free or self.chance(0.15):
            return ""
        self.members.append(f"Q{kind.name}{free[0]}")
        return self.members[-1]

    def colours(self) -> Kind:
        """The colour set of a place: few on a page, so that tokens get around."""
        return self.r.choice(self.chosen) if self.chance(0.9) else self.r.choice(self.kinds)

    def place(self, place: Place, words: str, start: list[str]) -> str:
        """The place, and its tokens: from `Start`, or with fuel also of its own, which are given back."""
        tokens, own = self.tokens(place.kind), ""
        if not words and self.style != "symmetric" and self.chance(0.2):
            tokens = self.plain(place.kind, Scope(), 0)  # cannot raise an exception
            own = f" = {self.r.randint(1, 2)}`{tokens}"
        self.lines.append(f"    place {place.name}{words} : {place.kind.name}{own}")
        if tokens and not own:
            start.append(f"out {place.name} : {tokens}")
        return own

    def tokens(self, kind: Kind) -> str:
        r = self.r
        if self.chance(0.12):
            return ""
        if 1 < kind.size <= 4 and kind.kind != "subset" and not kind.timed and self.chance(0.3):
            return f"{kind.name}.all()"
        values = [self.value(kind, Scope(), 1) for _ in range(r.choice((1, 2, 2, 3)))]
        terms = [f"{r.choice((1, 1, 2))}`{value}" for value in values]
        if kind.timed and self.chance(0.5):
            return " +++ ".join(f"{term}@+{r.randint(0, 3)}" for term in terms)
        return " ++ ".join(terms)

    def pattern(self, kind: Kind, scope: Scope, depth: int) -> str:
        """Often a variable: it matches."""
        if kind is not UNIT and (self.is_easy or self.chance(0.4)):
            name = f"{self.r.choice(VARIABLES)}{kind.name}"
            scope.add(name, kind)
            return name
        return super().pattern(kind, scope, depth)

    def occurring(self, name: str, places: list[Place]) -> None:
        """A transition that occurs on a page that was picked only, and not for ever if there is fuel."""
        before = len(self.lines)
        self.is_easy = self.chance(0.6)
        self.transition(name, places, "    ")
        self.lines.append(f"      {'in' if self.fuel else 'both'} Fuel : {self.number}")
        self.balance(before)
        if not self.has_priorities:
            kept = [t for t in self.lines[before:] if not t.startswith("      priority ")]
            self.lines[before:] = kept

    def balance(self, before: int) -> None:
        """Without fuel, no more tokens are put than taken, mostly."""
        if self.fuel or not self.chance(0.8):
            return
        taken = sum(text.startswith("      in ") for text in self.lines[before:])
        kept = []
        for text in self.lines[before:]:
            if text.startswith("      out "):
                taken -= 1
                if taken < 0:
                    continue
            kept.append(text)
        self.lines[before:] = kept


class _Small(Everything):
    """Small finite colour sets, no clock, no effects."""

    def __init__(self, r: Random, style: str) -> None:
        super().__init__(r, style)
        self.kinds = [BOOL, UNIT]

    def declarations(self) -> None:
        for i in range(self.r.randint(6, 9)):
            self.kind(f"C{i}")
        for name in ("BOOL", "UNIT"):
            self.variables(name)

    def component(self, small: bool = False) -> Kind:
        return super().component(True)

    def code(self, scope: Scope, clauses: list[str]) -> None:
        """None."""

    def pooled(self, kind: Kind) -> str:
        """None: what the nets do is to be independent."""
        return ""


class _Symmetric(_Small):
    """The colours of a colour set are all alike: inscriptions have variables, tuples of them, and `all()`."""

    def declarations(self) -> None:
        r = self.r
        base = [
            Kind("C0", "range", size=r.randint(2, 3)),
            Kind("C1", "enum", names=("ea", "eb", "ec"), size=3),
        ]
        self.lines.append(f"  colset C0 = int with 0..{base[0].size - 1};")
        self.lines.append("  colset C1 = with ea | eb | ec;")
        base.append(Kind("C2", "index", names=("ix",), size=2))
        self.lines.append("  colset C2 = index ix with 0..1;")
        self.kinds = list(base)
        for i in range(3, 6):
            parts = [r.choice(base) for _ in range(2)]
            is_record = r.random() < 0.4
            of = (
                f"record a: {parts[0].name} * b: {parts[1].name}"
                if is_record
                else f"product {parts[0].name} * {parts[1].name}"
            )
            labels = ("a", "b") if is_record else ("", "")
            self.lines.append(f"  colset C{i} = {of};")
            made = tuple(zip(labels, parts, strict=True))
            size = parts[0].size * parts[1].size
            self.kinds.append(Kind(f"C{i}", "record" if is_record else "product", made, (), size))
        for kind in self.kinds:
            self.lines.append(
                f"  var {', '.join(f'{v}{kind.name}' for v in VARIABLES)}: {kind.name};"
            )

    def colours(self) -> Kind:
        return self.r.choice(self.kinds) if self.chance(0.85) else UNIT

    def tokens(self, kind: Kind) -> str:
        if kind is UNIT:
            return f"{self.r.randint(1, 2)}`()"
        if self.chance(0.7 if kind.parts else 0.4):
            return ""
        return f"{kind.name}.all()"

    def of_variables(self, kind: Kind) -> str:
        if kind is UNIT:
            return "()"
        if not kind.parts or self.chance(0.4):
            return f"{self.r.choice(VARIABLES)}{kind.name}"
        values = [(label, f"{self.r.choice(VARIABLES)}{k.name}") for label, k in kind.parts if k]
        if kind.kind == "record":
            return "{" + ", ".join(f"{label} = {value}" for label, value in values) + "}"
        return f"({', '.join(value for _, value in values)})"

    def transition(self, name: str, places: list[Place], indent: str) -> None:
        r = self.r
        arcs = []
        taken = r.randint(1, 2)
        for place in r.sample(places, taken):
            word = "in" if self.chance(0.8) else "both"
            arcs.append(f"{word} {place.name} : {self.of_variables(place.kind)}")
        for place in r.sample(places, r.randint(0, 2 if self.fuel else taken)):
            text = self.of_variables(place.kind)
            if place.kind is not UNIT and text.isidentifier() and self.chance(0.15):
                text = f"{place.kind.name}.all() -- 1`{text}"
            arcs.append(f"out {place.name} : {text}")
        if self.chance(0.1):
            arcs.append(f"{r.choice(('inhibit', 'reset'))} {r.choice(places).name} :")
        self.lines.append(f"{indent}trans {name}")
        if self.chance(0.25):
            kind = r.choice(self.kinds)
            v, w = f"v{kind.name}", f"w{kind.name}"
            guard = f"{v} {r.choice(('=', '<>'))} {w}"
            taken_there = {arc.partition(" : ")[2] for arc in arcs if arc.startswith("in ")}
            if (
                "=" in guard and not {v, w} & taken_there
            ):  # an equation binds only from what is bound
                guard = f"not ({v} <> {w})"
            self.lines.append(f"{indent}  guard [{guard}]")
        self.lines += [f"{indent}  {arc}" for arc in arcs]
