"""`pn2code replay --engine compiled`: what the compiled net makes of a run."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from pn2code.cli.options import DEFAULT_SEED, Engine, Format, stop
from pn2code.cli.replay_claims import Claims, refuse
from pn2code.diagnostics import Diagnostics
from pn2code.semantics.game.report import PlaceRow, places
from pn2code.semantics.game.token_game import NotEnabled
from pn2code.simulate.recorded import repeat, repeat_occurrences
from pn2code.simulate.run import Outcome
from pn2code.trace.followed import Followed
from pn2code.trace.json_text import BadJson, parse_json
from pn2code.trace.lines import digest_problem, form_problem, is_by_hand
from pn2code.trace.replay_end import Ending, end_problem
from pn2code.trace.script import TraceRefusedError
from pn2code.trace.whole_lines import whole_lines
from pn2code.verdict.opened import OpenNet, as_traced


def repeat_own(
    trace: Path, opened: OpenNet, files: Path | None, claims: Claims, form: Format
) -> dict[str, Any]:
    """A trace of our own: the JSON answer."""

    opened = as_traced(opened, trace)

    by_hand: list[int] = []

    def run(d: Diagnostics) -> Outcome | None:
        by_hand.append(_checked(trace))
        return repeat(opened.flat, opened.storage, trace, files, d, initial=opened.initial)

    outcome = _run(run, form)
    answer = {**_answer(outcome, opened), "by_hand": sum(by_hand)}
    wrong = _claimed(trace, opened, files, claims, outcome) if answer["ok"] else None
    if wrong is not None:
        return {**answer, "ok": False, "failed_step": outcome.replayed + 1, "why": wrong}
    return answer


def _checked(trace: Path) -> int:
    """Compares the members of each line with docs/trace.md; how many say what a person has chosen.

    Raises:
        TraceRefusedError: a line has others.
        OSError: it cannot be read.
    """
    is_first = True
    by_hand = 0
    with trace.open(encoding="utf-8", errors="surrogateescape") as file:
        for number, text in enumerate(whole_lines(file), 1):
            if not text.strip():
                continue
            try:
                line = parse_json(text, once=True)
            except BadJson as problem:
                raise TraceRefusedError(f"this is not a line of JSON: {problem}", number) from None
            if not isinstance(line, dict):
                raise TraceRefusedError("this is not a JSON object", number)
            wrong = form_problem(line, is_first=is_first)
            if wrong is not None:
                raise TraceRefusedError(wrong, number)
            by_hand += not is_first and is_by_hand(line)
            is_first = False
    return by_hand


def _claimed(
    trace: Path, opened: OpenNet, files: Path | None, claims: Claims, outcome: Outcome
) -> str | None:
    """What is wrong with the first and the last line of a trace, whose steps the compiled net has repeated.

    What the marking permits is asked of the token game; a lasso is its business as well.
    """
    header, end = _ends(trace)
    problem = (
        digest_problem(header, opened.flat, claims.parties) if claims.check_digest else None
    ) or claims.parties.stranger(str(header.get("by", "")))
    if problem is not None or end is None or outcome.final is None:
        return problem
    if "loop" in end:
        refuse("only the token game checks whether a lasso closes: leave out `--engine compiled`")
    seed = header.get("seed")
    game = opened.game(seed=DEFAULT_SEED if seed is None else seed, files=files)
    game.marking, game.steps = outcome.final, outcome.replayed
    many = (outcome.final,) * (2 if outcome.replayed else 1)
    by = str(header.get("by", ""))
    return end_problem(game, end, Ending(by, True, claims.parties, many, claims.may_fail_outside))


def _ends(trace: Path) -> tuple[dict[str, Any], dict[str, Any] | None]:
    """The first line of a trace, and its last one if that says that the run ended."""
    with trace.open(encoding="utf-8", errors="surrogateescape") as lines:
        texts = (text for text in lines if text.strip())
        first = last = next(texts)
        for text in texts:
            last = text
    end = parse_json(last)
    return parse_json(first), end if end.get("event") == "end" else None


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
        why = "where equal tokens have different stamps, the recorded run took other tokens than the compiled net does"
        return {**result, "why": f"{why}, so only the token game repeated the run"}
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
