"""The machine-tending family: n parts through feeder, loader, mill and finisher onto pallets; two arms, three devices.

    python -m tools.bench.tending --parts 4 FOLDER           # cell.cpn and cell.toml; --properties: what it must not do
    python -m tools.bench.tending --measure 2,4,6             # markings with and without partial order
    python -m tools.bench.tending --reduced --measure 8,12    # with it only
    python -m tools.bench.tending --swept --measure 6,8       # all in memory, and by a sweep line

Arm 1 feeds the loader and carries loaded parts to the mill; arm 2 passes milled parts to the finisher and stows
finished ones on the pallet for good parts or for scrap. Between the machines parts wait on trays, any number of them.
Where arm 1 has lost a part, the run is aborted: parts that have not been fed go to the scrap, those on their way are
finished.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))  # as pytest does

from helpers.netbuilder import cpn

_HEAD = """
net tending
  standard
  colset JOB = int with 1..4;
  colset SAID = int with 1..2;
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  fun moveJoint (p : POSE) = ();
  fun grip () = ();
  fun work () = ();
  fun at n = {x = 4500.0 + 100.0 * Real.fromInt n, y = 500.0, z = 1200.0, rx = 180.0, ry = 0.0, rz = 90.0}
  var j: JOB;
  var k, held, verdict: SAID;
  var n: INT;
  var p: POSE;
  page Top
"""
_PARTIES = ("Arm1", "Arm2", "Loader", "Mill", "Finisher")
_SUPERVISOR = """
  page Supervisor
{ports}
    place Feeder = {parts}
    place Left : INT = 1`{parts}
    place Arm1Free = 1
    place Arm2Free = 1
    place LoaderFree = 1
    place MillFree = 1
    place FinisherFree = 1
    place Feeding
    place Loading
    place Loaded
    place Carrying
    place Milling
    place Milled
    place Passing
    place Finishing
    place Judged : SAID
    place Stowing : SAID
    place Good
    place Scrap
    place Aborted
    place Finished
    trans Feed
      in Feeder : ()
      in Arm1Free : ()
      in LoaderFree : ()
      out poseArm1 : at 1
      out jobArm1 : 1
      out Feeding : ()
    trans Fed
      in Feeding : ()
      in saidArm1 : 1
      out Arm1Free : ()
      out jobLoader : 1
      out Loading : ()
    trans Lost
      in Feeding : ()
      in saidArm1 : 2
      in Left : n
      out Left : n - 1
      out Arm1Free : ()
      out LoaderFree : ()
      out Scrap : ()
      out Aborted : ()
    trans Drop
      both Aborted : ()
      in Feeder : ()
      in Left : n
      out Left : n - 1
      out Scrap : ()
    trans TakeLoaded
      in Loading : ()
      in saidLoader : k
      out LoaderFree : ()
      out Loaded : ()
    trans Carry
      in Loaded : ()
      in Arm1Free : ()
      in MillFree : ()
      out poseArm1 : at 2
      out jobArm1 : 2
      out Carrying : ()
    trans Carried
      in Carrying : ()
      in saidArm1 : k
      out Arm1Free : ()
      out jobMill : 1
      out Milling : ()
    trans TakeMilled
      in Milling : ()
      in saidMill : k
      out MillFree : ()
      out Milled : ()
    trans Pass
      in Milled : ()
      in Arm2Free : ()
      in FinisherFree : ()
      out poseArm2 : at 3
      out jobArm2 : 3
      out Passing : ()
    trans Passed
      in Passing : ()
      in saidArm2 : k
      out Arm2Free : ()
      out jobFinisher : 1
      out Finishing : ()
    trans Judge
      in Finishing : ()
      in saidFinisher : k
      out FinisherFree : ()
      out Judged : k
    trans Stow
      in Judged : k
      in Arm2Free : ()
      out poseArm2 : at 4
      out jobArm2 : 4
      out Stowing : k
    trans StowedGood
      in Stowing : 1
      in saidArm2 : k
      in Left : n
      out Left : n - 1
      out Arm2Free : ()
      out Good : ()
    trans StowedScrap
      in Stowing : 2
      in saidArm2 : k
      in Left : n
      out Left : n - 1
      out Arm2Free : ()
      out Scrap : ()
    trans End
      in Left : 0
      out Finished : ()
"""
_ARM = """
  page {name}
    place job port in : JOB
    place pose port in : POSE
    place said port out : SAID
    place Waiting = 1
    place Told
    place There
    place Gripped
    place Over : SAID
    trans Accept
      in Waiting : ()
      in job : j
      out Told : ()
    trans Move code input (p); action moveJoint p
      in Told : ()
      in pose : p
      out There : ()
    trans Grip code action grip ()
      in There : ()
      out Gripped : ()
    trans {look}
      in Gripped : ()
      out Over : {said}
    trans Report
      in Over : k
      out Waiting : ()
      out said : k
"""
DEVICE = """
  page {name}
    place job port in : JOB
    place said port out : SAID
    place Waiting = 1
    place Told
    place Done
    trans Accept
      in Waiting : ()
      in job : j
      out Told : ()
    trans Work code action work ()
      in Told : ()
      out Done : ()
    trans Report
      in Done : ()
      out Waiting : ()
      out said : {said}
"""


_PROPERTIES = {
    "ends": "ctl AF tokens(Supervisor'Finished) = 1",
    "stops nowhere else": "deadlock free except tokens(Supervisor'Finished) = 1",
    "arm 1 has one job": "mutex Supervisor'Feeding, Supervisor'Carrying",
    "arm 2 has one job": "mutex Supervisor'Passing, Supervisor'Stowing",
    "the mill has one part": "bound Supervisor'Milling <= 1",
    "the loader is free when it is fed": "never tokens(Supervisor'Loading) = 1 && enabled(Supervisor'Feed)",
    "both arms work": "reachable tokens(PageArm1'Gripped) = 1 && tokens(PageArm2'Gripped) = 1",
}


def net(parts: int) -> str:
    """The net, as `helpers.netbuilder` reads it."""
    top, ports, sockets = [], [], []
    for who in _PARTIES:
        pose = ("pose", "POSE") if who.startswith("Arm") else None
        kinds = [("job", "JOB"), *([pose] if pose else []), ("said", "SAID")]
        for kind, colset in kinds:
            top.append(f"    place {kind}{who} : {colset}")
            ports.append(
                f"    place {kind}{who} port {'in' if kind == 'said' else 'out'} : {colset}"
            )
            sockets.append(f"{kind}{who} -> {kind}{who}")
        own = ", ".join(f"{kind} -> {kind}{who}" for kind, _ in kinds)
        top.append(f"    subst {who} = Page{who} ({own})")
    top.append(f"    subst Supervisor = Supervisor ({', '.join(sockets)})")
    pages = [
        _SUPERVISOR.format(ports="\n".join(ports), parts=parts),
        _ARM.format(name="PageArm1", look="Look", said="held"),
        _ARM.format(name="PageArm2", look="Leave", said="1"),
        *(DEVICE.format(name=f"Page{d}", said="1") for d in ("Loader", "Mill")),
        DEVICE.format(name="PageFinisher", said="verdict"),
    ]
    return _HEAD + "\n".join(top) + "".join(pages)


def toml() -> str:
    """The cell."""
    text = """[net]
file = "cell.cpn"

[supervisor]
instance = "Supervisor"
final = ["Finished"]
order = "documented"
"""
    for who in _PARTIES:
        kinds = ["job", *(["pose"] if who.startswith("Arm") else []), "said"]
        for kind in kinds:
            sort = "data" if kind == "pose" else "flag"
            text += (
                f'\n[[channel]]\nplace = "{kind}{who}"\nfile = "{kind}{who}.txt"\nkind = "{sort}"\n'
            )
    text += """
[primitives]
moveJoint = { command = "move_joint" }
grip = { command = "tool", action = "grip", duration_s = 0.5 }
work = { command = "tool", action = "work", duration_s = 2.0 }

[sensors.held]
file = "held.txt"
default = 1

[sensors.verdict]
file = "verdict.txt"
default = 1
"""
    for who in _PARTIES:
        owner = "robots" if who.startswith("Arm") else "devices"
        text += f'\n[{owner}.{who.lower()}]\ninstance = "{who}"\n'
        if who.startswith("Arm"):
            text += f'model = "kr120_r2500"\nbase = {{ x = {3.0 * int(who[-1]):.1f}, y = 0.0, z = 0.0, yaw = 0.0 }}\n'
    return text


def write(folder: Path, parts: int) -> Path:
    """The cell as files; gives the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn(net(parts)))
    (folder / "cell.toml").write_text(toml(), encoding="utf-8")
    return folder


def write_properties(cell: Path) -> None:
    """What is asked of it, beside the net."""
    rows = (
        f'[[property]]\nname = "{name}"\nholds = "{holds}"\n' for name, holds in _PROPERTIES.items()
    )
    (cell / "cell.properties.toml").write_text("\n".join(rows), encoding="utf-8")


def verified(path: Path, *options: str) -> dict[str, Any]:
    """What `pn2code verify` says of a net or cell; `wall` are the seconds of the whole command."""
    command = [sys.executable, "-m", "pn2code", "verify", str(path), "--json", "--no-graph"]
    began = time.perf_counter()
    done = subprocess.run([*command, *options], capture_output=True, text=True, check=False)
    took = time.perf_counter() - began
    try:
        found: dict[str, Any] = json.loads(done.stdout)
    except ValueError:
        raise SystemExit(done.stderr) from None
    return {**found, "wall": took}


def measure(parts: int, limits: list[str], *options: str) -> dict[str, Any]:
    """The same of the closed net of so many parts."""
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        net_file = write(Path(name), parts) / "cell.cpn"
        plain = ("--no-controller", "--no-medium", "--most-traces", "0")
        return verified(net_file, *plain, *limits, *options)


def main() -> int:
    """Writes a cell, or prints a table."""
    parser = argparse.ArgumentParser(prog="tools.bench.tending")
    parser.add_argument("--parts", type=int, default=4)
    parser.add_argument("--measure", default="", help="numbers of parts, with commas between")
    parser.add_argument(
        "--states", type=int, default=10_000_000, help="most markings (default: %(default)s)"
    )
    parser.add_argument("--reduced", action="store_true", help="with partial order only")
    parser.add_argument("--swept", action="store_true", help="all in memory, and by a sweep line")
    parser.add_argument("--properties", action="store_true", help="write some of them, too")
    parser.add_argument("folder", type=Path, nargs="?")
    given = parser.parse_args()
    if given.folder is not None:
        print(write(given.folder, given.parts))
        if given.properties:
            write_properties(given.folder)
    limits = ["--max-states", str(given.states)]
    if given.measure:
        print("| parts | reduction | markings | dead | seconds | MiB | whole command, s |")
        print("|---|---|---|---|---|---|---|")
    for parts in map(int, given.measure.split(",")) if given.measure else ():
        ways = ((), ("--reduce", "partial-order"))[given.reduced :]
        if given.swept:  # by one thread each, since a sweep has no more
            ways = (("--no-sweep", "--no-graph", "--threads", "1"), ("--sweep",))
        for options in ways:
            found = measure(parts, limits, *options)
            used = ", ".join(found["reductions"]) or ("sweep" if found["sweep"] else "none")
            size = f"{found['nodes']:,}" if found["complete"] else f"more than {found['nodes']:,}"
            dead = found["dead_markings"] if found["complete"] else "?"
            print(
                f"| {parts} | {used} | {size} | {dead} | {found['seconds']:.2f} | {found['peak_mib']} "
                f"| {found['wall']:.1f} |",
                flush=True,
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
