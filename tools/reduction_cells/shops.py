"""Random cells that are nearly right, with all that programs may do to each other: proofs are tried where they apply.

Parts go from a feeder through one to three devices; some are scrap, some break the run off. What varies: data beside a
flag, sent in one transition or not; a device that tells the next one something; a second command; priorities; places
that have to be empty, or are emptied; a reference that is read; packs of two; and more parts than limits count. A
quarter has a flaw.
"""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

FLAWS = (
    "two at once",
    "never free",
    "twice counted",
    "no answer",
    "goes round",
    "unheard",
    "kept back",
)
_HEAD = """net cell
  standard
  val P_HIGH = 100;
  val P_LOW = 10000;
  fun act () = ();
  globref mode = 1;
  colset SAID = int with 1..2;
  var k, j, v: SAID;
  var n: INT;
"""


@dataclass(frozen=True)
class _Device:
    number: int
    has_data: bool
    data_is_late: bool
    """it takes the data in a transition of its own"""
    speaks_data: bool
    tells_next: bool
    hears_last: bool
    has_second: bool
    """a second command"""
    is_open: bool
    """it decides between two answers"""
    is_scrap: bool
    """the second answer means scrap"""
    steps: int

    def channels(self) -> list[tuple[str, str, str]]:
        """Those with the supervisor: name, direction as the supervisor sees it, kind."""
        found = [("f", "out", "flag"), ("d", "in", "flag")]
        found += [("p", "out", "data")] * self.has_data + [("q", "in", "data")] * self.speaks_data
        return found + [("g", "out", "flag")] * self.has_second


class _Shop:
    def __init__(self, r: Random) -> None:
        self.r = r
        count = r.choice([1, 1, 2, 2, 3])
        self.parts = r.choice({1: [3, 4, 5, 6, 8], 2: [3, 3, 4], 3: [2, 3]}[count])
        self.flaw = r.choice(FLAWS) if r.random() < 0.25 else ""
        tells = [n < count and r.random() < 0.25 for n in range(1, count + 1)]
        self.devices = [self._device(n, tells) for n in range(1, count + 1)]
        self.flawed = r.choice(self.devices)
        self.is_counted = r.random() < 0.7
        self.in_packs = self.parts % 2 == 0 and r.random() < 0.25
        self.breaks_off = r.random() < 0.5
        self.has_mode = r.random() < 0.3
        self.has_priorities = r.random() < 0.5
        self.stores_at_once = not self.in_packs and r.random() < 0.6

    def _device(self, number: int, tells: list[bool]) -> _Device:
        r = self.r
        has_data = r.random() < 0.3
        is_open = r.random() < 0.5
        return _Device(
            number=number,
            has_data=has_data,
            data_is_late=has_data and r.random() < 0.5,
            speaks_data=r.random() < 0.25,
            tells_next=tells[number - 1],
            hears_last=number > 1 and tells[number - 2],
            has_second=r.random() < 0.2,
            is_open=is_open,
            is_scrap=is_open and not tells[number - 1] and r.random() < 0.7,
            steps=r.randint(0, 2),
        )

    def _has(self, flaw: str, d: _Device) -> bool:
        return self.flaw == flaw and d is self.flawed

    def _urgency(self) -> str:
        urgent = ["", "", "", " priority P_HIGH", " priority P_LOW"]
        return self.r.choice(urgent) if self.has_priorities else ""

    def net(self) -> str:
        """The net."""
        top = ["  page Top"]
        sockets = []
        for d in self.devices:
            own = [c for c, _, _ in d.channels()]
            top += [f"    place {c}{d.number} : SAID" for c in own]
            top += [f"    place l{d.number} : SAID"] * d.tells_next
            sockets += [f"{c}{d.number} -> {c}{d.number}" for c in own]
            pairs = [f"{c} -> {c}{d.number}" for c in own]
            pairs += [f"l -> l{d.number}"] * d.tells_next
            pairs += [f"m -> l{d.number - 1}"] * d.hears_last
            top.append(f"    subst D{d.number} = P{d.number} ({', '.join(pairs)})")
        top.append(f"    subst Supervisor = Sup ({', '.join(sockets)})")
        pages = [*top, *self._supervisor(), *(x for d in self.devices for x in self._page(d))]
        return _HEAD + "\n".join(pages) + "\n"

    def _supervisor(self) -> list[str]:
        lines = ["  page Sup"]
        for d in self.devices:
            i = d.number
            lines += [f"    place {c}{i} port {where} : SAID" for c, where, _ in d.channels()]
            lines += [f"    place Free{i} = 1", f"    place Busy{i}", f"    place Tray{i}"]
        lines += [f"    place Feeder = {self.parts}", f"    place Left : INT = 1`{self.parts}"]
        lines += [f"    place {p}" for p in ("Done", "Scrap", "Aborted", "Finished", "Log")]
        for d in self.devices:
            lines += self._send(d) + self._heard(d)
        last = len(self.devices)
        if self.in_packs:
            lines += [f"    trans Pack{self._urgency()}", f"      in Tray{last} : 2`()"]
            lines += ["      in Left : n", "      out Left : n - 2", "      out Done : 2`()"]
        elif not self.stores_at_once:
            lines += [f"    trans Store{self._urgency()}", f"      in Tray{last} : ()"]
            lines += ["      in Left : n", "      out Left : n - 1", "      out Done : ()"]
        if self.breaks_off:
            lines += [f"    trans Drop{self._urgency()}", "      both Aborted : ()"]
            lines += ["      in Feeder : ()", "      in Left : n", "      out Left : n - 1"]
            lines += ["      out Scrap : ()"]
        return lines + self._end()

    def _send(self, d: _Device) -> list[str]:
        r, i = self.r, d.number
        lines: list[str] = []
        for second in (False, True)[: 1 + d.has_second]:
            guard = " guard [!mode = 1]" * (self.has_mode and r.random() < 0.5)
            lines += [f"    trans Send{i}{'B' * second}{self._urgency()}{guard}"]
            lines += [f"      in {'Feeder' if i == 1 else f'Tray{i - 1}'} : ()"]
            lines += [f"      {'both' if self._has('two at once', d) else 'in'} Free{i} : ()"]
            lines += ["      inhibit Aborted"] * (i == 1 and self.breaks_off and r.random() < 0.5)
            lines += [f"      inhibit Tray{i}"] * (r.random() < 0.15)
            lines += ["      reset Log"] * (r.random() < 0.1)
            lines += [f"      out {'g' if second else 'f'}{i} : {r.randint(1, 2)}"]
            lines += [f"      out p{i} : {r.randint(1, 2)}"] * d.has_data
            lines += [f"      out Busy{i} : ()"]
        return lines

    def _heard(self, d: _Device) -> list[str]:
        r, i = self.r, d.number
        lines: list[str] = []
        is_split = d.is_scrap or r.random() < 0.3
        for said in (1, 2) if is_split else (0,):
            if said == 2 and self._has("unheard", d):
                continue
            guard = f" guard [k = {said}]" if said else ""
            lines += [
                f"    trans Heard{i}x{said}{self._urgency()}{guard}",
                f"      in Busy{i} : ()",
            ]
            lines += [f"      in d{i} : k"] + [f"      in q{i} : j"] * d.speaks_data
            lines += [f"      out Free{i} : ()"] * (not self._has("never free", d))
            lines += ["      out Log : ()"] * (r.random() < 0.2)
            if said == 2 and d.is_scrap:
                less = 2 if self._has("twice counted", d) else 1
                lines += [
                    "      in Left : n",
                    f"      out Left : n - {less}",
                    "      out Scrap : ()",
                ]
                lines += ["      out Aborted : ()"] * (self.breaks_off and r.random() < 0.7)
            elif d is self.devices[-1] and self.stores_at_once:
                lines += ["      in Left : n", "      out Left : n - 1", "      out Done : ()"]
            else:
                lines += [f"      out Tray{i} : ()"]
        return lines

    def _end(self) -> list[str]:
        lines = [f"    trans End{self._urgency()}"]
        if self.is_counted:
            lines += ["      in Left : 0"]
        else:
            lines += ["      in Left : n", "      inhibit Feeder"]
            for d in self.devices:
                lines += [f"      inhibit Busy{d.number}", f"      inhibit Tray{d.number}"]
        return [*lines, "      out Finished : ()"]

    def _page(self, d: _Device) -> list[str]:
        r = self.r
        lines = [f"  page P{d.number}"]
        for c, where, _ in d.channels():
            lines.append(f"    place {c} port {'in' if where == 'out' else 'out'} : SAID")
        lines += ["    place l port out : SAID"] * d.tells_next
        lines += ["    place m port in : SAID"] * d.hears_last
        states = ["Told", *(f"S{n}" for n in range(d.steps + d.data_is_late + d.hears_last))]
        lines += ["    place Waiting = 1", *(f"    place {s} : SAID" for s in states)]
        hears_at_once = d.hears_last and r.random() < 0.4
        for c in ("f", "g")[: 1 + d.has_second]:
            lines += [f"    trans Accept{c}", "      in Waiting : ()", f"      in {c} : k"]
            lines += ["      in p : j"] * (d.has_data and not d.data_is_late)
            lines += ["      in m : v"] * hears_at_once
            lines += ["      out Told : k"]
        names = ["Step"] * d.steps + ["Fetch"] * d.data_is_late
        names += ["Hear"] * (d.hears_last and not hears_at_once)
        r.shuffle(names)
        at = "Told"
        for n, name in enumerate(names):
            code = " code action act ()" * (name == "Step" and r.random() < 0.6)
            lines += [f"    trans {name}{n}{code}", f"      in {at} : k"]
            lines += ["      in p : j"] * (name == "Fetch") + ["      in m : v"] * (name == "Hear")
            lines += [f"      out S{n} : {r.choice(['k', 'j', 'v']) if name == 'Step' else 'k'}"]
            if self._has("goes round", d) and name == "Step":
                lines += ["    trans Again", f"      in S{n} : k", f"      out {at} : k"]
            at = f"S{n}"
        return lines + self._says(d, at)

    def _says(self, d: _Device, at: str) -> list[str]:
        r = self.r
        lines: list[str] = []
        has_guards = r.random() < 0.4
        for said in (1, 2)[: 1 + d.is_open]:
            if said == 2 and self._has("no answer", d) and has_guards:
                continue
            guard = f" guard [k = {said}]" * (d.is_open and has_guards)
            lines += [f"    trans Say{said}{guard}", f"      in {at} : k", "      out Waiting : ()"]
            lines += [f"      out d : {said if has_guards or not d.is_open else 'j'}"]
            lines += ["      out q : k"] * d.speaks_data
            lines += ["      out l : k"] * (d.tells_next and not self._has("kept back", d))
        return lines

    def toml(self) -> str:
        """The cell."""
        text = '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\n'
        text += 'final = ["Finished"]\norder = "documented"\n[primitives]\n'
        text += 'act = { command = "tool", action = "act", duration_s = 0.5 }\n'
        for d in self.devices:
            rows = [(f"{c}{d.number}", kind) for c, _, kind in d.channels()]
            rows += [(f"l{d.number}", self.r.choice(["data", "data", "flag"]))] * d.tells_next
            for place, kind in rows:
                text += f'[[channel]]\nplace = "{place}"\nfile = "{place}.txt"\nkind = "{kind}"\n'
            text += f'[devices.D{d.number}]\ninstance = "D{d.number}"\n'
        return text


def shop(r: Random) -> tuple[str, str]:
    """The net and the cell.toml."""
    made = _Shop(r)
    return made.net(), made.toml()
