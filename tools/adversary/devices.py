"""Random programs of devices: what they are told, what they do, what they look at, what they answer."""

from __future__ import annotations

from dataclasses import dataclass, field
from random import Random

from tools.adversary.pages import PRIORITIES, SORTS, Page, Sort, head


@dataclass(frozen=True)
class Port:
    """A channel of a device: `told` from the supervisor, or else to it."""

    name: str
    sort: Sort
    told: bool
    kind: str

    @property
    def colset(self) -> str:
        """That of its place."""
        return self.sort.colset


INT = SORTS[0]
_CODES = ("act ()", "act ()", "act ()", "rest 1.5", "(act (); rest 0.5)", "rest 0.0")
_MEMORIES = ("k", "n + k", "10 div k", "n * 2", "if n > 2 then 0 else n + 1", "(n + k) mod 3")


@dataclass
class Program:
    """A page, its channels, the places that are worth looking at, and the sensors that it asks."""

    page: Page
    ports: list[Port] = field(default_factory=list)
    places: list[str] = field(default_factory=list)
    sensors: set[str] = field(default_factory=set)
    end: str = "Done"
    """the place from which it answers"""
    memory: str = ""
    """a place with a number that it keeps; "": it keeps none"""

    def port(self, name: str) -> Port | None:
        """That of a name; None: it has none."""
        return next((p for p in self.ports if p.name == name), None)


def program(r: Random, number: int, *, is_timed: bool) -> Program:
    """A program that is nearly right."""
    made = Program(Page(f"Dev{number}"))
    page = made.page
    told, answer = r.choice(SORTS), r.choice(SORTS)
    made.ports += [Port("cmd", told, True, "flag"), Port("ans", answer, False, "flag")]
    if r.random() < 0.3:
        made.ports.append(Port("dat", INT, True, "data"))
    if r.random() < 0.2:
        made.ports.append(Port("rep", INT, False, "data"))
    if r.random() < 0.15:
        made.ports.append(Port("hint", INT, True, r.choice(["flag", "data"])))
    for p in made.ports:
        page.port(p.name, "in" if p.told else "out", p.colset)
    page.place("Waiting", initial="1")
    page.place("Told", told.colset)
    is_late = is_timed and r.random() < 0.4
    page.place("Done", "TU" if is_late else "")
    _accepts(r, made, told)
    made.places += ["Told", "Done"]
    made.memory = "Memo" if r.random() < 0.25 else ""
    if made.memory:
        page.place("Memo", "INT", f"1`{r.randint(0, 2)}")
    _works(r, made, told, is_late=is_late)
    _reports(r, made, answer)
    return made


def _accepts(r: Random, made: Program, told: Sort) -> None:
    """From `Waiting` to `Told`: any command alike, or each with the messages that belong to it."""
    page, v = made.page, told.variable
    takes = ["in Waiting : ()", f"in cmd : {v}", f"out Told : {v}"]
    with_data = [*takes, "in dat : d"] if made.port("dat") else takes
    how = r.random()
    if how < 0.75:
        page.transition("Accept", with_data, head(r.choice(PRIORITIES)))
    else:
        one, other = (*told.tests, *told.tests)[:2]
        guard = f"not ({one})" if how < 0.85 else other
        page.transition("Accept", with_data, head(r.choice(PRIORITIES), one))
        code = "act ()" if how < 0.9 else ""
        page.transition("Accept2", takes, head(r.choice(PRIORITIES), guard, code=code))
    if not made.port("hint"):
        return
    how = r.random()
    if how < 0.5:
        page.transition("Note", ["both Waiting : ()", "in hint : e"], head(r.choice(PRIORITIES)))
    elif how < 0.8:  # it does something without being told
        arcs = ["in Waiting : ()", "in hint : e", "out Done : ()"]
        guard = r.choice(["", "", "e > 2"])
        page.transition(
            "Note", arcs, head(r.choice(PRIORITIES), guard, code=r.choice(["", "act ()"]))
        )
    else:  # it cannot end its work before
        page.place("Noted")
        page.transition("Note", ["in Done : ()", "in hint : e", "out Noted : ()"], head())
        made.end = "Noted"


def _works(r: Random, made: Program, told: Sort, *, is_late: bool) -> None:
    """From `Told` to `Done`: in one of several ways, perhaps after some rounds, or after a look."""
    page, v = made.page, told.variable
    start = "Told"
    if r.random() < 0.2:  # a loop
        page.place("Round", "INT", "1`0")
        rounds = r.randint(1, 2)
        arcs = [f"in Told : {v}", f"out Told : {v}", "in Round : n", "out Round : n + 1"]
        code = "act ()" if r.random() < 0.5 else ""
        page.transition("Turn", arcs, head(guard=f"n < {rounds}", code=code))
        page.place("Ready", told.colset)
        arcs = [f"in Told : {v}", f"out Ready : {v}", "in Round : n"]
        arcs.append(f"out Round : {r.choice(['0', '0', 'n'])}")
        page.transition("Leave", arcs, head(guard=f"n >= {rounds}"))
        start = "Ready"
    finish = "out Done : ()" + (f"@+{r.randint(0, 3)}" if is_late else "")
    if r.random() < 0.25:  # a look decides
        sensor, tests = r.choice(
            [
                ("verdict", ("c = red", "c = green")),
                ("level", ("s = 1", "s > 1")),
                ("is_held", ("b", "not b")),
            ]
        )
        made.sensors.add(sensor)
        page.place("Seen", {"verdict": "COL", "level": "SMALL", "is_held": "B"}[sensor])
        page.transition("Look", [f"in {start} : {v}", f"out Seen : {sensor}"], head(code="act ()"))
        seen = tests[0].split()[0] if sensor != "is_held" else "b"
        page.transition("Good", [f"in Seen : {seen}", finish], head(guard=tests[0]))
        how = r.random()
        if how < 0.4:
            code = "" if is_late else "act ()"
            page.transition("Bad", [f"in Seen : {seen}", finish], head(guard=tests[1], code=code))
        elif how < 0.8:
            again = ["out Waiting : ()", f"out ans : {r.choice(made.ports[1].sort.values)}"]
            page.transition("Bad", [f"in Seen : {seen}", *again], head(guard=tests[1]))
        return
    ways = r.randint(1, 3)
    for w in range(ways):
        guard = r.choice(told.tests) if w and ways > 1 and r.random() < 0.6 else ""
        code = r.choice(_CODES) if not is_late and r.random() < 0.6 else ""
        arcs = [f"in {start} : {v}", finish]
        if told.colset == "INT" and r.random() < 0.2:
            if is_late:
                arcs[1] = f"out Done : ()@+(k {r.choice(['', '', '- 1'])})"
            else:
                code = f"input (k); action rest (Real.fromInt (k {r.choice(['', '', '- 1'])}))"
        if made.memory and told.colset == "INT" and r.random() < 0.5:
            arcs += [f"in {made.memory} : n", f"out {made.memory} : {r.choice(_MEMORIES)}"]
        page.transition(f"Work{w}", arcs, head(r.choice(PRIORITIES), guard, code=code))
        if r.random() < 0.5:
            break


def _reports(r: Random, made: Program, answer: Sort) -> None:
    """From `Done` to `Waiting`, with an answer; some programs end, or say too little."""
    for w in range(r.choice([1, 1, 2])):
        value = r.choice(answer.values)
        sensor = {"COL": "verdict", "SMALL": "level", "B": "is_held"}.get(answer.colset)
        is_computed = bool(made.memory) and r.random() < 0.7
        if w == 0 and sensor and not is_computed and r.random() < 0.4:
            value = sensor
            made.sensors.add(sensor)
        after = "Waiting"
        if r.random() < 0.05:
            after = "Over"
            made.page.place("Over")
        arcs = [f"in {made.end} : ()", f"out {after} : ()"]
        guard = ""
        if is_computed:
            said = r.choice(["n", "n", "10 div n", "n + 1", "n * n"])
            is_kept = r.random() < 0.5
            arcs += ["both Memo : n"] if is_kept else ["in Memo : n", f"out Memo : {said}"]
            guard = r.choice(["", "", "n > 0", "10 div n > 3", "n < 3"])
            if answer.colset in ("INT", "SMALL"):
                value = said
        arcs.append(f"out ans : {value}")
        if made.port("rep") and (w == 0 or r.random() < 0.8):
            arcs.append(f"out rep : {r.randint(0, 3)}")
        made.page.transition(f"Report{w}", arcs, head(r.choice(PRIORITIES), guard))
        if after == "Over":
            break
