"""What came out of each question about many nets."""

from __future__ import annotations

import json
import traceback
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path

from tools.oracle import engine, reordered
from tools.oracle.compare import GROUPS, Seen, Verdict, differs


def compared(
    path: Path,
    marking: engine.Answer,
    run: engine.Answer | None = None,
    space: engine.Answer | None = None,
) -> dict[str, Verdict]:
    """What comes out of each question about a net."""
    try:
        seen = Seen(path)
        found = {"verdict": seen.verdict(marking), "marking": seen.marking(marking)}
        if run is not None:
            found["run"] = seen.run(run)
        if space is not None:
            found["space"] = seen.space(space)
    except Exception:
        return {"verdict": differs("internal error: " + traceback.format_exc()[-500:])}
    return found


class Totals:
    """What came out of each question, and the nets that differ."""

    def __init__(self, save: Path | None) -> None:
        self.counts: dict[str, Counter[str]] = {}
        self.save = save
        self.notes: defaultdict[str, list[str]] = defaultdict(list)
        """Why something was not compared, and in which nets."""
        self.nets = 0
        self.wrong = 0

    def add(
        self, name: str, path: Path, found: dict[str, Verdict], said: Sequence[engine.Answer | None]
    ) -> None:
        """Counts a net; prints what differs, and keeps the net."""
        self.nets += 1
        first = said[0] or {}
        if found["verdict"] is GROUPS and not reordered.is_accepted(path, first["errors"]):
            found["verdict"] = differs("accepted here; the engine refuses every order of the arcs")
        for question, verdict in found.items():
            self.counts.setdefault(question, Counter())[verdict.state or "nothing"] += 1
            if verdict.state not in ("differs", "agrees") and verdict.note:
                self.notes[f"{question}, {verdict.state}: {verdict.note[:100]}"].append(name)
        wrong = {q: v.note for q, v in found.items() if v.state == "differs"}
        if wrong:
            self.wrong += 1
            for question, note in wrong.items():
                print(f"{name} {question}: {note}", flush=True)
            if self.save is not None:
                self.save.mkdir(parents=True, exist_ok=True)
                (self.save / f"{name}.cpn").write_bytes(path.read_bytes())
                (self.save / f"{name}.json").write_text(json.dumps(said, indent=1))

    def lines(self) -> Iterator[str]:
        """The answers to each question."""
        for question, counts in self.counts.items():
            states = ", ".join(f"{n} {state}" for state, n in counts.most_common())
            yield f"{question}: {states}"

    def report(self) -> int:
        """Prints the totals; the exit code."""
        print(*self.lines(), sep="\n")
        for note, names in self.notes.items():
            print(f"  {note}: {len(names)}, as in {', '.join(names[:5])}")
        print(f"{self.nets} nets, {self.wrong} differ")
        return 1 if self.wrong or not self.nets else 0
