"""Families of cells that are unlike the one that tends machines: how their checks grow with what they are made of.

python -m tools.bench.families --family ring --size 3 --parts 6 FOLDER   # cell.cpn and cell.toml
python -m tools.bench.families --measure                               # what `verify CELL` says of all, and how long

ring      robots that pass parts on from one to the next, on carriers that come back
zones     robots in a circle, each of which needs the zones on both of its sides for each of its parts
line      stations behind each other, with trays between them that hold any number of parts
pallets   stations behind each other, each of which needs a pallet while it works; there are as many as stations
chain     robots that hand parts on, and tell each other so themselves (`chains`)
retries   robots whose sensor tells whether they have a part; if not they try again, three times
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))  # as pytest does

from tools.bench import chains
from tools.bench.tending import DEVICE, verified

from helpers.netbuilder import cpn

_HEAD = """
net family
  standard
  colset JOB = int with 1..4;
  colset SAID = int with 1..2;
  colset TRY = int with 1..3;
  fun work () = ();
  var j: JOB;
  var k, held: SAID;
  var t: TRY;
  var n: INT;
  page Top
"""
Lines = list[str]


def _place(name: str, initial: str = "") -> str:
    return f"    place {name}{initial}"


def _trans(name: str, *arcs: str) -> Lines:
    return [f"    trans {name}", *(f"      {a}" for a in arcs)]


def _counted(parts: int) -> Lines:
    """Places that say how many parts are left, and the end."""
    return [_place("Left", f" : INT = 1`{parts}"), _place("Finished")]


_ONE_LESS = ("in Left : n", "out Left : n - 1")
_END = _trans("End", "in Left : 0", "out Finished : ()")


def ring(size: int, parts: int) -> Lines:
    """Robots 1 .. n pass parts on; there are n - 1 carriers (one at least), and one place behind each robot."""
    carriers = max(1, size - 1)
    lines = [
        _place("Feeder", f" = {parts}"),
        _place("Carriers", f" = {carriers}"),
        *_counted(parts),
    ]
    steps: Lines = []
    for i in range(1, size + 1):
        is_last = i == size
        lines += [_place(f"Free{i}", " = 1"), _place(f"Moving{i}")]
        lines += [] if is_last else [_place(f"Tray{i}"), _place(f"Room{i}", " = 1")]
        source = ("in Feeder : ()", "in Carriers : ()") if i == 1 else (f"in Tray{i - 1} : ()",)
        room = () if is_last else (f"in Room{i} : ()",)
        back = () if i == 1 else (f"out Room{i - 1} : ()",)
        steps += _trans(
            f"Pass{i}", *source, f"in Free{i} : ()", *room, *back,
            f"out job{i} : 1", f"out Moving{i} : ()",
        )  # fmt: skip
        target = ("out Carriers : ()", *_ONE_LESS) if is_last else (f"out Tray{i} : ()",)
        steps += _trans(
            f"Passed{i}", f"in Moving{i} : ()", f"in said{i} : k", f"out Free{i} : ()", *target
        )
    return lines + steps + _END


def zones(size: int, parts: int) -> Lines:
    """Robot i needs zones i and i + 1, of n in a circle, for each of its parts."""
    lines = [*_counted(parts * size), *(_place(f"Zone{i}", " = 1") for i in range(1, size + 1))]
    steps: Lines = []
    for i in range(1, size + 1):
        lines += [_place(f"Todo{i}", f" = {parts}"), _place(f"Inside{i}")]
        both = sorted({i, i % size + 1})
        steps += _trans(
            f"Enter{i}", f"in Todo{i} : ()", *(f"in Zone{z} : ()" for z in both),
            f"out job{i} : 1", f"out Inside{i} : ()",
        )  # fmt: skip
        steps += _trans(
            f"Leave{i}", f"in Inside{i} : ()", f"in said{i} : k",
            *(f"out Zone{z} : ()" for z in both), *_ONE_LESS,
        )  # fmt: skip
    return lines + steps + _END


def line(size: int, parts: int) -> Lines:
    """Stations 1 .. n, each with one part at a time; any number of parts between them."""
    lines = [_place("Tray0", f" = {parts}"), *_counted(parts)]
    steps: Lines = []
    for i in range(1, size + 1):
        is_last = i == size
        lines += [_place(f"Free{i}", " = 1"), _place(f"Busy{i}")]
        lines += [] if is_last else [_place(f"Tray{i}")]
        steps += _trans(
            f"Start{i}", f"in Tray{i - 1} : ()", f"in Free{i} : ()",
            f"out job{i} : 1", f"out Busy{i} : ()",
        )  # fmt: skip
        target = _ONE_LESS if is_last else (f"out Tray{i} : ()",)
        steps += _trans(
            f"Ready{i}", f"in Busy{i} : ()", f"in said{i} : k", f"out Free{i} : ()", *target
        )
    return lines + steps + _END


def retries(size: int, parts: int) -> Lines:
    """Robots that have their own parts; one that has none tries up to three times, and then it is lost."""
    lines = [*_counted(parts * size), _place("Good"), _place("Lost")]
    steps: Lines = []
    for i in range(1, size + 1):
        lines += [_place(f"Todo{i}", f" = {parts}"), _place(f"Free{i}", " = 1")]
        lines += [_place(f"Trying{i}", " : TRY")]
        own = (f"in Trying{i} : t", f"in said{i} : 2")
        steps += _trans(
            f"Take{i}", f"in Todo{i} : ()", f"in Free{i} : ()",
            f"out job{i} : 1", f"out Trying{i} : 1",
        )  # fmt: skip
        steps += _trans(
            f"Taken{i}", f"in Trying{i} : t", f"in said{i} : 1", f"out Free{i} : ()",
            "out Good : ()", *_ONE_LESS,
        )  # fmt: skip
        steps += _trans(
            f"Again{i} guard [t < 3]", *own, f"out job{i} : 2", f"out Trying{i} : t + 1"
        )
        steps += _trans(
            f"Gone{i} guard [t = 3]", *own, f"out Free{i} : ()", "out Lost : ()", *_ONE_LESS
        )
    return lines + steps + _END


def pallets(size: int, parts: int) -> Lines:
    """As `line`, and each part that is worked on is on one of n pallets."""
    found: Lines = []
    for x in line(size, parts):
        at = x.split()
        found.append(x)
        if at[0] == "trans" and at[1] != "End":
            found.append(f"      {'in' if at[1].startswith('Start') else 'out'} Pallets : ()")
    return [_place("Pallets", f" = {size}"), *found]


FAMILIES: dict[str, Callable[[int, int], Lines]] = {
    "ring": ring,
    "zones": zones,
    "line": line,
    "pallets": pallets,
    "retries": retries,
}
MEASURED: dict[str, tuple[tuple[int, int], ...]] = {
    "ring": ((3, 12), (5, 12), (5, 100), (7, 12)),
    "zones": ((3, 6), (4, 6), (5, 6), (5, 50), (6, 6)),
    "line": ((2, 12), (3, 12), (4, 12), (4, 50), (6, 12)),
    "pallets": ((2, 12), (3, 12), (4, 12), (4, 50)),
    "chain": ((2, 12), (3, 12), (4, 12), (4, 50), (6, 12)),
    "retries": ((1, 6), (2, 6), (3, 6), (3, 50), (4, 6)),
}


def net(family: str, size: int, parts: int) -> str:
    """The net, as `helpers.netbuilder` reads it."""
    if family == "chain":
        return chains.net(size, parts)
    numbers = range(1, size + 1)
    top, ports, sockets = [], [], []
    for i in numbers:
        for kind, colset in (("job", "JOB"), ("said", "SAID")):
            top.append(f"    place {kind}{i} : {colset}")
            way = "in" if kind == "said" else "out"
            ports.append(f"    place {kind}{i} port {way} : {colset}")
            sockets.append(f"{kind}{i} -> {kind}{i}")
        top.append(f"    subst R{i} = PageR{i} (job -> job{i}, said -> said{i})")
    top.append(f"    subst Supervisor = Supervisor ({', '.join(sockets)})")
    said = "held" if family == "retries" else "1"
    scripts = "".join(DEVICE.format(name=f"PageR{i}", said=said) for i in numbers)
    page = [*top, "  page Supervisor", *ports, *FAMILIES[family](size, parts)]
    return _HEAD + "\n".join(page) + "\n" + scripts


def toml(family: str, size: int) -> str:
    """The cell."""
    if family == "chain":
        return chains.toml(size)
    text = '[net]\nfile = "cell.cpn"\n\n[supervisor]\ninstance = "Supervisor"\n'
    text += 'final = ["Finished"]\norder = "documented"\n'
    for i in range(1, size + 1):
        for kind in ("job", "said"):
            text += f'\n[[channel]]\nplace = "{kind}{i}"\nfile = "{kind}{i}.txt"\nkind = "flag"\n'
    text += '\n[primitives]\nwork = { command = "tool", action = "work", duration_s = 2.0 }\n'
    if family == "retries":
        text += '\n[sensors.held]\nfile = "held.txt"\ndefault = 1\n'
    return text + "".join(f'\n[devices.r{i}]\ninstance = "R{i}"\n' for i in range(1, size + 1))


def write(folder: Path, family: str, size: int, parts: int) -> Path:
    """The cell as files; gives the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn(net(family, size, parts)))
    (folder / "cell.toml").write_text(toml(family, size), encoding="utf-8")
    return folder


def measured(family: str, size: int, parts: int, options: Sequence[str]) -> str:
    """One row of the table: what `pn2code verify CELL` says."""
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        cell = write(Path(name), family, size, parts)
        said = verified(cell, *options)
    checks = [c["answer"] for c in said["controller"]]
    medium = said["medium"][0]
    files = f"{medium['answer']}, {medium['nodes']:,}" + (" reduced" * medium["reduced"])
    answers = ", ".join(f"{checks.count(x)} {x}" for x in ("yes", "no", "unknown") if x in checks)
    space = said["cell"]
    how = "all" if not space["reduced"] else "counted" if space["bounds"] is None else "in turns"
    whole = "" if space["complete"] else "more than "
    return f"{how} | {whole}{space['states']:,} | {answers} | {files} | {said['wall']:.0f}"


def main() -> int:
    """Writes a cell, or prints a table."""
    parser = argparse.ArgumentParser(prog="tools.bench.families")
    parser.add_argument("--family", choices=sorted(MEASURED))
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("--size", type=int, default=3, help="robots (default: %(default)s)")
    parser.add_argument("--parts", type=int, default=6, help="(default: %(default)s)")
    parser.add_argument("--measure", action="store_true", help="print a table")
    parser.add_argument("--seconds", type=int, default=120, help="of one row at most")
    parser.add_argument("--all", action="store_true", help="without reduction")
    given = parser.parse_args()
    if given.folder is not None and given.family:
        print(write(given.folder, given.family, given.size, given.parts))
    if given.measure:
        options = ["--max-seconds", str(given.seconds), *(["--no-reduction"] * given.all)]
        print("| family | robots | parts | how | states | checks | medium | seconds |")
        print("|---|---|---|---|---|---|---|---|")
        for family in [given.family] if given.family else MEASURED:
            for size, parts in MEASURED[family]:
                row = measured(family, size, parts, options)
                print(f"| {family} | {size} | {parts} | {row} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
