"""Random cells of shapes that the other families lack, small enough to be seen to the end.

    cell = shape(Random(7))

Two channels each way, a register that several look at, lists as messages, pages of devices that are used twice, timers
of 0 s, equal priorities, guards that raise, arithmetic beyond what a colour set has, capacities that are declared.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from random import Random

from tools.adversary import claims
from tools.adversary.cells import Cell
from tools.adversary.claims import Claim
from tools.adversary.pages import DECLARATIONS, SORTS, TIMED, Page, Sort, head

_MORE = """  colset REG = int with 0..3;
  colset TR = REG timed;
  var r, r2 : REG;
  var i : INT;
  var l9 : LIST;
"""
LIST = Sort("LIST", ("[]", "[1]", "[0, ~3]"), "l", ("length l > 0", "hd l > 0", "l = []"))
RAISES = Sort("INT", ("0", "1", "~4"), "k", ("10 div k > 3", "k > 0", "k = 0"))
_SORTS = (*SORTS, LIST, LIST, RAISES)
_PRIORITIES = ("", "", "", "P_HIGH", "P_LOW", "P_NORMAL")
_LATE = 3
"""Most units of a timer."""


@dataclass(frozen=True)
class _Channel:
    """A channel of a device, from the supervisor (`is_down`) or to it."""

    name: str
    sort: Sort
    kind: str
    is_down: bool


@dataclass
class _Device:
    """A page of devices, and those who run it, by their numbers; it looks at the register, or a sensor decides."""

    page: Page
    channels: tuple[_Channel, ...]
    looks: bool
    decides: bool
    instances: list[int]


def shape(r: Random) -> Cell:
    """One of them."""
    return _Maker(r).made()


class _Maker:
    def __init__(self, r: Random) -> None:
        self.r = r
        self.is_timed = r.random() < 0.5
        number = r.choice((1, 2, 2, 2, 3))
        self.has_register = r.random() < 0.5
        self.top, self.supervisor = Page("Top"), Page("Sup")
        self.toml: list[str] = []
        self.joined: list[str] = []
        self.sensors: set[str] = set()
        self.watched: list[str] = []
        self.fired: list[str] = []
        self.devices: list[_Device] = []
        for k in range(1, number + 1):
            if self.devices and r.random() < 0.35:
                self.devices[-1].instances.append(k)
            else:
                self.devices.append(self._device(k))

    def made(self) -> Cell:
        """The cell."""
        for device in self.devices:
            for k in device.instances:
                self._instance(device, k)
        self._shared()
        self._supervisor()
        sockets = ", ".join(self.joined)
        self.top.transitions.insert(0, f"    subst Supervisor = Sup ({sockets})")
        pages = [self.top, self.supervisor, *(x.page for x in self.devices)]
        timed = TIMED if self.is_timed else ""
        net = f"net cell\n{DECLARATIONS}{timed}{_MORE}" + "".join(f"{p.text()}\n" for p in pages)
        return Cell(net, self._config(), tuple(self._claims()), bool(self.sensors))

    def _priority(self) -> str:
        return self.r.choice(_PRIORITIES)

    def _value(self, sort: Sort) -> str:
        return self.r.choice(sort.values)

    # --- devices ---------------------------------------------------------------------------------

    def _device(self, k: int) -> _Device:
        r = self.r
        down = [_Channel("cmd", r.choice(_SORTS), "flag", True)]
        if r.random() < 0.35:
            down.append(_Channel("dat", r.choice(_SORTS), "data", True))
        up = [_Channel("ans", r.choice(_SORTS), "flag", False)]
        if r.random() < 0.4:
            up.append(_Channel("rep", r.choice(_SORTS), r.choice(("data", "flag")), False))
        looks = self.has_register and (k == 1 or r.random() < 0.6)
        decides = not looks and r.random() < 0.35
        made = _Device(Page(f"Dev{k}"), (*down, *up), looks, decides, [k])
        self._program(made)
        return made

    def _program(self, x: _Device) -> None:
        """Takes a command, does something, and answers."""
        r, page = self.r, x.page
        for c in x.channels:
            page.port(c.name, "in" if c.is_down else "out", c.sort.colset)
        if x.looks:
            page.ports.append("    place reg port io : REG")
        command = x.channels[0].sort
        is_late = self.is_timed and r.random() < 0.6
        page.place("Waiting", initial="1")
        page.place("Told", command.colset)
        page.place("Mid", "TR" if is_late else "REG")
        page.place("Done")
        page.place("Memo", "INT", "1`0")
        takes = [
            "in Waiting : ()",
            f"in cmd : {command.variable}",
            f"out Told : {command.variable}",
        ]
        takes += [f"in {c.name} : {c.sort.variable}9" for c in x.channels[1:] if c.is_down]
        page.transition("Take", takes, head(self._priority()))
        told = f"in Told : {command.variable}"
        stamp = f"@+{r.randint(0, _LATE)}" if is_late else ""
        looks = ["both reg : r"] if x.looks else []
        middle = [told, *looks, f"out Mid : {'r' if x.looks else '1'}{stamp}"]
        guard = r.choice(command.tests) if r.random() < 0.4 else ""
        if x.decides:
            self._decides(page, told, stamp)
        else:
            page.transition("Go", middle, head(self._priority(), guard))
            if guard and r.random() < 0.8:
                other = f"not ({guard})" if r.random() < 0.5 else ""
                page.transition(
                    "Skip", [told, f"out Mid : 0{stamp}"], head(self._priority(), other)
                )
        changed = r.choice(("n + 1", "(n + r2) mod 3", "r2", "n"))
        works = ["in Mid : r2", "in Memo : n", f"out Memo : {changed}", "out Done : ()"]
        guard = r.choice(("", "", "", "4 div r2 > 0", "r2 < 3"))
        code = r.choice(
            ("", "act ()", "input (r2); action rest (Real.fromInt (r2 - 1))", "rest 0.0")
        )
        page.transition("Work", works, head(self._priority(), guard, code=code))
        ups = [c for c in x.channels if not c.is_down]
        says = [f"out {c.name} : {self._value(c.sort)}" for c in ups]
        ends = ["in Done : ()", "out Waiting : ()"]
        page.transition("Report", [*ends, *says], head(self._priority()))
        if r.random() < 0.3:
            says = [f"out {c.name} : {self._value(c.sort)}" for c in ups[: r.randint(1, len(ups))]]
            page.transition("Report2", [*ends, *says], head(self._priority()))

    def _decides(self, page: Page, told: str, stamp: str) -> None:
        """A sensor says what comes next."""
        r = self.r
        sensor, colset, variable, good, bad = r.choice(
            (("is_held", "B", "b", "b", "not b"), ("verdict", "COL", "c", "c = red", "c = green"))
        )
        self.sensors.add(sensor)
        page.place("Seen", colset)
        page.transition("Look", [told, f"out Seen : {sensor}"], head(code="act ()"))
        seen = f"in Seen : {variable}"
        page.transition("Good", [seen, f"out Mid : 1{stamp}"], head(self._priority(), good))
        if r.random() < 0.9:
            page.transition("Bad", [seen, f"out Mid : 0{stamp}"], head(self._priority(), bad))

    def _instance(self, x: _Device, k: int) -> None:
        """Its channels on the top page."""
        pairs = []
        for c in x.channels:
            name = f"{c.name}{k}"
            self._file(name, c.sort.colset, c.kind, "out" if c.is_down else "in")
            pairs.append(f"{c.name} -> {name}")
        pairs += ["reg -> reg"] if x.looks else []
        self.top.transitions.append(f"    subst D{k} = {x.page.name} ({', '.join(pairs)})")
        self.toml.append(f'[devices.dev{k}]\ninstance = "D{k}"')
        self.watched += [f"Top.D{k}.{p}" for p in ("Waiting", "Told", "Mid", "Done")]
        self.fired += [f"Top.D{k}.{t}" for t in x.page.names]

    def _file(self, name: str, colset: str, kind: str, direction: str, initial: str = "") -> None:
        self.top.place(name, colset, initial)
        self.supervisor.ports.append(f"    place {name} port {direction} : {colset}")
        self.joined.append(f"{name} -> {name}")
        self.toml.append(f'[[channel]]\nplace = "{name}"\nfile = "{name}.txt"\nkind = "{kind}"')

    def _shared(self) -> None:
        if any(x.looks for x in self.devices):
            self._file("reg", "REG", "register", "io", f"1`{self.r.randint(0, 3)}")
        else:
            self.has_register = False

    # --- the supervisor --------------------------------------------------------------------------

    def _supervisor(self) -> None:
        """Asks each device once or twice, hears its answers, and comes to an end."""
        page = self.supervisor
        page.place("Finished")
        ends = []
        for device in self.devices:
            for k in device.instances:
                self._exchange(device, k)
                ends += [f"in Idle{k} : ()", f"in Left{k} : 0"]
        page.transition("Finish", [*ends, "out Finished : ()"], head())
        self.fired += [f"Top.Supervisor.{t}" for t in page.names]
        self.watched.append("Top.Supervisor.Finished")

    def _sets(self) -> list[str]:
        return [
            "in reg : r",
            f"out reg : {self.r.choice(('(r + 1) mod 4', '3 - r', '0', 'r - 1'))}",
        ]

    def _exchange(self, x: _Device, k: int) -> None:
        r, page = self.r, self.supervisor
        is_late = self.is_timed and r.random() < 0.5
        page.place(f"Idle{k}", initial="1")
        page.place(f"Asked{k}", "TU" if is_late else "")
        page.place(f"Left{k}", "INT", f"1`{r.choice((1, 1, 2))}")
        self.watched += [f"Top.Supervisor.Idle{k}", f"Top.Supervisor.Asked{k}"]
        down = [c for c in x.channels if c.is_down]
        up = [c for c in x.channels if not c.is_down]
        sets = self._sets() if self.has_register and (k == 1 or r.random() < 0.5) else []
        stamp = f"@+{r.randint(0, _LATE)}" if is_late else ""
        asks = [f"in Idle{k} : ()", f"in Left{k} : n", f"out Left{k} : n - 1", *sets]
        asks += [f"out Asked{k} : (){stamp}"]
        says = [f"out {c.name}{k} : {self._value(c.sort)}" for c in down]
        if len(says) > 1 and r.random() < 0.4:
            page.place(f"Then{k}")
            asks.append(f"out Then{k} : ()")
            page.transition(f"More{k}", [f"in Then{k} : ()", says.pop()], head(self._priority()))
        page.transition(f"Ask{k}", [*asks, *says], head(self._priority(), "n > 0"))
        hears = [
            f"in Asked{k} : ()",
            f"out Idle{k} : ()",
            f"in {up[0].name}{k} : {up[0].sort.variable}",
        ]
        for c in up[1:]:
            arc = f"in {c.name}{k} : {c.sort.variable}9"
            if r.random() < 0.6:
                hears.append(arc)
            else:
                page.transition(f"Clear{k}", [f"both Left{k} : m", arc], head(self._priority()))
        guard = r.choice(up[0].sort.tests) if r.random() < 0.35 else ""
        page.transition(f"Got{k}", hears, head(self._priority(), guard))
        if guard and r.random() < 0.8:
            gives_up = [f"in Left{k} : n", f"out Left{k} : 0"] if r.random() < 0.4 else []
            other = f"not ({guard})" if r.random() < 0.5 else ""
            page.transition(f"Other{k}", [*hears, *gives_up], head(self._priority(), other))
        if is_late and r.random() < 0.4:
            page.place(f"Slow{k}", "INT", "1`0")
            arcs = [f"in Asked{k} : ()", f"out Asked{k} : ()@+{r.randint(1, 2)}"]
            arcs += [f"in Slow{k} : i", f"out Slow{k} : i + 1"]
            page.transition(f"Late{k}", arcs, head(self._priority(), "i < 2"))

    # --- what goes with it -----------------------------------------------------------------------

    def _config(self) -> str:
        r = self.r
        lines = [
            '[net]\nfile = "cell.cpn"',
            '[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]',
            *self.toml,
            f'[primitives]\nact = {{ command = "tool", action = "act", duration_s = {r.choice((0.5, 2.0))} }}',
            'rest = { command = "wait" }',
            *(f"[sensors.{s}]\nseed = {r.randint(1, 9)}" for s in sorted(self.sensors)),
        ]
        if r.random() < 0.3:
            lines.append(f'[capacity]\n"{self._first()}" = {r.choice((1, 1, 2))}')
        return "\n".join(lines) + "\n"

    def _first(self) -> str:
        return f"Idle{self.devices[0].instances[0]}"

    def _claims(self) -> Iterator[Claim]:
        r = self.r
        pair: Sequence[str]
        for _ in range(2):
            yield claims.never_both(*r.sample(self.watched, 2))
        yield claims.reached(*r.sample(self.watched, 2))
        for place in r.sample(self.watched, 2):
            yield claims.at_most(place, r.choice((0, 1, 1)))
        for pair in (("Asked1", "Idle1"), ("Idle1", "Finished")):
            yield claims.followed(*(f"Top.Supervisor.{x}" for x in pair))
        yield claims.followed_within(
            "Top.Supervisor.Asked1", "Top.Supervisor.Idle1", r.randint(2, 12)
        )
        yield claims.ends_with("Top.Supervisor.Finished")
        yield claims.silent(r.choice(self.fired))
        yield claims.not_before(*r.sample(self.fired, 2))
