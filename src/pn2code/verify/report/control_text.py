"""The checks of a supervisor as text: a line for each, then the runs that show what is wrong, told step by step."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from pn2code.net.engine_names import EngineNames
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.token_game import GameError
from pn2code.trace.script import TraceRefusedError
from pn2code.verify.answers import basis, properties
from pn2code.verify.answers.path import steps
from pn2code.verify.controller.cell_answers import reason
from pn2code.verify.controller.control_types import (
    CONFLUENT,
    MEANINGS,
    TITLES,
    Check,
    Control,
    Evidence,
)
from pn2code.verify.report import properties_text, swarm_text

TITLE = "Controller Checks"
_RULE = "-" * 72
_MARKS = {"yes": "yes", "no": "NO", "unknown": "?"}
_NAME = 28


def section(control: Control) -> str:
    """For the report."""
    lines = [f" {TITLE}", _RULE]
    for check in control.checks:
        mark = "no" if check.is_accepted else _MARKS[check.answer]
        lines.append(f"     {check.name.ljust(_NAME)}{mark:<4}{check.says}")
        lines += (f"     {'':{_NAME}}    {more}" for more in _rests(check))
    lines += [f"     {line}" for line in looked_at(control)]
    return "\n".join(lines)


def looked_at(control: Control) -> Iterator[str]:
    """What the answers were looked up in, and what of it the closed net does not have."""
    found = control.found
    if control.why:
        yield f"Looked up: {control.why}."
    elif found is not None and found.swarm is not None:
        yield f"Searched in the cell as it runs: {swarm_text.seen(found.swarm)}."
    elif found is not None:
        how = ", of the reduced space (docs/reductions.md)" if control.reduced else ""
        yield f"Checked in the cell as it runs: {found.nodes:,} states, {found.arcs:,} arcs{how}."
    if control.crowd is not None:
        yield from (f"{name} {what}" for name, what in control.crowd.lines())
    differing = [*differences(control)]
    yield from (what for _, what in differing)
    if differing:
        yield why_differs(control)


def differences(control: Control) -> Iterator[tuple[str, str]]:
    """Where bounds and dead transitions of the cell as it runs are not those of the closed net: title, sentence."""
    if control.running is None:
        return
    names = EngineNames(control.running.partition.net)
    never, only = control.other_dead()
    for where, other, indices in (
        ("the cell", "the closed net", never),
        ("the closed net", "the cell", only),
    ):
        for i in indices:
            yield (
                "Dead transitions",
                f"`{names.transition(i)}` never occurs in {where}, but it does in {other}.",
            )
    for place, own, in_net in control.other_bounds():
        tokens = f"{own} token{'s' * (own != 1)}"
        yield (
            "Bounds",
            f"`{names.place(place)}` holds at most {tokens} in the cell, {in_net} in the closed net.",
        )


def why_differs(control: Control) -> str:
    """The reason for `differences`."""
    assert control.running is not None
    return reason(control.running.partition)


def heading(check: Check, run: Evidence, number: int) -> str:
    """Of a run that shows an answer."""
    what = TITLES[check.name]
    if check.name == CONFLUENT:
        what += ": the documented order" if number == 0 else ": another order"
    length = f"{run.steps} step{'s' * (run.steps != 1)}"
    if run.loop is not None and run.loop < run.steps:
        turns = run.steps - run.loop
        last = f"last {turns} are" if turns > 1 else "last one is"
        length += f", of which the {last} repeated for ever"
    return f"{what}: {length}, {run.file}"


def runs(control: Control) -> Iterator[tuple[Check, Evidence, str]]:
    """The runs that were kept, with their headings."""
    for check in control.checks:
        for number, run in enumerate(check.evidence):
            if run.file is not None:
                yield check, run, heading(check, run, number)


def told(net: FlatNet, storage: Mapping[str, str], control: Control, *, most: int) -> Iterator[str]:
    """The runs, each step checked by the token game."""
    for _, run, head in runs(control):
        assert run.file is not None
        try:
            shown = steps(net, storage, run.file, most=most)
        except (TraceRefusedError, GameError, OSError) as problem:
            yield f"{head}\n  (it cannot be shown: {problem})"
            continue
        evidence = properties.Evidence(run.file, run.steps, run.loop)
        yield "\n".join([head, *properties_text.lines(shown, evidence)])


def _rests(check: Check) -> Iterator[str]:
    if check.rests_on is not None:
        yield f"rests on this: {'; '.join((basis.SAYS[check.rests_on], *check.assumes))}"


def rows(control: Control) -> Iterator[dict[str, object]]:
    """For the page."""
    for check in control.checks:
        is_bad = check.fails
        yield {
            "name": TITLES[check.name],
            "said": f"{check.says[:1].upper()}{check.says[1:]}.".replace("`", ""),
            "remarks": [MEANINGS[check.name], *_rests(check)],
            "answer": {"unknown": "not known"}.get(check.answer, check.answer),
            "kind": "open"
            if check.answer == "unknown" or check.is_accepted
            else "bad"
            if is_bad
            else "good",
        }
