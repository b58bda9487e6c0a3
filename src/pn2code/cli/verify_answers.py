"""The answers on one screen: how many there are of each kind, what they rest on, and those that are not good."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.cli.verify_rows import WIDTH, count_of
from pn2code.verdict import channel_model
from pn2code.verdict.whole import Said
from pn2code.verify.answers import basis
from pn2code.verify.answers.outcome import good_of
from pn2code.verify.answers.properties import kind as kind_of
from pn2code.verify.controller.control_types import TITLES
from pn2code.verify.report.properties_text import net_run
from pn2code.verify.report.properties_text import said as said_of

MOST_ITEMS = 8
"""Failures and open questions that have lines of their own on one screen."""
MOST_OF_ITEM = 4
"""Lines of each of them."""
MOST_NAMES_LINES = 4
"""Lines with the names of failures of which there is no room to say more."""


@frozen
class Item:
    """One answer: what was asked, how it came out ("good", "bad", "open"), and what there is to say."""

    name: str
    kind: str
    says: str
    file: Path | None = None
    lines: tuple[str, ...] = ()
    loop: int | None = None
    is_deadlock: bool = False


def items_of(said: Said) -> Iterator[Item]:
    """What the user has asked comes before what is asked of every cell."""
    for a in said.answers:
        kind = kind_of(a)
        says = f"not known: {a.why}" if kind == "open" else said_of(a)
        says += f" [the closed net: {a.net}{net_run(a)}]" if a.net is not None else ""
        says += f" (no run: {a.no_run})" if a.no_run else ""
        e = a.evidence
        file, loop = (None, None) if e is None else (e.trace, e.loop)
        is_deadlock = a.about.kind == "deadlock"
        yield Item(a.about.name, kind, says, file, loop=loop, is_deadlock=is_deadlock)
    for check in said.control.checks if said.control else ():
        run = next((run for run in check.evidence if run.file is not None), None)
        loop = None if run is None else run.loop
        file = None if run is None else run.file
        is_deadlock = check.why == "deadlock"
        yield Item(
            TITLES[check.name], check.kind, check.says, file, loop=loop, is_deadlock=is_deadlock
        )
    for m in said.channel_model:
        kind = {"yes": "good", "no": "bad"}.get(m.answer, "open")
        lines = next((tuple(e.lines) for e in m.evidence), ())
        says = {"open": f"not known: {m.why}", "bad": channel_model.shown(m)}.get(kind, m.says)
        yield Item(f"{m.check[:1].upper()}{m.check[1:]}", kind, says, None, lines)


_TITLES = ("Properties", "Controller checks", "Shared files")


def _groups(said: Said) -> tuple[tuple[str, Sequence[str], Sequence[str | None]], ...]:
    """For each kind of question: its name, how the answers came out, what they rest on."""
    items = list(items_of(said))
    checks = said.control.checks if said.control else ()
    first, second = len(said.answers), len(said.answers) + len(checks)
    kinds = [i.kind for i in items]
    return (
        (_TITLES[0], kinds[:first], [a.rests_on for a in said.answers]),
        (_TITLES[1], kinds[first:second], [c.rests_on for c in checks]),
        (_TITLES[2], kinds[second:], [m.rests_on for m in said.channel_model]),
    )


_RESTS = {
    basis.MARKINGS: "all markings",
    basis.ARCS: "all markings and arcs",
    basis.COMPONENTS: "all components",
    basis.MARKING: "a marking that was reached",
    basis.PART: "a part that decides",
    basis.RUN: "a run",
    basis.NET: "the net itself",
    basis.UNFOLDED: "the unfolded net",
}


def counts_of(said: Said) -> Iterator[str]:
    """How many answers of each kind are good, and what they rest on."""
    for title, kinds, rests in _groups(said):
        if kinds:
            yield from textwrap.wrap(
                f"{title}: {_count(kinds)}{_rest(rests)}.", WIDTH, subsequent_indent="  "
            )


def _assumed(said: Said) -> list[str]:
    """What answers rest on that no state shows."""
    checks = said.control.checks if said.control else ()
    return [
        *dict.fromkeys(
            [*(x for c in checks for x in c.assumes), *(x for a in said.answers for x in a.assumes)]
        )
    ]


def premises_of(said: Said) -> Iterator[str]:
    """What answers rest on that no state shows."""
    if found := _assumed(said):
        yield from textwrap.wrap(f"Assumed: {'; '.join(found)}.", WIDTH, subsequent_indent="  ")


def counted_premises(said: Said) -> Iterator[str]:
    """In place of them, where there is no room."""
    if found := _assumed(said):
        yield f"Assumed: {count_of(len(found), 'premise')} of the answers above; `--full` has them."


def _count(kinds: Sequence[str]) -> str:
    good, bad, is_open = (kinds.count(kind) for kind in ("good", "bad", "open"))
    text = good_of(good, len(kinds))
    text += f", {bad} {'are' if bad != 1 else 'is'} not" if bad else ""
    return text + (f", {is_open} {'are' if is_open != 1 else 'is'} not known" if is_open else "")


def _rest(rests: Sequence[str | None]) -> str:
    counted = [f"{says} ({rests.count(word)})" for word, says in _RESTS.items() if word in rests]
    return f"; the answers rest on {', '.join(counted)}" if counted else ""


def wrong_lines(wrong: Sequence[Item], room: int) -> list[str]:
    """Failures, then open questions: as many as there is room for, the first in any case; of the others the names."""
    lines: list[str] = []
    for number, item in enumerate(wrong):
        mark = {"bad": "NO", "open": "?"}[item.kind]
        run = f" (run: {item.file})" if item.file is not None else ""
        wrapped = textwrap.wrap(
            f"{mark:<3}{item.name}: {item.says}{run}",
            WIDTH,
            subsequent_indent="   ",
            break_long_words=False,
            break_on_hyphens=False,
        )[:MOST_OF_ITEM]
        is_full = len(lines) + len(wrapped) + len(_names_of(wrong[number + 1 :])) > room
        if number and (number == MOST_ITEMS or is_full):
            return [*lines, *_names_of(wrong[number:])]
        lines += wrapped
    return lines


def _names_of(wrong: Sequence[Item]) -> list[str]:
    """What failed and what is open, by name."""
    lines: list[str] = []
    for kind, title, more in (
        ("bad", "also NO", ""),
        ("open", "also not known", "; --full says why"),
    ):
        names = [item.name for item in wrong if item.kind == kind]
        if names:
            lines += textwrap.wrap(
                f"{title} ({len(names)}{more}): {', '.join(names)}",
                WIDTH,
                initial_indent="   ",
                subsequent_indent="     ",
                max_lines=MOST_NAMES_LINES,
                placeholder=" ...",
            )
    return lines
