"""Reading a trace of a simulator, to repeat its steps: the header, then the steps one after the other.

Only what the simulators wrote can be continued (`by` is `simulate` or `reference`); other traces are for the verb
`replay`.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.semantics.game.marking import PlaceMarking, place_from_json
from pn2code.semantics.values.colour_json import JsonError, from_json, to_json
from pn2code.semantics.values.data import Value
from pn2code.trace.lines import is_number, order_problem, origin_problem, unknown_variable
from pn2code.trace.parties import RUN, SIMULATORS, VERIFY
from pn2code.trace.whole_lines import whole_lines
from pn2code.trace.writing import json_text


class TraceRefusedError(Exception):
    """The trace cannot be repeated.

    Args:
        why: what is wrong, lower case.
        line: of the file, from 1; 0: as a whole.
    """

    def __init__(self, why: str, line: int = 0) -> None:
        super().__init__(f"line {line}: {why}" if line else why)
        self.why = why
        self.line = line


def _refuse(problem: str | None, line: int) -> None:
    if problem is not None:
        raise TraceRefusedError(problem, line)


def _lines(path: Path) -> Iterator[str]:
    with path.open(encoding="utf-8", errors="surrogateescape") as file:
        yield from whole_lines(file)


def _objects(lines: Iterable[str]) -> Iterator[tuple[int, dict[str, Any]]]:
    for number, text in enumerate(lines, 1):
        if not text.strip():
            continue
        try:
            data = json.loads(text)
        except (ValueError, RecursionError):
            raise TraceRefusedError("this is not a line of JSON", number) from None
        if not isinstance(data, dict):
            raise TraceRefusedError("this is not a JSON object", number)
        yield number, data


@frozen
class Step:
    """An occurrence that is to be repeated.

    Args:
        line: of the file, from 1.
        transition: which one.
        time: the model time that it says, None if it says none.
        values: of all variables, outputs of the code segment included.
    """

    line: int
    transition: FlatTransition
    time: int | float | None
    values: Mapping[Symbol, Value]

    @property
    def bound(self) -> dict[Symbol, Value]:
        """The values of the variables that are bound before the code segment runs."""
        outputs = self.transition.code.outputs if self.transition.code else ()
        return {s: v for s, v in self.values.items() if s not in outputs}

    def script(self) -> str:
        """The line for the compiled simulator (cnative/src/simulate/simulate_replay.c)."""
        t = self.transition
        outputs = t.code.outputs if t.code else ()
        texts = [
            (s, f"{json_text(s.name)}: {json_text(to_json(s.colset, v))}")
            for s, v in self.values.items()
            if s.colset is not None
        ]
        bound = ", ".join(text for s, text in texts if s not in outputs)
        everything = ", ".join(text for _, text in texts)
        time = "" if self.time is None else json_text(self.time)
        return f"{t.index}\t{time}\t{{{bound}\t{{{everything}}}\n"


@frozen
class Header:
    """The first line of a trace.

    Args:
        seed: of the random numbers of the run, None if it does not say.
        initial: markings that replace initial markings, by name of the place.
        by: who wrote it.
        still: the random numbers are the same at each step (docs/trace.md).
    """

    seed: int | None
    initial: Mapping[str, PlaceMarking]
    by: str
    still: bool = False


class Trace:
    """A trace that is read once.

    Args:
        lines: of the file.
        net: the net that it is of.
        is_shown: whether it is only to be told or drawn: then runs of a cell, also those of `verify`, will do.

    Raises:
        OSError: it cannot be read.
        TraceRefusedError: it is no trace of a simulator, or has another form.
    """

    def __init__(self, lines: Iterable[str], net: FlatNet, *, is_shown: bool = False) -> None:
        self._net = net
        self._writers = {*SIMULATORS, VERIFY, RUN} if is_shown else SIMULATORS
        self._wanted = (
            "traces of `simulate`, of `verify`, and `NET.trace.jsonl` of `run`"
            if is_shown
            else "only traces of `simulate`, which can be continued,"
        )
        self._transitions = {t.name: t for t in net.transitions}
        self._lines = _objects(lines)
        first = next(self._lines, None)
        if first is None:
            raise TraceRefusedError("the trace is empty")
        self.header = self._header(first[1])

    @staticmethod
    def open(path: Path, net: FlatNet, *, is_shown: bool = False) -> Trace:
        """From a file."""
        return Trace(_lines(path), net, is_shown=is_shown)

    def _header(self, line: Mapping[str, Any]) -> Header:
        if line.get("trace") != 1:
            raise TraceRefusedError('the header of a trace is missing: `"trace": 1`', 1)
        if line.get("by") not in self._writers:
            raise TraceRefusedError(
                f"the trace is by `{line.get('by')}`; {self._wanted} are taken here", 1
            )
        seed = line.get("seed")
        if seed is not None and (isinstance(seed, bool) or not isinstance(seed, int)):
            raise TraceRefusedError("the `seed` is not a number", 1)
        initial = line.get("initial", {})
        if not isinstance(initial, dict):
            raise TraceRefusedError("`initial` is not an object", 1)
        places = {p.name: p for p in self._net.places}
        found: dict[str, PlaceMarking] = {}
        for name, data in initial.items():
            if name not in places:
                raise TraceRefusedError(f"the net has no place `{name}`", 1)
            try:
                found[name] = place_from_json(places[name].colset, data)
            except JsonError as error:
                raise TraceRefusedError(f"initial marking of `{name}`: {error}", 1) from None
        return Header(seed, found, str(line["by"]), line.get("still") is True)

    def steps(self) -> Iterator[Step]:
        """The occurrences, in order; notes and the end are passed over.

        Raises:
            TraceRefusedError: a line has another form.
        """
        latest, count, is_over = 0.0, 0, False
        for number, line in self._lines:
            if "event" in line:
                is_over = is_over or line["event"] == "end"
                continue
            if is_over:
                raise TraceRefusedError("it comes after the end of the run", number)
            count += 1
            _refuse(order_problem(line, count, latest), number)
            yield self._step(number, line)
            latest = max(latest, float(line["t"])) if is_number(line.get("t")) else latest

    def _step(self, number: int, line: Mapping[str, Any]) -> Step:
        t = self._transitions.get(str(line.get("transition")))
        if t is None:
            raise TraceRefusedError(f"the net has no transition `{line.get('transition')}`", number)
        time = line.get("t")
        if isinstance(time, bool) or not isinstance(time, int | float | None):
            raise TraceRefusedError("the time `t` is not a number", number)
        if isinstance(time, int) and self._net.real_time:
            time = float(time)
        given = line.get("binding")
        if not isinstance(given, dict):
            raise TraceRefusedError("the binding is not a JSON object", number)
        _refuse(origin_problem(line, t) or unknown_variable(given, t), number)
        return Step(number, t, time, dict(self._values(number, t, given)))

    def _values(
        self, number: int, t: FlatTransition, given: Mapping[str, Any]
    ) -> Iterator[tuple[Symbol, Value]]:
        for s in t.variables:
            if s.name not in given:
                raise TraceRefusedError(f"the binding lacks the variable `{s.name}`", number)
            assert s.colset is not None, "a net variable has a colour set"
            try:
                yield s, from_json(s.colset, given[s.name])
            except JsonError as error:
                raise TraceRefusedError(f"variable `{s.name}`: {error}", number) from None
