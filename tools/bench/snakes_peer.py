"""The benchmark nets in SNAKES, the Python library of Petri nets, and their firings per second there.

Each function builds the same net as the text of the same name in `measures`: same tokens, same guards, one firing a
step, drawn at random among all enabled bindings. Where SNAKES has two ways to say a thing, the faster one is taken.
"""

from __future__ import annotations

import random
import time
from collections.abc import Callable

from snakes.nets import (  # type: ignore[import-untyped]
    Expression,
    MultiArc,
    PetriNet,
    Place,
    Transition,
    Variable,
)


def ring() -> PetriNet:
    """`measures.RING`: a counter goes round through four places."""
    net = PetriNet("ring")
    for i in range(4):
        net.add_place(Place(f"p{i}", [0] if i == 0 else []))
    for i, text in enumerate(("n + 1", "n", "n", "n % 1000")):
        net.add_transition(Transition(f"t{i}"))
        net.add_input(f"p{i}", f"t{i}", Variable("n"))
        net.add_output(f"p{(i + 1) % 4}", f"t{i}", Expression(text))
    return net


def table() -> PetriNet:
    """`measures.TABLE`: ten philosophers who take both forks at once."""
    net = PetriNet("table")
    net.globals["seats"] = 10
    net.add_place(Place("thinking", list(range(10))))
    net.add_place(Place("eating", []))
    net.add_place(Place("forks", list(range(10))))
    net.add_transition(Transition("take", Expression("q == (p + 1) % seats")))
    net.add_input("thinking", "take", Variable("p"))
    net.add_input("forks", "take", MultiArc([Variable("p"), Variable("q")]))
    net.add_output("eating", "take", Expression("p"))
    net.add_transition(Transition("put"))
    net.add_input("eating", "put", Variable("p"))
    net.add_output("thinking", "put", Expression("p"))
    net.add_output("forks", "put", MultiArc([Expression("p"), Expression("(p + 1) % seats")]))
    return net


def protocol() -> PetriNet:
    """`measures.PROTOCOL`: packets with text are sent, lost at times, received in order and acknowledged."""
    net = PetriNet("protocol")
    packets = [(n, f"packet {n}") for n in range(1, 9)]
    net.add_place(Place("send", packets))
    net.add_place(Place("a", []))
    net.add_place(Place("b", []))
    net.add_place(Place("received", [(1, "")]))
    net.add_place(Place("limit", [0, 1, 2]))
    net.add_transition(Transition("Send"))
    net.add_input("send", "Send", Variable("p"))
    net.add_input("limit", "Send", Variable("c"))
    net.add_output("send", "Send", Expression("p"))
    net.add_output("a", "Send", Expression("(c, p)"))
    net.add_transition(Transition("Lose"))
    net.add_input("a", "Lose", Variable("m"))
    net.add_output("limit", "Lose", Expression("m[0]"))
    net.add_transition(Transition("Pass"))
    net.add_input("a", "Pass", Variable("m"))
    net.add_output("b", "Pass", Expression("m"))
    net.add_transition(Transition("Receive"))
    net.add_input("b", "Receive", Variable("m"))
    net.add_input("received", "Receive", Variable("r"))
    net.add_output(
        "received",
        "Receive",
        Expression(
            "(r[0] % 8 + 1, m[1][1] if r[0] == 8 else r[1] + m[1][1]) if m[1][0] == r[0] else r"
        ),
    )
    net.add_output("limit", "Receive", Expression("m[0]"))
    return net


def firings_per_second(make: Callable[[], PetriNet], steps: int) -> float:
    """Of a random walk."""
    net = make()
    transitions = net.transition()
    source = random.Random(1)
    start = time.perf_counter()
    for _ in range(steps):
        t, mode = source.choice([(t, m) for t in transitions for m in t.modes()])
        t.fire(mode)
    return steps / (time.perf_counter() - start)
