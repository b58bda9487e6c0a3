"""What the last line of a trace claims, compared with the marking to which its steps have led.

{"t": 58.1, "event": "end", "why": "finished", "final": ["Cell.Supervisor.Finished"]}
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.semantics.game.errors import GivenUpError
from pn2code.semantics.game.marking import Marking, PlaceMarking, element_text
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.data import Timed
from pn2code.semantics.values.multiset import TimedMultiSet
from pn2code.trace.lines import is_number
from pn2code.trace.markings import Markings
from pn2code.trace.model_time import stamps
from pn2code.trace.parties import EVIDENCE, RUN, VERIFY, Parties

FINISHED = "finished"
ERROR = "error"
UNTIL = "until"
GOES_ON = ("steps", UNTIL)
"""The run was to be no longer, though something was enabled, or will be at a later time."""
RUN_ENDS = (FINISHED, "stopped", "failed")
"""What may become of a whole cell (`run.record`)."""
BROKEN_OFF = ("interrupted", "breakpoint", "trace", "replay")
"""Words of a simulator that claim nothing about the net."""

_RAISED = re.compile(r", while (?:looking for bindings of `|firing `|making room between firings)")
"""The end of what a supervisor says of an error that an evaluation has led to
(`cnative/src/supervisor/supervisor_play.c`)."""
_LIMITS = (
    "the place is full",
    "the memory for lists and strings is used up",
    "the recursion is too deep",
    "an evaluation does not come to an end",
    "a model time is beyond 64 bits",
    "a function is not available here",
)
"""Errors that a program can come to where the net has none."""
_DEADLOCK = "deadlock: "
_NOT_OF_THE_NET = ("interrupted by ", "no end ", "monitor: ", "place `", "cannot write the trace")
"""How other reasons of a supervisor to stop begin: they claim nothing about what the net can do."""


@frozen
class Ending:
    """What the last line is compared with.

    Args:
        by: who wrote the trace.
        is_simulated: a simulator did.
        parties: who runs what.
        markings: from the first to the last; at least that to which a lasso goes back, and the last, are there.
        may_fail_outside: something beside the net (a monitor) may have raised the exception.
    """

    by: str
    is_simulated: bool
    parties: Parties
    markings: Markings | tuple[Marking, ...]
    may_fail_outside: bool


def end_problem(game: Game, line: Mapping[str, Any], ending: Ending) -> str | None:
    """What is wrong with the last line of a trace; None: nothing."""
    why = line.get("why")
    if not isinstance(why, str):
        return "it does not say why the run ended"
    return _final_problem(game, line, ending) or (
        _simulated(game, why, ending) or _loop_problem(line, ending) or _clock_problem(game, line)
        if ending.is_simulated
        else _run(game, line, why, ending)
    )


def _clock_problem(game: Game, line: Mapping[str, Any]) -> str | None:
    """A simulator's clock stands where its last step was, or where the next one is possible; between them where the
    time was limited.
    """
    t, shown = line.get("t"), game.marking.time
    if not is_number(t) or t == shown:
        return None
    try:
        later = game.advance_time(game.marking).time
    except GameError:
        return None
    is_between = line.get("why") == UNTIL and shown < t < later
    return None if t == later or is_between else f"it says time {t}, but the clock shows {shown}"


def _simulated(game: Game, why: str, ending: Ending) -> str | None:
    if why == FINISHED:
        return _not_dead(game)
    if why in GOES_ON:
        if len(ending.markings) > 1 and _next(game) == "":
            return f'it says "{why}": the run could have gone on, but nothing is enabled any more'
        return None
    if why == ERROR:
        if ending.may_fail_outside or _raises(game):
            return None
        return "it says that an inscription raises an exception, but none does"
    if why in BROKEN_OFF:
        return None
    return f'it says "{why}", which is no reason for a run to end'


def _run(game: Game, line: Mapping[str, Any], why: str, ending: Ending) -> str | None:
    if why in (*GOES_ON, ERROR):
        return f'it says "{why}", which only simulators say'
    if (ending.by, why) == (VERIFY, EVIDENCE):
        return _loop_problem(line, ending)
    if "loop" in line:
        return "it says that the run repeats for ever, which only simulators and `verify` can know"
    if why == FINISHED and "reason" in line:
        return "it gives a reason why the run did not finish, but says that it did"
    if ending.by == RUN and why in RUN_ENDS and why != FINISHED:
        return _broken_off(line, why)
    if why not in RUN_ENDS and (ending.by == RUN or not _may_be_told(why)):
        return _alone(game, why, ending)
    if why != FINISHED or not ending.parties.is_known:
        return None
    if not ending.parties.final:
        return _not_dead(game)
    if _marked(game, ending):
        return None
    names = ", ".join(f"`{game.net.places[p].name}`" for p in ending.parties.final)
    return f"it says that the cell has finished, but there is no token in {names}"


def _broken_off(line: Mapping[str, Any], why: str) -> str | None:
    """A run of a cell that has not come to its end says why, and has no final place."""
    if "final" in line:
        return f'it says "{why}", but names final places as if the run had finished'
    return None if line.get("reason") else f'it says "{why}", but not for which reason'


def _may_be_told(why: str) -> bool:
    """Whether a program of a cell may give this reason: a sentence, often about others, of which the net knows nothing.

    A deadlock is found only by who plays the whole net.
    """
    return " " in why.strip() and not why.startswith(_DEADLOCK)


def _alone(game: Game, why: str, ending: Ending) -> str | None:
    """A supervisor that plays its net alone (`--dry-run`) ends with a sentence that says what has happened."""
    if why.startswith(_DEADLOCK):
        found = _marked(game, ending)
        if found:
            return f"it says that there was a deadlock, but {found} hold a token"
        return _not_dead(game)
    if _RAISED.search(why):
        if any(limit in why for limit in _LIMITS) or _raises(game):
            return None
        return "it says that an inscription raises an exception, but none does"
    if why.startswith(_NOT_OF_THE_NET):
        return None
    return f'it says "{why}", which is no reason for a run to end'


def _final_problem(game: Game, line: Mapping[str, Any], ending: Ending) -> str | None:
    """The final places that are named are those that hold a token."""
    if not ending.parties.is_known:
        return None
    said = line.get("final")
    found = _marked(game, ending)
    if said is None:
        is_missing = found and line.get("why") == FINISHED and not ending.is_simulated
        return (
            f"it does not name the final places that hold a token: {found}" if is_missing else None
        )
    if not isinstance(said, list) or sorted(map(str, said)) != sorted(found):
        return f"its `final` is {said}, but the final places that hold a token are {found}"
    return None


def _marked(game: Game, ending: Ending) -> list[str]:
    places = game.marking.places
    return [game.net.places[p].name for p in ending.parties.final if len(places[p])]


def _next(game: Game) -> str:
    """What can occur next, now or later; "": nothing. An exception counts as something."""
    try:
        enabled = game.enabled_in(game.advance_time(game.marking))
    except GivenUpError:
        raise
    except GameError as error:
        return str(error)
    return element_text(game.colours, game.net, enabled[0]) if enabled else ""


def _not_dead(game: Game) -> str | None:
    enabled = _next(game)
    return f"it says that nothing is enabled any more, but {enabled} is" if enabled else None


def _raises(game: Game) -> bool:
    """Whether the search for what is enabled, or an occurrence, raises an exception."""
    done = game.steps
    try:
        marking = game.advance_time(game.marking)
        enabled = game.enabled_in(marking)
        game.evaluator.steps = done + 1  # an occurrence counts while it occurs
        for element in enabled:
            game.occur(marking, element)
    except GameError:
        return True
    finally:
        game.steps = done
    return False


# --- lassos --------------------------------------------------------------------------------------


def _loop_problem(line: Mapping[str, Any], ending: Ending) -> str | None:
    """A lasso comes back to the marking in which its cycle begins; of timed nets, but for the time that has gone by."""
    loop = line.get("loop")
    if loop is None:
        return None
    last = len(ending.markings) - 1
    if isinstance(loop, bool) or not isinstance(loop, int) or not 0 <= loop <= last:
        return f"its `loop` is {loop}, but the run has {last} steps"
    try:
        first = ending.markings[loop]
    except LookupError:
        return f"it says that the run repeats from step {loop} on; the file has changed while it was read"
    after = ending.markings[last]
    is_back = _relative(first) == _relative(after) or (
        not ending.is_simulated and _comes_back(first, after, line.get("t"))
    )
    if not is_back:
        return (
            f"it says that the run repeats from step {loop} on, but the marking there is different"
        )
    return None


def _comes_back(first: Marking, last: Marking, end: object) -> bool:
    """Whether a cycle of a cell comes back: one that is compared at the time of the last line.

    A marking has the time of the step before it, and the cycle may have begun later: when its next stamp is as far away
    as it is at the end, or when none is left.
    """
    now = end if is_number(end) and end > last.time else last.time
    last = replace(last, time=now)
    ahead = min((s - now for s in stamps(last) if s > now), default=None)
    of_first = stamps(first)
    begun = [s - ahead for s in of_first] if ahead is not None else [max([first.time, *of_first])]
    return any(
        _relative(replace(first, time=t)) == _relative(last)
        for t in [first.time, *begun]
        if first.time <= t <= now
    )


def _relative(marking: Marking) -> Marking:
    """Stamps counted from the marking's time, real ones to 9 decimals; what is over is over."""
    places: list[PlaceMarking] = []
    for tokens in marking.places:
        if isinstance(tokens, TimedMultiSet):
            left = (Timed(t.value, max(round(t.stamp - marking.time, 9), 0)) for t in tokens)
            places.append(TimedMultiSet.of(left))
        else:
            places.append(tokens)
    return replace(marking, time=0, places=tuple(places))
