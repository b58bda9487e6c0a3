"""Where each script of a cell stands when nothing can occur: the file it waits for, and the line that waits.

Scripts.of(partition, config).standing(game)
# {1: "Robot `robot1` waits for `target` (robot1.tdl:34).", 2: "Device `press` has come to the end of press.tdl."}
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import OwnerKind, Partition
from pn2code.diagnostics import Diagnostics
from pn2code.emission import tdl
from pn2code.emission.output import OutputFile
from pn2code.ml.core import terms as core
from pn2code.net.builder import Builder
from pn2code.net.flat import ArcKind, FlatTransition
from pn2code.robot_scripts.machine import Machine, Step
from pn2code.robot_scripts.translate import lower_robots
from pn2code.semantics.game.enabling import Enabling
from pn2code.semantics.game.token_game import Game
from pn2code.verify.controller.stops import NoProgramError, machine, waits


@frozen
class _Script:
    """Of one owner; `files`: the names of its files in the script, by place."""

    phrase: str
    machine: Machine
    text: OutputFile
    files: Mapping[int, str]


@frozen
class Scripts:
    """The scripts of a cell, with their line numbers."""

    partition: Partition
    scripts: tuple[_Script, ...]

    @staticmethod
    def of(partition: Partition, config: CellConfig) -> Scripts:
        """As `pn2code generate` writes them; none where a page is no program, which has been reported."""
        programs = lower_robots(partition, config, Diagnostics())
        owners = [o for o in partition.owners if o.kind is not OwnerKind.SUPERVISOR]
        if programs is None:
            return Scripts(partition, ())
        # Neither digest nor version changes the number of a line.
        texts = tdl.emit(programs, source=partition.net.file, digest="-", version="-")
        places = {p.name: p.index for p in partition.net.places}
        found = []
        for owner, program, text in zip(owners, programs, texts, strict=True):
            try:
                made = machine(partition, owner.index)
            except NoProgramError:
                return Scripts(partition, ())
            files = {places[f.element.name]: f.declaration.name for f in program.files}
            phrase = owner.phrase[:1].upper() + owner.phrase[1:]
            found.append(_Script(phrase, made, text, files))
        return Scripts(partition, tuple(found))

    def standing(self, game: Game) -> dict[int, str]:
        """By owner, a sentence for each script; of one that can go on, none.

        Args:
            game: at the marking in question.

        Raises:
            GameError: a condition of a script raises an exception.
        """
        return {
            script.machine.owner.index: sentence
            for script in self.scripts
            for sentence in self._stands(script, game)
        }

    def _stands(self, script: _Script, game: Game) -> Iterator[str]:
        made, marking = script.machine, game.marking
        at = next((p for p in made.control if any(True for _ in marking.places[p])), None)
        if at is None:
            return
        steps = made.steps_from(at)
        if not steps:
            yield f"{script.phrase} has come to the end of {script.text.path}."
            return
        if any(_is_enabled(game, s.transition) for s in steps):
            return
        awaited: dict[int | None, list[str]] = {}
        for s in steps:
            missing = self._missing(game, made, s)
            if missing:
                line, names = _line(script, at, s.transition, [script.files[p] for p in missing])
                awaited.setdefault(line, []).extend(names)
        ways = []
        for line, names in awaited.items():
            where = script.text.path + (f":{line}" if line is not None else "")
            ways.append(f"{' or '.join(f'`{n}`' for n in dict.fromkeys(names))} ({where})")
        if ways:
            yield f"{script.phrase} waits for {' or '.join(ways)}."
            return
        short = game.net.places[at].short
        yield (
            f"{script.phrase} stops at `{short}` ({script.text.path}), because none of its transitions is possible "
            "there."
        )

    def _missing(self, game: Game, program: Machine, step: Step) -> list[int]:
        """The places of the messages that the transition lacks, if it is they that hold it back."""
        b = Builder(self.partition.net)

        def token(place: int, name: str) -> core.Exp:
            return b.var(name, self.partition.net.places[place].colset)

        for arcs, guards in waits(self.partition, program, step, lambda _: [], b.absent, token):
            b.transition("waits", arcs, priority=step.transition.priority, guards=guards)
        net = b.net()
        enabling = Enabling(net, game.evaluator)
        return [
            a.place
            for probe in net.transitions[len(self.partition.net.transitions) :]
            if next(enabling.enabled(probe, game.marking), None) is not None
            for a in probe.arcs
            if a.kind is ArcKind.INHIBITOR
        ]


def _is_enabled(game: Game, t: FlatTransition) -> bool:
    return next(game.enabling.enabled(t, game.marking), None) is not None


def _line(
    script: _Script, at: int, t: FlatTransition, names: Sequence[str]
) -> tuple[int | None, list[str]]:
    """The first line that waits for one of the files, from 1, and which of them it names; None: there is none."""
    place = script.machine.net.places[at].name
    lines = script.text.text.split("\n")
    for element in (t.name, place):
        for block in script.text.blocks:
            if block.element != element:
                continue
            for number in range(block.first, block.last + 1):
                line = lines[number - 1]
                asked = re.findall(r"filled\(([^)]*)\)", line) if "wait until" in line else []
                here = [n for n in names if n in asked]
                if here:
                    return number, here
    return None, list(names)
