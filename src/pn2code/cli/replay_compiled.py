"""`pn2code replay --engine compiled`: what the compiled net makes of a run."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from pn2code.cli.nets import OpenNet
from pn2code.cli.options import DEFAULT_SEED, Engine, Format, stop
from pn2code.cli.replay import refuse
from pn2code.diagnostics import Diagnostics
from pn2code.semantics.game import NotEnabled
from pn2code.semantics.replay_recording import Followed
from pn2code.semantics.report import PlaceRow, places
from pn2code.simulate.recorded import repeat, repeat_occurrences
from pn2code.simulate.run import Outcome
from pn2code.simulate.script import TraceRefusedError


def repeat_own(trace: Path, opened: OpenNet, files: Path | None, form: Format) -> dict[str, Any]:
    """A trace of our own: the JSON answer."""
    outcome = _run(lambda d: repeat(opened.flat, opened.storage, trace, files, d), form)
    return _answer(outcome, opened)


def repeat_recorded(
    opened: OpenNet, followed: Followed, result: dict[str, Any], files: Path | None, form: Format
) -> dict[str, Any]:
    """A recording that the token game has followed, with its answer: the answer of the compiled net.

    Of equal tokens with different stamps the compiled net takes the latest, the recorded run took any. Where that
    makes a difference it cannot repeat the run, and the answer is that of the token game.
    """
    occurrences = followed.occurrences
    outcome = _run(
        lambda d: repeat_occurrences(opened.flat, opened.storage, occurrences, files, d), form
    )
    compiled = _answer(outcome, opened)
    ours = _markings(compiled["places"]) if compiled["ok"] else None
    if ours == _markings(followed.rows):
        return {**compiled, "time": followed.time}
    if ours == _usual(opened, followed, files):
        why = "of equal tokens with different stamps the recorded run took others than the compiled net does"
        return {**result, "why": f"{why}, so the token game alone followed it"}
    if compiled["ok"]:
        why = "in the end the compiled net has another marking than the token game"
        return {**compiled, "ok": False, "failed_step": compiled["steps"] + 1, "why": why}
    return compiled


def _markings(rows: list[PlaceRow]) -> list[object]:
    return [row["marking"] for row in rows]


def _usual(opened: OpenNet, followed: Followed, files: Path | None) -> list[object] | None:
    """The last marking when the latest tokens are taken; None if that is not possible."""
    game = opened.game(seed=DEFAULT_SEED, files=files)
    for _, element in followed.occurrences:
        game.advance()
        outputs = game.net.transitions[element.transition].code
        own = [(s, v) for s, v in element.values if not outputs or s not in outputs.outputs]
        try:
            game.fire(type(element)(element.transition, tuple(own)))
        except NotEnabled:
            return None
    return _markings(places(opened.flat, game.marking))


def _run(run: Callable[[Diagnostics], Outcome | None], form: Format) -> Outcome:
    """What the compiled net made of a trace; leaves when there is no compiled net, or the file is no trace."""
    d = Diagnostics()
    try:
        outcome = run(d)
    except TraceRefusedError as problem:
        refuse(f"the trace cannot be repeated: {problem}")
    except OSError as problem:
        refuse(f"the trace cannot be repeated: {problem.strerror or problem}")
    if outcome is None:
        stop(d, form)
    return outcome


def _answer(outcome: Outcome, opened: OpenNet) -> dict[str, Any]:
    ok = outcome.why not in ("replay", "error")
    why = outcome.refusal or (outcome.failure.message if outcome.failure else "")
    return {
        "ok": ok,
        "steps": outcome.replayed,
        "failed_step": None if ok else outcome.replayed + 1,
        "why": why,
        "time": outcome.final.time if outcome.final else None,
        "random": False,
        "engine": Engine.COMPILED.value,
        "places": places(opened.flat, outcome.final) if outcome.final else [],
    }
