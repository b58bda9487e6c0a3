"""How a verification has come out: the sentence at the head of a report and the one at its end, from the same answers.

counts = Counts(good=3, bad=0, open=1)
header(net, found, counts)       # "it ended early, since ...", or "" where everything was seen
closing(net, found, counts)      # "Verdict: NOT KNOWN. 1 of 4 answers is not known."
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from pn2code.base.frozen import frozen
from pn2code.net import guard_order
from pn2code.net.flat import FlatNet
from pn2code.net.magnitudes import Magnitudes
from pn2code.verify.answers import basis
from pn2code.verify.answers.reasons import clause, raises
from pn2code.verify.exploring import nondeterminism
from pn2code.verify.exploring.result import Exploration, Known, RaisedThere

Word = Literal["yes", "no", "inconclusive"]
_MORE = {
    "chance": "the net draws random numbers or reads files",
    "steps": "the net asks for the number of steps",
}
MOST_NAMED = 5
"""Transitions that are named in one sentence."""
_OPEN_YET = "nothing that was asked of this state space was open any more"


@frozen
class Counts:
    """How many answers are as they should be, are not, and are not known.

    Args:
        good, bad, open: those.
        errors: what else is wrong.
        asked: whether there are properties among them: else the state space itself is what was asked for.
    """

    good: int = 0
    bad: int = 0
    open: int = 0
    errors: int = 0
    asked: bool = False

    @staticmethod
    def of(kinds: Iterable[str], errors: int = 0, *, asked: bool = False) -> Counts:
        """From words "good", "bad" and "open"."""
        kinds = list(kinds)
        good, bad, open_ = (kinds.count(x) for x in ("good", "bad", "open"))
        return Counts(good, bad, open_, errors, asked)

    @property
    def all(self) -> int:
        """All answers."""
        return self.good + self.bad + self.open


def verdict(found: Exploration, counts: Counts) -> Word:
    """The worst of all: where no property is asked, whether all markings were seen counts as well."""
    if counts.bad or counts.errors or (has_raised(found) and is_everywhere(found)):
        return "no"
    if has_raised(found) or may_stop(found):
        return "inconclusive"
    return "yes" if not counts.open and _is_enough(found, counts) else "inconclusive"


def _is_enough(found: Exploration, counts: Counts) -> bool:
    """Whether what was looked at is all that was asked: where nothing else is, that is all markings."""
    return bool(counts.asked or found.knows_whole or (found.known and counts.all))


def header(net: FlatNet, found: Exploration, counts: Counts) -> str:
    """Why the report is about a part only, and what that means, without a word before it; "": it is about all."""
    if found.complete:
        return ""
    if found.known is not None:
        return _counted(found, found.known)
    rest = basis.partial(found)
    if found.unfolded is not None and found.unfolded.is_alone:
        return "" if found.knows_whole else f"{_why(found, counts)}."
    if found.unfolded is not None and found.unfolded.is_asked:
        rest = (
            "Nodes, and tables of bounds, dead markings and transitions, are those of the part that was seen; what the "
            "unfolded net tells is about all reachable markings."
        )
    return f"{_why(found, counts)}. {endless(net, found)}{rest}"


def _counted(found: Exploration, known: Known) -> str:
    """What is said of a closed net whose markings were not counted to the end."""
    ends = "which has a token in a final place" if known.ends else "which may be no end"
    how = "in which tokens are counted up to a limit"
    if known.symmetries:
        how = f"symmetric to others ({', '.join(known.symmetries)})"
    return (
        f"the closed net has more than {found.nodes:,} markings; `--no-reduction` counts them. {known.nodes:,} states, "
        f"{how}, stand for all of them (docs/reductions.md): no inscription raises "
        f"an exception, and each run comes to a dead marking, {ends}. Bounds, arcs and numbers of dead markings are "
        "those of the part that was seen."
    )


def closing(net: FlatNet, found: Exploration, counts: Counts) -> str:
    """The last line: it says what `verdict` says."""
    if has_raised(found) and is_everywhere(found):
        return f"Verdict: NO. {error_text(net, found)} in a reachable marking."
    if counts.bad:
        are = "are not as they" if counts.bad != 1 else "is not as it"
        return f"Verdict: NO. {counts.bad} of {counts.all} answers {are} should be."
    if counts.errors:
        return "Verdict: NO. There are errors, see below."
    if has_raised(found):
        return (
            f"Verdict: NOT KNOWN. {error_text(net, found)} in a reachable marking; CPN Tools may ask another condition "
            "first, or find too few tokens, and raise nothing."
        )
    if may_stop(found):
        return f"Verdict: NOT KNOWN. {order_text(net, found)}"
    if counts.open:
        are = "are" if counts.open != 1 else "is"
        return f"Verdict: NOT KNOWN. {counts.open} of {counts.all} answers {are} not known."
    if counts.all and _is_enough(found, counts):
        return f"Verdict: YES. {_all_good(counts.all)}.{_in_order(net, found)}"
    if found.complete:
        one = nondeterminism.undetermined(net)
        what = (
            f"markings of one of many state spaces ({_MORE[one]})" if one else "reachable markings"
        )
        nothing = "and there are no properties to check"
        return f"Verdict: COMPLETE. All {what} were seen, {nothing}.{_in_order(net, found)}"
    if found.knows_whole:
        return (
            "Verdict: COMPLETE. All reachable markings are known, as a set of those of the unfolded net, and there are "
            f"no properties to check.{_in_order(net, found)}"
        )
    why = _why(found, counts)
    known = f"{_all_good(counts.all)}, but " if counts.all else ""
    return f"Verdict: NOT COMPLETE. {known}{why if known else why[:1].upper() + why[1:]}."


def may_stop(found: Exploration) -> bool:
    """Whether CPN Tools may stop with an exception, or it is not known that it does not, and answers rest on that."""
    return found.orders is not None and bool(found.orders.why) and not found.orders.of_cell


def order_text(net: FlatNet, found: Exploration) -> str:
    """That CPN Tools may stop, in sentences."""
    assert found.orders is not None
    raised = found.orders.raised
    here = "in the order in which they are asked here nothing raises an exception"
    if raised is None:
        return (
            "CPN Tools may ask conditions in another order, and whether one raises an exception then is not known: "
            f"{clause(found.orders.why)}; {here}."
        )
    name = (
        "the net" if raised.transition is None else f"`{net.transitions[raised.transition].name}`"
    )
    if raised.kind == "outside":
        return (
            f"CPN Tools may find other bindings in a reachable marking: `{raised.text}` of {name} {raised.message}, "
            "which CPN Tools does not look at; here it is none."
        )
    if raised.kind == "bind":
        return (
            f"CPN Tools may stop in a reachable marking: `{raised.text}` of {name} {raises(raised.message)}; here that "
            "means that there is no binding."
        )
    return (
        f"CPN Tools may stop in a reachable marking: if it asks `{raised.text}` of {name} before other conditions, "
        f"that {raises(raised.message)}; {here}."
    )


def closed_net(net: FlatNet, found: Exploration) -> str:
    """What other orders may do to the closed net of a cell, in sentences; "": nothing, or that was not looked at."""
    if found.orders is None or not found.orders.of_cell or not found.orders.why:
        return ""
    programs = (
        "The cell's programs ask conditions in the order here, and the verdict is about them."
    )
    return f"{programs} Of the closed net: {order_text(net, found)}"


def does(there: RaisedThere) -> str:
    """What is wrong with the text of it, behind that."""
    return there.message if there.kind == "outside" else raises(there.message)


def _in_order(net: FlatNet, found: Exploration) -> str:
    """Of conditions that may be asked in another order, what became of it, after a blank; or ""."""
    if closed_net(net, found):
        return ""
    if found.complete and found.orders is not None:
        return " In every order in which CPN Tools may ask conditions none of them raises an exception."
    warned = guard_order.unsure(net)
    warning = " (warning `guard-order`)"
    if not warned and not found.complete and found.orders is None:
        warned, warning = guard_order.unsure(net, Magnitudes(net)), ""
    if not warned:
        return ""
    names = ", ".join(f"`{x.transition.name}`" for x in warned[:MOST_NAMED])
    more = f" and {len(warned) - MOST_NAMED} more" if len(warned) > MOST_NAMED else ""
    return (
        f" This holds for the order in which conditions are asked here; CPN Tools may ask those of {names}{more} in "
        f"another, and stop with an exception{warning}."
    )


def _all_good(number: int) -> str:
    return (
        f"All {number} answers are as they should be"
        if number != 1
        else "The answer is as it should be"
    )


def good_of(good: int, number: int) -> str:
    """How many of some answers are as they should be."""
    return f"{good} of {number} {'are as they' if good != 1 else 'is as it'} should be"


def endless(net: FlatNet, found: Exploration) -> str:
    """What grows without bound, and the run that shows it, in sentences with a blank after them; or ""."""
    run = found.covering
    if run is None:
        return ""
    if not run.grows:
        file = f" (run: {run.file})" if run.file is not None else ""
        return (
            f"Time goes on for ever, and each marking has its time: {run.steps(net)}, and all is as before{file}. "
            "`--reduce time` counts markings that differ in the time alone as one; `--max-states` explores so many. "
        )
    names = ", ".join(f"`{name}`" for name in run.places(net))
    what = f"Place {names} grows" if len(run.grows) == 1 else f"Places {names} grow"
    file = f" (run: {run.file})" if run.file is not None else ""
    return f"{what} without bound: {run.steps(net)}{file}. "


def error_text(net: FlatNet, found: Exploration) -> str:
    """What raises the exception of `found.error`: the transition, and the binding if it is an occurrence."""
    error = found.error
    assert error is not None
    index, binding = error.get("transition"), error.get("binding")
    what = f"`{net.transitions[index].name}`" if index is not None else error["where"]
    if binding:
        what += f" with {', '.join(f'{k} = {v}' for k, v in binding.items())}"
    return f"{what} {raises(error['message'])}"


def has_raised(found: Exploration) -> bool:
    """Whether an exception has ended the exploration."""
    return found.error is not None and found.why == "error"


def is_everywhere(found: Exploration) -> bool:
    """Whether CPN Tools raises it, too, whatever it asks first."""
    return found.error is None or bool(found.error.get("everywhere", True))


def _why(found: Exploration, counts: Counts) -> str:
    """As `clause`, but that everything was decided is only said where no answer is missing."""
    return _OPEN_YET if found.why == "decided" and counts.open else clause(found.why)
