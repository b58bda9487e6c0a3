"""A run by the compiled net: a process of its own that tells how it goes on (cnative/src/simulate/simulate_report.c).

Monitors without functions are watched by the process. With others it also sends its trace, and the token game follows
it step by step: it repeats each occurrence, without looking for what is enabled, and the monitors watch that. Then the
trace file, the output and the final marking are those of the token game, and a breakpoint ends the process.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import IO, Any

from pn2code.base.processor_time import Patience, processor_time
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.monitors.compiling import Instrumented
from pn2code.monitors.simple import Simple
from pn2code.monitors.watch import not_one_list
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.semantics.game.marking import BindingElement, Marking, place_from_json
from pn2code.semantics.game.report import value_text
from pn2code.semantics.values.colour_json import from_json
from pn2code.simulate.codes import SIMULATOR_FAILED
from pn2code.simulate.reference import ReferenceRun
from pn2code.simulate.run import Failure, Outcome, Output, Request
from pn2code.trace.script import Trace, TraceRefusedError
from pn2code.trace.writing import TraceUnwritableError

ENDLESS_S = 120.0
"""Of processor time without a word: it is in an expression that has no end; between steps it says something."""
GRACE_S = 5.0
"""Told to end, it has so much time."""
PROGRESS_S = 0.25
"""Seconds between two reports."""
_NO_LIMIT = 2**64 - 1


MEMORY = 1 << 22
"""Bytes for lists and strings at first."""


class OutOfRoomError(Exception):
    """The program has too little room for this run; with more the same run can be made.

    Args:
        limit: "room" (of places) or "memory" (of lists and strings).
    """

    def __init__(self, limit: str) -> None:
        super().__init__(limit)
        self.limit = limit


def run(
    request: Request,
    program: Path,
    d: Diagnostics,
    *,
    memory: int = MEMORY,
    instrumented: Instrumented | None = None,
) -> Outcome | None:
    """Plays the run; None when the program came to a bad end, which was reported.

    Args:
        request: what is asked for.
        program: the simulator.
        d: gets the errors, and warnings of monitors.
        memory: bytes for lists and strings.
        instrumented: the net with its monitors, if that is what was compiled.

    Raises:
        OutOfRoomError: the program is too small for this run.
        TraceUnwritableError: the trace cannot be written.
        TraceRefusedError: the trace that is to be repeated is none.
        OSError: it cannot be read, or the program cannot be started.
    """
    given = Trace.open(request.replay, request.net) if request.replay else None
    simple: Simple | None = None
    if request.monitors is not None and request.monitors.monitors:
        simple = Simple.of(
            request.monitors,
            request.net,
            breakpoints=request.breakpoints,
            own=instrumented.places if instrumented else None,
        )
    if simple is None and request.monitors is not None and request.monitors.monitors:
        return _followed(request, program, given, memory, d)
    return _alone(request, program, given, memory, simple, d)


# --- the process -----------------------------------------------------------------------------------


class _Process:
    """The compiled simulator at work.

    Args:
        request: what is asked for.
        program: the simulator.
        given: the trace that it repeats first.
        memory: for lists and strings.
        simple: the monitors that it watches.
        follows: whether its trace comes through a pipe, and its output is of no interest.
    """

    def __init__(
        self,
        request: Request,
        program: Path,
        given: Trace | None,
        memory: int,
        simple: Simple | None = None,
        *,
        follows: bool,
    ) -> None:
        self.request = request
        self.output = Output()
        self.errors = Output()
        self.refused: TraceRefusedError | None = None
        self.traced: IO[str] | None = None
        self._threads: list[threading.Thread] = []
        self._ended = threading.Event()
        self._follows = follows
        self.endless = False
        report_in, report_out = os.pipe()
        handed = [report_out]
        trace = str(request.trace) if request.trace is not None else None
        if follows:
            trace_in, trace_out = os.pipe()
            handed.append(trace_out)
            trace = f"/dev/fd/{trace_out}"
            self.traced = os.fdopen(trace_in, encoding="utf-8", errors="surrogateescape")
        self.report = os.fdopen(report_in, encoding="utf-8", errors="surrogateescape")
        seed, choice = request.seeds(given.header.seed if given else None)
        command = _command(request, program, trace, report_out, seed, choice)
        command += ["--memory", str(memory), *(simple.options() if simple else [])]
        try:
            self.process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL if given is None else subprocess.PIPE,
                stdout=subprocess.DEVNULL if follows else subprocess.PIPE,
                stderr=subprocess.PIPE,
                pass_fds=handed,
                start_new_session=True,  # Ctrl-C is for us; we pass it on, once
            )
        finally:
            for fd in handed:
                os.close(fd)
        self._patience = Patience(ENDLESS_S, lambda: processor_time(self.process.pid))
        if self.process.stdout is not None:
            self._start(self._collect, self.process.stdout, self.output)
        assert self.process.stderr is not None
        self._start(self._collect, self.process.stderr, self.errors)
        if given is not None:
            assert self.process.stdin is not None
            self._start(self._feed, self.process.stdin, given)
        self._start(self._pass_on)

    def _start(self, work: Any, *arguments: Any) -> None:
        thread = threading.Thread(target=work, args=arguments, daemon=True)
        thread.start()
        self._threads.append(thread)

    @staticmethod
    def _collect(stream: IO[bytes], output: Output) -> None:
        """Texts of CPN ML are bytes, one a character."""
        with stream:
            while data := stream.read1(1 << 16):  # type: ignore[attr-defined]  # pipes have it
                output.write(data.decode("latin-1"))

    def _feed(self, stream: IO[bytes], given: Trace) -> None:
        """Hands over the steps that are to be repeated; a broken pipe means that the process has had enough."""
        with suppress(BrokenPipeError), stream:
            try:
                for step in given.steps():
                    stream.write(step.script().encode("utf-8", "surrogateescape"))
            except TraceRefusedError as refused:
                self.refused = refused

    def _pass_on(self) -> None:
        """Tells the process when the run shall end; ends it when it does not hear."""
        while not self._ended.wait(0.05):
            # Who follows a trace may be slower than the process, which waits then.
            silent = not self._follows and self._patience.is_over()
            if not (silent or self.request.interrupted()):
                continue
            with suppress(ProcessLookupError):
                self.process.send_signal(signal.SIGINT)
            if not self._ended.wait(GRACE_S * (10 if self._follows else 1)):
                self.endless = True
                self.kill()
            return

    def lines(self) -> Iterator[dict[str, Any]]:
        """What it reports, line by line."""
        for text in self.report:
            self._patience.renew()
            try:
                yield json.loads(text)
            except ValueError:
                return  # it was ended while it wrote

    def end(self) -> int:
        """Waits for its end, or ends it when nobody listens any more."""
        self.report.close()
        if self.traced is not None:
            self.traced.close()
        code = self.process.wait()
        self._ended.set()
        for thread in self._threads:
            thread.join()
        return code

    def kill(self) -> None:
        """Ends it at once."""
        with suppress(ProcessLookupError):
            self.process.kill()


def _command(
    request: Request, program: Path, trace: str | None, report: int, seed: int, choice: int
) -> list[str]:
    steps = _NO_LIMIT if request.steps is None else request.steps
    command = [str(program), "--steps", str(steps), "--seed", str(seed)]
    command += ["--report", f"/dev/fd/{report}", "--progress", str(PROGRESS_S)]
    if choice != seed:
        command += ["--choice", str(choice)]
    if request.until is not None:
        command += ["--until", str(request.until)]
    if trace is not None:
        command += ["--trace", trace]
    if request.initial is not None:
        command += ["--initial", request.initial]
    if request.replay is not None:
        command += ["--replay", "-"]
    if request.files is not None:
        command += ["--files", str(request.files)]
    return command


def _last_report(process: _Process) -> dict[str, Any] | None:
    """Passes the progress on; gives the last line, with the initial marking in it; None when there is none."""
    initial: Any = None
    for line in process.lines():
        if "why" in line:
            return {**line, "initial": initial}
        if "initial" in line:
            initial = line["initial"]
        else:
            process.request.progress(line["steps"], line["t"])
    return None


# --- by itself -------------------------------------------------------------------------------------


def _alone(
    request: Request,
    program: Path,
    given: Trace | None,
    memory: int,
    simple: Simple | None,
    d: Diagnostics,
) -> Outcome | None:
    net = request.net
    began = time.perf_counter()
    process = _Process(request, program, given, memory, simple, follows=False)
    try:
        last = _last_report(process)
    except BaseException:
        process.kill()
        raise
    finally:
        code = process.end()
    seconds = time.perf_counter() - began
    if last is None:
        _bad_end(process, code, d)
        return None
    why = last["why"]
    if why == "trace":
        assert request.trace is not None
        raise TraceUnwritableError(request.trace, last.get("message", "").lower())
    refusal = last.get("message", "") if why == "replay" else ""
    if process.refused is not None and why != "replay":
        why, refusal = "replay", str(process.refused)
    if why == "error" and "limit" in last:
        raise OutOfRoomError(last["limit"])
    stopped = simple.breakpoint(last["watch"]) if simple and why == "breakpoint" else None
    return Outcome(
        engine="compiled",
        seed=request.seeds(given.header.seed if given else None)[0],
        why=why,
        steps=last["steps"],
        replayed=last["replayed"],
        initial=_marking(net, last["initial"], 0) if last["initial"] is not None else None,
        final=_marking(net, last["marking"], last["t"]) if last["initial"] is not None else None,
        failure=_failure(net, last, simple) if why == "error" else None,
        refusal=refusal,
        breakpoint=stopped.row() if stopped else None,
        monitors=simple.rows(last["watched"], last["t"]) if simple else (),
        output=process.output.text(),
        seconds=seconds,
    )


def _bad_end(process: _Process, code: int, d: Diagnostics) -> None:
    said = process.errors.text().strip()
    how = f"was ended by signal {-code}" if code < 0 else f"ended with code {code}"
    if process.endless:
        d.error(
            SIMULATOR_FAILED,
            "the run was stopped, because an expression of the net does not end",
            Origin(process.request.net.file),
            hint="`--engine reference` stops such an expression and says which one it is",
        )
        return
    d.error(
        SIMULATOR_FAILED,
        f"the compiled simulator {how}",
        Origin(process.request.net.file),
        notes=said.splitlines()[-3:],
        hint="`--engine reference` makes the same run",
    )


def _marking(net: FlatNet, found: Mapping[str, Any], time: int | float) -> Marking:
    """A marking of a report."""
    places = tuple(
        place_from_json(p.colset, _stamps(found[p.name], net.real_time)) for p in net.places
    )
    return Marking(float(time) if net.real_time else time, places)


def _stamps(tokens: list[list[Any]], real: bool) -> list[list[Any]]:
    return [[*t[:2], float(t[2])] if real and len(t) == 3 else t for t in tokens]


def _failure(net: FlatNet, last: Mapping[str, Any], simple: Simple | None = None) -> Failure:
    """The error of a report."""
    index = last.get("transition")
    t = net.transitions[index] if index is not None else None
    if simple is not None and "watch" in last:
        m = simple.monitors[last["watch"]]
        tokens = sum(token[0] for token in last["marking"][net.places[m.places[0].place].name])
        return Failure(not_one_list(m, tokens), m.origin, None, t, _binding(t, last))
    name = last["error"]
    if t is None:
        message = f"`{name}` in the declarations or an initial marking: {last['origin']}"
        return Failure(message, Origin(net.file))
    doing = "the occurrence of" if "binding" in last else "the search for bindings of"
    said = last["origin"]
    where = f" ({said})" if said and said != t.origin.describe() else ""
    # An exception has a name; limits and what is not available here are told in words.
    what = f"raised `{name}`" if name.isidentifier() else f"cannot go on: {name}"
    message = f"{doing} `{t.name}` {what}{where}"
    return Failure(message, t.origin, None, t, _binding(t, last))


def _binding(t: FlatTransition | None, last: Mapping[str, Any]) -> dict[str, str] | None:
    """Texts of the variables that were bound, but for outputs of the code segment."""
    if t is None or "binding" not in last:
        return None
    outputs = t.code.outputs if t.code else ()
    return {
        s.name: value_text(s, from_json(s.colset, last["binding"][s.name]))
        for s in t.variables
        if s.colset is not None and s not in outputs
    }


# --- followed by the token game --------------------------------------------------------------------


def _followed(
    request: Request, program: Path, given: Trace | None, memory: int, d: Diagnostics
) -> Outcome | None:
    own = ReferenceRun(request, d, by="simulate")
    own.seed = request.seeds(given.header.seed if given else None)[0]
    began = time.perf_counter()
    try:
        why = own.begin(given)
        last: dict[str, Any] | None = None
        if not why:
            process = _Process(replace(request, trace=None), program, given, memory, follows=True)
            try:
                why = _follow(own, process)
                if not why:
                    last = _last_report(process)
            except BaseException:
                process.kill()
                raise
            finally:
                if why:
                    process.kill()
                code = process.end()
            if not why and last is None:
                _bad_end(process, code, d)
                return None
            if last is not None:
                why = _catch_up(own, last, process)
        why = own.finish(why)
    finally:
        own.close()
    outcome = own.outcome("compiled", why, time.perf_counter() - began)
    assert request.monitors is not None
    return replace(outcome, interpreted=tuple(c.monitor.name for c in request.monitors.monitors))


def _follow(own: ReferenceRun, process: _Process) -> str:
    """Repeats what the process does; gives why the run ends here, or "" when the process has ended by itself."""
    assert process.traced is not None
    trace = Trace(process.traced, own.request.net)
    for step in trace.steps():
        game = own.game
        assert game is not None
        if step.time is not None and step.time > game.marking.time:
            game.set_time(step.time)
            if why := own.time_grew():
                return why
        element = BindingElement.make(step.transition, step.bound)
        if why := own.fire(element):
            return why
        own.request.progress(game.steps, game.marking.time)
    return ""


def _catch_up(own: ReferenceRun, last: Mapping[str, Any], process: _Process) -> str:
    """Takes over how the process has ended."""
    why: str = last["why"]
    own.replayed = last["replayed"]
    if own.game is not None and last["t"] > own.game.marking.time:
        own.game.set_time(last["t"])
    if why == "error":
        if "limit" in last:
            raise OutOfRoomError(last["limit"])
        own.fail_as(_failure(own.request.net, last))
    elif why == "replay":
        own.refuse(last.get("message", ""))
    elif process.refused is not None:
        why = "replay"
        own.refuse(str(process.refused))
    return why
