"""Small coloured nets of the kinds that the contest has: mutual exclusion, elections, resources, protocols, games."""

from __future__ import annotations

from helpers.coloured_nets import (
    DOT,
    ColouredNet,
    Enum,
    Partition,
    Product,
    Range,
    add,
    all_,
    eq,
    less,
    ne,
    pred,
    succ,
    times,
    tup,
)


def _enum(name: str, n: int, *, cyclic: bool = True) -> Enum:
    return Enum(tuple(f"{name}{i}" for i in range(n)), cyclic)


def shared_memory(n: int = 3) -> ColouredNet:
    """Processors that use memories over one bus, each its own or another one's."""
    return ColouredNet(
        {"P": _enum("p", n), "PM": Product(("P", "P"))},
        {"x": "P", "y": "P"},
        {
            "Active": ("P", all_("P")), "Queue": ("P", None), "Memory": ("P", all_("P")),
            "Own": ("P", None), "Other": ("PM", None), "Bus": (DOT, times(1, DOT)),
        },
        [
            ("ask", None, {"Active": "x"}, {"Queue": "x"}),
            ("own", None, {"Queue": "x", "Memory": "x"}, {"Own": "x"}),
            ("end_own", None, {"Own": "x"}, {"Active": "x", "Memory": "x"}),
            ("other", ne("x", "y"), {"Queue": "x", "Memory": "y", "Bus": DOT}, {"Other": tup("x", "y")}),
            ("end", None, {"Other": tup("x", "y")}, {"Active": "x", "Memory": "y", "Bus": DOT}),
        ],
    )  # fmt: skip


def dynamic_philosophers() -> ColouredNet:
    """Philosophers who come to a table of which they do not know the places, and leave."""
    return ColouredNet(
        {"Id": _enum("i", 3, cyclic=False), "Pair": Product(("Id", "Id"))},
        {"x": "Id", "y": "Id", "z": "Id"},
        {
            "Out": ("Id", less(all_("Id"), "i0")), "Think": ("Id", times(1, "i0")), "Eat": ("Id", None),
            "Fork": ("Id", times(1, "i0")), "Next": ("Pair", tup("i0", "i0")),
        },
        [
            ("sit", ("and", ne("x", "y"), ("not", eq("x", "z"))), {"Out": "x", "Next": tup("y", "z")},
             {"Think": "x", "Fork": "x", "Next": add(tup("y", "x"), tup("x", "z"))}),
            ("eat", ne("x", "y"), {"Think": "x", "Fork": add("x", "y"), "Next": tup("x", "y")},
             {"Eat": "x", "Next": tup("x", "y")}),
            ("think", None, {"Eat": "x", "Next": tup("x", "y")}, {"Think": "x", "Fork": add("x", "y"),
             "Next": tup("x", "y")}),
            ("leave", ("or", ("lessthan", "x", "i2"), eq("x", "i2")),
             {"Think": "x", "Fork": "x", "Next": add(tup("y", "x"), tup("x", "z"))},
             {"Out": "x", "Next": tup("y", "z")}),
        ],
    )  # fmt: skip


def quasi_certificate() -> ColouredNet:
    """A certificate is signed by all servers, in any order, or is broken off."""
    return ColouredNet(
        {"S": _enum("s", 3), "Vote": Enum(("yes", "no"), False), "SV": Product(("S", "Vote"))},
        {"x": "S", "v": "Vote", "w": "Vote"},
        {
            "Start": (DOT, times(1, DOT)), "Asked": ("S", None), "Said": ("SV", None),
            "Good": (DOT, None), "Bad": (DOT, None), "Log": ("SV", tup(all_("S"), "no")),
        },
        [
            ("ask", None, {"Start": DOT}, {"Asked": all_("S")}),
            ("vote", None, {"Asked": "x"}, {"Said": tup("x", "v")}),
            ("win", None, {"Said": tup(all_("S"), "yes")}, {"Good": DOT}),
            ("lose", None, {"Said": tup("x", "no")}, {"Bad": DOT}),
            ("log", ne("v", "w"), {"Log": tup("x", "v"), "Bad": DOT}, {"Log": tup("x", "w"), "Bad": DOT}),
        ],
    )  # fmt: skip


def fast_mutex() -> ColouredNet:
    """Two shared variables, one with "nobody" as its first value."""
    return ColouredNet(
        {"P": Range(0, 2), "B": Enum(("f", "t"), False), "PB": Product(("P", "B"))},
        {"i": "P", "j": "P", "b": "B"},
        {
            "Idle": ("P", less(all_("P"), 0)), "Want": ("P", None), "In": ("P", None),
            "X": ("P", times(1, 0)), "Y": ("P", times(1, 0)), "Flag": ("PB", tup(all_("P"), "f")),
        },
        [
            ("start", ne("i", 0), {"Idle": "i", "X": "j", "Flag": tup("i", "b")},
             {"Want": "i", "X": "i", "Flag": tup("i", "t")}),
            ("enter", ("and", ("greaterthan", "i", 0), eq("i", "i")), {"Want": "i", "X": "i", "Y": 0},
             {"In": "i", "X": "i", "Y": "i"}),
            ("retry", ("and", ("greaterthanorequal", "j", 1), ne("i", "j")), {"Want": "i", "Y": "j"},
             {"Idle": "i", "Y": "j"}),
            ("leave", None, {"In": "i", "Y": "i", "Flag": tup("i", "t")},
             {"Idle": "i", "Y": 0, "Flag": tup("i", "f")}),
        ],
    )  # fmt: skip


def safe_bus() -> ColouredNet:
    """A bus that goes round, with a set of those who wait made by subtraction."""
    return ColouredNet(
        {"It": _enum("t", 3), "Pair": Product(("It", "It"))},
        {"x": "It", "y": "It"},
        {
            "Cable": ("It", all_("It")), "Wait": ("It", None), "Turn": ("It", times(1, "t0")), "Sent": ("Pair", None),
        },
        [
            ("ask", None, {"Cable": "x"}, {"Wait": "x"}),
            ("send", None, {"Wait": "x", "Turn": "x"}, {"Sent": tup("x", less(all_("It"), "x"))}),
            ("get", None, {"Sent": tup("x", "y")}, {"Cable": times(1, "y")}),
            ("pass", None, {"Turn": "x"}, {"Turn": succ("x")}),
            ("drop", None, {"Cable": times(2, "x")}, {"Cable": "x", "Turn": pred("x")}),
        ],
    )  # fmt: skip


def admissibility() -> ColouredNet:
    """A network of switches that permute their inputs: it only goes forward."""
    return ColouredNet(
        {"N": Range(0, 3)},
        {"a": "N", "b": "N"},
        {
            "In": ("N", all_("N")), "One": ("N", None), "Two": ("N", None), "Out": ("N", None),
        },
        [
            ("low", ("lessthan", "a", 2), {"In": "a"}, {"One": "a"}),
            ("high", ("and", ("lessthanorequal", 2, "a"), ("not", ("greaterthan", "a", 3))), {"In": "a"}, {"Two": "a"}),
            ("swap", ("lessthan", "a", "b"), {"One": "a", "Two": "b"}, {"Out": add("a", "b")}),
        ],
    )  # fmt: skip


def resources() -> ColouredNet:
    """Processes that take one, then a second resource: they can wait for one another."""
    return ColouredNet(
        {
            "P": _enum("p", 2), "R": _enum("r", 3, cyclic=False),
            "PR": Product(("P", "R")), "PRR": Product(("P", "R", "R")),
        },
        {"p": "P", "r": "R", "s": "R"},
        {
            "Idle": ("P", all_("P")), "Free": ("R", less(times(2, all_("R")), add("r0", times(2, "r2")))),
            "Has": ("PR", None), "Both": ("PRR", None),
        },
        [
            ("first", None, {"Idle": "p", "Free": "r"}, {"Has": tup("p", "r")}),
            ("second", None, {"Has": tup("p", "r"), "Free": "s"}, {"Both": tup("p", "r", "s")}),
            ("free", None, {"Both": tup("p", "r", "s")}, {"Idle": "p", "Free": add("r", "s")}),
        ],
    )  # fmt: skip


def vending() -> ColouredNet:
    """Products and options, each of a sort of its own; what is chosen depends on a partition."""
    return ColouredNet(
        {
            "D": _enum("d", 4), "Kind": Partition("D", {"hot": ("d0", "d2"), "cold": ("d1", "d3")}),
            "DK": Product(("D", "Kind")),
        },
        {"x": "D", "y": "D", "k": "Kind"},
        {
            "Ready": ("D", add("d0", "d1", "d3")), "Made": ("DK", None), "Coins": (DOT, times(3, DOT)),
            "Taken": ("D", None),
        },
        [
            ("make", eq(("part", "Kind", "x"), "k"), {"Ready": "x", "Coins": DOT}, {"Made": tup("x", "k")}),
            ("take", ("not", eq("k", "hot")), {"Made": tup("x", "k")}, {"Taken": "x"}),
            ("change", ("and", eq(("part", "Kind", "x"), ("part", "Kind", "y")), ne("x", "y")),
             {"Taken": "x"}, {"Ready": "y"}),
            ("pour", None, {"Made": tup("x", "hot")}, {"Ready": succ(succ("x")), "Coins": times(1, DOT)}),
        ],
    )  # fmt: skip


def peterson(n: int = 2) -> ColouredNet:
    """Each process waits at each level until it is not the last one there, or all others are out (Peterson 1981)."""
    last, top, zero = ("number", "Pid", n - 1), ("number", "Level", n - 2), ("number", "Pid", 0)
    at = tup("i", "l")
    more = [("climb", ("lessthan", "l", top), {"Passed": at}, {"Ask": tup("i", succ("l"))})]
    return ColouredNet(
        {
            "Pid": Range(0, n - 1), "Level": Range(0, n - 2), "Flag": Enum(("out", "in"), cyclic=False),
            "PF": Product(("Pid", "Flag")), "PL": Product(("Pid", "Level")), "LP": Product(("Level", "Pid")),
            "PLP": Product(("Pid", "Level", "Pid")),
        },
        {"i": "Pid", "k": "Pid", "l": "Level"},
        {
            "Idle": ("Pid", all_("Pid")), "Wants": ("PF", tup(all_("Pid"), "out")), "Ask": ("PL", None),
            "Turn": ("LP", tup(all_("Level"), zero)), "Test": ("PL", None), "Look": ("PLP", None),
            "Next": ("PLP", None), "Passed": ("PL", None), "Critical": ("Pid", None),
        },
        [
            ("ask", None, {"Idle": "i", "Wants": tup("i", "out")},
             {"Wants": tup("i", "in"), "Ask": tup("i", ("number", "Level", 0))}),
            ("turn", None, {"Ask": at, "Turn": tup("l", "k")}, {"Turn": tup("l", "i"), "Test": at}),
            ("not_last", ne("i", "k"), {"Test": at, "Turn": tup("l", "k")}, {"Turn": tup("l", "k"), "Passed": at}),
            ("last", None, {"Test": at, "Turn": tup("l", "i")}, {"Turn": tup("l", "i"), "Look": tup("i", "l", zero)}),
            ("itself", eq("i", "k"), {"Look": tup("i", "l", "k")}, {"Next": tup("i", "l", "k")}),
            ("is_out", ne("i", "k"), {"Look": tup("i", "l", "k"), "Wants": tup("k", "out")},
             {"Next": tup("i", "l", "k"), "Wants": tup("k", "out")}),
            ("is_in", ne("i", "k"), {"Look": tup("i", "l", "k"), "Wants": tup("k", "in")},
             {"Test": at, "Wants": tup("k", "in")}),
            ("next", ("lessthan", "k", last), {"Next": tup("i", "l", "k")}, {"Look": tup("i", "l", succ("k"))}),
            ("alone", None, {"Next": tup("i", "l", last)}, {"Passed": at}),
            *(more if n > 2 else []),
            ("enter", None, {"Passed": tup("i", top)}, {"Critical": "i"}),
            ("leave", None, {"Critical": "i", "Wants": tup("i", "in")}, {"Idle": "i", "Wants": tup("i", "out")}),
        ],
    )  # fmt: skip


def trains(n: int = 2, speeds: int = 3, way: int = 5) -> ColouredNet:
    """Trains with a speed and a way to go, which they have to be slow enough for."""
    slow, here, end = ("number", "Speed", 0), tup("t", "s", "d"), ("number", "Way", 0)
    return ColouredNet(
        {
            "Train": _enum("t_", n, cyclic=False), "Speed": Range(0, speeds - 1), "Way": Range(0, way - 1),
            "TSW": Product(("Train", "Speed", "Way")),
        },
        {"t": "Train", "s": "Speed", "d": "Way"},
        {"Out": ("Train", all_("Train")), "On": ("TSW", None), "There": ("Train", None)},
        [
            ("start", None, {"Out": "t"}, {"On": tup("t", slow, ("number", "Way", way - 1))}),
            ("faster", ("and", ("lessthan", "s", ("number", "Speed", speeds - 1)),
             ("greaterthan", "d", ("number", "Way", 1))), {"On": here}, {"On": tup("t", succ("s"), pred("d"))}),
            ("on", ("and", ("greaterthan", "s", slow), ("greaterthan", "d", end)),
             {"On": here}, {"On": tup("t", "s", pred("d"))}),
            ("slower", ("and", ("greaterthan", "s", slow), ("greaterthan", "d", end)),
             {"On": here}, {"On": tup("t", pred("s"), pred("d"))}),
            ("arrive", None, {"On": tup("t", slow, end)}, {"There": "t"}),
            ("again", None, {"There": "t"}, {"Out": "t"}),
        ],
    )  # fmt: skip


FAMILIES = {
    f.__name__: f
    for f in (
        shared_memory, dynamic_philosophers, quasi_certificate, fast_mutex, safe_bus, admissibility, resources, vending,
        peterson, trains,
    )
}  # fmt: skip
