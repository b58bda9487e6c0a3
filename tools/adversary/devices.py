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


@dataclass
class Program:
    """A page, its channels, the places that are worth looking at, and the sensors that it asks."""

    page: Page
    ports: list[Port] = field(default_factory=list)
    places: list[str] = field(default_factory=list)
    sensors: set[str] = field(default_factory=set)

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
    takes = ["in Waiting : ()", f"in cmd : {told.variable}", f"out Told : {told.variable}"]
    if made.port("dat"):
        takes.insert(2, "in dat : d")
    page.transition("Accept", takes, head(r.choice(PRIORITIES)))
    if made.port("hint"):
        page.transition("Note", ["both Waiting : ()", "in hint : e"], head(r.choice(PRIORITIES)))
    made.places += ["Told", "Done"]
    _works(r, made, told, is_late=is_late)
    _reports(r, made, answer)
    return made


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
        code = "act ()" if not is_late and r.random() < 0.6 else ""
        clauses = head(r.choice(PRIORITIES), guard, code=code)
        page.transition(f"Work{w}", [f"in {start} : {v}", finish], clauses)
        if r.random() < 0.5:
            break


def _reports(r: Random, made: Program, answer: Sort) -> None:
    """From `Done` to `Waiting`, with an answer; some programs end, or say too little."""
    for w in range(r.choice([1, 1, 2])):
        value = r.choice(answer.values)
        sensor = {"COL": "verdict", "SMALL": "level", "B": "is_held"}.get(answer.colset)
        if w == 0 and sensor and r.random() < 0.4:
            value = sensor
            made.sensors.add(sensor)
        after = "Waiting"
        if r.random() < 0.05:
            after = "Over"
            made.page.place("Over")
        arcs = ["in Done : ()", f"out {after} : ()", f"out ans : {value}"]
        if made.port("rep") and (w == 0 or r.random() < 0.8):
            arcs.append(f"out rep : {r.randint(0, 3)}")
        made.page.transition(f"Report{w}", arcs, head(r.choice(PRIORITIES)))
        if after == "Over":
            break
