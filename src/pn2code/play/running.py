"""Many steps at once: by the token game, one after the other, or by the compiled simulator, which is much faster.

ended = run(session, Wish(steps=1_000_000), tell)

Both make the same steps from the same seed. What has to be looked at after each step (conditions, breakpoints,
monitors) needs the token game; the compiled simulator makes a leap, which is taken back as a whole.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics
from pn2code.play.saving import leap_lines, save
from pn2code.play.session import Session
from pn2code.play.trouble import Trouble, of_diagnostics, of_game, rows
from pn2code.play.typed_texts import Condition
from pn2code.semantics.evaluation.references import NOTHING
from pn2code.semantics.game.errors import GameError
from pn2code.simulate.choose import Wish as Engine
from pn2code.simulate.choose import simulate
from pn2code.simulate.run import Request
from pn2code.trace.script import TraceRefusedError
from pn2code.trace.writing import TraceUnwritableError

MANY = 3_000
"""From so many steps on the compiled simulator is worth its compilation."""
REPEATED = 8
"""So many steps are repeated by the compiled simulator while the token game makes one."""
MOST_STEPS = 100_000_000
MOST_TRACED = 3_000_000
"""A longer leap writes no trace."""
_TELL_S = 0.2

Tell = Callable[[int, float], None]
"""Is told now and then how many steps of this run have been made, and the model time."""


@frozen
class Wish:
    """A run.

    Args:
        steps: most steps.
        until: no step after this model time; None: no limit.
        condition: the run ends where it becomes true; None: there is none.
        breakpoints: transitions after which it ends.
        engine: "auto", "compiled" or "reference".
    """

    steps: int
    until: float | None = None
    condition: Condition | None = None
    breakpoints: frozenset[int] = frozenset()
    engine: str = "auto"


@frozen
class Ended:
    """Why a run has ended.

    Args:
        why: "steps", "finished", "until", "condition", "breakpoint", "stopped" or "error".
        text: in words.
        steps: how many there were.
        seconds: how long it took.
        engine: who made them.
    """

    why: str
    text: str
    steps: int
    seconds: float
    engine: str


def run(session: Session, wish: Wish, tell: Tell) -> Ended:
    """Makes the run.

    Raises:
        Trouble: it cannot be made, or the net raises an exception; the steps before it have been made.
    """
    session.stop.clear()
    why_not = _why_not_compiled(session, wish)
    if wish.engine == "compiled" and why_not:
        raise Trouble(f"the compiled simulator cannot make this run: {why_not}")
    is_compiled = wish.engine == "compiled" or (
        wish.engine == "auto" and is_worth_it(session, wish)
    )
    if is_compiled and not why_not:
        return _leap(session, wish, tell)
    return _walk(session, wish, tell)


def is_worth_it(session: Session, wish: Wish) -> bool:
    """Whether the compiled simulator is faster: it repeats first what was not chosen at random from the start."""
    if wish.steps < MANY:
        return False
    return wish.steps * REPEATED >= session.game.steps or session.history.chosen_by(session.seed)


# --- by the token game -----------------------------------------------------------------------------


def _walk(session: Session, wish: Wish, tell: Tell) -> Ended:
    began = told = time.monotonic()
    first = session.game.steps
    condition = wish.condition
    why, text = "steps", ""
    done = 0
    while done < wish.steps:
        if session.stop.is_set():
            why, text = "stopped", "stopped"
            break
        if _is_beyond(session, wish.until):
            why, text = "until", f"nothing more occurs up to time {wish.until}"
            break
        try:
            reached = session.step()
        except Trouble as trouble:
            if trouble.rows:
                raise
            why, text = "finished", trouble.message
            break
        done += 1
        now = time.monotonic()
        if now - told > _TELL_S:
            told = now
            tell(done, session.game.marking.time)
        if reached is not None:
            why, text = "breakpoint", f"the breakpoint `{reached.monitor.name}` is reached"
            break
        element = session.history.entry(session.history.position - 1).element
        if element is not None and element.transition in wish.breakpoints:
            name = session.net.transitions[element.transition].short
            why, text = "breakpoint", f"`{name}` has occurred, which is a breakpoint"
            break
        if condition is not None and session.holds(condition.exp, condition.looks):
            why, text = "condition", "the condition is true"
            break
    return Ended(why, text, session.game.steps - first, time.monotonic() - began, "the token game")


def _is_beyond(session: Session, until: float | None) -> bool:
    """Whether the next step would be after a model time; then the clock is moved on to it."""
    if until is None:
        return False
    game = session.game
    try:
        if game.enabled_transitions(game.marking):
            return game.marking.time > until
        later = session.later()
    except GameError as error:
        raise of_game(error) from None
    if later is None or later <= until:
        return False
    limit = until if session.net.real_time else math.floor(until)
    if limit > game.marking.time:
        session.stopped_at(limit)
    return True


# --- by the compiled simulator ---------------------------------------------------------------------


def _why_not_compiled(session: Session, wish: Wish) -> str:
    """Why the compiled simulator cannot make a run; "" if it can."""
    start, initial, obstacle = session.run
    if wish.condition is not None or wish.breakpoints:
        return "after each step something is to be looked at"
    if session.watching is not None and wish.engine == "auto":
        return "the monitors watch each step"
    if obstacle or start > 0 or dict(initial) not in ({}, session.given()):
        return "the run does not begin with the initial marking of the net"
    if session.game.own_initial_marking.references is not NOTHING:
        return "transitions change references"
    if session.game.evaluator.random.is_still:
        return "the run comes from `verify`, where random numbers are drawn in another way"
    return ""


def _leap(session: Session, wish: Wish, tell: Tell) -> Ended:
    before = session.folder / "before.trace.jsonl"
    after = session.folder / "after.trace.jsonl"
    steps = session.game.steps
    is_fresh = session.history.chosen_by(session.seed)
    is_traced = steps + wish.steps <= MOST_TRACED
    replayed: Path | None = None
    if not is_fresh:
        save(session, before, is_checked=False)
        replayed = before
    d = Diagnostics()
    request = Request(
        net=session.net,
        storage=session.opened.storage,
        initial=session.opened.initial,
        steps=wish.steps + (steps if is_fresh else 0),
        seed=session.seed,
        until=_limit(session, wish.until),
        trace=after if is_traced else None,
        replay=replayed,
        progress=lambda n, t: tell(max(n - steps, 0), t),
        interrupted=session.stop.is_set,
    )
    try:
        outcome = simulate(request, Engine.ANY, d)
        if outcome is None:
            raise of_diagnostics(d, "the compiled simulator has come to a bad end")
        if outcome.why == "replay" or outcome.final is None or outcome.steps < steps:
            raise Trouble(f"the compiled simulator does not repeat the run: {outcome.refusal}")
        count = outcome.steps - steps
        tell(count, outcome.final.time)  # reading them takes a while, too
        moved = outcome.final.time != session.game.marking.time
        if count or moved:
            lines, written = leap_lines(after, steps) if is_traced else ([], 0)
            session.leapt(outcome.final, outcome.steps, lines)
            if written != count:
                session.forbid_saving("a run of so many steps has no trace")
        if outcome.output:
            session.output.append(outcome.output)
        if outcome.failure is not None:
            outcome.failure.report(d, outcome.steps)
            raise Trouble(outcome.failure.message, rows(d.sorted()))
    except (TraceUnwritableError, TraceRefusedError, OSError) as problem:
        raise Trouble(f"the run cannot be made: {problem}") from None
    finally:
        for file in (before, after):
            file.unlink(missing_ok=True)
    return Ended(
        "stopped" if outcome.why == "interrupted" else outcome.why,
        _words(outcome.why, wish),
        count,
        outcome.seconds,
        "the compiled simulator" if outcome.engine == "compiled" else "the token game",
    )


def _limit(session: Session, until: float | None) -> int | float | None:
    if until is None:
        return None
    return until if session.net.real_time else math.floor(until)


def _words(why: str, wish: Wish) -> str:
    return {
        "finished": "nothing is enabled any more, now or later",
        "until": f"nothing more occurs up to time {wish.until}",
        "interrupted": "stopped",
    }.get(why, "")
