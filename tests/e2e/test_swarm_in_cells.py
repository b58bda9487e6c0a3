"""A swarm in a cell as it runs, and in its channel model: what it finds is so."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from tools.swarm_cells import differences, limits_of
from tools.swarm_cells import said as said_of

from helpers import overtaking_cell
from pn2code.diagnostics import Diagnostics, render
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.token_game import Game
from pn2code.trace.parties import Parties
from pn2code.trace.replay import replay
from pn2code.verdict.opened import OpenNet, read
from pn2code.verdict.whole import Checks, Said
from pn2code.verify.controller.control_types import BLOCKING, CONFLUENT, MESSAGES
from pn2code.verify.controller.played import Played, why_not

pytestmark = pytest.mark.cc

SEARCHES = 2
SEED = 5
"""Of a random cell in which something is wrong."""


def opened(folder: Path, *, goes_on: bool = False) -> OpenNet:
    d = Diagnostics()
    found = read(overtaking_cell.write(folder, goes_on=goes_on), {}, d)
    assert found is not None, render.report(d)
    return found


def searched(
    folder: Path,
    *texts: str,
    checks: Checks,
    swarm: bool = True,
    goes_on: bool = False,
    most: int = 400,
) -> Said:
    """What is said of the cell; the runs are in `folder`."""
    cell = opened(folder, goes_on=goes_on)
    limits = limits_of(most, most if swarm else 0, SEARCHES)
    return said_of(cell, texts, folder, limits=limits, checks=checks)


def test_what_the_programs_do_and_the_net_does_not(tmp_path: Path) -> None:
    """The property holds in the closed net; the cell violates it, by a run of its programs."""
    said = searched(
        tmp_path, overtaking_cell.NEVER, checks=Checks(controller=False, channel_model=False)
    )
    (answer,) = said.answers
    assert (answer.answer, answer.cell) == ("no", True)
    assert answer.evidence is not None and answer.evidence.confirmed
    assert said.control is None and said.verdict == "no"
    assert said.found.answers[0]["answer"] == "unknown", "of the net nothing is found"


def test_a_dead_end_of_the_cell(tmp_path: Path) -> None:
    """Of the checks it is one that a marking shows; the others are not known, and it is said why."""
    said = searched(tmp_path, checks=Checks(channel_model=False))
    assert said.control is not None
    checks = {c.name: c for c in said.control.checks}
    ends = checks[BLOCKING]
    assert (ends.answer, ends.why) == ("no", "deadlock")
    (run,) = ends.evidence
    assert run.file is not None and run.transitions[-2:] != ()
    cell = opened(tmp_path)
    partition = said.control.partition
    played = replay(run.file, cell.flat, parties=Parties.of(partition), is_whole=True)
    assert played.ok, played.why
    assert (checks[CONFLUENT].answer, checks[CONFLUENT].why) == ("unknown", "graphless")
    assert (checks[MESSAGES].answer, checks[MESSAGES].why) == ("unknown", "colourless")
    row: dict[str, Any] = said.row()["cell"]
    assert row["swarm"]["counted"] <= row["swarm"]["searches"] == SEARCHES
    # What is so of all states says the same.
    whole = searched(tmp_path, checks=Checks(channel_model=False), swarm=False)
    assert whole.control is not None
    known = {c.name: c.answer for c in whole.control.checks}
    assert all(c.answer in ("unknown", known[name]) for name, c in checks.items())


def test_no_end_although_the_cell_goes_on(tmp_path: Path) -> None:
    """A walk looks at all that follows where it stands; the run leads to the first marking without an end."""
    checks = Checks(channel_model=False)
    said = searched(tmp_path, checks=checks, goes_on=True, most=20_000)
    assert said.control is not None
    ends = next(c for c in said.control.checks if c.name == BLOCKING)
    assert (ends.answer, ends.why) == ("no", "endless")
    (run,) = ends.evidence
    assert run.transitions[-1] == "Top.B.Report", "when the supervisor sees that, it is too late"
    # Walks are too short for that where they look at few markings.
    few = searched(tmp_path, checks=checks, goes_on=True, most=400)
    assert few.control is not None
    assert next(c for c in few.control.checks if c.name == BLOCKING).answer == "unknown"


def test_the_channel_model(tmp_path: Path) -> None:
    """The dead end is found in the cell with its files, too, and told by the token game."""
    said = searched(tmp_path, checks=Checks(controller=False))
    cell, *exchanges = said.channel_model
    assert cell.answer == "no" and cell.evidence[0].lines[-1] == "and nothing can happen any more"
    assert cell.swarm is not None and cell.row()["swarm"]["searches"] == SEARCHES
    assert all(a.answer == "yes" and a.swarm is None for a in exchanges)


def test_what_is_known_of_the_end_is_said_of_the_files_too(tmp_path: Path) -> None:
    """The searches of the cell with its files see too little for that; those of its programs know."""
    said = searched(tmp_path, checks=Checks(), goes_on=True, most=5_000)
    cell = said.channel_model[0]
    assert cell.swarm is not None and not cell.evidence
    assert cell.answer == "no" and cell.why.startswith(f"`{BLOCKING}`: ")


def test_the_judge_of_runs_knows_what_programs_do(tmp_path: Path) -> None:
    """All markings that it permits are those that the explorer finds, and as many of them are dead."""
    said = searched(tmp_path, checks=Checks(channel_model=False), swarm=False)
    assert said.control is not None and said.control.running is not None
    running, found = said.control.running, said.control.found
    assert found is not None and found.complete
    game = Game(running.net, {}, files=Files(None))
    played = Played(running, game)
    seen, todo, dead = {game.marking}, [game.marking], 0
    while todo:
        marking = todo.pop()
        game.marking = marking
        dead += played.is_dead()
        for t in running.net.transitions:
            for binding in game.bindings(t, marking):
                if played.why_not(t, binding) is None:
                    game.fire(BindingElement.make(t, binding), checked=False)
                    if game.marking not in seen:
                        seen.add(game.marking)
                        todo.append(game.marking)
                    game.marking = marking
    assert (len(seen), dead) == (found.nodes, found.dead_count)


def test_a_run_that_programs_do_not_have(tmp_path: Path) -> None:
    """Steps of programs have been left out of a run of the net, so it is none of the cell as it runs."""
    checks = Checks(channel_model=False)
    said = searched(tmp_path, overtaking_cell.NEVER, checks=checks, swarm=False)
    (answer,) = said.answers
    assert said.control is not None and said.control.running is not None
    assert answer.evidence is not None
    problem = why_not(said.control.running, {}, answer.evidence.trace)
    assert problem is not None and "is not enabled" in problem


def test_a_random_cell(tmp_path: Path) -> None:
    """What is found there is what all states say. `python -m tools.swarm_cells` has others."""
    seen: Counter[str] = Counter()
    assert not [*differences(SEED, tmp_path, seen)]
    assert seen["cells"] == 1 and seen["no"] > 0, seen
