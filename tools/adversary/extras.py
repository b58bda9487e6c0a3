"""What random supervisors do besides: many tokens, inhibitor and reset arcs, stamps, reals, lists of unions, code."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

from tools.adversary.pages import Page, head

Head = Callable[..., str]
"""What stands behind the name of a transition: guard, delay."""


def more(
    r: Random, page: Page, devices: int, clauses: Head, *, is_timed: bool, path: str
) -> list[str]:
    """Adds some of them; gives the paths of their places."""
    chosen = [f for f in _FORMS if r.random() < 0.12]
    if is_timed:
        chosen += [f for f in _TIMED if r.random() < 0.25]
    return [f"{path}{name}" for form in chosen for name in form(r, page, devices, clauses)]


def _when(r: Random, devices: int) -> str:
    """An arc that looks at how far an exchange is."""
    return f"both {r.choice(['Idle', 'Armed', 'Have'])}{r.randint(1, devices)} : ()"


def _does(r: Random, devices: int) -> list[str]:
    """What comes of it: mostly nothing else."""
    return r.choice([[], [], ["out Alarm : ()"], [f"out Idle{r.randint(1, devices)} : ()"]])


def _bag(r: Random, page: Page, devices: int, clauses: Head) -> list[str]:
    """Tokens of which the first in order is taken, one or two at a time."""
    page.place("Bag", "INT", r.choice(["1`1++2`2", "1`1++1`2++1`3", "3`2", "2`(~1)++1`4"]))
    page.place("Drawn", "INT")
    one = r.random() < 0.6
    arcs = ["in Bag : n", "out Drawn : n"] if one else ["in Bag : 1`n++1`m", "out Drawn : m - n"]
    guards = ["", "n <> 2", "n > 1"] if one else ["", "n < m", "n <> m"]
    page.transition(
        "Draw", [*arcs, _when(r, devices), *_does(r, devices)], clauses(r.choice(guards))
    )
    if r.random() < 0.4:
        arcs = [
            "in Drawn : n",
            f"out Bag : {r.choice(['n', 'n + 1', 'n mod 2'])}",
            _when(r, devices),
        ]
        page.transition("Redraw", arcs, clauses(r.choice(["n > 1", "n = 2"])))
    return ["Bag", "Drawn"]


def _inhibited(r: Random, page: Page, devices: int, clauses: Head) -> list[str]:
    """Something that happens only while a place is empty, and a place that is emptied."""
    page.place("Free", initial=str(r.randint(1, 2)))
    page.place("Heap")
    empty = r.choice(["Alarm", "Heap", f"Have{r.randint(1, devices)}"])
    arcs = ["in Free : ()", "out Heap : ()", f"inhibit {empty}", _when(r, devices)]
    page.transition("Quiet", [*arcs, *_does(r, devices)], clauses())
    if r.random() < 0.5:
        page.place("Broom", initial="1")
        emptied = r.choice(["Alarm", "Heap", f"Idle{r.randint(1, devices)}"])
        page.transition(
            "Sweep", ["in Broom : ()", f"reset {emptied}", _when(r, devices)], clauses()
        )
    return ["Free", "Heap"]


def _reals(r: Random, page: Page, devices: int, clauses: Head) -> list[str]:
    """A level that is not a whole number."""
    page.place("Level", "REAL", f"1`{r.choice(['0.0', '1.0', '(~0.5)', '0.1'])}")
    page.place("Full")
    change = r.choice(["x + 0.5", "x * ~2.0", "x / 2.0", "~x", "1.0 / x"])
    page.place("Pump", initial=str(r.randint(1, 3)))
    arcs = ["in Pump : ()", "in Level : x", f"out Level : {change}", _when(r, devices)]
    page.transition("Rises", arcs, clauses(r.choice(["", "x < 1.0"])))
    test = r.choice(["x > 1.0", "x = 0.0", "x <= 1.0", "Real.== (x, x)"])
    page.place("Seal", initial="1")
    arcs = ["in Seal : ()", "both Level : x", "out Full : ()", *_does(r, devices)]
    page.transition("Seals", arcs, clauses(test))
    return ["Level", "Full"]


def _log(r: Random, page: Page, devices: int, clauses: Head) -> list[str]:
    """A list of what may be of several kinds."""
    page.place("Log", "EVENTS", "1`[]")
    what = r.choice(["told (length evs)", "felt 0.5", "heard red", "felt (real (length evs))"])
    arcs = ["in Log : evs", f"out Log : {what} :: evs", _when(r, devices)]
    page.transition("Logs", arcs, clauses(f"length evs < {r.randint(1, 2)}"))
    read = r.choice(["ev :: evs", "[ev]", "[ev, felt 0.5]"])
    page.place("Read", "EVENT")
    arcs = [
        f"in Log : {read}",
        "out Read : ev",
        "out Log : []",
        _when(r, devices),
        *_does(r, devices),
    ]
    page.transition("Reads", arcs, clauses())
    return ["Log", "Read"]


def _code(r: Random, page: Page, devices: int, clauses: Head) -> list[str]:
    """A code segment that gives a value; an expression that may raise an exception."""
    page.place("Count", "INT", f"1`{r.randint(0, 2)}")
    page.place("Result", "INT")
    value = r.choice(["n + 1", "10 div n", "hd (List.tabulate (n, fn j => j))", "n * n"])
    code = f"input (n); output (m); action {value}"
    arcs = ["in Count : n", "out Result : m", _when(r, devices), *_does(r, devices)]
    page.transition("Computes", arcs, head(guard=r.choice(["", "n > 0"]), code=code))
    return ["Count", "Result"]


def _stamps(r: Random, page: Page, devices: int, clauses: Head) -> list[str]:
    """Tokens of one colour with several stamps, of which the latest that is there is taken; perhaps before its time."""
    page.place("Trays", "TI", r.choice(["1`1@0+++1`1@2", "1`1@1+++1`2@1", "2`1@0+++1`2@3"]))
    page.place("Used", "TI")
    early = r.choice(["", "", "@+1"])
    arcs = [f"in Trays : n{early}", f"out Used : n@+{r.randint(0, 2)}", _when(r, devices)]
    page.transition("Uses", [*arcs, *_does(r, devices)], clauses(r.choice(["", "n = 1"])))
    if r.random() < 0.5:
        page.transition("Returns", ["in Used : n", "out Trays : n", _when(r, devices)], clauses())
    return ["Trays", "Used"]


_FORMS = (_bag, _inhibited, _reals, _log, _code)
_TIMED = (_stamps,)


def relay(r: Random, page: Page, devices: int) -> list[Page]:
    """A page that stands in the supervisor twice, each time with a place of its own."""
    if r.random() > 0.12:
        return []
    made = Page("Relay")
    made.port("Rin", "in", "UNIT")
    made.port("Rout", "out", "UNIT")
    made.place("Credit", initial=str(r.randint(1, 2)))
    made.transition("Pass", ["in Rin : ()", "in Credit : ()", "out Rout : ()"], head())
    for n in range(1, 3):
        a, b = r.randint(1, devices), r.randint(1, devices)
        page.transitions.append(f"    subst R{n} = Relay (Rin -> Have{a}, Rout -> Idle{b})")
    return [made]
