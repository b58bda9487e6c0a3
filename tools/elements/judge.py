"""Whether a change of a net shows: in what `check` says, or in the program of whoever it concerns."""

from __future__ import annotations

import re
import shutil
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from tools.elements.changes import Change

from pn2code import pipeline
from pn2code.cell.partition import OwnerKind
from pn2code.diagnostics import Diagnostics
from pn2code.net.codes import SOCKET_ARCS

_COMMENT = re.compile(r"/\*[\s\S]*?\*/|(?m:(^|\s)--[^\n]*$)")
_DIGEST = re.compile(r"[0-9a-f]{64}")
_ID = re.compile(r"\bID\d+\b")


@dataclass(frozen=True)
class Shown:
    """Where a change shows: `refused`, `program`, `check` (by a warning alone), or `nowhere`.

    `drawing`: an arc between a socket and a substitution transition. What such an arc means is said by the assignment
    of ports; CPN Tools refuses a net where the two differ, and `check` warns of it.
    """

    where: str
    detail: str = ""


class Judge:
    """One cell.

    Args:
        cell: its folder.
        room: a folder that does not exist yet.
    """

    def __init__(self, cell: Path, room: Path) -> None:
        shutil.copytree(cell, room)
        (self.net,) = room.glob("*.cpn")
        self.data = self.net.read_bytes()
        self._room = room
        d = Diagnostics()
        made = pipeline.generate(room, d, checked=False)
        assert made is not None, list(d)
        self._said = _said(d)
        self._files = _programs(made)
        partition = made.partition
        self._script_of: dict[str, set[str]] = {}
        for t, owner in zip(partition.net.transitions, partition.transition_owner, strict=True):
            who = partition.owners[owner]
            file = "net.c" if who.kind is OwnerKind.SUPERVISOR else f"{who.name}.tdl"
            self._script_of.setdefault(t.id, set()).add(file)

    def shown(self, change: Change) -> Shown:
        """Where it shows."""
        self.net.write_bytes(change.make())
        d = Diagnostics()
        try:
            made = pipeline.generate(self._room, d, checked=False)
        finally:
            self.net.write_bytes(self.data)
        if made is None:
            return Shown("refused", d.errors[0].code)
        files = _programs(made)
        other = {f for f in {*files, *self._files} if files.get(f) != self._files.get(f)}
        wanted = self._script_of.get(change.element)
        if wanted is None and other or wanted is not None and other & wanted:
            return Shown("program", min(other))
        said = _said(d)
        if said != self._said:
            news = sorted((Counter(said) - Counter(self._said)).elements())
            drawn = news and all(text.split()[0] == SOCKET_ARCS for text in news)
            why = "; ".join(news) or "nothing is said where something was"
            return Shown("drawing" if drawn else "check", why)
        return Shown("nowhere", ", ".join(sorted(other)))


def _said(d: Diagnostics) -> list[str]:
    """What is said, without lines, which a change moves."""
    return sorted(f"{i.code} {i.message}" for i in d)


def _programs(made: pipeline.Generated) -> dict[str, str]:
    """What runs: the supervisor's own files and the scripts, without comments, digests, ids."""
    kept = [f for f in made.files if f.path.endswith((".c", ".h", ".tdl")) and "/" not in f.path]
    return {f.path: _ID.sub("", _DIGEST.sub("", _COMMENT.sub("", f.text))) for f in kept}
