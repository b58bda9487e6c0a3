"""One net against what the real engine recorded of it: verdict, elements, initial marking, run, state space.

    compare(corpus, "hglps+Petri-nets/atv/atv6.cpn", max_nodes=200)

`corpus` has `nets/PATH`, `expected/PATH.json` and perhaps `traces/PATH.json`.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostic, Diagnostics
from pn2code.engine_comparison.finding import AGREES, NOTHING, Finding, State, differs
from pn2code.net import front
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.evaluation.effects import Effects, outside
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.graph import state_space
from pn2code.semantics.game.report import places
from pn2code.semantics.game.token_game import Game
from pn2code.trace.recording import recording
from pn2code.trace.replay_recording import follow

SEED = 1
QUESTIONS = ("verdict", "elements", "initial marking", "run", "state space")


@frozen
class Compared:
    """A net and the findings about it, one for each of `QUESTIONS`.

    Args:
        path: below the folder of nets.
        accepted: whether the real engine accepts the net.
        ours: whether we do.
        runs: whether we accept it and can play it from its initial marking.
        surroundings: files it needs that are not there; the real engine had them.
        findings: by question.
    """

    path: str
    accepted: bool
    ours: bool
    runs: bool
    surroundings: tuple[str, ...]
    findings: dict[str, Finding]

    @property
    def state(self) -> State:
        """The worst of the findings."""
        found = {f.state for f in self.findings.values()}
        for state in (State.DIFFERS, State.UNSUPPORTED, State.RANDOM):
            if state in found:
                return state
        return State.AGREES


def paths(corpus: Path) -> list[str]:
    """The nets of which something is recorded, sorted."""
    folder = corpus / "expected"
    files = sorted(folder.rglob("*.json"))
    return [f.relative_to(folder).as_posix().removesuffix(".json") for f in files]


def compare(corpus: Path, path: str, *, max_nodes: int) -> Compared:
    """Compares one net; state spaces up to that many nodes."""
    expected = json.loads((corpus / "expected" / f"{path}.json").read_text(encoding="utf-8"))
    d = Diagnostics()
    net = front.load(corpus / "nets" / path, d, compute=compute)
    rejected = list(_rejected(expected))
    accepted = not rejected
    missing = _missing_files(d)
    findings = dict.fromkeys(QUESTIONS, NOTHING)
    findings["verdict"] = _verdict(accepted, net, d, missing)
    findings["elements"] = _elements(expected, d)
    game: Game | None = None
    if net is not None and accepted:
        try:
            game = Game(net, seed=SEED)
        except GameError as error:
            findings["initial marking"] = differs(str(error.message))
    if game is not None:
        findings["initial marking"] = _initial(game, expected["initial_marking"] or [])
        findings["run"] = _run(game, corpus / "traces" / f"{path}.json")
        findings["state space"] = _space(game, expected["state_space"], max_nodes)
    return Compared(path, accepted, net is not None, game is not None, missing, findings)


# --- accepted or not -------------------------------------------------------------------------------


def _rejected(expected: dict[str, Any]) -> Iterator[str]:
    for key in ("rejected_declarations", "rejected_elements"):
        yield from (str(entry["id"]) for entry in expected.get(key) or [])


def _missing_files(d: Diagnostics) -> tuple[str, ...]:
    """Files that the net `use`s and that are not there."""
    return tuple(
        e.span.text.strip().strip('"') if e.span else e.message for e in d.errors if "use" in e.code
    )


def _verdict(
    accepted: bool, net: FlatNet | None, d: Diagnostics, missing: tuple[str, ...]
) -> Finding:
    if accepted == (net is not None):
        warned = sorted({i.message for i in d if i.code.startswith("unsupported-")})
        if accepted and warned:
            return Finding(State.AGREES, _some(warned))
        return AGREES
    if missing:
        return Finding(State.UNSUPPORTED, f"needs {_some([f'`{m}`' for m in missing])}")
    unsupported = sorted({e.message for e in d.errors if e.code.startswith("unsupported-")})
    if unsupported:
        return Finding(State.UNSUPPORTED, _some(unsupported))
    if net is None:
        return differs("rejected here: " + _some([e.message for e in d.errors]))
    return differs("accepted here")


def _elements(expected: dict[str, Any], d: Diagnostics) -> Finding:
    """The same elements must be wrong. After a wrong declaration errors elsewhere are its consequences.

    The engine refuses a transition for a variable on its arc; here the arc is wrong, and a note leads to the
    transition.
    """
    theirs = set(_rejected(expected))
    ours = {i for e in d.errors for i in _about(e)}
    declarations = {str(x["id"]) for x in expected.get("rejected_declarations") or []}
    if not theirs and not ours:
        return AGREES
    if bool(theirs) != bool(ours):
        return NOTHING  # the verdict differs
    if declarations:
        missing, extra = declarations - ours, set[str]()
    else:
        missing = theirs - ours
        extra = {e.origin.element_id for e in d.errors if theirs.isdisjoint(_about(e))}
    if not missing and not extra:
        return AGREES
    parts = [f"not found wrong here: {_some(sorted(missing))}"] if missing else []
    parts += [f"only here found wrong: {_some(sorted(extra))}"] if extra else []
    return differs("; ".join(parts))


def _about(e: Diagnostic) -> set[str]:
    """The elements that an error is about."""
    return {o.element_id for o in (e.origin, *(n.origin for n in e.notes)) if o is not None}


# --- behaviour -------------------------------------------------------------------------------------


def _initial(game: Game, recorded: list[dict[str, Any]]) -> Finding:
    if not recorded:
        return NOTHING
    ours = {(row["id"], row["instance"]): row["marking"] for row in places(game.net, game.marking)}
    effects = Effects(game.net.program)
    drawn = {
        (p.id, p.number)
        for p in game.net.place_instances
        if (initial := game.net.places[p.place].initial) and outside(effects, initial[0])
    }
    wrong: list[str] = []
    random: list[str] = []
    for entry in recorded:
        key = (entry["id"], entry["instance"])
        found = ours.get(key, "no such place")
        if found != entry["marking"]:
            text = f"{entry['id']}: {_line(found)} instead of {_line(entry['marking'])}"
            (random if key in drawn else wrong).append(text)
    if wrong:
        return differs(_some(wrong))
    return Finding(State.RANDOM, _some(random)) if random else AGREES


def _run(game: Game, file: Path) -> Finding:
    if not file.is_file():
        return NOTHING
    followed = follow(recording(json.loads(file.read_text(encoding="utf-8"))), game)
    if not followed.ok:
        return differs(f"step {followed.steps + 1}: {followed.why}")
    if not followed.random:
        return AGREES
    taken = _some([f"`{name}`" for name in followed.drawn]) or "nothing"
    return Finding(State.RANDOM, f"taken as recorded in the final marking: {taken}")


def _space(game: Game, size: dict[str, int] | None, max_nodes: int) -> Finding:
    if size is None or size["nodes"] > max_nodes:
        return NOTHING
    theirs = (size["nodes"], size["arcs"], size["dead_markings"])
    try:
        space = state_space(game, max_nodes=max(2 * size["nodes"], 50))
    except GameError as error:
        return differs(error.message)
    ours = (len(space.nodes), len(space.arcs), len(space.dead))
    if ours == theirs:
        return AGREES
    note = "nodes, arcs, dead markings: {} {} {} instead of {} {} {}".format(*ours, *theirs)
    if outside(Effects(game.net.program), game.net):
        return Finding(State.RANDOM, note)
    return differs(note)


def _some(texts: Iterable[str], most: int = 3) -> str:
    listed = list(dict.fromkeys(texts))
    return "; ".join(listed[:most]) + (f"; and {len(listed) - most} more" * (len(listed) > most))


def _line(text: object) -> str:
    return " ".join(str(text).split())
