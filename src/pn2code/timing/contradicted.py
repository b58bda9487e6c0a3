"""Answers of `verify` whose premises measured durations contradict, or confirm.

    said = weighed(said, control.premises, times)

That nobody owes an answer for longer than `reply_timeout_s`, and that arms get to where they are told to go, no state
shows: answers assume it. Where somebody may be late by what commands take, or an arm may be told what it cannot do,
each "yes" that assumes the opposite is not known any more. Where all answers come in time, the premise says how much
time they take.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.channel_model.check import Answer as OfMedium
from pn2code.timing.answers import Layout, seconds_up
from pn2code.timing.look import AT_ONCE, PLANNED, Times
from pn2code.verdict.whole import Said
from pn2code.verify.answers.properties import Answer
from pn2code.verify.controller.control_types import IN_TIME, Check
from pn2code.verify.controller.premises import Premises


@frozen
class _Weighed:
    """What became of a premise.

    Args:
        word, why: why it does not hold: a word of `reasons`, and a clause; "": it may hold.
        says: what is to be said instead of it.
    """

    word: str
    why: str
    says: str


def weighed(said: Said, premises: Premises, times: Times) -> Said:
    """The same, with answers that take account of what was measured."""
    found: dict[str, _Weighed] = {}
    stops = [_in(x, f"a run may stop: {why}") for x in times.layouts for why in x.cycle.stops]
    if stops:
        found[premises.reached] = _Weighed("moves", stops[0], premises.reached)
    checks: tuple[Check, ...] = ()
    if premises.replies.premise:
        replies = _replies(times, f"{PLANNED}, and {AT_ONCE}" if premises.sensors else PLANNED)
        if replies is not None:
            found[premises.replies.premise] = replies
            checks = (_in_time(replies, premises),)
    control = said.control
    if control is not None:
        old = (_check(c, found) for c in control.checks)
        control = replace(control, checks=(*old, *checks))
    return replace(
        said,
        control=control,
        answers=tuple(_answer(a, found) for a in said.answers),
        channel_model=tuple(_medium(a, found) for a in said.channel_model),
    )


def _in(layout: Layout, clause: str) -> str:
    return f"in layout `{layout.name}`: {clause}" if layout.name else clause


def _replies(times: Times, planned: str) -> _Weighed | None:
    """Of the premise that answers come in time; None: nothing was measured."""
    limit = f"nobody owes an answer for longer than `reply_timeout_s`, {times.reply_timeout_s:g} s"
    late = [_in(x, why) for x in times.layouts for why in x.cycle.late]
    if late:
        return _Weighed("late", late[0], limit)
    known = [x.cycle.reply for x in times.layouts if x.cycle.reply is not None]
    if len(known) < len(times.layouts) or not known:
        return None
    return _Weighed("", "", f"{limit} ({seconds_up(max(known))} s at most, if {planned})")


def _in_time(replies: _Weighed, premises: Premises) -> Check:
    if replies.why:
        return Check(IN_TIME, "unknown", f"not known: {replies.why}", why=replies.word)
    return Check(IN_TIME, "yes", replies.says, assumes=premises.of_check(IN_TIME, "yes"))


def _doubt(assumes: Iterable[str], found: Mapping[str, _Weighed]) -> _Weighed | None:
    return next((found[x] for x in assumes if x in found and found[x].why), None)


def _told(assumes: Iterable[str], found: Mapping[str, _Weighed]) -> tuple[str, ...]:
    return tuple(found[x].says if x in found else x for x in assumes)


def _check(c: Check, found: Mapping[str, _Weighed]) -> Check:
    doubt = _doubt(c.assumes, found)
    if doubt is None or c.answer != "yes":
        return replace(c, assumes=_told(c.assumes, found))
    says = f"not known: {doubt.why}"
    return replace(c, answer="unknown", says=says, value=None, why=doubt.word, assumes=())


def _answer(a: Answer, found: Mapping[str, _Weighed]) -> Answer:
    doubt = _doubt(a.assumes, found)
    if doubt is None or a.answer != "yes":
        return replace(a, assumes=_told(a.assumes, found))
    return Answer(
        a.about, "inconclusive", doubt.why, cell=a.cell, net=a.net, net_why=a.net_why
    )  # fmt: skip


def _medium(a: OfMedium, found: Mapping[str, _Weighed]) -> OfMedium:
    """The shared files; what it assumes is one text."""
    mentioned = [x for x in found if x in a.assumes]
    doubt = _doubt(mentioned, found)
    assumes = a.assumes
    for x in mentioned:
        assumes = assumes.replace(x, found[x].says)
    if doubt is None or a.answer != "yes":
        return replace(a, assumes=assumes)
    return replace(a, answer="inconclusive", why=doubt.why, assumes=assumes)
