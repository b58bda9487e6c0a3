"""Random channels from one device to another, past the supervisor."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from random import Random

from tools.adversary.devices import Program
from tools.adversary.pages import SORTS, head


@dataclass(frozen=True)
class Link:
    """A channel from device `writer` to device `reader` (numbers from 1); the ports have the names of its place."""

    writer: int
    reader: int
    colset: str
    kind: str

    @property
    def name(self) -> str:
        """That of its place on the top page."""
        return f"from{self.writer}to{self.reader}"

    def ports(self, device: int) -> Iterator[str]:
        """Those of a device, none if it has nothing to do with it."""
        if device in (self.writer, self.reader):
            yield self.name


def link(r: Random, devices: Sequence[Program]) -> Iterator[Link]:
    """Lets some devices tell each other something; pages of several instances are left alone."""
    alone = [k for k, made in enumerate(devices, 1) if sum(d is made for d in devices) == 1]
    if len(alone) < 2 or r.random() > 0.35:
        return
    pairs = [r.sample(alone, 2)]
    if r.random() < 0.3:  # an answer to it, or somebody who hears as well
        pairs.append(pairs[0][::-1] if r.random() < 0.5 else r.sample(alone, 2))
    for writer, reader in sorted({(a, b) for a, b in pairs}):
        sort = r.choice(SORTS)
        made = Link(writer, reader, sort.colset, r.choice(["flag", "data", "data"]))
        _writes(r, devices[writer - 1], made, r.choice(sort.values))
        _reads(r, devices[reader - 1], made, sort.variable)
        yield made


def _writes(r: Random, program: Program, made: Link, value: str) -> None:
    """With its answer, or when it has taken a command."""
    program.page.port(made.name, "out", made.colset)
    names = [n for n in program.page.names if n == "Accept" or n.startswith("Report")]
    for name in names[-1:] if r.random() < 0.6 else r.sample(names, 1):
        program.page.also(name, f"out {made.name} : {value}")


def _reads(r: Random, program: Program, made: Link, variable: str) -> None:
    """With a command, before an answer, whenever it waits, or never."""
    page = program.page
    page.port(made.name, "in", made.colset)
    how = r.random()
    arc = f"in {made.name} : {variable}9"
    if how < 0.35:
        page.also(r.choice([n for n in page.names if n.startswith(("Accept", "Report"))]), arc)
    elif how < 0.7:
        after = r.choice(["Waiting", "Waiting", "Done"])
        page.transition(f"Hear{made.writer}", ["in Waiting : ()", arc, f"out {after} : ()"], head())
    else:
        page.transition(f"Hear{made.writer}", ["both Waiting : ()", arc], head())
