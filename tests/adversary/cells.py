"""Random cells: a supervisor and one to three devices, with priorities, timers, free choices, counters, retries.

    cell = random_cell(Random(7))
    cell.net, cell.toml, cell.claims

They are made to be nearly right: most come to an end, many have a flaw that only a program shows (a priority that
counts among strangers in the net, a message that is there in mid-cycle, a choice that a script never takes).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from random import Random

TYPES = {
    "INT": ["1", "2", "0"],
    "B": ["true", "false"],
    "COL": ["red", "green"],
    "SMALL": ["1", "2"],
}
PRIORITIES = ["", "", "", " priority P_HIGH", " priority P_LOW"]


@dataclass(frozen=True)
class Claim:
    """A property, and the same in Python: over the numbers of tokens by the place's name.

    Args:
        text: in the language of properties.
        places: their names; `most`: the sum of their tokens is never larger than this.
    """

    text: str
    places: tuple[str, ...]
    most: int
    every: bool = False
    """all of them are marked at once, never"""

    def is_broken(self, tokens: dict[str, int]) -> bool:
        """Whether a marking contradicts it."""
        held = [tokens[p] for p in self.places]
        return all(held) if self.every else sum(held) > self.most


@dataclass(frozen=True)
class Cell:
    """A cell as two files, and what may be claimed of it; `has_sensors`: somebody else decides something."""

    net: str
    toml: str
    claims: tuple[Claim, ...]
    has_sensors: bool


@dataclass
class _Page:
    """A page in the making."""

    name: str
    ports: list[str] = field(default_factory=list)
    places: list[str] = field(default_factory=list)
    transitions: list[str] = field(default_factory=list)

    def place(self, name: str, colset: str = "", initial: str = "") -> str:
        kind = f" : {colset}" if colset else ""
        start = f" = {initial}" if initial else ""
        self.places.append(f"    place {name}{kind}{start}")
        return name

    def transition(self, name: str, arcs: list[str], head: str = "") -> None:
        self.transitions.append(
            "\n".join([f"    trans {name}{head}", *(f"      {a}" for a in arcs)])
        )

    def text(self) -> str:
        return "\n".join([f"  page {self.name}", *self.ports, *self.places, *self.transitions])


class _Maker:
    def __init__(self, r: Random) -> None:
        self.r = r
        self.is_timed = r.random() < 0.35
        self.top = _Page("Top")
        self.supervisor = _Page("Sup")
        self.pages: list[_Page] = []
        self.toml: list[str] = []
        self.has_sensors = False
        self.may_fail = False
        self.looked_at: list[str] = []

    # --- devices -------------------------------------------------------------------------------

    def device(self, k: int) -> tuple[str, str, bool]:
        """A device's page; gives the types of its command and its answer, and whether it takes data."""
        r = self.r
        page = _Page(f"Dev{k}")
        kind, answer = r.choice(list(TYPES)), r.choice(list(TYPES))
        has_data = r.random() < 0.3
        page.ports += [f"    place cmd port in : {kind}", f"    place ans port out : {answer}"]
        if has_data:
            page.ports.append("    place dat port in : INT")
        page.place("Waiting", initial="1")
        page.place("Told", kind)
        page.place("Done")
        given = _variable(kind)
        takes = ["in Waiting : ()", f"in cmd : {given}", f"out Told : {given}"]
        if has_data:
            takes.insert(2, "in dat : d")
        page.transition("Accept", takes, self.r.choice(PRIORITIES[:4]))
        ways = r.randint(1, 3)
        for w in range(ways):
            guard = ""
            if ways > 1 and r.random() < 0.6:
                guard = f" guard [{given} = {r.choice(TYPES[kind])}]" if w else ""
            code = " code action act ()" if r.random() < 0.6 else ""
            head = f"{r.choice(PRIORITIES)}{guard}{code}"
            page.transition(f"Work{w}", [f"in Told : {given}", "out Done : ()"], head)
            if r.random() < 0.5:
                break
        for w in range(r.choice([1, 1, 2])):
            value = r.choice(TYPES[answer])
            if w == 0 and answer == "COL" and r.random() < 0.5:
                value, self.has_sensors = "verdict", True
            arcs = ["in Done : ()", "out Waiting : ()", f"out ans : {value}"]
            page.transition(f"Report{w}", arcs, r.choice(PRIORITIES))
        self.pages.append(page)
        self.looked_at += [f"D{k}.Done", f"D{k}.Told"]
        return kind, answer, has_data

    # --- supervisor ----------------------------------------------------------------------------

    def exchange(self, k: int, kind: str, answer: str, has_data: bool) -> None:
        """What the supervisor does with a device: asks, hears, tries again, gives up."""
        r, page = self.r, self.supervisor
        page.ports += [f"    place c{k} port out : {kind}", f"    place a{k} port in : {answer}"]
        if has_data:
            page.ports.append(f"    place d{k} port out : INT")
        initial = "1" if k == 1 or r.random() < 0.6 else ""
        page.place(f"Idle{k}", initial=initial)
        page.place(f"Armed{k}")
        page.place(f"Have{k}")
        page.place(f"Left{k}", "INT", f"1`{r.randint(0, 2)}")
        self.looked_at += [f"Supervisor.{n}{k}" for n in ("Idle", "Armed", "Have")]
        sends = [f"out c{k} : {r.choice(TYPES[kind])}", f"out Armed{k} : ()"]
        if has_data:
            sends.append(f"out d{k} : {r.randint(0, 5)}")
        if self.is_timed and r.random() < 0.6:
            page.place(f"Dog{k}", "TU")
            sends.append(f"out Dog{k} : ()@+{r.randint(1, 3)}")
            self.watchdog(k)
        page.transition(f"Ask{k}", [f"in Idle{k} : ()", *sends], r.choice(PRIORITIES))
        heard = _variable(answer)
        values = list(TYPES[answer])
        r.shuffle(values)
        for w, value in enumerate(values[: r.randint(1, 2)]):
            guard = f" guard [{heard} = {value}]" if r.random() < 0.5 else ""
            again = w > 0 and r.random() < 0.6
            arcs = [f"in Armed{k} : ()", f"in a{k} : {heard}"]
            if again:
                guard = f" guard [{heard} = {value}, n > 0]" if guard else " guard [n > 0]"
                arcs += [f"in Left{k} : n", f"out Left{k} : n - 1", f"out Idle{k} : ()"]
            else:
                arcs.append(f"out Have{k} : ()")
            if r.random() < 0.2:
                arcs.append(f"both {r.choice([f'Left{k} : m', 'Tick : m'])}")
            page.transition(f"Got{k}_{w}", arcs, f"{r.choice(PRIORITIES)}{guard}")
        if r.random() < 0.35:  # it may go on before it has heard
            page.place(f"Past{k}")
            page.transition(
                f"Advance{k}", [f"in Armed{k} : ()", f"out Past{k} : ()"], r.choice(PRIORITIES)
            )
            arcs = [f"in Past{k} : ()", f"in a{k} : {heard}"]
            arcs.append(f"out {r.choice([f'Have{k}', f'Idle{k}', f'Have{k}'])} : ()")
            page.transition(f"Late{k}", arcs, r.choice(PRIORITIES))
            self.looked_at.append(f"Supervisor.Past{k}")

    def watchdog(self, k: int) -> None:
        """A timer that may run out while the device works."""
        r = self.r
        arcs = [f"in Dog{k} : ()"]
        how = r.random()
        if how < 0.4:
            arcs += [f"in Armed{k} : ()", f"out Have{k} : ()"]
        elif how < 0.7:
            arcs += [f"both Armed{k} : ()", "out Alarm : ()"]
        else:
            arcs.append("out Alarm : ()")
        self.supervisor.transition(f"Bark{k}", arcs, r.choice(PRIORITIES))

    def ends(self, devices: int) -> None:
        """How the supervisor finishes, and what else it does."""
        r, page = self.r, self.supervisor
        page.place("Tick", "INT", "1`0")
        page.place("Alarm")
        page.place("Finished")
        page.place("Failed")
        self.looked_at += ["Supervisor.Alarm", "Supervisor.Failed"]
        needed = [f"in Have{k} : ()" for k in range(1, devices + 1)]
        page.transition("End", [*needed, "out Finished : ()"], r.choice(PRIORITIES))
        if r.random() < 0.5:
            k = r.randint(1, devices)
            other = r.randint(1, devices)
            arcs = [f"in Have{k} : ()", "in Tick : n", "out Tick : n + 1", f"out Idle{other} : ()"]
            page.transition("More", arcs, f"{r.choice(PRIORITIES)} guard [n < {r.randint(1, 2)}]")
        self.may_fail = r.random() < 0.5
        if self.may_fail:
            page.transition("GiveUp", ["in Alarm : ()", "out Failed : ()"], r.choice(PRIORITIES))
        if devices > 1 and r.random() < 0.5:
            a, b = r.sample(range(1, devices + 1), 2)
            arcs = [f"both Have{a} : ()", f"in Idle{b} : ()", f"out Idle{b} : ()", "out Alarm : ()"]
            page.place("Once", initial="1")
            page.transition("Notice", ["in Once : ()", *arcs], r.choice(PRIORITIES))

    # --- the whole -----------------------------------------------------------------------------

    def make(self) -> Cell:
        r = self.r
        devices = r.choice([1, 1, 2, 2, 3])
        sockets = []
        for k in range(1, devices + 1):
            kind, answer, has_data = self.device(k)
            self.exchange(k, kind, answer, has_data)
            names = {f"c{k}": kind, f"a{k}": answer} | ({f"d{k}": "INT"} if has_data else {})
            for name, colset in names.items():
                self.top.place(name, colset)
                sockets.append(f"{name} -> {name}")
                sort = "data" if name.startswith("d") else "flag"
                self.toml.append(
                    f'[[channel]]\nplace = "{name}"\nfile = "{name}.txt"\nkind = "{sort}"'
                )
            data = f", dat -> d{k}" if has_data else ""
            self.top.transitions.append(f"    subst D{k} = Dev{k} (cmd -> c{k}, ans -> a{k}{data})")
            self.toml.append(f'[devices.dev{k}]\ninstance = "D{k}"')
        self.ends(devices)
        self.top.transitions.insert(0, f"    subst Supervisor = Sup ({', '.join(sockets)})")
        final = ["Finished"] + (["Failed"] if self.may_fail and r.random() < 0.7 else [])
        claims = tuple(self.claims())
        return Cell(self.net(), self.config(final), claims, self.has_sensors)

    def net(self) -> str:
        timed = "  colset TU = unit timed;\n" if self.is_timed else ""
        pages = "\n".join(p.text() for p in (self.top, self.supervisor, *self.pages))
        return (
            "net cell\n  standard\n  colset B = bool;\n  colset COL = with red | green;\n"
            f"  colset SMALL = int with 1..2;\n{timed}"
            "  val P_HIGH = 100;\n  val P_NORMAL = 1000;\n  val P_LOW = 10000;\n  fun act () = ();\n"
            "  var k, n, m, d: INT;\n  var b: B;\n  var c, verdict: COL;\n  var s: SMALL;\n"
            f"{pages}\n"
        )

    def config(self, final: list[str]) -> str:
        r = self.r
        head = [
            '[net]\nfile = "cell.cpn"',
            f'[supervisor]\ninstance = "Supervisor"\nfinal = [{", ".join(f"{chr(34)}{f}{chr(34)}" for f in final)}]\n'
            'order = "documented"',
        ]
        act = f'[primitives]\nact = {{ command = "tool", action = "act", duration_s = {r.choice([0.5, 2.0, 4.0])} }}'
        sensors = (
            ['[sensors.verdict]\ndefault = "green"']
            if self.has_sensors and r.random() < 0.3
            else []
        )
        if self.has_sensors and not sensors:
            sensors = ["[sensors.verdict]\nseed = 3"]
        return "\n".join([*head, *self.toml, act, *sensors]) + "\n"

    def claims(self) -> Iterator[Claim]:
        r = self.r
        for _ in range(3):
            a, b = r.sample(self.looked_at, 2)
            text = f"never tokens({_short(a)}) >= 1 && tokens({_short(b)}) >= 1"
            yield Claim(text, (f"Top.{a}", f"Top.{b}"), 0, every=True)
        for place in r.sample(self.looked_at, 3):
            most = r.choice([0, 1, 1, 2])
            yield Claim(f"bound {_short(place)} <= {most}", (f"Top.{place}",), most)


def _short(name: str) -> str:
    """A place of an instance as properties name it: by its page."""
    instance, _, place = name.partition(".")
    page = {"Supervisor": "Sup"}.get(instance, instance.replace("D", "Dev"))
    return f"{page}'{place}"


def _variable(kind: str) -> str:
    return {"INT": "k", "B": "b", "COL": "c", "SMALL": "s"}[kind]


def random_cell(r: Random) -> Cell:
    """A cell."""
    return _Maker(r).make()
