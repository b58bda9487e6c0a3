"""The answers for people: a table of moves, and what is wrong with pairs."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence

from pn2code.geometry.answers import Layout, Move, Open, Pair, Proposal
from pn2code.geometry.claims import kept_apart
from pn2code.geometry.runs import Run
from pn2code.geometry.supervised import UNKNOWN
from pn2code.geometry.sweeps import RESOLUTION
from pn2code.geometry.words import listed
from pn2code.verify.controller.control_types import CONFLUENT

MOST_MOVES = 12
"""Moves of a table that is not full."""
_ANSWERS = {"yes": "yes", "no": "NO", "unknown": "not known"}


def text(layouts: Sequence[Layout], *, full: bool) -> str:
    """The whole report."""
    return "\n".join(line for layout in layouts for line in _lines(layout, full))


def answers(layouts: Sequence[Layout]) -> Iterator[str]:
    """What is said, without the table of moves and what is behind it: of each layout both answers."""
    for layout in layouts:
        if layout.name:
            yield f"layout `{layout.name}`:"
        if layout.open:
            yield f"not all is known: {layout.open}"
        yield from (line.strip() for line in _verdicts(layout))


def reasons(layouts: Sequence[Layout]) -> Iterator[str]:
    """What is wrong or not known, where, with the runs that lead there, and what would keep it from being so."""
    for layout in layouts:
        yield from _reasons(layout)


def _lines(layout: Layout, full: bool) -> Iterator[str]:
    where = f"Layout `{layout.name}`: " if layout.name else ""
    yield (
        f"{where}{layout.states:,} states of {_whose(layout)}, {layout.situations:,} with the places of the arms; "
        f"{_many(len(layout.moves), 'move')}, {_many(layout.looked, 'pair')} of moves; {layout.seconds:.1f} s"
    )
    if layout.open:
        yield f"  not all is known: {layout.open}"
    yield ""
    yield from _table(layout, full)
    yield ""
    yield from _verdicts(layout)
    yield from _reasons(layout)
    yield ""


def _reasons(layout: Layout) -> Iterator[str]:
    for move in layout.moves:
        if move.answer != "yes":
            yield from _bad_move(move, layout.devices)
    for pair in layout.pairs:
        yield from _bad_pair(pair)
    for at in layout.open_at:
        yield from _open_at(at)
    for proposal in layout.proposals:
        yield from _proposed(proposal)


def _open_at(x: Open) -> Iterator[str]:
    yield ""
    names = " and ".join(f"`{t}`" for t in x.transitions)
    whose = " and ".join(dict.fromkeys(x.owners))
    at_once = "may be under way at once" if len(x.transitions) > 1 else "may be under way"
    yield f"not known: {names} ({whose}) {at_once}"
    yield f"  {x.says}"
    yield f"  {x.do}"
    yield from _run(x.run)


def _whose(layout: Layout) -> str:
    return "a net that does more than the cell" if layout.is_wider else "the cell"


def _verdicts(layout: Layout) -> Iterator[str]:
    yield (
        f"{_ANSWERS[layout.of_moves]:>9}  each move can be done from wherever the arm can be then, without touching "
        "what stands or itself"
    )
    resolution = f"resolution {1000.0 * RESOLUTION:g} mm"
    yield (
        f"{_ANSWERS[layout.of_pairs]:>9}  {kept_apart(devices=bool(layout.devices))} ({resolution})"
    )
    if layout.pairs_open:
        yield f"           {layout.pairs_open}"
    if layout.of_pairs == "yes" and layout.nearest is not None:
        near = layout.nearest.where
        seen = (
            f"; of what was measured {layout.nearest.between} came nearest, {_far(near.distance)}, "
            if near
            else ""
        )
        seen += "but not all was, and others may come as near as that bound" if near else ""
        who = "arms or devices" if layout.devices else "arms"
        carry = ", with what they hold or carry," if "(a " in layout.nearest.between else ""
        yield f"           two {who}{carry} keep at least {_millimetres(layout.nearest.least)} apart{seen}"


def _table(layout: Layout, full: bool) -> Iterator[str]:
    shown = sorted(layout.moves, key=_badness)
    who = "robot or device" if layout.devices else "robot"
    left = 0 if full else max(0, len(shown) - MOST_MOVES)
    rows: list[tuple[str, ...]] = [
        (who, "transition", "move", "limit", "condition", "scene >=", "itself >=", "")
    ]
    rows += [_cells(m) for m in (shown[:MOST_MOVES] if left else shown)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        yield "  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)).rstrip()
    if left:
        yield f"... and {_many(left, 'move')} with larger margins (`--full` shows all)"


def _badness(m: Move) -> tuple[int, float, str]:
    """The worst first: what cannot be done, then the least clearance and the worst conditioning, each by its scale."""
    rank = {"no": 0, "unknown": 1, "yes": 2}[m.answer]
    parts = [
        1.0 if m.scene is None else m.scene / 0.1,
        1.0 if m.itself is None else m.itself / 0.1,
        1.0 if m.limit is None else m.limit / 20.0,
        1.0 if not m.condition else 50.0 / m.condition,
    ]
    return rank, min(parts), m.transition


def _cells(m: Move) -> tuple[str, ...]:
    condition = (
        "-"
        if m.condition is None
        else "singular"
        if math.isinf(m.condition)
        else f"{m.condition:.1f}"
    )
    limit = "-" if m.limit is None else f"{m.limit:.1f} deg A{m.axis}"
    mark = "" if m.answer == "yes" else _ANSWERS[m.answer]
    return (
        m.robot,
        m.transition.removeprefix("Cell."),
        m.command,
        limit,
        condition,
        _millimetres(m.scene),
        _millimetres(m.itself),
        mark,
    )


def _millimetres(value: float | None) -> str:
    if value is None:
        return "-"
    return f"{1000.0 * value:.0f} mm" if value >= 0.01 else f"{1000.0 * value:.1f} mm"


def _bad_move(m: Move, devices: Collection[str]) -> Iterator[str]:
    yield ""
    what = f"`{m.transition}`: {m.command}" if m.transition else f"where it {m.command}"
    yield f"{_ANSWERS[m.answer]}: {m.robot}, {what}"
    if m.begins:
        yield f"  from {m.begins}" if m.robot in devices else f"  from TCP pose {m.begins}"
    yield f"  {m.problem}"
    yield from _run(m.run)


def _bad_pair(p: Pair) -> Iterator[str]:
    yield ""
    yield f"{_ANSWERS[p.answer]}: {_at_once(p)}"
    for robot, does, thing in zip(p.robots, p.doing, p.things, strict=True):
        yield f"  {thing or robot or 'part'}: {does}"
    yield f"  {p.says}"
    if p.is_held:
        yield "  let the net command that the clamp opens, and wait for the answer, before the part is taken away"
    if p.do:
        yield f"  {p.do}"
    yield from _run(p.run)
    if p.picture:
        yield f"  picture: {p.picture}"


def _at_once(p: Pair) -> str:
    """That both may be so at the same time; an arm at rest and a part stand."""
    moving = [f"`{t}`" for t in p.transitions if t]
    standing = [
        thing or (f"{robot} at rest" if robot else "a part")
        for t, robot, thing in zip(p.transitions, p.robots, p.things, strict=True)
        if not t
    ]
    if not standing:
        return f"{' and '.join(moving)} may be under way at once"
    if not moving:
        return f"{' and '.join(standing)} may stand there at once"
    return f"{moving[0]} may be under way while {standing[0].removesuffix(' at rest')} stands there"


def _run(run: Run | None) -> Iterator[str]:
    if run is None:
        return
    if not run.steps:
        yield f"  it is so at the start: {run.file or 'the run could not be written'}"
        return
    last = {1: "the last of them", 2: "the last two of them"}.get(run.under_way, "")
    which = f" ({last} under way)" if last else ""
    yield f"  a run of {_many(run.steps, 'step')} leads there{which}: {run.file or 'it could not be written'}"


_FROM_START = (
    "from the start of each run, so that no place alone keeps them apart: let HOME, or the way of the others, be "
    "elsewhere, or send it away first and wait for its answer"
)
_PUT_THERE = "where it has been put: nobody may come there until it is taken away"
NOT_TRIED = "the properties of the cell: ask `pn2code verify` when the arcs are drawn"
"""Of a proposal."""
_LATER = "where a command has left it: bring it out (such as by `move_home`) before it answers"


def _proposed(p: Proposal) -> Iterator[str]:
    yield ""
    zone = listed(f"`{t}`" for t in p.transitions)
    if p.rests:
        come = "come" if len(p.transitions) > 1 else "comes"
        who = [*dict.fromkeys(x.thing or x.robot for x in p.rests)]
        resting, verb = listed(who), "rest" if len(who) > 1 else "rests"
        yield (
            f"{zone} {come} to where {resting} {verb}"
            if zone
            else f"{resting} rest where they touch"
        )
        for rest in p.rests:
            later = _PUT_THERE if rest.thing else _LATER
            where = _FROM_START if rest.from_start else later
            yield f"  {rest.thing or rest.robot} rests at {rest.at}, {where}"
    else:
        whose = f" ({listed(p.robots)})" if len(p.robots) > 1 else ""
        yield f"{zone}{whose} share a zone that the net does not guard"
    for x in p.served:
        during, but = (listed((f"`{t}`" for t in ts), "or") for ts in (x.during, x.but))
        yield f"  the token of `{x.place}` is away whenever {during} is under way, but not always while {but} is"
    if not p.works:
        yield f"  {p.says}"
        return
    also = ""
    if p.is_there:
        yield f"  proposal: the token `()` of `{p.name}`, a place that is there"
        also = "also "
    else:
        yield f"  proposal: a place `{p.name}` of the supervisor with one token `()`"
    yield f"    {also}taken by {_each(p.takes, p.takes_when, 'if')}"
    yield f"    {also}given back by {_each(p.gives, p.gives_when, 'if')}"
    if any((*p.takes_when, *p.gives_when)):
        yield "    (on these arcs: `if CONDITION then 1`() else empty`)"
    yield f"    arcs to draw: {', '.join(_arcs(p))}"
    yield f"    (it is empty while {_each(p.while_, p.while_with, 'with', 'or')} is marked)"
    yield f"  {p.says}"
    yield from _supervised(p.refused)
    yield f"  not tried: {NOT_TRIED}"


def _supervised(refused: str) -> Iterator[str]:
    """What `generate` would say of the supervisor."""
    if not refused:
        yield "  `generate` objects to nothing in its supervisor to which it does not object without the place"
        return
    if refused == UNKNOWN:
        yield f"  {refused}"
        return
    yield f"  but `generate` refuses the supervisor with it: {refused}"
    if refused.startswith(f"{CONFLUENT}:"):
        yield (
            "    who takes the token first is then decided by the order of firings: if that may be so, write "
            '`order = "documented"` in [supervisor]; or give the transitions different priorities'
        )


def _arcs(p: Proposal) -> Iterator[str]:
    """Of the place that is proposed, each with the transition that it leads to or comes from."""
    yield from (f"`{p.name}` -> `{t}`" for t in p.takes)
    yield from (f"`{t}` -> `{p.name}`" for t in p.gives)


def _far(distance: float) -> str:
    return f"{1000.0 * distance:.0f} mm"


def _each(names: Sequence[str], cases: Sequence[str], word: str, last: str = "and") -> str:
    told = (f"`{n}`{f' {word} `{c}`' if c else ''}" for n, c in zip(names, cases, strict=True))
    return listed(told, last)


def _many(n: int, what: str) -> str:
    return f"{n:,} {what}{'s' * (n != 1)}"
