"""A run of a channel model in words of files and sides.

told(model, storage, trace)      # lines; the run is played by the reference token game

    supervisor renames .flag1.robcad.supervisor.tmp over flag1.robcad: the message is there
        flag1.robcad: 0 -> message 1 of session 1: 4
    robot1 crashes: its memory is lost, its lock is free, the files stay
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pn2code.base.readable import readable
from pn2code.channel_model.faults import SAYS, Fault
from pn2code.channel_model.places import ABSENT, FINISHED, RUNNING, STOPPED, ChannelModel
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.values.colours import TEXTS
from pn2code.verify.answers.path import play

_STATES = {ABSENT: "nothing", RUNNING: "running", FINISHED: "finished", STOPPED: "stopped"}
MOST_VALUE = 60
"""Characters of a message's value."""


class RunText:
    """Tells the runs of one net."""

    def __init__(self, model: ChannelModel, storage: Mapping[str, str]) -> None:
        self._model = model
        self._storage = storage

    def told(self, trace: Path) -> tuple[tuple[str, ...], Fault | None]:
        """The lines, and the verdict at the end of the run, None for a deadlock.

        Raises:
            TraceRefusedError, GameError, OSError: as for `play`.
        """
        model = self._model
        owners = model.partition.owners
        game, played = play(model.net, self._storage, trace)
        lines: list[str] = []
        before = self._directory(game.marking)
        fault: Fault | None = None
        for step, transition in played:
            says = model.says.get(step.transition)
            if says is None:
                owner = owners[model.partition.transition_owner[transition.index]].name
                binding = ", ".join(f"{k} = {v}" for k, v in step.binding.items())
                says = f"{owner}: `{step.transition}` fires" + (f" ({binding})" if binding else "")
            verdict = tuple(game.marking.places[model.verdict])
            if verdict:
                fault = Fault(_first(verdict))
                lines.append(f"so {SAYS[fault]}")
                break
            after = self._directory(game.marking)
            if says:
                lines.append(says)
            for file, content in after.items():
                if content != before[file]:
                    lines.append(f"    {file}: {before[file]} -> {content}")
            before = after
        if fault is None:
            lines.append("and nothing can happen any more")
        return tuple(lines), fault

    def _directory(self, marking: Marking) -> dict[str, str]:
        """What is in the shared directory."""
        found: dict[str, str] = {}
        for f in self._model.files:
            found[f.channel.file] = self._content(marking, f.file, f.half)
        for side in self._model.sides:
            for token in marking.places[side.status]:
                state, session = _parts(token)
                text = _STATES[state] + (f", session {session}" if session else "")
                locked = "locked" if tuple(marking.places[side.locked]) else "not locked"
                found[f"{side.name}.status"] = f"{text} ({locked})"
        return found

    def _content(self, marking: Marking, file: int, half: int) -> str:
        place = self._model.net.places[file]
        colset = place.colset.components[0]
        assert colset is not None
        for token in marking.places[file]:
            value, session, seq, _ = _parts(token)
            text = readable(TEXTS.text(colset, value))
            shown = text if len(text) <= MOST_VALUE else text[: MOST_VALUE - 3] + "..."
            return f"message {seq} of session {session}: {shown}"
        return "half a message" if tuple(marking.places[half]) else "0"


def _parts(token: Any) -> tuple[Any, ...]:
    """Of a tuple of the token game."""
    return tuple(token)


def _first(tokens: tuple[Any, ...]) -> int:
    return int(tokens[0])
