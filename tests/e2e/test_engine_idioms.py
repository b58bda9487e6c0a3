"""Small nets with the idioms of published models beside the recorded answers of the engine of CPN Tools.

Verdict, initial marking, a run of the engine followed here, and the size of the state space by the token game; of some
nets that of the compiled explorer, too. `./dev oracle --idioms` asks the engine again.
"""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from tools.oracle.compare import Seen, has_ties
from tools.oracle.idioms import answers, digest, nets

from helpers.netbuilder import cpn
from helpers.thorough import THOROUGH, amount
from pn2code.semantics.evaluation.effects import Effects, outside
from pn2code.semantics.game.graph import state_space
from pn2code.structure.analysis import analyse

NETS = nets()
KEPT = answers()
STATES = {"agrees", "random", ""}
REFERENCES = {"GlobrefLists", "StatisticsReals"}
"""The engine does not restore references, so that the sizes that it finds depend on the order of its search."""
OCCURRING = {"InstanceNumbers", "InstanceCoefficients"}
"""When a transition occurs, the engine's state-space tool has another value for `inst ()` than its simulator: that of
an instance that it looked at before."""
OTHER_SPACE = REFERENCES | OCCURRING
COMPILED = sorted(name for name in NETS if "space" in KEPT[name] and name not in OTHER_SPACE)[
    :: 1 if THOROUGH else 12
]
ENGINE_FAILS = {"LetInArc", "GuardSquare"}
"""The engine ends with an internal error, of which `check` warns."""

OTHER_ORDER = {
    f"GuardOrder{name}" for name in ("Third", "Equation", "OtherPlace", "EquationOnArc", "InArc")
}
"""The engine computes something that raises an exception before a condition that is false, of which `check` warns."""


def test_every_net_has_an_answer() -> None:
    assert len(NETS) >= 295
    assert {name: digest(text) for name, text in NETS.items()} == {
        name: kept["digest"] for name, kept in KEPT.items()
    }, "the nets have changed: ./dev oracle --idioms asks the engine again"
    assert sum(kept["accepted"] for kept in KEPT.values()) >= 199


@pytest.fixture
def seen(name: str, tmp_path: Path) -> Seen:
    """A net as pn2code sees it."""
    path = tmp_path / f"{name}.cpn"
    path.write_bytes(cpn(NETS[name]))
    return Seen(path)


@pytest.mark.parametrize("name", NETS)
def test_what_the_engine_says(name: str, seen: Seen) -> None:
    kept = KEPT[name]
    verdict = seen.verdict(kept)
    if name in ENGINE_FAILS:
        assert verdict.state == "engine" and seen.d.items
        return
    assert verdict.state == "agrees", verdict.note
    assert (seen.net is not None) == kept["accepted"]
    if "run" in kept:
        assert seen.marking(kept).state in STATES, seen.marking(kept).note
        run = seen.run(kept["run"])
        if name in OTHER_ORDER:
            assert "Empty" in kept["run"]["stopped_by_error"]
            assert (run.state, "guard-order" in seen.codes) == ("engine", True), run.note
            return
        assert run.state in STATES, run.note


@pytest.mark.parametrize(
    "name",
    [name for name in NETS if "space" in KEPT[name] and name not in OTHER_SPACE][:: amount(2, 1)],
)
def test_the_size_of_the_state_space(name: str, seen: Seen) -> None:
    kept = KEPT[name]["space"]
    assert seen.net is not None and seen.game is not None
    space = state_space(seen.game, max_nodes=2 * kept["nodes"] + 1)
    if seen.net.timed and has_ties(space):
        return  # the engine chooses among equal tokens with different stamps
    if outside(Effects(seen.net.program), seen.net):
        return  # the net draws random numbers
    found = (len(space.nodes), len(space.arcs), len(space.dead))
    assert found == (kept["nodes"], kept["arcs"], len(kept["dead"]))


@pytest.mark.parametrize("name", [name for name in NETS if "run" in KEPT[name]][:: amount(3, 1)])
def test_the_bounds_of_the_structure_hold_in_the_run(name: str, seen: Seen) -> None:
    """Any inscription can be looked at, and what is said is true of the end of the engine's run."""
    assert seen.net is not None
    bounds = analyse(seen.net).bounds
    indices = {(x.id, x.number): x.place for x in seen.net.place_instances}
    for row in KEPT[name]["run"]["final_marking"]:
        place = indices[row["id"], row["instance"]]
        upper = bounds[place].bound
        assert upper is None or tokens(row["marking"]) <= upper, row


def tokens(marking: str) -> int:
    """How many tokens a marking has, as the engine prints it."""
    return sum(int(n) for n in re.findall(r"^(\d+)`", marking, flags=re.MULTILINE))


@pytest.mark.cc
@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")
@pytest.mark.parametrize("name", COMPILED)
def test_the_compiled_explorer_finds_the_same(name: str, seen: Seen) -> None:
    found = seen.space(KEPT[name]["space"])
    assert found.state in {"agrees", "random"}, found.note
