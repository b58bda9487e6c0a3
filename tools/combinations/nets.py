"""Small nets in which tokens go round: symmetric colours, clocks, priorities, references, chance, all on few places.

Each transition puts as many tokens as it takes, mostly, so that most are finite, and most have cycles: what is said of
fairness, of runs that come back and of waits depends on these.
"""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

HEAD = """net small
  standard
  colset ID = index p with 1..{size};
  colset IDT = ID timed;
  colset PAIR = product ID * ID;
  colset PAIRT = PAIR timed;
  colset BIT = int with 0..2;
  colset BITT = BIT timed;
  colset U = unit;
  colset UT = unit timed;
  colset REC = record who: ID * n: BIT;
  colset MSG = union Told: ID + Asked: PAIR + Quit;
  colset L = list ID;
  val P_HIGH = 100; val P_NORMAL = 1000; val P_LOW = 10000;
  var x, y, z : ID;
  var n, m : BIT;
  var l : L;
  {declared}
"""
_BASES = ("ID", "ID", "PAIR", "BIT", "U", "U")
_TIMED = {"ID": "IDT", "PAIR": "PAIRT", "BIT": "BITT", "U": "UT"}


def small(r: Random) -> str:
    """A net."""
    return _Net(r).text()


class _Net:
    def __init__(self, r: Random) -> None:
        self.r = r
        self.size = r.randint(2, 3)
        self.is_timed = r.random() < 0.4
        self.is_symmetric = r.random() < 0.6
        self.has_references = r.random() < 0.15
        self.draws = r.random() < 0.08
        self.has_priorities = r.random() < 0.4
        odd = ["REC", "MSG", "L"] if r.random() < 0.4 else []
        self.places = {f"P{i}": r.choice([*_BASES, *odd]) for i in range(r.randint(3, 5))}
        for i in range(2):  # somewhere to go
            self.places[f"Q{i}"] = r.choice(list(self.places.values()))

    def text(self) -> str:
        """All of it."""
        declared = "globref seen = 0;" if self.has_references else ""
        lines = [HEAD.format(size=self.size, declared=declared), "  page Top"]
        for name, kind in self.places.items():
            lines.append(f"    place {name} : {self._colset(kind)}{self._initial(kind)}")
        for i in range(self.r.randint(2, 5)):
            lines += self._transition(f"T{i}")
        return "\n".join(lines) + "\n"

    def _colset(self, kind: str) -> str:
        is_timed = self.is_timed and kind in _TIMED and self.r.random() < 0.6
        return _TIMED[kind] if is_timed else kind

    def _initial(self, kind: str) -> str:
        r = self.r
        if r.random() < 0.35:
            return ""
        match kind:
            case "ID":
                return " = ID.all()" if r.random() < 0.6 else " = 1`(p 1)"
            case "PAIR":
                return " = 1`(p 1, p 2)" if r.random() < 0.5 else " = 1`(p 1, p 1)"
            case "BIT":
                return f" = 1`{r.randint(0, 2)}"
            case "U":
                return f" = {r.randint(1, 2)}`()"
            case "REC":
                return " = 1`{who = p 1, n = 0}"
            case "MSG":
                return r.choice([" = 1`Quit", " = 1`Told (p 1)", " = 1`Asked (p 1, p 2)"])
            case _:
                return r.choice([" = 1`[]", " = 1`[p 1]"])

    def _transition(self, name: str) -> Iterator[str]:
        r = self.r
        names = list(self.places)
        taken = r.sample(names, r.randint(1, 2))
        put = [r.choice(names) for _ in taken]
        if r.random() < 0.1:
            put = put[:-1]
        bound: list[str] = []
        arcs = []
        for place, variables in zip(
            taken, (("x", "y", "n", "l"), ("y", "z", "m", "l")), strict=False
        ):
            arcs.append(f"in {place} : {self._token(self.places[place], variables, bound)}")
        known = list(bound)
        for place in put:
            arcs.append(f"out {place} : {self._made(self.places[place], known)}{self._delay()}")
        extra = r.random()
        other = r.choice(names)
        if other not in taken and extra < 0.12:
            arcs.append(f"inhibit {other} :")
        elif other not in taken and extra < 0.18:
            arcs.append(f"reset {other} :")
        elif other not in taken and extra < 0.3:
            arcs.append(
                f"both {other} : {self._token(self.places[other], ('z', 'z', 'm', 'l'), known)}"
            )
        head = f"    trans {name}"
        if r.random() < 0.3 and (guard := self._guard(known)):
            head += f" guard [{guard}]"
        if self.is_timed and r.random() < 0.2:
            head += f" delay @+{r.randint(0, 2)}"
        if self.has_priorities:
            head += f" priority {r.choice(['P_HIGH', 'P_NORMAL', 'P_NORMAL', 'P_LOW'])}"
        if self.has_references and r.random() < 0.5:
            head += " code action (seen := (!seen + 1) mod 3)"
        yield head
        yield from (f"      {arc}" for arc in arcs)

    def _token(self, kind: str, variables: tuple[str, ...], bound: list[str]) -> str:
        """A pattern; `bound` gets its variables."""
        r = self.r
        a, b, n, l = variables  # noqa: E741
        constant = not self.is_symmetric and r.random() < 0.3
        used: list[str] = []
        match kind:
            case "ID":
                text, used = ("p 1", []) if constant else (a, [a])
            case "PAIR":
                text, used = (f"({a}, {b})", [a, b]) if r.random() < 0.8 else (f"({a}, {a})", [a])
            case "BIT":
                text, used = (str(r.randint(0, 2)), []) if r.random() < 0.4 else (n, [n])
            case "U":
                text = "()"
            case "REC":
                text, used = f"{{who = {a}, n = {n}}}", [a, n]
            case "MSG":
                text, used = r.choice(
                    [("Quit", []), (f"Told {a}", [a]), (f"Asked ({a}, {b})", [a, b])]
                )
            case _:
                text, used = r.choice([(l, [l]), (f"{a} :: {l}", [a, l]), ("[]", [])])
        bound += [x for x in used if x not in bound]
        return text

    def _made(self, kind: str, known: list[str]) -> str:
        """A token of what is bound, or of anything."""
        r = self.r

        def who() -> str:
            own = [x for x in known if x in "xyz"]
            if own and r.random() < 0.85:
                return r.choice(own)
            return r.choice("xyz") if self.is_symmetric else f"p {r.randint(1, self.size)}"

        def bit() -> str:
            own = [x for x in known if x in "nm"]
            if self.draws and r.random() < 0.5:
                return "discrete (0, 2)"
            if self.has_references and r.random() < 0.3:
                return "!seen"
            some = f"({r.choice(own)} + 1) mod 3" if own else "1"
            return r.choice([some, own[0] if own else "0", str(r.randint(0, 2))])

        match kind:
            case "ID":
                return who()
            case "PAIR":
                return f"({who()}, {who()})"
            case "BIT":
                return bit()
            case "U":
                return "()"
            case "REC":
                return f"{{who = {who()}, n = {bit()}}}"
            case "MSG":
                return r.choice(["Quit", f"Told ({who()})", f"Asked ({who()}, {who()})"])
            case _:
                own = "l" in known
                return r.choice(
                    ["[]", f"[{who()}]", *(["l", f"List.take (l ^^ [{who()}], 1)"] if own else [])]
                )

    def _delay(self) -> str:
        return f"@+{self.r.randint(0, 3)}" if self.is_timed and self.r.random() < 0.4 else ""

    def _guard(self, known: list[str]) -> str:
        r = self.r
        own = [x for x in known if x in "xyz"]
        bits = [x for x in known if x in "nm"]
        some = []
        if len(own) > 1:
            some += [f"{own[0]} <> {own[1]}", f"{own[0]} = {own[1]}"]
        if bits:
            some += [f"{bits[0]} > 0", f"{bits[0]} <> 1", f"10 div {bits[0]} > 3"]
        if own and not self.is_symmetric:
            some.append(f"{own[0]} = p 1")
        return r.choice(some) if some else ""
