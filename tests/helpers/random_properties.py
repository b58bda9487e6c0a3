"""Random properties of a net, of all kinds."""

from __future__ import annotations

from random import Random

from pn2code.net.engine_names import EngineNames
from pn2code.net.flat import FlatNet

_JOINS = ("&&", "||", "->", "<->")


class Author:
    """Who writes them.

    Args:
        r: decides.
        net: what they are about.
    """

    def __init__(self, r: Random, net: FlatNet) -> None:
        self.r = r
        self.net = net
        self.names = EngineNames(net)

    def property(self) -> str:
        """A property."""
        r = self.r
        match r.randrange(9):
            case 0:
                return f"{r.choice(['always', 'never', 'reachable'])} {self.joined(r.randrange(3))}"
            case 1:
                return f"deadlock free except {self.joined(1)}"
            case 2:
                return f"bound {r.randrange(2)} <= {self.place()} <= {r.randint(1, 3)}"
            case 3 | 4:
                return f"ctl {self.branching(r.randint(1, 3))}"
            case 5 | 6:
                return f"ltl {self.linear(r.randint(1, 3))}{self.assumption()}"
            case 7:
                return f"every {self.event()} is followed by {self.event()} within {r.randrange(8)} firings"
            case _:
                limit = f" within {r.randrange(12)} time" if self.net.timed else ""
                return f"every {self.event()} is followed by {self.event()}{limit}"

    def place(self) -> str:
        return self.names.place(self.r.randrange(len(self.net.places)))

    def transition(self) -> str:
        return self.names.transition(self.r.randrange(len(self.net.transitions)))

    def atom(self, *, steps: bool = False) -> str:
        r = self.r
        match r.randrange(6 if steps else 5):
            case 0 | 1:
                operator = r.choice(["=", ">=", "<=", "<>", "<", ">"])
                return f"tokens({self.place()}) {operator} {r.randrange(3)}"
            case 2:
                return f"enabled({self.transition()})"
            case 3:
                return r.choice(["dead", "initial", "true"])
            case 4:
                return f"{{ size (Mark.{self.place()}) = size (Mark.{self.place()}) }}"
            case _:
                return f"fires({self.transition()})"

    def event(self) -> str:
        return f"fires({self.transition()})" if self.r.random() < 0.5 else self.atom()

    def joined(self, depth: int) -> str:
        if depth == 0:
            return self.atom()
        if self.r.random() < 0.2:
            return f"!({self.joined(depth - 1)})"
        return f"(({self.joined(depth - 1)}) {self.r.choice(_JOINS)} ({self.joined(depth - 1)}))"

    def branching(self, depth: int) -> str:
        if depth == 0:
            return self.atom()
        r = self.r
        a, b = self.branching(depth - 1), self.branching(depth - 1)
        return r.choice([
            f"{r.choice(['AX', 'EX', 'AF', 'EF', 'AG', 'EG'])} ({a})",
            f"{r.choice('AE')}[({a}) {r.choice('UWR')} ({b})]",
            f"{r.choice(['AX', 'EX'])}<{self.transition()}> ({a})",
            f"(({a}) {r.choice(_JOINS)} ({b}))",
        ])  # fmt: skip

    def linear(self, depth: int) -> str:
        if depth == 0:
            return self.atom(steps=True)
        r = self.r
        a, b = self.linear(depth - 1), self.linear(depth - 1)
        return r.choice([
            f"{r.choice('XFG!')} ({a})", f"(({a}) {r.choice('UWR')} ({b}))", f"(({a}) {r.choice(_JOINS)} ({b}))"
        ])  # fmt: skip

    def assumption(self) -> str:
        r = self.r
        if r.random() < 0.6:
            return ""
        some = [
            f"{r.choice(['strong', 'weak'])} {r.choice([self.transition(), 'all'])}"
            for _ in range(r.randint(1, 2))
        ]
        return f" assuming {', '.join(some)}"
