"""`pn2code replay`: is a recorded run an occurrence sequence of the net?"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from pn2code.base.os_reason import os_reason
from pn2code.cli.nets import open_net, playing
from pn2code.cli.options import (
    DEFAULT_INT_BITS,
    DEFAULT_SEED,
    Engine,
    EngineOption,
    Exit,
    FilesOption,
    Format,
    FormatOption,
    IntBitsOption,
    JsonOption,
    NetArgument,
    SetOption,
    parse_values,
)
from pn2code.cli.replay_claims import Claims, claims, refuse
from pn2code.cli.trace_progress import TraceProgress
from pn2code.cli.traces_there import traces_there
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.report import places, time_text
from pn2code.trace import replay as own
from pn2code.trace.json_text import BadJson, parse_json
from pn2code.trace.recording import NotARecording, Recording, recording
from pn2code.trace.replay_end import UNTIL
from pn2code.trace.replay_recording import follow
from pn2code.trace.whole_lines import whole_lines
from pn2code.verdict.opened import OpenNet

EPILOG = """Examples:

  pn2code simulate net.cpn --trace run.trace.jsonl && pn2code replay run.trace.jsonl net.cpn

  pn2code replay recorded.json net.cpn --json
"""

LARGEST = 500_000_000
"""Bytes of a recording, which is read as a whole."""


def replay(
    trace: Annotated[
        Path, typer.Argument(help="A trace (*.trace.jsonl), or a recording by CPN Tools.")
    ],
    net: NetArgument,
    as_json: JsonOption = False,
    engine: EngineOption = Engine.REFERENCE,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    files: FilesOption = None,
    int_bits: IntBitsOption = DEFAULT_INT_BITS,
    any_digest: Annotated[
        bool,
        typer.Option("--any-digest", help="Accept a trace of another version of the net."),
    ] = False,
    form: FormatOption = Format.FULL,
) -> None:
    """Repeat a recorded run, and check that each step is enabled when its turn comes.

    The other statements of the trace are checked as well: the net, elements, numbers, times, priorities, and why and
    where the run ended.

    A recording of CPN Tools does not say which random numbers were drawn. Such a run is compared as far as it is
    determined, and the output says so.
    """
    what = kind(trace)
    try:
        values = parse_values(settings)
        opened = open_net(net, values, form, int_bits=int_bits, has_own_marking=True)
        with playing(form):
            if isinstance(what, Recording):
                result = _recording(what, opened, files, engine, form)
            elif engine is Engine.COMPILED:
                from pn2code.cli.replay_compiled import repeat_own  # loads the compiler

                claimed = claims(opened, values, int_bits, any_digest=any_digest, form=form)
                result = repeat_own(trace, opened, files, claimed, form)
            else:
                claimed = claims(opened, values, int_bits, any_digest=any_digest, form=form)
                with TraceProgress(shown=not as_json) as progress:
                    result = _own(trace, opened, files, claimed, progress.report)
    except typer.Exit as left:
        if as_json and left.exit_code == Exit.MODEL:
            typer.echo(json.dumps(_NOT_PLAYED, indent=1))
        raise
    if as_json:
        typer.echo(json.dumps(result, indent=1))
    else:
        typer.echo(_sentence(trace, result))
    if not result["ok"]:
        raise typer.Exit(Exit.INCONCLUSIVE if result.get("given_up") else Exit.MODEL)


_NOT_PLAYED: dict[str, Any] = {
    "ok": False,
    "steps": 0,
    "failed_step": None,
    "why": "the net cannot be played: it has errors, or its initial marking raises an exception",
    "time": None,
    "places": [],
}


def kind(trace: Path) -> Recording | None:
    """The recording that a file is; None for a trace of our own; leaves when it is neither."""
    try:
        with trace.open(encoding="utf-8") as lines:
            first = next((line for line in whole_lines(lines) if line.strip()), "")
            if _is_header(first):
                return None
            if trace.stat().st_size > LARGEST:
                refuse(f"`{trace}` is too large for a recording")
            lines.seek(0)
            return recording(parse_json(lines.read()))
    except OSError as problem:
        there = traces_there(trace, "")
        refuse(f"cannot read `{trace}`: {os_reason(problem)}{f'; {there}' if there else ''}")
    except UnicodeDecodeError:
        refuse(f"`{trace}` is not a trace: it is no UTF-8 text")
    except BadJson as problem:
        refuse(f"`{trace}` is not a trace: {problem}")
    except NotARecording as problem:
        refuse(f"`{trace}`: {problem}")


def _is_header(line: str) -> bool:
    """Whether a line by itself is the header of a trace, or another line of one."""
    try:
        data = parse_json(line)
    except BadJson:
        return False
    return isinstance(data, dict) and not {"trace", "transition", "event"}.isdisjoint(data)


def _recording(
    run: Recording, opened: OpenNet, files: Path | None, engine: Engine, form: Format
) -> dict[str, Any]:
    """A recording, by the token game; what is determined, by the compiled net as well if that is wanted."""
    followed = follow(run, opened.game(seed=DEFAULT_SEED, files=files))
    result: dict[str, Any] = {
        "ok": followed.ok,
        "steps": followed.steps,
        "failed_step": None if followed.ok else followed.steps + 1,
        "why": followed.why,
        "given_up": followed.given_up,
        "time": followed.time,
        "random": followed.random,
        "drawn": list(followed.drawn),
        "engine": Engine.REFERENCE.value,
        "places": followed.rows,
    }
    if engine is Engine.REFERENCE or not followed.ok:
        return result
    if followed.random:
        return {**result, "why": f"{followed.why}; {_NOT_COMPILED}"}
    from pn2code.cli.replay_compiled import repeat_recorded  # loads the compiler

    return repeat_recorded(opened, followed, result, files, form)


_NOT_COMPILED = (
    "the compiled net cannot repeat what was drawn, so only the token game repeated the run"
)


def _own(
    trace: Path,
    opened: OpenNet,
    files: Path | None,
    claims: Claims,
    progress: own.Progress,
) -> dict[str, Any]:
    """A trace of our own, by the token game."""
    result = own.replay(
        trace,
        opened.flat,
        opened.storage,
        parties=claims.parties,
        check_digest=claims.check_digest,
        may_fail_outside=claims.may_fail_outside,
        notes=claims.notes,
        is_whole=True,
        files=Files(files),
        progress=progress,
    )
    game = result.game
    return {
        "ok": result.ok,
        "steps": result.steps,
        "failed_step": None if result.ok else result.steps + 1,
        "why": result.why,
        "given_up": result.given_up,
        "line": result.line,
        "transition": result.transition,
        "ended": result.ended,
        "ended_at": result.ended_at,
        "given": list(result.given),
        "by_hand": result.by_hand,
        "time": game.marking.time if game else None,
        "engine": Engine.REFERENCE.value,
        "places": places(opened.flat, game.marking) if game else [],
    }


_ENDED = {UNTIL: "the next step would be after the given time"}
"""What a word of a trace means that says little by itself."""


def _sentence(trace: Path, result: dict[str, Any]) -> str:
    """The result for people."""
    steps = f"{result['steps']} step{'s' * (result['steps'] != 1)}"
    if not result["ok"]:
        line = f"{trace}:{result['line']}" if result.get("line") else str(trace)
        transition = f"`{result['transition']}`: " if result.get("transition") else ""
        could = "is not known to be possible" if result.get("given_up") else "cannot be repeated"
        return f"{line}: step {result['failed_step']} {could}: {transition}{result['why']}"
    word = result.get("ended")
    # Where nothing more occurred, the run may have ended later than the last step.
    time = result.get("ended_at") or result["time"]
    ended = f", ended: {_ENDED.get(word, word)}" if word else ""
    text = f"{trace}: {steps}, each enabled when its turn came{ended}"
    if time:
        text += f", at time {time_text(time)}"
    if result.get("given"):
        names = ", ".join(f"`{name}`" for name in result["given"])
        text += f"; it begins with other tokens than the net in {names}, as its header says"
    if by_hand := result.get("by_hand"):
        text += f"; a person has chosen {by_hand} of the values, pauses and fates of messages in it"
    if "ended" in result and not result["ended"]:
        text += "; its last line is missing, the run may have continued"
    return text + (f"\n{result['why']}" if result["why"] else "")
