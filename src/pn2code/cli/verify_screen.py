"""What `pn2code verify` prints: one screen with the verdict, or with `--full` all that is known.

print(screen(said))      # at most about 40 lines: sizes, what failed and the way there, the verdict
print(full(said))        # the report of CPN Tools, all answers, all runs step by step
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import islice
from pathlib import Path

from pn2code.base.deadline import TimeIsOverError
from pn2code.base.frozen import frozen
from pn2code.cell.partition import SUPERVISOR, Partition
from pn2code.net.engine_names import EngineNames
from pn2code.net.flat import ArcKind, FlatNet, Role
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.report import element
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.trace.script import Trace as Recorded
from pn2code.trace.script import TraceRefusedError
from pn2code.verdict import channel_model
from pn2code.verdict.whole import Said
from pn2code.verify.answers import basis, outcome, why_disabled
from pn2code.verify.answers.outcome import does, error_text, good_of, may_stop
from pn2code.verify.answers.path import Step, play, steps, text
from pn2code.verify.answers.properties import kind as kind_of
from pn2code.verify.answers.waiting import Scripts
from pn2code.verify.answers.who_waits import lacks_messages_alone, supervisor_waits
from pn2code.verify.controller.control_types import TITLES
from pn2code.verify.controller.premises import in_space
from pn2code.verify.exploring.result import Exploration, Known, Trace
from pn2code.verify.report import control_text
from pn2code.verify.report.properties_text import said as said_of
from pn2code.verify.report.properties_text import told
from pn2code.verify.report.text import bounded_places, report

MOST_LINES = 40
"""Of one screen."""
SHOWN_STEPS = 40
"""Of a longer run only the first steps are printed with `--full`."""
LAST_STEPS = 8
"""Of the run that is told on one screen the last ones: what they lead to is what matters."""
LEAST_STEPS = 3
"""Of it are always there, whatever else the screen has to say."""
MOST_STEPS = 3_000
"""A longer run is not played again: its last steps are shown as they are recorded."""
LEAST_WHY = 6
"""Lines that tell why nothing can occur after it, if there is so much to tell."""
LEAST_WAY = 12
"""Lines that a run gets before further failures do: its head, steps, and why it goes on no more."""
MOST_ITEMS = 8
"""Failures and open questions that have lines of their own on one screen."""
MOST_OF_ITEM = 4
"""Lines of each of them."""
MOST_NAMES = 6
MOST_NAMES_LINES = 4
"""Lines with the names of failures of which there is no room to say more."""
MOST_DIFFERENCES = 4
"""Of the cell as it runs from the closed net, on one screen."""
_WIDTH = 110
_NAME = 21


@frozen
class _Item:
    """One answer: what was asked, how it came out ("good", "bad", "open"), and what there is to say."""

    name: str
    kind: str
    says: str
    file: Path | None = None
    lines: tuple[str, ...] = ()
    loop: int | None = None
    is_deadlock: bool = False


# --- everything ----------------------------------------------------------------------------------


def full(said: Said) -> str:
    """The report, then all runs."""
    net, found = said.net, said.found
    parts = [
        report(net, found, None, said.answers, said.control, said.counts).rstrip(),
        _figures(found),
        *(f"Perhaps {line}" for line in _growing(net, found)),
    ]
    with suppress(TimeIsOverError), said.deadline.enforced():
        for a in said.answers:
            if a.evidence is not None:
                is_deadlock, e = a.about.kind == "deadlock", a.evidence
                end = [] if e.loop is not None else _end(said, e.trace, is_deadlock)
                parts.append("\n".join([told(net, said.storage, a, SHOWN_STEPS), *end]))
        if said.control is not None:
            texts = control_text.told(net, said.storage, said.control, most=SHOWN_STEPS)
            for (check, run, _), text_ in zip(control_text.runs(said.control), texts, strict=True):
                assert run.file is not None
                is_deadlock = check.why == "deadlock"
                end = [] if run.loop is not None else _end(said, run.file, is_deadlock)
                parts.append("\n".join([text_, *end]))
        for trace in found.traces:
            parts.append(_told(said, trace, f"the dead marking {trace.node}"))
        if found.error_trace is not None:
            goal = f"marking {found.error_trace.node}, in which an exception is raised"
            path = _told(said, found.error_trace, goal)
            parts.append(f"{path}\n  then {error_text(net, found)}")
        orders = found.orders.raised if found.orders is not None else None
        if orders is not None and orders.trace is not None:
            path = _told(said, orders.trace, f"marking {orders.node}, where CPN Tools may stop")
            parts.append(f"{path}\n  then `{orders.text}` {does(orders)}")
    if said.channel_model:
        parts.append(channel_model.told(said.channel_model))
    timed = "\n".join(_durations(said)).strip("\n")
    return "\n\n\n".join([*parts, *([timed] if timed else ()), ending(said)])


def _told(said: Said, trace: Trace, goal: str) -> str:
    head = f"Shortest run to {goal}: {trace.steps} steps, {trace.file}"
    try:
        shown = steps(said.net, said.storage, trace.file, most=SHOWN_STEPS)
    except (TraceRefusedError, GameError, OSError) as problem:
        return f"{head}\n  (it cannot be shown: {problem})"
    end = [] if trace not in said.found.traces else _end(said, trace.file, False)
    return "\n".join([head, *([text(shown, trace.steps)] if trace.steps else ()), *end])


def _end(said: Said, file: Path, is_deadlock: bool) -> list[str]:
    """Why nothing can occur after a run; nothing where something can, or the run is too long to be played."""
    try:
        game, played = play(said.net, said.storage, file)
        if sum(1 for _ in islice(played, MOST_STEPS)) == MOST_STEPS:
            return []
        return _after(_why_disabled(said, game, is_deadlock))
    except (TraceRefusedError, GameError, OSError):
        return []  # the run is told above, with what is wrong with it


def _after(why: Sequence[str]) -> list[str]:
    return ["  After that nothing can occur:", *(f"    {x}" for x in why)] if why else []


def _why_disabled(said: Said, game: Game, is_deadlock: bool, most: int | None = None) -> list[str]:
    """Which transitions are nearest to occurring and what they lack, then what each program waits for.

    A transition that lacks messages alone is not named again where it is said what its program waits for.
    A cell may be in a deadlock where its closed net can go on.

    Args:
        most: lines; where there are more, some of the programs are only counted, but the transitions are named: where
            every program waits for a message, it is they that tell which token somebody has forgotten.

    Raises:
        GameError: an inscription raises an exception.
    """
    running = said.control.running if said.control is not None else None
    if running is None or said.config is None:
        return why_disabled.reasons(game)[:most]
    if game.advance() and not is_deadlock:
        return []
    partition = running.partition
    stand = Scripts.of(partition, said.config).standing(game)
    supervisor = supervisor_waits(game, partition)
    if supervisor:
        stand[0] = supervisor
    waiting = {
        t.index
        for t, owner in zip(game.net.transitions, partition.transition_owner, strict=True)
        if owner in stand and lacks_messages_alone(game, partition, t)
    }
    others = [t for t in game.net.transitions if t.index not in waiting and t.role is Role.OWN]
    programs, near = [stand[k] for k in sorted(stand)], why_disabled.reasons(game, others)
    near += _other_end(game, partition)
    room = len(programs) if most is None else max(most - len(near), 1)
    if len(programs) > room:
        rest = len(programs) - max(room - 1, 1)
        programs[-rest:] = [
            f"And {_count_of(rest, 'program')} more: `--full` says what each waits for."
        ]
    return [*near, *programs]


def _other_end(game: Game, partition: Partition) -> list[str]:
    """The place in which the supervisor has ended, where nobody takes a token away, but which is not said to be final.

    Nothing where there is no one such place, or the cell has come to its end.
    """

    def holds(place: int) -> bool:
        return any(True for _ in game.marking.places[place])

    if any(holds(p) for p in partition.final_places):
        return []
    net, first = game.net, game.own_initial_marking.places
    used = {a.place for t in net.transitions for a in t.arcs if a.kind is not ArcKind.OUTPUT}
    put = {
        a.place
        for t, owner in zip(net.transitions, partition.transition_owner, strict=True)
        if owner == SUPERVISOR
        for a in t.arcs
    }
    ends = [p for p in put - used if holds(p) and not any(True for _ in first[p])]
    if len(ends) != 1:
        return []
    return [
        f"Nothing takes the token of `{net.places[ends[0]].short}` away: if the cell may end there, add this place to "
        "`final` in [supervisor] of cell.toml."
    ]


def _figures(found: Exploration) -> str:
    partial = "" if found.complete else " TRUNCATED, see above."
    if found.why == "decided":
        partial = " Ended early, see above."
    return (
        f"{found.nodes:,} markings and {found.arcs:,} arcs{' of the reduced space' * found.is_reduced} "
        f"in {found.seconds:.2f} s "
        f"({found.states_per_second:,.0f} markings/s, {found.threads} thread{'s' * (found.threads > 1)}), "
        f"{found.bytes_per_state:.1f} bytes a marking, {found.peak_mib:.0f} MiB at most; "
        f"compiled in {found.compile_seconds:.1f} s.{partial}"
    )


# --- one screen ----------------------------------------------------------------------------------


def screen(said: Said) -> str:
    """The verdict, sizes, what failed, and the way there."""
    closed = ", as a closed net" if said.control is not None else ""
    lines = [f"State space of {said.net.file}{closed}", ""]
    if not said.found.complete:
        partial = f"PARTIAL: {outcome.header(said.net, said.found, said.counts)}"
        lines += [*textwrap.wrap(partial, _WIDTH), ""]
    lines += _sizes(said)
    crowd = said.control.crowd if said.control is not None else None
    if crowd is not None:
        lines += (x for name, what in crowd.lines() for x in _row(name, what))
    remarks = list(_as_it_runs(said))
    items = tuple(_items(said))
    wrong = sorted((i for i in items if i.kind != "good"), key=lambda i: i.kind != "bad")
    counts = ["", *_counts(said)] if items else []
    premises, timed = list(_premises(said)), list(_durations(said))
    end = ["", *textwrap.wrap(_MORE, _WIDTH)]
    for note in said.notes:
        end += textwrap.wrap(f"{_NOTE}{note}", _WIDTH, subsequent_indent="  ")
    end += textwrap.wrap(closing(said), _WIDTH)
    has_run = any(i.file is not None or i.lines for i in wrong) or said.found.error_trace
    kept = LEAST_WAY + 1 if has_run else 0
    room = MOST_LINES - len(lines) - len(counts) - len(timed) - len(end) - 1 - kept
    if any(i.kind == "bad" for i in wrong):
        # What failed comes before what the other answers rest on, and before remarks.
        needed = len(_wrong(wrong, MOST_LINES))
        if needed > room - len(premises) - len(remarks):
            premises = list(_counted_premises(said))
        if needed > room - len(premises) - len(remarks):
            remarks = list(_counted_remarks(said))
    room -= len(premises) + len(remarks)
    lines += [*remarks, *counts, *premises, *timed]
    if wrong:
        lines += ["", *_wrong(wrong, room)]
    room = MOST_LINES - len(lines) - len(end) - 1
    path = _path_lines(said, wrong, room)
    if path:
        lines += ["", *path]
    return "\n".join([*lines, *end])


def _durations(said: Said) -> Iterator[str]:
    for i, line in enumerate(said.durations.lines if said.durations is not None else ()):
        yield from ([""] if i == 0 else [])
        yield from _row("Durations" if i == 0 else "", line)


_MORE = "`--full` prints the whole report, `--report FILE` writes it (.html or .txt)."


def _row(name: str, what: str) -> Iterator[str]:
    wrapped = textwrap.wrap(what, _WIDTH - _NAME - 2) or [""]
    yield f"  {name:<{_NAME}}{wrapped[0]}"
    yield from (f"  {'':{_NAME}}{line}" for line in wrapped[1:])


def _sizes(said: Said) -> Iterator[str]:
    net, found = said.net, said.found
    if found.known is not None:
        yield from _of_counted(said, found.known)
        return
    for name, what in basis.complete(found):
        more = ""
        if name == "Markings":
            more = f", in {found.seconds:.2f} s; compiled in {found.compile_seconds:.1f} s"
        if name == "Components" and found.graph is not None:
            more = f": {found.graph.scc_nodes:,}"
        yield from _row(name, what + more)
    if found.approximation is not None:
        kind, omitted = found.approximation["kind"], found.approximation["omission_probability"]
        yield from _row(
            "Approximate",
            f"{kind}: the probability that a marking was omitted is about {omitted:.2g}",
        )
    if found.reductions:
        yield from _row("Reduced by", ", ".join(found.reductions))
    yield from _row("Dead markings", _dead(found))
    if found.graph is not None:
        every = found.graph.home_count == found.nodes
        yield from _row("Home markings", "all" if every else f"{found.graph.home_count:,}")
    if found.knows_dead_transitions:
        names = EngineNames(net)
        dead = [names.transition(i) for i in found.dead_transitions()]
        name = "Dead transitions" if found.seen.markings else "Transitions not seen"
        yield from _row(name, _listed(dead, len(net.transitions)))
    if found.graph is not None:
        live = len(found.live_transitions())
        yield from _row("Live transitions", f"{live} of {len(net.transitions)}")
    if found.bounds is not None:
        yield from _row("Bounds", _most(net, found))
    yield from (x for line in _growing(net, found) for x in _row("Grows, perhaps", line))


def _of_counted(said: Said, known: Known) -> Iterator[str]:
    """Of a closed net whose markings were not counted to the end."""
    net, found = said.net, said.found
    more = f"{known.nodes:,} states stand for all of them, {known.seconds:.2f} s"
    yield from _row("Markings", f"more than {found.nodes:,}, {found.seconds:.2f} s; {more}")
    ends = "each has a token in a final place" if known.ends else "not known whether each is an end"
    yield from _row("Dead markings", ends)
    names = EngineNames(net)
    never = [names.transition(i) for i in known.never]
    yield from _row("Dead transitions", _listed(never, len(net.transitions)))
    others = [names.transition(i) for i in found.dead_transitions() if i not in known.never]
    if others:
        yield from _row("Transitions not seen", _listed(others, len(net.transitions)))


def _growing(net: FlatNet, found: Exploration) -> Iterator[str]:
    """What may be the reason that there is no end of markings."""
    growing = found.growing()
    is_said = found.covering is not None and not found.covering.grows
    if growing is not None and not is_said:
        place, count = net.places[growing[0]], growing[1]
        what = "a number, text or list in a token may grow for ever"
        so = "so that there is no end of markings; is there a guard that limits it?"
        if place.colset.timed and "time" in found.reductions:
            what += ", or long delays are gone through in small steps"
            so = "so that there are very many markings, or no end of them"
        elif place.colset.timed:
            what += ", or the time of a token does"
            so = (
                "so that there is no end of markings (`--reduce time`, where it is possible, counts those that differ "
                "in the time alone as one)"
            )
        yield (
            f"place `{place.name}` has held {count:,} different multi-sets of tokens: {what}, {so}"
        )


def _as_it_runs(said: Said) -> Iterator[str]:
    """Which of the sizes above, of the closed net, are others in the cell as it runs: a remark on them, no failure."""
    control = said.control
    differing = [] if control is None else [*control_text.differences(control)]
    if control is None or not differing:
        return
    yield ""
    yield "In the cell as it runs, other than in the closed net (no failure; `--full` says why):"
    for title, what in differing[:MOST_DIFFERENCES]:
        yield from _row(title, what)
    if len(differing) > MOST_DIFFERENCES:
        yield from _row("", f"and {len(differing) - MOST_DIFFERENCES} more")
    never, only = control.other_dead()
    if said.found.knows_dead_transitions and (never or only):
        names = EngineNames(said.net)
        both = [names.transition(i) for i in said.found.dead_transitions() if i not in only]
        yield from _row("Dead in both", _listed(both, len(said.net.transitions)))


def _counted_remarks(said: Said) -> Iterator[str]:
    """In place of them, where there is no room."""
    count = 0 if said.control is None else len([*control_text.differences(said.control)])
    if count:
        does = "differs" if count == 1 else "differ"
        yield ""
        yield (
            f"In the cell as it runs {_count_of(count, 'size')} {does} from the closed net's (no failure; `--full` "
            "says which)."
        )


def _dead(found: Exploration) -> str:
    if not found.dead_count:
        return "none" if found.seen.markings else "none was seen"
    first = ", ".join(map(str, found.dead[:MOST_NAMES]))
    more = ", ..." if found.dead_count > len(found.dead[:MOST_NAMES]) else ""
    return f"{found.dead_count:,}" + (
        f" (node{'s' * (found.dead_count != 1)} {first}{more})" if first else ""
    )


def _listed(names: Sequence[str], of: int) -> str:
    if not names:
        return "none"
    if len(names) == of:
        return f"all {of}"
    more = f", and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return f"{len(names)}: {', '.join(names[:MOST_NAMES])}{more}"


def _most(net: FlatNet, found: Exploration) -> str:
    """The places that hold most tokens at a time."""
    assert found.bounds is not None
    rows = [(name, found.bounds[place.index].upper) for name, place in bounded_places(net)]
    most = max((upper for _, upper in rows), default=0)
    names = [name for name, upper in rows if upper == most]
    is_long = len(names) > MOST_NAMES // 2
    where = f"{len(names)} of {len(rows)} places" if is_long else ", ".join(names)
    seen = "" if found.seen.markings else "seen so far: "
    return f"{seen}at most {most:,} token{'s' * (most != 1)} in a place (in {where})"


def _items(said: Said) -> Iterator[_Item]:
    """What the user has asked comes before what is asked of every cell."""
    for a in said.answers:
        kind = kind_of(a)
        says = f"not known: {a.why}" if kind == "open" else said_of(a)
        says += f" [the closed net: {a.net}]" if a.net is not None else ""
        e = a.evidence
        file, loop = (None, None) if e is None else (e.trace, e.loop)
        is_deadlock = a.about.kind == "deadlock"
        yield _Item(a.about.name, kind, says, file, loop=loop, is_deadlock=is_deadlock)
    for check in said.control.checks if said.control else ():
        run = next((run for run in check.evidence if run.file is not None), None)
        loop = None if run is None else run.loop
        file = None if run is None else run.file
        is_deadlock = check.why == "deadlock"
        yield _Item(
            TITLES[check.name], check.kind, check.says, file, loop=loop, is_deadlock=is_deadlock
        )
    for m in said.channel_model:
        kind = {"yes": "good", "no": "bad"}.get(m.answer, "open")
        lines = next((tuple(e.lines) for e in m.evidence), ())
        says = {"open": f"not known: {m.why}", "bad": channel_model.shown(m)}.get(kind, m.says)
        yield _Item(f"{m.check[:1].upper()}{m.check[1:]}", kind, says, None, lines)


_TITLES = ("Properties", "Controller checks", "Shared files")


def _groups(said: Said) -> tuple[tuple[str, Sequence[str], Sequence[str | None]], ...]:
    """For each kind of question: its name, how the answers came out, what they rest on."""
    items = list(_items(said))
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
}


def _counts(said: Said) -> Iterator[str]:
    for title, kinds, rests in _groups(said):
        if kinds:
            yield from textwrap.wrap(
                f"{title}: {_count(kinds)}{_rest(rests)}.", _WIDTH, subsequent_indent="  "
            )


def _assumed(said: Said) -> list[str]:
    """What answers rest on that no state shows."""
    checks = said.control.checks if said.control else ()
    return [
        *dict.fromkeys(
            [*(x for c in checks for x in c.assumes), *(x for a in said.answers for x in a.assumes)]
        )
    ]


def _premises(said: Said) -> Iterator[str]:
    if found := _assumed(said):
        yield from textwrap.wrap(f"Assumed: {'; '.join(found)}.", _WIDTH, subsequent_indent="  ")


def _counted_premises(said: Said) -> Iterator[str]:
    """In place of them, where there is no room."""
    if found := _assumed(said):
        yield f"Assumed: {_count_of(len(found), 'premise')} of the answers above; `--full` has them."


def _count(kinds: Sequence[str]) -> str:
    good, bad, is_open = (kinds.count(kind) for kind in ("good", "bad", "open"))
    text = good_of(good, len(kinds))
    text += f", {bad} {'are' if bad != 1 else 'is'} not" if bad else ""
    return text + (f", {is_open} {'are' if is_open != 1 else 'is'} not known" if is_open else "")


def _rest(rests: Sequence[str | None]) -> str:
    counted = [f"{says} ({rests.count(word)})" for word, says in _RESTS.items() if word in rests]
    return f"; the answers rest on {', '.join(counted)}" if counted else ""


def _wrong(wrong: Sequence[_Item], room: int) -> list[str]:
    """Failures, then open questions: as many as there is room for, the first in any case; of the others the names."""
    lines: list[str] = []
    for number, item in enumerate(wrong):
        mark = {"bad": "NO", "open": "?"}[item.kind]
        run = f" (run: {item.file})" if item.file is not None else ""
        wrapped = textwrap.wrap(
            f"{mark:<3}{item.name}: {item.says}{run}",
            _WIDTH,
            subsequent_indent="   ",
            break_long_words=False,
            break_on_hyphens=False,
        )[:MOST_OF_ITEM]
        is_full = len(lines) + len(wrapped) + len(_names_of(wrong[number + 1 :])) > room
        if number and (number == MOST_ITEMS or is_full):
            return [*lines, *_names_of(wrong[number:])]
        lines += wrapped
    return lines


def _names_of(wrong: Sequence[_Item]) -> list[str]:
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
                _WIDTH,
                initial_indent="   ",
                subsequent_indent="     ",
                max_lines=MOST_NAMES_LINES,
                placeholder=" ...",
            )
    return lines


def _path_lines(said: Said, wrong: Sequence[_Item], room: int) -> list[str]:
    """The last steps of one run: of the exception, of the first failure, or to the first dead marking."""
    found = said.found
    # Where there is no room for the least of a run, the screen is longer.
    most = max(min(LAST_STEPS, room - 2), LEAST_STEPS)
    if found.error_trace is not None:
        lines = _last(said, found.error_trace.file, "to the exception", most - 1)
        return [*lines, f"  then {error_text(said.net, found)}"]
    orders = found.orders.raised if found.orders is not None and may_stop(found) else None
    if orders is not None and orders.trace is not None and all(i.kind != "bad" for i in wrong):
        lines = _last(said, orders.trace.file, "to where CPN Tools may stop", most - 1)
        return [
            *lines,
            f"  then `{orders.text}` {does(orders)}",
        ]
    for item in wrong:
        if item.file is not None:
            what = f"for `{item.name}`"
            return _last(said, item.file, what, most, item.loop, is_deadlock=item.is_deadlock)
        if item.lines:
            before = len(item.lines) - most
            cut = [f"  ... {_count_of(before, 'line')} before; `--full` prints them all"]
            shown = [f"  {x}" for x in item.lines[-most:]]
            return [f"The run for `{item.name}`:", *(cut if before > 0 else ()), *shown]
    if found.traces and not wrong and not said.answers and said.control is None:
        trace = found.traces[0]
        return _last(said, trace.file, f"to the dead marking {trace.node}", most)
    return []


def _count_of(count: int, what: str) -> str:
    return f"{count} {what}{'s' * (count != 1)}"


def _last(
    said: Said,
    file: Path,
    goal: str,
    most: int,
    loop: int | None = None,
    *,
    is_deadlock: bool = False,
) -> list[str]:
    """The last steps of a run, at least `LEAST_STEPS`, and why nothing can occur then: about `most` lines."""
    why: list[str] = []
    try:
        with said.deadline.enforced():
            game, played = play(said.net, said.storage, file)
            shown = [_step(step) for step, _ in islice(played, MOST_STEPS)]
            if len(shown) == MOST_STEPS:
                shown = _recorded(said, file)
            elif loop is None:
                with suppress(GameError):  # an inscription raises an exception there
                    why = _why_disabled(
                        said, game, is_deadlock, max(most - LEAST_STEPS - 1, LEAST_WHY)
                    )
    except TimeIsOverError:
        return [f"The run {goal} is in {file}; there was no time to show it."]
    except (TraceRefusedError, GameError, OSError) as problem:
        return [f"The run {goal} is in {file}; it cannot be shown: {problem}"]
    lines = [f"The run {goal}, {_count_of(len(shown), 'step')}, {file}:"]
    least = min(LEAST_STEPS, len(shown))
    after = [
        part
        for x in _after(why)
        for part in textwrap.wrap(
            x, _WIDTH, subsequent_indent="      ", break_long_words=False, break_on_hyphens=False
        )
    ]
    last = max(most - len(after), least)
    if len(shown) > last:
        lines.append(f"  ... {_count_of(len(shown) - last, 'step')} before")
    lines += shown[-last:] if last else ()
    lines += after
    if loop is not None and loop < len(shown):
        lines.append(f"  The steps from step {loop + 1} on are repeated for ever.")
    return lines if len(lines) > 1 else []


def _step(step: Step) -> str:
    return _line(step.number, step.transition, step.binding)


def _line(number: int, transition: str, binding: Mapping[str, str]) -> str:
    values = ", ".join(f"{k} = {v}" for k, v in binding.items())
    return _cut(f"  {number:>3}  {transition}" + (f"  ({values})" if values else ""))


def _recorded(said: Said, file: Path) -> list[str]:
    """The steps of a run as the file has them, without playing it."""
    found = []
    for number, step in enumerate(Recorded.open(file, said.net, is_shown=True).steps(), 1):
        played = element(said.net, BindingElement.make(step.transition, step.bound))
        found.append(_line(number, step.transition.name, played["binding"]))
    return found


def _cut(line: str) -> str:
    return line if len(line) <= _WIDTH else f"{line[: _WIDTH - 3]}..."


# --- the verdict ---------------------------------------------------------------------------------

_NOTE = "Note: "


def ending(said: Said) -> str:
    """The last lines: what a yes leaves to be remarked, then the verdict."""
    return "\n".join([*(f"{_NOTE}{x}" for x in said.notes), closing(said)])


def closing(said: Said) -> str:
    """The last line; a yes about a cell names what it is not about."""
    text_ = outcome.closing(said.net, said.found, said.counts)
    things = in_space(said.config) if said.config is not None and said.control is not None else ()
    if not things or said.verdict != "yes":
        return text_
    listed = " and ".join(filter(None, (", ".join(things[:-1]), things[-1])))
    return f"{text_.removesuffix('.')} ({listed} in space: `check --geometry`)."
