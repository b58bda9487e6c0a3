"""Monitors in the engine of CPN Tools: `./dev oracle --monitored` asks it again about the nets of `monitored_nets.py`.

The program `oracle` sends no monitors. Its modules are used here: they start the engine with a net, and what CPN Tools'
editor sends of monitors (450) is sent as well. A net's answer: `errors` of each monitor's functions, the steps of the
run, the number of the last one by the engine's own count (`step`: an occurrence after which a monitor raises counts,
too, though the run that the oracle prints ends before it), why it ended, the statistics of each collector, and the
content of the files that were written.
"""

from __future__ import annotations

import json
import re
import sys
import tempfile
import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.oracle.engine import ROOT, program
from tools.oracle.monitored_nets import CASES, Case

from helpers.monitors import with_monitors
from pn2code.diagnostics import Diagnostics
from pn2code.monitors.kinds import COLLECTORS, Kind, Monitor, resolve
from pn2code.net import front
from pn2code.net.flat import FlatNet, FlatTransition, PlaceInstance
from pn2code.simulate import reference
from pn2code.simulate.choose import monitors_of
from pn2code.simulate.run import Outcome, Request

ANSWERS = ROOT / "tests" / "golden" / "engine_monitors.json"
STANDARD = {
    Kind.MARKING_SIZE: 20,
    Kind.LIST_LENGTH: 21,
    Kind.COUNT_OCCURRENCES: 22,
    Kind.PLACE_CONTENT: 40,
    Kind.TRANSITION_ENABLED: 41,
}
"""Numbers of the requests that make a standard monitor."""
WRITTEN = {
    Kind.BREAKPOINT: (1, ("predicate",)),
    Kind.USER_DEFINED: (2, ("init", "predicate", "observer", "action", "stop")),
    Kind.DATA_COLLECTION: (3, ("predicate", "observer", "init", "stop")),
    Kind.WRITE_IN_FILE: (4, ("init", "predicate", "observer", "stop")),
}
"""Numbers of monitors with functions, and in which order the request has them."""
STATISTICS = ("count", "sum", "avrg", "min", "max", "first", "last", "ss", "ssd", "vari", "std",
              "starttime", "lasttime", "interval")  # fmt: skip


def _modules() -> tuple[ModuleType, ModuleType]:
    folder = str(program().parent)
    if folder not in sys.path:
        sys.path.insert(0, folder)
    import oracle_engine  # type: ignore[import-not-found]
    import oracle_net  # type: ignore[import-not-found]

    return oracle_engine, oracle_net


def ask(path: Path, monitors: Iterable[Monitor], *, steps: int) -> dict[str, Any]:
    """What the engine says of a net with its monitors; the places and transitions are those of pn2code."""
    found = list(monitors)
    oracle_engine, oracle_net = _modules()
    net = oracle_net.Net(str(path))
    with oracle_net.Session(oracle_engine.Files(), net, time.monotonic() + 60, 1209, 3000) as s:
        if not s.check():
            return {"accepted": False, "errors": s.errors}
        s.instantiate()
        s.e.packet([], [450, 1, len(found)], [m.id for m in found])
        errors = {m.name: e for m in found if (e := _create(s, m))}
        for page in net.pages.values():  # their code calls the monitors now
            for t in page.findall("trans"):
                if t.find("subst") is None:
                    s.e.packet([False], [500, 3, 0, 0, 1], [t.get("id")])
        s.start()
        run = s.run(str(steps))
        counted = s.e.evaluate("IntInf.toInt (step ());")[3]
        statistics = {
            m.name: _statistics(s, m)
            for m in found
            if m.kind in COLLECTORS and m.name not in errors
        }
        files = {}
        for file in sorted(Path(s.e.scratch).rglob("*")):
            written = file.is_file() and not file.is_symlink() and file.name != "dump.sml"
            if written and not file.name.startswith(("simrep-", "PerfReport")):
                files[file.name] = file.read_text(encoding=s.e.encoding)
    return {
        "accepted": True,
        "errors": errors,
        "steps": [x["transition"] for x in run["steps"]],
        "step": int(re.findall(r"val it = (\d+) :", counted)[0]),
        "time": run["final_time"],
        "stop": run["stop"],
        "marking": [[r["id"], r["instance"], r["marking"]] for r in run["final_marking"]],
        "statistics": statistics,
        "files": files,
    }


def _number(node: PlaceInstance | FlatTransition) -> int:
    """The number of its page instance."""
    return node.number if isinstance(node, PlaceInstance) else node.instance_number


def _create(s: Any, m: Monitor) -> list[str]:
    """Makes a monitor; the errors of its functions."""
    number = STANDARD.get(m.kind)
    logging = m.option("logging")
    if number is not None:
        node: Any = (m.places or m.transitions)[0]
        switch = {
            Kind.PLACE_CONTENT: m.option("if is empty"),
            Kind.TRANSITION_ENABLED: m.option("if is enabled"),
        }.get(m.kind, logging)
        answer = s.e.packet([switch], [450, number, _number(node)], [m.id, m.ml_name, node.id])
    else:
        number, wanted = WRITTEN[m.kind]
        texts = []
        for name in wanted:
            text = m.functions.get(name)
            texts += [f"{m.id}_{name}", text.text if text else ""]
        extension = [m.options.get("file extension", "")] if m.kind is Kind.WRITE_IN_FILE else []
        bools = [m.option("timed"), logging] if m.kind is Kind.DATA_COLLECTION else []
        nodes = [_number(n) for n in (*m.places, *m.transitions)]
        ids = [n.id for n in (*m.places, *m.transitions)]
        numbers = [450, 3, number, len(m.places), len(m.transitions), *nodes]
        answer = s.e.packet(bools, numbers, [m.id, m.ml_name, *extension, *texts, *ids])
    return [x[:80] for x in answer[2] if re.search(r"[Ee]rror|not checked|Cannot", x)]


def _statistics(s: Any, m: Monitor) -> dict[str, str]:
    """Each statistic, as SML prints it."""
    said = {}
    for name in STATISTICS:
        status, _, _, text = s.e.evaluate(f"{m.ml_name}.{name} ();")
        value = re.search(r"val it = (.*?) : ", text, re.DOTALL)
        if status == "ok" and value:
            said[name] = value.group(1)
    return said


class Found(NamedTuple):
    """A net, its run, its monitors, the files that they wrote, and what was said."""

    net: FlatNet
    outcome: Outcome
    monitors: list[Monitor]
    files: dict[str, str]
    d: Diagnostics


def here(case: Case, folder: Path) -> Found:
    """A case by the reference engine.

    Args:
        case: the net.
        folder: an empty one, where the net is put.
    """
    path = folder / "net.cpn"
    path.write_bytes(with_monitors(case.net, *case.monitors))
    d = Diagnostics()
    examined = front.examine(path, d)
    assert examined.flat is not None, [e.message for e in d.errors]
    program = monitors_of(examined, d)
    monitors = resolve(examined.document, examined.flat, Diagnostics())
    files = folder / "files"
    files.mkdir()
    request = Request(net=examined.flat, monitors=program, steps=case.steps, files=files)
    outcome = reference.run(request, d)
    written = {
        f.name: f.read_text(encoding="latin-1") for f in sorted(files.rglob("*")) if f.is_file()
    }
    return Found(examined.flat, outcome, monitors, written, d)


def answers() -> dict[str, Any]:
    """What was recorded, by name."""
    kept: dict[str, Any] = json.loads(ANSWERS.read_text(encoding="utf-8"))
    return kept


def main(arguments: Sequence[str]) -> int:
    """Asks about the named cases, or all; 0 when nothing has changed."""
    before = answers() if ANSWERS.is_file() else {}
    now = dict(before)
    for name in arguments or CASES:
        with tempfile.TemporaryDirectory() as folder:
            monitors = here(CASES[name], Path(folder)).monitors
            now[name] = ask(Path(folder) / "net.cpn", monitors, steps=CASES[name].steps)
    text = json.dumps({n: now[n] for n in CASES if n in now}, indent=1, ensure_ascii=False)
    ANSWERS.write_text(text + "\n", encoding="utf-8")
    changed = [name for name in now if now[name] != before.get(name)]
    print(
        f"{len(now)} nets with monitors, {len(changed)} answers have changed: {' '.join(changed)}"
    )
    return 1 if changed else 0
