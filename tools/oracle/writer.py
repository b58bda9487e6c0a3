"""Random nets with what those of `helpers.random_nets` lack, still well-typed by construction.

Hierarchies of several levels whose pages are used many times (names of substitution transitions in any order, ports
without sockets), fusion sets over pages, constants in patterns, references, computed priorities, odd names, `as`.
"""

from __future__ import annotations

from random import Random

from helpers.random_nets import INT, Kind, Place, Scope, Writer

NAMES = ("Send", "a b", "x1", "Zeta", "beta", "T_1", "n'", "Aa", "Go 2", "mid", "q", "B")


class RichWriter(Writer):
    """Writes one net."""

    def __init__(self, r: Random) -> None:
        super().__init__(r)
        self.constants: list[tuple[str, Kind]] = []
        self.references: list[str] = []

    def declare(self) -> None:
        super().declare()
        for i in range(self.r.randint(0, 3)):
            kind = self.component()
            if kind.has_equality:
                # sometimes computed
                value = self.value(kind, Scope(), 2 if self.chance(0.3) else 0)
                self.lines.append(f"  val k{i} = {value} : {kind.name}")
                self.constants.append((f"k{i}", kind))
        if self.chance(0.3):
            self.lines.append("  globref count = 0;")
            self.references.append("count")

    def pattern(self, kind: Kind, scope: Scope, depth: int) -> str:
        known = [n for n, k in self.constants if k.name == kind.name]
        if known and self.chance(0.3):
            return self.r.choice(known)
        return super().pattern(kind, scope, depth)

    def plain(self, kind: Kind, scope: Scope, depth: int) -> str:
        known = [n for n, k in self.constants if k.name == kind.name]
        if known and self.chance(0.2):
            return self.r.choice(known)
        return super().plain(kind, scope, depth)

    def code(self, scope: Scope, clauses: list[str]) -> None:
        super().code(scope, clauses)
        if self.references and self.chance(0.6):
            head, action, body = clauses[-1].partition("action ")
            clauses[-1] = f"{head}{action}(count := (!count + 1) mod 7; {body})"

    def transition(self, name: str, places: list[Place], indent: str) -> None:
        super().transition(name, places, indent)
        if self.chance(0.1):
            at = max(i for i, line in enumerate(self.lines) if line.startswith(f"{indent}trans "))
            if not any("priority" in line for line in self.lines[at:]):
                text = self.r.choice(("P_HIGH + 1", "~3 + 10", "length [1, 2]", "Int.max (4, 7)"))
                self.lines.insert(at + 1, f"{indent}  priority {text}")

    def net(self) -> str:
        r = self.r
        self.declare()
        for name in ("INT", "BOOL", "STRING", "UNIT", "REAL"):
            self.variables(name)
        kinds = [r.choice([k for k in self.kinds if k.name.startswith("C")] or [INT]) for _ in "ab"]
        shared = r.choice(kinds) if self.chance(0.4) else None
        shared_initial = self.initial(shared) if shared else ""
        levels = r.choice((1, 2, 2, 3))
        loose = self.chance(0.15)
        names = list(NAMES)
        r.shuffle(names)
        for level in range(levels):
            self.lines.append(f"  page {('Top', 'Mid', 'Leaf')[level]}")
            places = []
            for name, kind in zip("AB", kinds, strict=True):
                port = "port io " if level else ""
                initial = "" if level else f" = {self.initial(kind)}"
                self.lines.append(f"    place {name} {port}: {kind.name}{initial}")
                places.append(Place(name, kind))
            for i in range(r.randint(0, 2)):
                kind = r.choice(self.kinds)
                places.append(Place(f"O{i}", kind))
                self.lines.append(f"    place O{i} : {kind.name} = {self.initial(kind)}")
            if shared and self.chance(0.7):
                places.append(Place("F", shared))
                self.lines.append(f"    place F fusion Shared : {shared.name} = {shared_initial}")
            for i in range(r.randint(1, 3) if level else r.randint(0, 3)):
                self.transition(f'"{r.choice(NAMES)}{i}"', places, "    ")
            for below in range(level + 1, levels):
                for _ in range(r.randint(1, 2) if below == level + 1 else r.randint(0, 1)):
                    self.substitute(names.pop(), below, kinds, places, loose)
        return "\n".join(self.lines) + "\n"

    def substitute(
        self, name: str, below: int, kinds: list[Kind], places: list[Place], loose: bool
    ) -> None:
        """A substitution transition; `loose`: not all ports have sockets."""
        given = []
        for port, kind in zip("AB", kinds, strict=True):
            sockets = [p.name for p in places if p.kind.name == kind.name]
            if not (loose and self.chance(0.5)):
                given.append(f"{port} -> {self.r.choice(sockets)}")
        page = ("Top", "Mid", "Leaf")[below]
        self.lines.append(f'    subst "{name}" = {page} ({", ".join(given)})')


def rich_net(r: Random) -> str:
    """A net."""
    return RichWriter(r).net()
