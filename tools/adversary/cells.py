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

from tools.adversary.devices import Program, program
from tools.adversary.pages import DECLARATIONS, TIMED, Page
from tools.adversary.supervisors import Supervisor


@dataclass(frozen=True)
class Claim:
    """A property, and the same in Python: over the numbers of tokens by the place's name.

    Args:
        text: in the language of properties.
        places: their names; `most`: the sum of their tokens is never larger than this.
    """

    text: str
    places: tuple[str, ...]
    most: int = 0
    every: bool = False
    """all of them are marked at once, never"""
    follows: bool = False
    """after the first is marked the second one is marked at some time"""

    def broken(self, run: Sequence[dict[str, int]], *, is_over: bool) -> int | None:
        """The first marking of a run that contradicts it; None: there is none.

        Args:
            run: numbers of tokens, one marking after the other.
            is_over: nothing comes after the last of them.
        """
        if self.follows:
            one, other = self.places
            last = max((i for i, at in enumerate(run) if at[one]), default=-1)
            is_open = is_over and last >= 0 and not any(at[other] for at in run[last:])
            return last if is_open else None
        for i, at in enumerate(run):
            held = [at[p] for p in self.places]
            if all(held) if self.every else sum(held) > self.most:
                return i
        return None


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
        devices: list[Program] = []
        for k in range(1, r.choice([1, 1, 2, 2, 3]) + 1):
            is_again = k > 1 and r.random() < 0.25  # another instance of the same page
            devices.append(devices[-1] if is_again else program(r, k, is_timed=self.is_timed))
        self.supervisor = Supervisor(r, devices, is_timed=self.is_timed)
        self.sensors = sorted({s for made in devices for s in made.sensors})
        self.looked_at = list(self.supervisor.looked_at)
        self.inputs = list(self._inputs(len(devices)))
        self.pages = {made.page.name: made.page for made in devices}
        sockets = []
        for k, made in enumerate(devices, 1):
            self.looked_at += [f"Top.D{k}.{x}" for x in made.places]
            sockets += self._join(k, made)
        self.top.transitions.insert(0, f"    subst Supervisor = Sup ({', '.join(sockets)})")

    def _join(self, k: int, made: Program) -> Iterator[str]:
        """A device on the top page and in cell.toml; gives the supervisor's sockets for it."""
        for p in made.ports:
            name = f"{p.name}{k}"
            self.top.place(name, p.colset)
            self.toml.append(
                f'[[channel]]\nplace = "{name}"\nfile = "{name}.txt"\nkind = "{p.kind}"'
            )
            yield f"{name} -> {name}"
        ports = ", ".join(f"{p.name} -> {p.name}{k}" for p in made.ports)
        self.top.transitions.append(f"    subst D{k} = {made.page.name} ({ports})")
        self.toml.append(f'[devices.dev{k}]\ninstance = "D{k}"')

    def made(self) -> Cell:
        """The cell."""
        capacities, claims = list(self._capacities()), list(self._claims())
        return Cell(
            self._net(),
            self._config(capacities),
            tuple(claims),
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
            f'[primitives]\nact = {{ command = "tool", action = "act", duration_s = {seconds} }}',
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
            yield Claim("", (place,), self.r.choice([1, 2]))

    def _claims(self) -> Iterator[Claim]:
        r = self.r
        for _ in range(3):
            a, b = r.sample(self.looked_at, 2)
            text = f"never tokens({_asked(a)}) >= 1 && tokens({_asked(b)}) >= 1"
            yield Claim(text, (a, b), every=True)
        for place in r.sample(self.looked_at, 3):
            most = r.choice([0, 1, 1, 2])
            yield Claim(f"bound {_asked(place)} <= {most}", (place,), most)
        for pair in self.supervisor.followed[:2]:
            a, b = pair
            text = f"every tokens({_asked(a)}) >= 1 is followed by tokens({_asked(b)}) >= 1"
            yield Claim(text, (a, b), follows=True)


def _asked(place: str) -> str:
    """A place as properties name it: by its path, or by its page where the path is that of a fusion set."""
    fused = place.removeprefix("Fusion.")
    return f'"{place}"' if fused == place else f"Sup'{fused}"


def random_cell(r: Random) -> Cell:
    """A cell."""
    return _Maker(r).made()
