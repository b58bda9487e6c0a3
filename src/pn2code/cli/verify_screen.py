"""What `pn2code verify` prints: one screen with the verdict, or with `--full` all that is known.

print(screen(said))      # at most about 40 lines: sizes, what failed and the way there, the verdict
print(full(said))        # the report of CPN Tools, all answers, all runs step by step
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from pn2code.base.deadline import TimeIsOverError
from pn2code.cell.partition import Partition
from pn2code.net.engine_names import EngineNames
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.token_game import GameError
from pn2code.trace.script import TraceRefusedError
from pn2code.verdict import channel_model
from pn2code.verdict.whole import Said
from pn2code.verify.answers import basis, ending, outcome
from pn2code.verify.answers.outcome import error_text
from pn2code.verify.answers.path import play, steps, text
from pn2code.verify.answers.properties import kind as kind_of
from pn2code.verify.controller.control_types import TITLES
from pn2code.verify.exploring.result import Exploration, Trace
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
LEAST_STEPS = 2
"""So many are told, however much there is to say of what comes after them."""
MOST_STEPS = ending.MOST_STEPS
"""A longer run is not played again to show its last steps."""
MOST_ITEMS = 8
"""Failures and open questions that have lines of their own on one screen."""
MOST_NAMES = 6
MOST_DIFFERENCES = 4
"""Of the cell as it runs from the closed net, on one screen."""
_WIDTH = 110
_NAME = 21


@dataclass(frozen=True, slots=True)
class _Item:
    """One answer: what was asked, how it came out ("good", "bad", "open"), and what there is to say."""

    name: str
    kind: str
    says: str
    file: Path | None = None
    lines: tuple[str, ...] = ()
    loop: int | None = None


# --- everything ----------------------------------------------------------------------------------


def full(said: Said) -> str:
    """The report, then all runs."""
    net, found = said.net, said.found
    parts = [
        report(net, found, None, said.answers, said.control, said.counts).rstrip(),
        _figures(found),
    ]
    with suppress(TimeIsOverError), said.deadline.enforced():
        if said.control is not None:
            parts += control_text.told(net, said.storage, said.control, most=SHOWN_STEPS)
        parts += [
            told(net, said.storage, a, SHOWN_STEPS) for a in said.answers if a.evidence is not None
        ]
        for trace in found.traces:
            parts.append(_told(said, trace, f"the dead marking {trace.node}"))
        if found.error_trace is not None:
            goal = f"marking {found.error_trace.node}, in which an exception is raised"
            way = _told(said, found.error_trace, goal)
            parts.append(f"{way}\n  then {error_text(net, found)}")
    if said.medium:
        parts.append(channel_model.told(said.medium))
    return "\n\n\n".join([*parts, closing(said)])


def _told(said: Said, trace: Trace, goal: str) -> str:
    head = f"Shortest run to {goal}: {trace.steps} steps, {trace.file}"
    try:
        shown = steps(said.net, said.storage, trace.file, most=SHOWN_STEPS)
    except (TraceRefusedError, GameError, OSError) as problem:
        return f"{head}\n  (it cannot be shown: {problem})"
    way = [text(shown, trace.steps)] if trace.steps else []
    return "\n".join(
        [head, *way, *ending.after(said.net, said.storage, trace.file, _partition(said))]
    )


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
    lines += _as_it_runs(said)
    items = tuple(_items(said))
    wrong = sorted((i for i in items if i.kind != "good"), key=lambda i: i.kind != "bad")
    if items:
        lines += ["", *_counts(said), *_premises(said)]
    if wrong:
        lines += ["", *_wrong(wrong)]
    end = ["", *textwrap.wrap(_MORE, _WIDTH), *textwrap.wrap(closing(said), _WIDTH)]
    room = MOST_LINES - len(lines) - len(end) - 1
    way = _way(said, wrong, room)
    if way:
        lines += ["", *way]
    return "\n".join([*lines, *end])


_MORE = "`--full` prints the whole report, `--report FILE` writes it (.html or .txt)."


def _row(name: str, what: str) -> Iterator[str]:
    wrapped = textwrap.wrap(what, _WIDTH - _NAME - 2) or [""]
    yield f"  {name:<{_NAME}}{wrapped[0]}"
    yield from (f"  {'':{_NAME}}{line}" for line in wrapped[1:])


def _sizes(said: Said) -> Iterator[str]:
    net, found = said.net, said.found
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


def _as_it_runs(said: Said) -> Iterator[str]:
    """Where the cell as it runs differs from what stands above."""
    control = said.control
    differing = [] if control is None else [*control_text.differences(control)]
    if control is None or not differing:
        return
    yield ""
    yield "The cell as it runs differs from the closed net:"
    for title, what in differing[:MOST_DIFFERENCES]:
        yield from _row(title, what)
    if len(differing) > MOST_DIFFERENCES:
        yield from _row("", f"and {len(differing) - MOST_DIFFERENCES} more")
    yield from _row("Reason", control_text.why_differs(control))


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
    for check in said.control.checks if said.control else ():
        run = next((run for run in check.evidence if run.file is not None), None)
        loop = None if run is None else run.loop
        yield _Item(
            TITLES[check.name], check.kind, check.says, None if run is None else run.file, loop=loop
        )
    for m in said.medium:
        kind = {"yes": "good", "no": "bad"}.get(m.answer, "open")
        lines = next((tuple(e.lines) for e in m.evidence), ())
        says = {"open": f"not known: {m.why}", "bad": channel_model.shown(m)}.get(kind, m.says)
        yield _Item(f"{m.check[:1].upper()}{m.check[1:]}", kind, says, None, lines)
    for a in said.answers:
        kind = kind_of(a)
        says = f"not known: {a.why}" if kind == "open" else said_of(a)
        says += f" [the closed net: {a.net}]" if a.net is not None else ""
        e = a.evidence
        file, loop = (None, None) if e is None else (e.trace, e.loop)
        yield _Item(a.about.name, kind, says, file, loop=loop)


_TITLES = ("Controller checks", "Shared files", "Properties")


def _groups(said: Said) -> tuple[tuple[str, Sequence[str], Sequence[str | None]], ...]:
    """For each kind of question: its name, how the answers came out, what they rest on."""
    items = list(_items(said))
    checks = said.control.checks if said.control else ()
    first, second = len(checks), len(checks) + len(said.medium)
    kinds = [i.kind for i in items]
    return (
        (_TITLES[0], kinds[:first], [c.rests_on for c in checks]),
        (_TITLES[1], kinds[first:second], [m.rests_on for m in said.medium]),
        (_TITLES[2], kinds[second:], [a.rests_on for a in said.answers]),
    )


_RESTS = {
    basis.MARKINGS: "all markings",
    basis.ARCS: "all markings and arcs",
    basis.COMPONENTS: "all components",
    basis.MARKING: "a marking that was reached",
    basis.RUN: "a run",
    basis.NET: "the net itself",
}


def _counts(said: Said) -> Iterator[str]:
    for title, kinds, rests in _groups(said):
        if kinds:
            yield from textwrap.wrap(
                f"{title}: {_count(kinds)}{_rest(rests)}.", _WIDTH, subsequent_indent="  "
            )


def _premises(said: Said) -> Iterator[str]:
    """What answers rest on that no state shows."""
    checks = said.control.checks if said.control else ()
    found = dict.fromkeys(
        [*(x for c in checks for x in c.assumes), *(x for a in said.answers for x in a.assumes)]
    )
    if found:
        yield from textwrap.wrap(f"Assumed: {'; '.join(found)}.", _WIDTH, subsequent_indent="  ")


def _count(kinds: Sequence[str]) -> str:
    good, bad, is_open = (kinds.count(kind) for kind in ("good", "bad", "open"))
    text = f"{good} of {len(kinds)} are as they should be"
    text += f", {bad} {'are' if bad != 1 else 'is'} not" if bad else ""
    return text + (f", {is_open} {'are' if is_open != 1 else 'is'} not known" if is_open else "")


def _rest(rests: Sequence[str | None]) -> str:
    counted = [f"{says} ({rests.count(word)})" for word, says in _RESTS.items() if word in rests]
    return f"; the answers rest on {', '.join(counted)}" if counted else ""


def _wrong(wrong: Sequence[_Item]) -> Iterator[str]:
    for item in wrong[:MOST_ITEMS]:
        mark = {"bad": "NO", "open": "?"}[item.kind]
        run = f" (run: {item.file})" if item.file is not None else ""
        yield from textwrap.wrap(
            f"{mark:<3}{item.name}: {item.says}{run}",
            _WIDTH,
            subsequent_indent="   ",
            break_long_words=False,
            break_on_hyphens=False,
        )[:3]
    if len(wrong) > MOST_ITEMS:
        yield f"   and {len(wrong) - MOST_ITEMS} more"


def _way(said: Said, wrong: Sequence[_Item], room: int) -> list[str]:
    """The last steps of one run: of the exception, of the first failure, or to the first dead marking."""
    found = said.found
    if room < 3:
        return []
    most = min(LAST_STEPS, room - 2)
    if found.error_trace is not None:
        lines = _last(said, found.error_trace.file, "to the exception", most - 1)
        return [*lines, f"  then {error_text(said.net, found)}"]
    for item in wrong:
        if item.file is not None:
            return _last(said, item.file, f"for `{item.name}`", most, item.loop)
        if item.lines:
            before = len(item.lines) - most
            cut = _earlier(before)
            return [f"The run for `{item.name}`:", *cut, *(f"  {x}" for x in item.lines[-most:])]
    if found.traces and not wrong and not said.answers and said.control is None:
        trace = found.traces[0]
        return _last(said, trace.file, f"to the dead marking {trace.node}", most)
    return []


def _earlier(count: int) -> list[str]:
    return [f"  ... {count} step{'s' * (count != 1)} before"] if count > 0 else []


def _last(said: Said, file: Path, goal: str, most: int, loop: int | None = None) -> list[str]:
    why: list[str] = []
    try:
        with said.deadline.enforced():
            game, played = play(said.net, said.storage, file)
            shown = [step for step, _ in islice(played, MOST_STEPS)]
            if loop is None and len(shown) < MOST_STEPS:
                with suppress(GameError):  # an inscription raises an exception there
                    why = ending.sentences(game, _partition(said))
    except TimeIsOverError:
        return [f"The run {goal} is in {file}; there was no time to show it."]
    except (TraceRefusedError, GameError, OSError) as problem:
        return [f"The run {goal} is in {file}; it cannot be shown: {problem}"]
    if len(shown) == MOST_STEPS:
        return [f"The run {goal} is in {file}; it is too long to be shown."]
    head = f"The run {goal}, {len(shown)} step{'s' * (len(shown) != 1)}, {file}:"
    why = [line for x in why for line in _wrapped(x)][: max(most - 1 - LEAST_STEPS, 0)]
    rest = [ending.HEAD, *why] if why else []
    most -= len(rest)
    lines = _earlier(len(shown) - most)
    for step in shown[-most:] if most else ():
        values = ", ".join(f"{k} = {v}" for k, v in step.binding.items())
        line = f"  {step.number:>3}  {step.transition}" + (f"  ({values})" if values else "")
        lines.append(_cut(line))
    lines += rest
    if loop is not None and loop < len(shown):
        lines.append(f"  The steps from step {loop + 1} on are repeated for ever.")
    return [head, *lines] if lines else []


def _partition(said: Said) -> Partition | None:
    running = said.control.running if said.control is not None else None
    return None if running is None else running.partition


def _wrapped(sentence: str) -> list[str]:
    """With an indentation; of a long one two lines."""
    return textwrap.wrap(
        sentence,
        _WIDTH,
        initial_indent="    ",
        subsequent_indent="      ",
        max_lines=2,
        placeholder=" ...",
        break_long_words=False,
        break_on_hyphens=False,
    )


def _cut(line: str, indented: int = 0) -> str:
    width = _WIDTH - indented
    return line if len(line) <= width else f"{line[: width - 3]}..."


# --- the verdict ---------------------------------------------------------------------------------


def closing(said: Said) -> str:
    """The last line."""
    return outcome.closing(said.net, said.found, said.counts)
