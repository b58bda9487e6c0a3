"""Random small cells whose devices talk to each other, and whose supervisor acts on data before their flag.

In each round the supervisor tells some of two or three devices to begin, each device tells the next one, some of them
answer the one before, and some tell the supervisor, by a flag, or by data and a flag that it takes one after the other.
What varies: who waits for whom, in which order, what is sent in one transition, and the order of the files. Often
somebody does not wait for long enough, so that half of these cells are wrong.
"""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

_HEAD = """net cell
  standard
  colset SAID = int with 1..2;
  var k, j, v: SAID;
  var n: INT;
  page Top
"""
SUPERVISOR = -1
Step = tuple[str, str]
"""`in` or `out`, and a channel."""


@dataclass(frozen=True)
class _Channel:
    name: str
    writer: int
    reader: int
    kind: str = "flag"


class _Cell:
    def __init__(self, r: Random) -> None:
        self.r = r
        self.count = r.choice([2, 2, 3])
        self.rounds = r.choice([2, 2, 3])
        devices = range(self.count)
        self.is_told = [i == 0 or r.random() < 0.35 for i in devices]
        self.answers = [i == self.count - 1 or r.random() < 0.4 for i in devices]
        self.is_early = [a and r.random() < 0.3 for a in self.answers]
        """its data, sent with its flag, are acted on alone"""
        self.is_double = [r.random() < 0.25 for _ in devices]
        """it has a second flag for the supervisor"""
        self.patience = r.choice([0.4, 0.7, 1.0])
        """how often an answer is waited for"""
        self.eagerness = r.choice([0.0, 0.0, 0.4])
        """how often something is said before something is heard"""
        self.channels: list[_Channel] = []
        for i in devices:
            if self.is_told[i]:
                self.channels.append(_Channel(f"f{i}", SUPERVISOR, i))
            if self.answers[i]:
                self.channels.append(_Channel(f"d{i}", i, SUPERVISOR))
            if self.is_early[i]:
                self.channels.append(_Channel(f"q{i}", i, SUPERVISOR, "data"))
            if self.is_double[i]:
                self.channels.append(_Channel(f"e{i}", i, SUPERVISOR))
            if i:
                kind = r.choice(["flag", "flag", "data"])
                self.channels.append(_Channel(f"l{i}", i - 1, i, kind))
                if r.random() < 0.35:
                    self.channels.append(_Channel(f"b{i}", i, i - 1))

    def _own(self, owner: int, *, out: bool) -> list[str]:
        return [c.name for c in self.channels if (c.writer if out else c.reader) == owner]

    def _ports(self, owner: int) -> list[str]:
        both = [(c, "in") for c in self._own(owner, out=False)]
        both += [(c, "out") for c in self._own(owner, out=True)]
        return [f"    place {c} port {where} : SAID" for c, where in both]

    def net(self) -> str:
        """The net."""
        lines = [f"    place {c.name} : SAID" for c in self.channels]
        pages = [*self._supervisor()]
        for owner in range(SUPERVISOR, self.count):
            own = [*self._own(owner, out=False), *self._own(owner, out=True)]
            sockets = ", ".join(f"{c} -> {c}" for c in own)
            page = "Supervisor = Sup" if owner == SUPERVISOR else f"D{owner} = P{owner}"
            lines.append(f"    subst {page} ({sockets})")
            pages += [] if owner == SUPERVISOR else self._device(owner)
        return _HEAD + "\n".join([*lines, *pages]) + "\n"

    def _supervisor(self) -> list[str]:
        r = self.r
        places = ["Free = 1", f"Todo = {self.rounds}", f"Left : INT = 1`{self.rounds}", "Finished"]
        send = ["    trans Send", "      in Free : ()", "      in Todo : ()"]
        send += [f"      out {c} : 1" for c in self._own(SUPERVISOR, out=True)]
        heard: list[str] = []
        after = [
            "    trans Next",
            "      in Left : n",
            "      out Left : n - 1",
            "      out Free : ()",
        ]
        for c in self._own(SUPERVISOR, out=False):
            is_alone = r.random() < 0.15  # nobody waits for it
            places += [f"Got{c}", *([] if is_alone else [f"Wait{c}"])]
            send += [] if is_alone else [f"      out Wait{c} : ()"]
            heard += [f"    trans Hear{c}", f"      in {c} : k", f"      out Got{c} : ()"]
            heard += [] if is_alone else [f"      in Wait{c} : ()"]
            if r.random() < self.patience:
                after.append(f"      in Got{c} : ()")
        end = ["    trans End", "      in Left : 0", "      out Finished : ()"]
        head = ["  page Sup", *self._ports(SUPERVISOR), *(f"    place {p}" for p in places)]
        return [*head, *send, *heard, *after, *end]

    def _device(self, owner: int) -> list[str]:
        """One transition after the other, each with some messages that it takes, or sends."""
        r = self.r
        steps: list[Step] = [("in", c) for c in self._own(owner, out=False) if c[0] != "b"]
        r.shuffle(steps)
        sent: list[Step] = [("out", c) for c in self._own(owner, out=True) if c[0] != "q"]
        r.shuffle(sent)
        for step in sent:
            at = r.randint(0, len(steps)) if r.random() < self.eagerness else len(steps)
            steps.insert(at, step)
        told = ("out", f"l{owner + 1}")
        if f"b{owner + 1}" in self._own(owner, out=False):
            at = r.randint(steps.index(told) + 1, len(steps))
            steps.insert(at, ("in", f"b{owner + 1}"))
        groups: list[list[Step]] = []
        for step in steps:
            fits = bool(groups) and (step[0] == "out" or groups[-1][-1][0] == "in")
            if fits and r.random() < 0.35:
                groups[-1].append(step)
            else:
                groups.append([step])
        states = ["W", *(f"S{n}" for n in range(1, len(groups))), "W"]
        lines = [f"  page P{owner}", *self._ports(owner), "    place W = 1"]
        lines += [f"    place {s}" for s in states[1:-1]]
        for n, group in enumerate(groups):
            lines += [
                f"    trans T{n}",
                f"      in {states[n]} : ()",
                f"      out {states[n + 1]} : ()",
            ]
            taken = [c for where, c in group if where == "in"]
            lines += [f"      in {c} : {'kjv'[i]}" for i, c in enumerate(taken)]
            put = [c for where, c in group if where == "out"]
            put += [f"q{owner}"] * (f"d{owner}" in put and self.is_early[owner])
            lines += [f"      out {c} : 1" for c in put]
        return lines

    def toml(self) -> str:
        """The cell."""
        text = '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\n'
        text += 'final = ["Finished"]\norder = "documented"\n'
        rows = self.r.sample(self.channels, len(self.channels))
        for c in rows:
            text += f'[[channel]]\nplace = "{c.name}"\nfile = "{c.name}.txt"\nkind = "{c.kind}"\n'
        return text + "".join(f'[devices.D{i}]\ninstance = "D{i}"\n' for i in range(self.count))


def peers(r: Random) -> tuple[str, str]:
    """The net and the cell.toml."""
    made = _Cell(r)
    return made.net(), made.toml()
