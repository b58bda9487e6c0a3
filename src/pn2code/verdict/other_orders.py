"""What CPN Tools may come to where it asks conditions in another order than here: a second look at a state space.

found = look(opened, found, limits, options)
found.orders               # what raises an exception in some order, where nothing does here
found.error["everywhere"]  # whether what raises one here does so in every order

Of a cell this is said of its closed net, apart: what is said of its programs, which ask in the order here, does not
depend on it.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import islice

from pn2code.base.deadline import TimeIsOverError
from pn2code.diagnostics import Diagnostics, Note, Origin
from pn2code.net.conditions import conditions
from pn2code.net.flat import FlatTransition
from pn2code.net.magnitudes import ANY, Magnitudes, of_json
from pn2code.net.other_orders import Asking, asking
from pn2code.net.outside import RAISED
from pn2code.net.uses import NetVariables
from pn2code.semantics.game.every_order import raises_in_every_order
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.trace.script import TraceRefusedError
from pn2code.verdict.opened import OpenNet
from pn2code.verify.answers.culprit import MOST_STEPS
from pn2code.verify.answers.path import play
from pn2code.verify.answers.reasons import OUTSIDE, raises
from pn2code.verify.codes import OTHER_ORDER
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.programs import FIRST_STATES
from pn2code.verify.exploring.result import Exploration, OtherOrders, RaisedThere, Trace

_PARTS = ("decided", "states")
"""Ends of an exploration of which some markings are enough for an answer: those that were seen are seen again."""


def look(
    opened: OpenNet, found: Exploration, limits: Limits, options: ExploreOptions
) -> Exploration:
    """With what is known of other orders.

    Args:
        opened: the net.
        found: its state space.
        limits, options: of its exploration.

    Raises:
        GameError: as for `explore`.
    """
    is_cell = opened.config is not None
    if found.error is not None and found.why == "error":
        if is_cell:
            return found
        everywhere = _is_everywhere(opened, found)
        return replace(found, error={**found.error, "everywhere": everywhere})
    if not found.complete and not (options.questions and found.why in _PARTS):
        return found
    try:
        with limits.deadline.enforced():
            made = asking(opened.flat, _sizes(opened, found, options))
    except TimeIsOverError:
        return replace(found, orders=OtherOrders("seconds", of_cell=is_cell))
    if made is None:
        return found
    orders = replace(_asked(opened, made, found, limits, options), of_cell=is_cell)
    return replace(found, orders=orders)


def _sizes(opened: OpenNet, found: Exploration, options: ExploreOptions) -> Magnitudes:
    """How large integers are, by the markings where all of them and all of their colours are known."""
    measured = None
    if found.complete and found.bounds is not None:
        measured = [
            max((of_json(x) for _, x in b.upper_multiset), default=0)
            if b.upper_multiset is not None and len(b.upper_multiset) >= b.upper_colours
            else ANY
            for b in found.bounds
        ]
    return Magnitudes(opened.flat, measured, is_initial=options.initial is None)


def _asked(
    opened: OpenNet, made: Asking, found: Exploration, limits: Limits, options: ExploreOptions
) -> OtherOrders:
    found_there = _looked(opened, made, found, limits, options)
    may_bind = any(q.kind == "outside" for q in (*made.questions, *made.left))
    return replace(found_there, more=bool(found_there.why) and may_bind)


def _looked(
    opened: OpenNet, made: Asking, found: Exploration, limits: Limits, options: ExploreOptions
) -> OtherOrders:
    options.stage("asking conditions in other orders ...")
    most = limits.max_states if found.complete else max(found.nodes, 1)
    sweeps = found.sweep is not None or limits.sweeps
    own = replace(limits, max_states=most, graph=False, traces=0, sweeps=sweeps)
    asked = ExploreOptions(
        traces=options.traces,
        stem=f"{options.stem}.asked",
        initial=options.initial,
        colours=0,
        sizes=options.sizes,
        quick=found.nodes <= FIRST_STATES,
        pace=options.pace,
        progress=options.progress,
        interrupted=options.interrupted,
    )
    again = explore(made.net, opened.storage, own, Diagnostics(), asked)
    if again is None:
        return OtherOrders("truncated")
    error = again.error
    if error is not None and again.why == "error":
        index = error.get("transition")
        question = None if index is None else made.question(index)
        t = index if question is None else question.transition
        text = "" if question is None else " ".join(question.raises.span.text.split())
        trace = again.error_trace
        message = error["message"]
        if question is not None and RAISED in message:
            message = OUTSIDE if question.kind == "outside" else "Bind"
        kind = "order" if question is None else question.kind
        there = RaisedThere(t, text, message, error.get("node"), trace, kind)
        return OtherOrders("error", there)
    if made.left:
        return OtherOrders("ways")
    is_all = again.seen.markings or (not found.complete and again.why == "states")
    return OtherOrders("" if is_all else again.why)


def _is_everywhere(opened: OpenNet, found: Exploration) -> bool:
    """Whether the exception that ended the exploration is raised whatever is asked first."""
    error = found.error
    assert error is not None
    index = error.get("transition")
    if index is None or error.get("binding"):
        return True
    t = opened.flat.transitions[index]
    if opened.flat.file.lower().endswith(".pnml"):
        return True
    shown = None if found.error_trace is None else _is_raised(opened, found.error_trace, t)
    if shown is not None:
        return shown
    # The marking is not known. Where the search computes nothing of this kind, it was an occurrence that raised it.
    raising = Magnitudes(opened.flat, is_initial=False).raising(t)
    asked = conditions(t, raising, NetVariables(opened.flat.program.variables))
    return not any(c.may_raise for c in asked) or len(asked) == len(t.arcs) == 1


def _is_raised(opened: OpenNet, trace: Trace, t: FlatTransition) -> bool | None:
    """Whether it is raised in every order after a run; None: the token game does not come there."""
    try:
        game, played = play(opened.flat, opened.storage, trace.file)
        if sum(1 for _ in islice(played, MOST_STEPS)) == MOST_STEPS:
            return None
        return _raises_next(game, t)
    except (TraceRefusedError, GameError, OSError):
        return None


def _raises_next(game: Game, t: FlatTransition) -> bool:
    """At the earliest time at which the search raises something."""
    marking = game.marking
    times = {marking.time}
    if game.net.timed:
        times |= game.enabling.thresholds(t, marking)
    for time in sorted(times):
        later = replace(marking, time=time)
        try:
            for _ in game.enabling.enabled(t, later):
                pass
        except GameError:
            return raises_in_every_order(game.enabling, t, later)
    return False


def tell(opened: OpenNet, found: Exploration, d: Diagnostics) -> None:
    """Warn of what CPN Tools may raise where nothing is raised here."""
    orders = found.orders
    if orders is None or orders.raised is None:
        return
    raised = orders.raised
    t = None if raised.transition is None else opened.flat.transitions[raised.transition]
    where = "the net" if t is None else f"transition `{t.short}`"
    notes: list[str | Note] = []
    if orders.of_cell:
        where += " of the closed net"
        notes.append("the cell's programs ask in the order here, and what is said of them stays so")
    if raised.trace is not None:
        notes.append(f"{raised.trace.steps} steps lead to that marking: {raised.trace.file}")
    if raised.kind == "outside":
        d.warning(
            OTHER_ORDER,
            f"CPN Tools may find other bindings of {where} in a reachable marking: `{raised.text}` {OUTSIDE}, "
            "which CPN Tools does not look at",
            t.origin if t is not None else Origin(opened.flat.file),
            notes=notes,
            hint="add a condition that the value is one of the colour set, or give the variable a larger one",
        )
        return
    d.warning(
        OTHER_ORDER,
        f"CPN Tools may stop in a reachable marking: of {where} it may compute `{raised.text}`"
        f"{' first' if raised.kind == 'order' else ''}, which {raises(raised.message)}",
        t.origin if t is not None else Origin(opened.flat.file),
        notes=notes,
        hint="put both conditions into one: `a andalso b`, or `m = (if a then b else c)`",
    )
