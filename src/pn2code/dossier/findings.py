"""What the commands of a report have found out, read from what they have written."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from pn2code.base.clearance_words import figure
from pn2code.base.conditioning import condition_text
from pn2code.base.frozen import frozen
from pn2code.dossier.geometry import Table, answered, tables
from pn2code.dossier.steps import Done

Json = Mapping[str, Any]
YES, NO, OPEN = "yes", "no", "not known"
NOTED = "noted"
"""A figure or a warning, which is nothing that was asked."""
_IN_SECONDS = re.compile(r"\bwithin\s+[0-9.]+\s+(?:seconds?|time)\s*$")
_MOST = 2_000
"""Characters of a message that are shown."""


@frozen
class Finding:
    """An answer, and where it comes from.

    Args:
        about: what was asked.
        answer: `YES`, `NO`, `OPEN` or `NOTED`.
        says: in words.
        assumes: what it rests on besides what was looked at.
    """

    about: str
    answer: str
    says: str
    assumes: tuple[str, ...] = ()


@frozen
class Chapter:
    """What one command has found out.

    Args:
        done: the command.
        answer: the worst of its answers.
        says: a sentence.
        findings: one by one.
        messages: what it complained of.
        tables: what else is worth reading one by one.
    """

    done: Done
    answer: str
    says: str
    findings: tuple[Finding, ...] = ()
    messages: str = ""
    tables: tuple[Table, ...] = ()


def worst(answers: Sequence[str]) -> str:
    """`NO` before `OPEN` before `YES`; nothing is not known."""
    found = [a for a in (NO, OPEN, YES) if a in answers]
    return found[0] if found else OPEN


def read(done: Done, folder: Path) -> Chapter:
    """What a command has said.

    Raises:
        OSError: what it has written cannot be read.
    """
    if done.code is None:
        return Chapter(done, OPEN, f"It was left out: {done.why}.")
    by_code = {0: YES, 1: NO}.get(done.code, OPEN)
    reader = _geometry if done.step.is_geometry else _READERS.get(done.step.verb)
    said = _json(folder, done) if reader is not None else None
    if reader is None or said is None:
        says = (
            "It has succeeded." if done.code == 0 else f"It has ended with exit code {done.code}."
        )
        return Chapter(done, by_code, says, messages=done.complaint[:_MOST])
    says, findings = reader(said)
    answer = worst([by_code, *(f.answer for f in findings)])
    shown = (
        tuple(t for row in said["layouts"] for t in tables(row)) if done.step.is_geometry else ()
    )
    return Chapter(done, answer, says, tuple(findings), done.complaint[:_MOST], shown)


def _json(folder: Path, done: Done) -> Json | None:
    name = done.step.said
    if done.step.verb == "run":
        name = f"{Path(name).stem}/summary.json"
    try:
        found = json.loads((folder / name).read_text(encoding="utf-8"))
    except (FileNotFoundError, ValueError):  # it had nothing to say, which its exit code tells
        return None
    return found if isinstance(found, dict) else None


def _checked(said: Json) -> tuple[str, list[Finding]]:
    counts = ", ".join(f"{said[k]:,} {k}" for k in ("pages", "places", "transitions", "arcs"))
    rows = [
        Finding(
            f"{d.get('page') or 'the net'}{': ' + d['element'] if d.get('element') else ''}",
            {"error": NO}.get(d["severity"], NOTED),
            f"{d['severity']} {d['code']}: {d['message']}"
            + (f" (accepted: {d['accepted']})" if d.get("accepted") else ""),
        )
        for d in said["diagnostics"]
    ]
    return f"{counts[0].upper()}{counts[1:]}; {len(rows)} remark{'s' * (len(rows) != 1)}.", rows


def _geometry(said: Json) -> tuple[str, list[Finding]]:
    if not said["layouts"]:
        return f"Nothing is known: {said['why']}.", [Finding("geometry", OPEN, said["why"] or "")]
    found = []
    for row in said["layouts"]:
        where = f"layout {row['layout']}: " if row["layout"] else ""
        part = f" ({row['open']})" if row["open"] else ""
        near = row["nearest"]
        nearest = (
            f"; they keep apart by at least {1000 * near['at_least_m']:.0f} mm" if near else ""
        )
        whole = row["pairs_says"]
        if row.get("pairs_open"):
            nearest = f"; {row['pairs_open']}"
        found += [
            Finding(
                f"{where}moves",
                answered(row["moves_answer"]),
                "Each move can be done from wherever the arm can be then, without touching what stands or itself"
                f": {len(row['moves'])} moves{part}",
            ),
            Finding(
                f"{where}{'arms and devices' if row['devices'] else 'arms'} keep apart",
                answered(row["pairs_answer"]),
                f"{whole[:1].upper()}{whole[1:]}: {row['pairs_compared']:,} pairs of moves, "
                f"{row['distances_measured']:,} distances{nearest}{part}",
            ),
        ]
        found += [
            Finding(f"{where}{' and '.join(x['transitions'])}", OPEN, f"{x['says']}; {x['do']}")
            for x in row.get("open_at", ())
        ]
    states = max(row["states"] for row in said["layouts"])
    return f"All that can be under way in the {states:,} states of the cell was swept.", found


def _verified(said: Json) -> tuple[str, list[Finding]]:
    durations = said.get("durations")
    found = [
        _answer(
            p.get("name") or p["holds"], p, f"{p['says'] or p['holds']}{_longest(p, durations)}"
        )
        for p in said.get("properties", ())
    ]
    found += [_answer(_titled(c["check"]), c, c["says"]) for c in said.get("controller") or ()]
    found += [_answer(_begun(m["check"]), m, m["says"]) for m in said.get("medium") or ()]
    found += [Finding("note", NOTED, x) for x in said.get("notes") or ()]
    found += _cycles(durations) if durations else []
    whole = "all" if said["complete"] else f"a part ({said['why']}): {said['nodes']:,} of its"
    nodes = f" {said['nodes']:,}" if said["complete"] else ""
    says = f"The net was seen in {whole}{nodes} markings, with {said['arcs']:,} steps between them."
    cell = said.get("cell")
    if cell and cell.get("modelled"):
        part = "" if cell["complete"] else ", not to the end"
        says += f" The cell as its programs run has {cell['states']:,} states{part}."
    return says, found


def _titled(check: str) -> str:
    """A check of the supervisor as the screen has it, with the name by which files and documents know it."""
    from pn2code.verify.controller.control_types import (
        TITLES,
    )  # what it loads is not needed for the rest

    return f"{TITLES[check]} ({check})" if check in TITLES else check


def _begun(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}"


def _longest(row: Json, durations: Json | None) -> str:
    """How long the longest wait of a property in seconds is, as a clause."""
    if not durations or row.get("value") is None or not _IN_SECONDS.search(row["holds"]):
        return ""
    return f": {row['value']:g} s at most" if row["answer"] == "yes" else f": {row['value']:g} s"


def _cycles(durations: Json) -> list[Finding]:
    """The best and the worst time of each way to end, in each layout."""
    if durations["why"]:
        return [Finding("durations", OPEN, durations["why"])]
    rows = []
    for layout in durations["layouts"]:
        where = f"layout {layout['layout']}: " if layout["layout"] else ""
        cycle = layout["cycle"]
        if cycle["why"]:
            rows.append(Finding(f"{where}cycle", NOTED, f"not known: {cycle['why']}"))
        for ending in cycle["endings"]:
            best, worst = (
                "not known" if ending[k] is None else f"{ending[k]:g} s"
                for k in ("least_s", "most_s")
            )
            if ending["most_s"] is None and cycle["repeats"]:
                worst = "no upper bound"
            late = "; if no answer were too late" if cycle["late"] else ""
            places = ", ".join(x.rpartition(".")[2] for x in ending["final"])
            rows.append(
                Finding(f"{where}cycle to {places}", NOTED, f"best {best}, worst {worst}{late}")
            )
    return rows


def _answer(about: str, row: Json, says: str) -> Finding:
    """A row of `verify --json`."""
    answer = row["answer"]
    expected = row.get("expect", True)
    if answer in ("yes", "no"):
        is_good = (answer == "yes") == expected or bool(row.get("accepted"))
        answer = YES if is_good else NO
    else:
        answer = OPEN
    why = f" ({row['why']})" if row.get("why") and answer != YES else ""
    assumed = row.get("assumes") or ()
    listed = (assumed,) if isinstance(assumed, str) else tuple(assumed)
    return Finding(about, answer, says + why, listed)


def _compared(said: Json) -> tuple[str, list[Finding]]:
    core, supervisor = said["core"], said["supervisor"]
    found = [
        _equal("files", not _listed(said["files"]), f"{said['files']['files']} files", True),
        _equal(
            "net.c",
            core["deviation"] is None,
            core["deviation"] or f"{core['nodes']:,} markings, {core['arcs']:,} occurrences",
            core["complete"],
        ),
    ]
    rows = [("supervisor", supervisor)] if supervisor else []
    rows += [(r["robot"], r) for r in said.get("robots") or ()]
    for name, row in rows:
        says = row["deviation"] or f"{row['states']:,} states"
        found.append(_equal(name, row["deviation"] is None, says, row["complete"]))
    return "Each program does what its page of the net says, or the difference is named.", found


def _listed(files: Json) -> list[str]:
    return [x for kind in ("differing", "intruding", "foreign") for x in files.get(kind) or ()]


def _equal(about: str, is_equal: bool, says: str, is_whole: bool) -> Finding:
    answer = (YES if is_whole else OPEN) if is_equal else NO
    return Finding(about, answer, says if is_whole else f"{says}; not to the end")


def _ran(said: Json) -> tuple[str, list[Finding]]:
    ended = said["verdict"]
    places = ", ".join(said.get("final") or ())
    is_good = ended == "finished" and not said.get("failed")
    others = [x for x in said.get("failed") or () if x not in (said.get("final") or ())]
    why = f"(a failure: {'; '.join(others)})" if others else ""
    text = " ".join(x for x in (ended, places and f"in {places}", why, said["reason"]) if x)
    found = [Finding("end of the run", YES if is_good else NO, text)]
    cycle = said.get("cycle_seconds")
    says = f"It has {ended}" + (f" after {cycle:.2f} s of its time" if cycle else "") + "."
    found += [
        Finding(f"least clearance, {name}", NOTED, figure(row))
        for name, row in _rows(said, "clearances")
    ]
    found += [
        Finding(
            f"worst conditioning, {name}",
            NOTED,
            f"{condition_text(row['worst'], 1)} at {row['t']:.2f} s",
        )
        for name, row in _rows(said, "conditioning")
    ]
    found += [
        Finding("warning", NOTED, f"{w['robot']} {w['text']}" if w.get("robot") else w["text"])
        for w in said.get("warnings") or ()
    ]
    return says, found


def _rows(said: Json, key: str) -> Iterator[tuple[str, Any]]:
    yield from (said.get(key) or {}).items()


_READERS = {"check": _checked, "verify": _verified, "conform": _compared, "run": _ran}
