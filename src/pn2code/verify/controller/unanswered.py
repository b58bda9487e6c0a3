"""Where a script may take a flag and be ready for the next one, or end, without having given an answer.

unanswered(program)     # "`Cell.Rob.Ignore` leads back to where the next message is awaited, without an answer; ..."
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.cell.partition import ChannelKind
from pn2code.robot_scripts.machine import Machine, Outcome, Step

ADVICE = 'let it answer, or say `kind = "data"` of the message in cell.toml (docs/protocol.md, I8)'


def unanswered(program: Machine) -> str:
    """What the script does instead of answering, with the transition and the advice; "" if it always answers."""
    for step, flag in _asked(program):
        found = _way_back(program, step)
        if found is None:
            continue
        last, ends = found
        name, file = last.transition.name, program.channels[flag].file
        does = (
            "is the end of the script"
            if ends
            else "leads back to where the script waits for the next message"
        )
        return (
            f"after a message of `{file}` `{name}` {does}, and no answer has been given: {ADVICE}"
        )
    return ""


def _asked(program: Machine) -> Iterator[tuple[Step, int]]:
    """The steps that take a flag of the supervisor, and its place."""
    for step in program.steps:
        for place, *_ in step.takes:
            channel = program.channels.get(place)
            if channel is None or channel.kind is not ChannelKind.FLAG:
                continue
            if channel.reader == program.owner.index and channel.writer == 0:
                yield step, place


def _way_back(program: Machine, asked: Step) -> tuple[Step, bool] | None:
    """The last step on a way without an answer back to where `asked` begins (False), or to an end (True)."""
    start = _here(program, asked)
    todo = [asked]
    seen = {id(asked)}
    while todo:
        step = todo.pop(0)
        for outcome in step.outcomes:
            if _answers(program, outcome):
                continue
            there = program.target(outcome)
            onward = program.steps_from(there)
            if there == start or not onward:
                return step, there != start
            for following in onward:
                if id(following) not in seen:
                    seen.add(id(following))
                    todo.append(following)
    return None


def _here(program: Machine, step: Step) -> int:
    return next(p for p, *_ in step.takes if p in program.control)


def _answers(program: Machine, outcome: Outcome) -> bool:
    return any(p in program.channels and program.channels[p].reader == 0 for p, _ in outcome.puts)
