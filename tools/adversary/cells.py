"""Random cells: a supervisor and one to three devices, with priorities, timers, free choices, counters, retries.

    cell = random_cell(Random(7))
    cell.net, cell.toml, cell.claims

They are made to be nearly right: most come to an end, many have a flaw that only a program shows (a priority that
counts among strangers in the net, a message that is there in mid-cycle, a choice that a script never takes).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from random import Random

from tools.adversary import claims
from tools.adversary.claims import Claim
from tools.adversary.devices import Program, program
from tools.adversary.links import link
from tools.adversary.pages import DECLARATIONS, TIMED, Page
from tools.adversary.supervisors import Supervisor


@dataclass(frozen=True)
class Cell:
    """A cell as two files, and what may be claimed of it; `has_sensors`: somebody else decides something.

    `capacities`: bounds that its cell.toml declares; `inputs`: its input files, name and text.
    """

    net: str
    toml: str
    claims: tuple[Claim, ...]
    has_sensors: bool
    capacities: tuple[Claim, ...] = ()
    inputs: tuple[tuple[str, str], ...] = ()
    is_long: bool = False
    """it may repeat its work hundreds of times"""


class _Maker:
    def __init__(self, r: Random) -> None:
        self.r = r
        self.is_timed = r.random() < 0.4
        self.top = Page("Top")
        self.toml: list[str] = []
        self.devices = devices = list[Program]()
        for k in range(1, r.choice([1, 1, 2, 2, 3]) + 1):
            is_again = k > 1 and r.random() < 0.25  # another instance of the same page
            devices.append(devices[-1] if is_again else program(r, k, is_timed=self.is_timed))
        self.links = list(link(r, devices))
        self.supervisor = Supervisor(r, devices, is_timed=self.is_timed)
        self.sensors = sorted({s for made in devices for s in made.sensors})
        self.looked_at = list(self.supervisor.looked_at)
        self.inputs = list(self._inputs(len(devices)))
        self.pages = {made.page.name: made.page for made in devices}
        sockets = []
        for k, made in enumerate(devices, 1):
            self.looked_at += [f"Top.D{k}.{x}" for x in made.places]
            sockets += self._join(k, made)
        for made in self.links:
            self._channel(made.name, made.colset, made.kind)
        self.top.transitions.insert(0, f"    subst Supervisor = Sup ({', '.join(sockets)})")

    def _join(self, k: int, made: Program) -> Iterator[str]:
        """A device on the top page and in cell.toml; gives the supervisor's sockets for it."""
        for p in made.ports:
            self._channel(f"{p.name}{k}", p.colset, p.kind)
            yield f"{p.name}{k} -> {p.name}{k}"
        pairs = [(p.name, f"{p.name}{k}") for p in made.ports]
        pairs += [(port, found.name) for found in self.links for port in found.ports(k)]
        ports = ", ".join(f"{port} -> {socket}" for port, socket in pairs)
        self.top.transitions.append(f"    subst D{k} = {made.page.name} ({ports})")
        self.toml.append(f'[devices.dev{k}]\ninstance = "D{k}"')

    def _channel(self, name: str, colset: str, kind: str) -> None:
        """A place of the top page that is a file."""
        self.top.place(name, colset)
        self.toml.append(f'[[channel]]\nplace = "{name}"\nfile = "{name}.txt"\nkind = "{kind}"')

    def made(self) -> Cell:
        """The cell."""
        capacities = list(self._capacities())
        return Cell(
            self._net(),
            self._config(capacities),
            tuple(self._claims()),
            bool(self.sensors),
            tuple(capacities),
            tuple((file, text) for _, file, text in self.inputs),
            self.supervisor.is_long,
        )

    def _net(self) -> str:
        pages = (self.top, *self.supervisor.pages, *self.pages.values())
        timed = TIMED if self.is_timed else ""
        text = "\n".join(p.text() for p in pages)
        return f"net cell\n{DECLARATIONS}{timed}{self.supervisor.declarations}{text}\n"

    def _config(self, capacities: Sequence[Claim]) -> str:
        r = self.r
        final = ", ".join(f'"{place}"' for place in self.supervisor.final)
        seconds = r.choice([0.5, 2.0, 4.0])
        parts = [
            '[net]\nfile = "cell.cpn"',
            f'[supervisor]\ninstance = "Supervisor"\nfinal = [{final}]\norder = "documented"',
            f"reply_timeout_s = {r.choice([1.0, 30.0])}" if r.random() < 0.15 else "",
            *self.toml,
            *(f'[[input]]\nplace = "{place}"\nfile = "{file}"' for place, file, _ in self.inputs),
            f'[primitives]\nact = {{ command = "tool", action = "act", duration_s = {seconds} }}\n'
            'rest = { command = "wait" }',
        ]
        for sensor in self.sensors:
            said = {"verdict": '"green"', "level": "2", "is_held": "true"}[sensor]
            how = f"default = {said}" if r.random() < 0.3 else f"seed = {r.randint(1, 9)}"
            parts.append(f"[sensors.{sensor}]\n{how}")
        if capacities:
            parts.append("[capacity]")
            parts += [f'"{c.places[0]}" = {c.most}' for c in capacities]
        return "\n".join(p for p in parts if p) + "\n"

    def _inputs(self, devices: int) -> Iterator[tuple[str, str, str]]:
        """Places whose tokens come from files, mostly others than the net has: place, file, text."""
        if self.r.random() < 0.3:
            for place in self.r.sample(["Tick", *(f"Left{k}" for k in range(1, devices + 1))], 1):
                yield place, f"{place.lower()}.in", f"{self.r.choice([-1, 0, 1, 2, 3])}\n"

    def _capacities(self) -> Iterator[Claim]:
        for place in self.r.sample(self.looked_at, 2) if self.r.random() < 0.2 else ():
            yield claims.at_most(place, self.r.choice([1, 2]))

    def _claims(self) -> Iterator[Claim]:
        r = self.r
        for _ in range(3):
            yield claims.never_both(*r.sample(self.looked_at, 2))
        yield claims.reached(*r.sample(self.looked_at, 2))
        for place in r.sample(self.looked_at, 3):
            yield claims.at_most(place, r.choice([0, 1, 1, 2]))
        for one, other in self.supervisor.followed[:2]:
            yield claims.followed(one, other)
            yield claims.followed_within(one, other, r.randint(1, 12))
        yield claims.ends_with("Top.Supervisor.Finished")
        fired = self._transitions()
        yield claims.silent(r.choice(fired))
        yield claims.not_before(*r.sample(fired, 2))

    def _transitions(self) -> list[str]:
        """The paths of those of the supervisor's page and of the devices."""
        of_devices = [(f"D{k}", made.page) for k, made in enumerate(self.devices, 1)]
        pages = [("Supervisor", self.supervisor.page), *of_devices]
        return [f"Top.{at}.{name}" for at, page in pages for name in page.names]


def random_cell(r: Random) -> Cell:
    """A cell."""
    return _Maker(r).made()
