"""Properties of a cell: what is so of the cell as it runs, and where the closed net differs.

    for answer in of_cell(properties, said, control, answers): ...

The answer is that of the cell (`verify.controller.running`). Where it was not seen to its end, an invariant that
holds in a closed
net that can do more holds in the cell as well; nothing else does. What is so of the closed net is said beside, if it is
something else.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pn2code.cell.partition import OwnerKind, Partition
from pn2code.properties import meaning as m
from pn2code.properties.silent import means_the_same
from pn2code.properties.universal import is_universal
from pn2code.verify.answers.properties import Answer, Evidence, answers
from pn2code.verify.answers.reasons import clause
from pn2code.verify.controller.control_answers import can_more, has_own_priorities
from pn2code.verify.controller.control_types import Control
from pn2code.verify.controller.overtaking import is_in_order
from pn2code.verify.controller.premises import COUNTED, IN_TURNS
from pn2code.verify.exploring import nondeterminism

_PRIORITIES = (
    "In the closed net priorities are global: a transition waits while one of higher priority is enabled anywhere. In "
    "the cell each program knows only its own transitions and the messages that it has seen."
)
_TIME = (
    "In the closed net time does not advance while something is enabled. In the cell the supervisor may be late, and "
    "moves take time that the net does not know."
)
_CHOICES = (
    "In the closed net everything that is enabled may occur, and messages arrive at once. In the cell the supervisor "
    "and the scripts choose in the documented order, and a message has an effect only after it has been seen."
)
_NEXT = "it is about the very next step, but between two occurrences the programs take steps of their own"
_INITIAL = "when the net returns to its initial marking, the programs are not at their start again"


def waits(asked: m.Response, partition: Partition) -> str:
    """What the net does not know of a time: how long that takes which those do whose steps the property names.

    Of steps with a condition on their bindings nobody is named.
    """
    named = [x for f in (asked.first, asked.second) for x in m.atoms(f)]
    fired = {x.number for x in named if x.kind == "fires"}
    owners = {partition.transition_owner[t] for t in fired}
    of_steps = all(x.kind == "fires" for x in named)
    whole = {o.index for o in partition.owners if o.kind is not OwnerKind.SUPERVISOR}
    doing = owners if of_steps and owners <= whole and len(owners) == 1 else whole
    names = [f"`{o.name}`" for o in partition.owners if o.index in doing]
    if any(partition.owners[i].kind is OwnerKind.ROBOT for i in doing):
        what, measured = "moves take", "moves"
    elif len(names) == 1:
        what, measured = f"what device {names[0]} does takes", "it"
    else:
        what, measured = "what devices do takes", "it"
    return (
        f"the net knows neither how long {what} nor how late the supervisor is "
        f"(`--durations` measures {measured})"
    )


_ORDERS = (
    "it says that something can happen, and a script that waits for several messages may take them in fewer orders "
    "than are looked at"
)

_OVERTAKEN = (
    "in the run that was found a script takes a message although it would have seen another one before it, and whether "
    "there is a run in which it does not is not known"
)


def is_about_all(asked: m.Asked) -> bool:
    """Whether "yes" holds as well for programs that do less: it says of all paths what is so of them, and no more.

    Not so where fairness is assumed: a transition that seems to be possible, and is not, makes paths unfair.
    """
    match asked:
        case m.Bound() | m.Response():
            return True
        case m.Invariant():
            return asked.wanted
        case m.Linear():
            return not asked.fair
        case m.Branching(formula):
            return is_universal(formula, True)


def _is_shown(answer: Answer) -> bool:
    """Whether the run that goes with "yes" is all that it says: that a marking can be reached."""
    asked = answer.about.asked
    if answer.evidence is None:
        return False
    match asked:
        case m.Invariant():
            return True
        case m.Branching(m.Op("EF", (part,))):
            return is_universal(part, True) and is_universal(part, False)
        case _:
            return False


def is_kept(p: m.Property) -> bool:
    """Whether "yes" is kept when the programs do less."""
    match p.asked:
        case m.Bound():
            return True
        case m.Invariant(condition, wanted):
            return wanted and all(a.kind in ("true", "pred") for a in m.atoms(condition))
        case _:
            return False


def reason(partition: Partition) -> str:
    """Why the closed net may differ from the cell: all that there is, since which of it mattered is not known."""
    found = [_PRIORITIES] if has_own_priorities(partition) else []
    found += [_TIME] if partition.net.timed else []
    found += [_CHOICES]
    return " ".join(found)


def of_cell(
    properties: m.Properties,
    said: Sequence[Mapping[str, Any]],
    control: Control,
    closed: Sequence[Answer],
    *,
    storage: Mapping[str, str] | None = None,
    all_orders: bool = False,
) -> Iterator[Answer]:
    """The answers; runs are those of the net, without steps of programs.

    Args:
        properties: what was asked.
        said: what the explorer says of the cell.
        control: what the cell was looked at in.
        closed: the answers of the closed net.
        storage: as for `Game`.
        all_orders: whether the supervisor was left its choice, so that it may do less.
    """
    found, partition = control.found, control.partition
    if found is None:
        looked: Sequence[Answer] = [
            Answer(p, "inconclusive", clause(control.why)) for p in properties.properties
        ]
    else:
        looked = answers(properties, said, found)
    undetermined = nondeterminism.undetermined(partition.net)
    for of_net, answer in zip(closed, looked, strict=True):
        if of_net.about.of_net:
            yield of_net
            continue
        asked = (
            of_net.about.asked
        )  # of parts of transitions, what is assumed is a part of the formula
        is_fair = isinstance(asked, m.Linear) and bool(asked.fair)
        certain = _certain(answer, asked, control, undetermined, all_orders, is_fair)
        if certain.evidence is not None and not _can_be_done(answer, control, storage or {}):
            certain = Answer(answer.about, "inconclusive", _OVERTAKEN)
        certain = _projected(certain, control)
        found_one = _one(of_net, certain, partition)
        assumes = control.premises.of_property(asked, found_one.answer, kept=found_one.kept)
        is_from_states = found_one.answer != "inconclusive" and found_one.evidence is None
        if control.reduced and is_from_states:
            assumes = (*assumes, IN_TURNS, *([COUNTED] if control.is_counted else []))
        yield replace(found_one, assumes=assumes)


def _certain(
    answer: Answer,
    drawn: m.Asked,
    control: Control,
    undetermined: str,
    all_orders: bool,
    is_fair: bool,
) -> Answer:
    """Without what the cell's own steps, chance, numbers of steps or durations leave open.

    Args:
        answer: of the cell; where parts of transitions are asked about, its formula has the numbers of these.
        drawn: the formula with the numbers of the net's own transitions.
        control: what the cell was looked at in.
        undetermined: what chance and the order of steps leave open.
        all_orders: whether the supervisor was left its choice.
        is_fair: whether fairness is assumed.
    """
    asked, running = answer.about.asked, control.running
    open_ = ""
    if answer.answer == "inconclusive":
        return replace(answer, node=None)
    if isinstance(asked, m.Response) and asked.time is not None:
        assert isinstance(drawn, m.Response)
        open_ = waits(drawn, control.partition)
    elif not means_the_same(asked, answer.answer):
        is_all = isinstance(asked, m.Invariant) and asked.wanted and answer.answer == "yes"
        open_ = "" if is_all else _INITIAL if _asks_initial(asked) else _NEXT
    elif all_orders and (answer.answer == "no" or is_fair):
        # Where more is enabled, fewer paths are fair.
        open_ = "this covers all orders in which the supervisor could fire"
    is_possible = isinstance(asked, m.Invariant) and not asked.wanted
    if not open_ and answer.answer == "yes" and not (is_kept(answer.about) or is_possible):
        open_ = control.stops
    if not open_ and answer.answer == "yes" and running is not None and running.meek:
        open_ = "" if is_about_all(asked) or _is_shown(answer) else _ORDERS
    # Each program of a cell counts its own steps, which no run of the net shows.
    if not open_ and undetermined and (undetermined == "steps" or answer.evidence is None):
        open_ = clause(undetermined)
    if open_:
        return Answer(answer.about, "inconclusive", open_)
    return replace(answer, node=None)


def _can_be_done(answer: Answer, control: Control, storage: Mapping[str, str]) -> bool:
    """Whether scripts can take their messages as in the run, as far as that can be found out."""
    e, running = answer.evidence, control.running
    if e is None or running is None or not running.meek:
        return True
    found = is_in_order(running, storage, e.trace)
    # What cannot be played is no proof that something can happen.
    return found is True or (found is None and answer.answer == "no")


def _projected(answer: Answer, control: Control) -> Answer:
    """With the run of the cell's net, without the steps of programs."""
    e = answer.evidence
    if e is None or control.running is None:
        return answer
    steps, loop = control.running.project(e.trace, e.loop)
    return replace(answer, evidence=Evidence(e.trace, steps, loop))


def _asks_initial(asked: m.Asked) -> bool:
    match asked:
        case m.Invariant(formula) | m.Branching(formula) | m.Linear(formula):
            return any(a.kind == "initial" for a in m.atoms(formula))
        case _:
            return False


def _one(of_net: Answer, of_cell: Answer, partition: Partition) -> Answer:
    kept = is_kept(of_net.about)
    if of_cell.answer == "inconclusive" and kept and can_more(partition) and of_net.answer == "yes":
        return replace(of_net, kept=True, cell=True)
    found = replace(of_cell, about=of_net.about, kept=kept, cell=True)
    asked = of_net.about.asked
    if isinstance(asked, m.Response) and asked.of_commands:
        return found  # without time everything of the closed net happens at once
    if of_net.answer == found.answer or of_net.answer == "inconclusive":
        return found
    is_open = found.answer == "inconclusive"
    run = of_net.evidence if is_open else None
    return replace(found, net=of_net.answer, net_why=reason(partition), net_evidence=run)
