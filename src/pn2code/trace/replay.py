"""Replaying a trace: is it an occurrence sequence of the net?

    result = replay(Path("run.trace.jsonl"), net)
    result.ok, result.why

Each line that names a transition must be enabled with that binding when its turn comes; all values, reals included,
are compared exactly. Lines with an `event` are passed over.

Time: the simulators (`by` is `simulate` or `reference`) write model times, and the clock must do exactly what the
rules say. All others write seconds of the run; there the clock follows the trace (`t` divided by `time_unit`), and
tokens must be available by then. Their priorities hold among the transitions of one party (`Parties`). A run of a cell
that `verify` has found is in model time: its clock follows the trace too, unit by unit where something is waited for.

What else a trace claims is looked at as well: the net's digest, the element that each step names, the numbers and times
of steps, who made them, why the run ended, and in which final places, and where a lasso goes back to.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.semantics.evaluation.evaluate import Limits
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.errors import GivenUpError
from pn2code.semantics.game.marking import (
    BindingElement,
    Marking,
    PlaceMarking,
    element_text,
    place_from_json,
)
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.colour_json import JsonError, from_json, to_json
from pn2code.semantics.values.data import Value
from pn2code.trace.json_text import BadJson, parse_json
from pn2code.trace.lines import (
    digest_problem,
    form_problem,
    is_by_hand,
    is_number,
    order_problem,
    origin_problem,
    time_problem,
    unknown_variable,
)
from pn2code.trace.markings import ALL, Markings, claimed_loop
from pn2code.trace.model_time import ModelTime
from pn2code.trace.parties import SIMULATORS, VERIFY, Parties
from pn2code.trace.repeated import Repeated
from pn2code.trace.replay_end import Ending, end_problem
from pn2code.trace.replay_result import Notes, ReplayResult, Rules
from pn2code.trace.whole_lines import whole_lines

DEFAULT_SEED = 1
"""Of the random numbers of a run whose header does not name another."""


Watch = Callable[[Game, BindingElement | None, Mapping[str, Any]], None]


class _Wrong(Exception):
    """A line cannot be repeated; the message says why."""


Progress = Callable[[int, float], None]
_TOLD_LINES = 500


def replay(
    path: Path,
    net: FlatNet,
    storage: Mapping[str, str] | None = None,
    *,
    rules: Rules | None = None,
    time_unit: float = 1.0,
    parties: Parties | None = None,
    check_digest: bool = False,
    may_fail_outside: bool = False,
    notes: Notes | None = None,
    is_whole: bool = False,
    limits: Limits | None = None,
    files: Files | None = None,
    progress: Progress | None = None,
) -> ReplayResult:
    """Replays a trace file.

    Args:
        path: the file.
        net: the net that it is said to come from.
        storage: as for `Game`.
        rules: overrides what the header's `by` decides.
        time_unit: seconds in a unit of model time.
        parties: who runs what; None: that is not known, and what only they could have done wrong is not looked at.
        check_digest: whether the header's digest must be one of the net's or of the parties' programs.
        may_fail_outside: whether something beside the net (a monitor) may have ended the run by an exception.
        notes: compares what a run notes of its robots with what the net makes them do; None: notes are passed over.
        is_whole: whether each line must have all the members that docs/trace.md says, and no others.
        limits: of each evaluation.
        files: what the net can do with files; nothing by default.
        progress: is called now and then with how many lines have been read, and which share of the file.
    """
    with path.open(encoding="utf-8", errors="replace") as file:
        size = path.stat().st_size
        lines = whole_lines(file)
        return replay_lines(
            lines if progress is None else _told(lines, size, progress),
            net,
            storage,
            rules=rules,
            time_unit=time_unit,
            parties=parties,
            check_digest=check_digest,
            may_fail_outside=may_fail_outside,
            notes=notes,
            is_whole=is_whole,
            limits=limits,
            files=files,
            loop=claimed_loop(path),
        )


def _told(lines: Iterable[str], size: int, progress: Progress) -> Iterator[str]:
    read = 0
    for number, text in enumerate(lines):
        read += len(text)
        if number % _TOLD_LINES == 0 and number:
            progress(number, min(read / max(size, 1), 1.0))
        yield text


def replay_lines(
    lines: Iterable[str],
    net: FlatNet,
    storage: Mapping[str, str] | None = None,
    *,
    rules: Rules | None = None,
    time_unit: float = 1.0,
    parties: Parties | None = None,
    check_digest: bool = False,
    may_fail_outside: bool = False,
    notes: Notes | None = None,
    is_whole: bool = False,
    limits: Limits | None = None,
    files: Files | None = None,
    watch: Watch | None = None,
    loop: int | str | None = ALL,
) -> ReplayResult:
    """Replays the lines of a trace; see `replay`.

    Args:
        watch: sees the game at its start (with no element) and after each step, with the line.
        loop: which marking the last line will ask for (`claimed_loop`).
    """
    game: Game | None = None
    who = parties or Parties.unknown(net)
    steps, at, ended, transition, source, by = 0, 0, None, "", net.name, ""
    names = {t.name: t for t in net.transitions}
    given: tuple[str, ...] = ()
    markings: Markings | None = None
    latest = 0.0
    by_hand = 0
    ended_at: float | None = None
    repeated: Repeated | None = None
    clock: ModelTime | None = None
    try:
        for number, text in enumerate(lines, 1):
            if not text.strip():
                continue
            at = number
            again = repeated.repeat(text) if repeated is not None and ended is None else None
            if again is not None:
                assert game is not None and markings is not None
                line, occurred = again
                transition = str(line["transition"])
                if watch is not None:
                    watch(game, occurred, line)
                _refuse(order_problem(line, steps + 1, latest))
                markings.add(game.marking)
                steps += 1
                continue
            line = _object(text)
            transition = str(line.get("transition", ""))
            _refuse(form_problem(line, is_first=game is None) if is_whole else None)
            if game is None:
                by, source = str(line.get("by", "")), str(line.get("net", source))
                _refuse(digest_problem(line, net, who) if check_digest else None)
                initial = _initial(net, line, who)
                _refuse(who.stranger(by))
                still = line.get("still") is True
                game = Game(
                    net, storage, initial, seed=_seed(line), still=still, limits=limits, files=files
                )
                given = tuple(_given(game, initial))
                rules = rules or _rules_for(by, time_unit)
                clock = ModelTime(game, who) if by == VERIFY and not rules.own_clock else None
                if notes is None:
                    repeated = Repeated(game, rules.priorities, who)
                else:
                    notes.begin(game, by)
                if watch is not None:
                    watch(game, None, line)
                markings = Markings(game.marking, loop)
            elif ended is not None and (is_whole or "event" not in line):
                raise _Wrong("it comes after the end of the run")
            elif line.get("event") == "end":
                assert rules is not None and markings is not None
                ended = str(line.get("why", ""))
                _refuse(clock.problem(line.get("t")) if clock is not None else None)
                ending = Ending(by, rules.own_clock, who, markings, may_fail_outside)
                _refuse(end_problem(game, line, ending) or time_problem(line, latest))
                ended_at = line.get("t") if rules.own_clock else None
                _refuse(notes.end(game, ended) if notes is not None else None)
            elif "event" not in line:
                assert rules is not None and markings is not None
                occurred = _step(game, line, rules, names, who, by, notes, clock)
                if watch is not None:
                    watch(game, occurred, line)
                _refuse(order_problem(line, steps + 1, latest))
                latest = max(latest, _time_of(line))
                markings.add(game.marking)
                steps += 1
                if repeated is not None:
                    repeated.learn(text, line, occurred)
            else:
                assert rules is not None
                if is_whole and (rules.own_clock or clock is not None):
                    raise _Wrong(f"`{by}` writes no notes")
                by_hand += is_by_hand(line)
                if notes is not None:
                    _refuse(notes.note(line) or time_problem(line, latest))
                    latest = max(latest, _time_of(line))
        if game is None:
            raise _Wrong("the trace is empty")
    except (_Wrong, GameError) as wrong:
        why = str(wrong) if source == net.name else f"{wrong}; the trace is of net `{source}`"
        gave_up = isinstance(wrong, GivenUpError)
        return ReplayResult(False, steps, why, at, transition, ended, game, gave_up, given)
    return ReplayResult(
        True, steps, "", 0, "", ended, game, given=given, by_hand=by_hand, ended_at=ended_at
    )


def _refuse(problem: str | None) -> None:
    if problem is not None:
        raise _Wrong(problem)


def _rules_for(by: str, time_unit: float) -> Rules:
    simulator = by in SIMULATORS
    return Rules(own_clock=simulator, priorities=simulator, time_unit=time_unit)


def _object(text: str) -> dict[str, Any]:
    try:
        data = parse_json(text, once=True)
    except BadJson as error:
        raise _Wrong(f"not JSON: {error}") from None
    if not isinstance(data, dict):
        raise _Wrong("not a JSON object")
    return data


def _initial(net: FlatNet, header: dict[str, Any], parties: Parties) -> dict[str, PlaceMarking]:
    """The overrides of initial markings that the header lists."""
    if header.get("trace") != 1:
        raise _Wrong('the first line is not the header of a trace: `"trace": 1` is missing')
    places = {p.name: p for p in net.places}
    found: dict[str, PlaceMarking] = {}
    initial = header.get("initial", {})
    if not isinstance(initial, dict):
        raise _Wrong("the `initial` of the header is not an object")
    for name, data in initial.items():
        if name not in places:
            raise _Wrong(f"the header names the place `{name}`, which the net does not have")
        try:
            found[name] = place_from_json(places[name].colset, data)
        except JsonError as error:
            raise _Wrong(f"initial marking of `{name}`: {error}") from None
        _refuse(parties.not_given(places[name], len(found[name])))
    return found


def _given(game: Game, initial: Mapping[str, PlaceMarking]) -> Iterator[str]:
    """The places that begin with other tokens than the net's."""
    own = game.own_initial_marking.places
    for place in game.net.places:
        if place.name in initial and own[place.index] != game.marking.places[place.index]:
            yield place.name


def _seed(header: dict[str, Any]) -> int:
    """The seed of the random numbers of the run."""
    seed = header.get("seed", DEFAULT_SEED)
    if isinstance(seed, bool) or not isinstance(seed, int):
        raise _Wrong("the `seed` of the header is not a number")
    return seed


def _time_of(line: dict[str, Any]) -> float:
    t = line.get("t")
    try:
        return float(t) if is_number(t) else 0.0
    except OverflowError:
        raise _Wrong("its time `t` is too large") from None


def _step(
    game: Game,
    line: dict[str, Any],
    rules: Rules,
    names: Mapping[str, FlatTransition],
    parties: Parties,
    by: str,
    notes: Notes | None,
    clock: ModelTime | None,
) -> BindingElement:
    """Repeats one occurrence, and gives it with all its outputs; raises _Wrong when that is not possible."""
    t = names.get(str(line.get("transition")))
    if t is None:
        raise _Wrong("the net has no such transition")
    _refuse(origin_problem(line, t) or parties.not_by(by, t.index))
    given = _binding(t, line.get("binding", {}))
    element = BindingElement.make(t, {s: x for s, x in given.items() if s not in _outputs(t)})
    _set_clock(game, line, rules, clock)
    why = game.why_disabled(game.marking, element, priorities=rules.priorities)
    if why is not None:
        raise _Wrong(f"not enabled: {why}")
    if not rules.priorities:
        _own_priorities(
            game, element, parties.rivals(game.net, t.index), _moment(game, line, rules)
        )
    game.evaluator.steps = game.steps + 1
    with nullcontext() if notes is None else notes.occurring():
        marking, occurred = game.occur(game.marking, element)
    for symbol in _outputs(t):
        _compare(symbol, occurred.binding[symbol], given[symbol])
    if notes is not None:
        _refuse(notes.step(line, t, game.marking, marking))
    game.marking = marking
    game.steps += 1
    if clock is not None:
        clock.occurred(t.index)
    return occurred


def _moment(game: Game, line: dict[str, Any], rules: Rules) -> Marking:
    """The marking at the time of the party that made the step: clocks of parties differ a little."""
    t = line.get("t")
    if not game.net.timed or rules.own_clock or not is_number(t):
        return game.marking
    return replace(game.marking, time=min(game.marking.time, _model_time(game, t, rules)))


def _model_time(game: Game, t: float, rules: Rules) -> int | float:
    """What the clock of a supervisor shows at a second of the run: whole units, but for the rounding of `t`
    (cnative/src/supervisor/supervisor_play.c)."""
    try:
        scaled = t / rules.time_unit
    except OverflowError:
        raise _Wrong("its time `t` is too large") from None
    return scaled if game.net.real_time else math.floor(scaled + 1e-9 * max(1.0, abs(scaled)))


def _own_priorities(
    game: Game, element: BindingElement, rivals: Sequence[FlatTransition], moment: Marking
) -> None:
    """No transition that its party has to prefer is enabled."""
    for other in rivals:
        binding = next(game.enabling.enabled(other, moment), None)
        if binding is not None:
            text = element_text(game.colours, game.net, BindingElement.make(other, binding))
            raise _Wrong(
                f"not enabled: {text} of the same program has a higher priority and is enabled"
            )


def _outputs(t: FlatTransition) -> tuple[Symbol, ...]:
    return t.code.outputs if t.code else ()


def _binding(t: FlatTransition, data: Any) -> dict[Symbol, Value]:
    if not isinstance(data, dict):
        raise _Wrong("its binding is not a JSON object")
    _refuse(unknown_variable(data, t))
    found: dict[Symbol, Value] = {}
    for s in t.variables:
        if s.name not in data:
            raise _Wrong(f"its binding lacks variable `{s.name}`")
        assert s.colset is not None, "a net variable has a colour set"
        try:
            found[s] = from_json(s.colset, data[s.name])
        except JsonError as error:
            raise _Wrong(f"variable `{s.name}`: {error}") from None
    return found


def _set_clock(game: Game, line: dict[str, Any], rules: Rules, clock: ModelTime | None) -> None:
    t = line.get("t")
    if not game.net.timed:
        is_model_time = rules.own_clock or clock is not None
        if is_model_time and is_number(t) and t != game.marking.time:
            raise _Wrong(f"it says time {t}, but without time the clock shows {game.marking.time}")
        return
    if isinstance(t, bool) or not isinstance(t, int | float):
        raise _Wrong("it has no time `t`")
    if rules.own_clock:
        if t != game.marking.time:  # else what is enabled at this time keeps the clock
            game.marking = game.advance_time(game.marking)
        if t != game.marking.time:
            raise _Wrong(f"it says time {t}, but the clock shows {game.marking.time}")
        return
    if clock is not None:
        _refuse(clock.problem(t))
        game.set_time(t)
        return
    time = _model_time(game, t, rules)
    if time < game.marking.time - (0 if game.net.real_time else 1):
        raise _Wrong(f"time goes back: {time} after {game.marking.time}")
    game.set_time(max(game.marking.time, time))


def _compare(symbol: Symbol, ours: Value, theirs: Value) -> None:
    """The output of a code segment must be what the trace says."""
    assert symbol.colset is not None
    if to_json(symbol.colset, ours) != to_json(symbol.colset, theirs):
        raise _Wrong(
            f"the code segment gives `{symbol.name}` = {json.dumps(to_json(symbol.colset, ours))}, "
            f"the trace says {json.dumps(to_json(symbol.colset, theirs))}"
        )
