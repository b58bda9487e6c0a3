"""The binding elements of a net as a table that the explorer reads: what reductions of the state space rest on.

    table = elements(net)    # raises NotPossibleError with the reason
    path.write_text(table.text())

Counters are the colours of packed places that can be marked, elements the bindings that can occur: the unfolded net.
The explorer makes successors with the compiled net, as always, and compares in each state which elements are enabled:
a difference is an error that it reports.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics
from pn2code.lowering.nets.packing import MOST_COLOURS
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.net.flat import FlatNet
from pn2code.semantics.values.colour_components import component, parts_of
from pn2code.semantics.values.data import Value
from pn2code.unfold.codes import UNFOLDING_FAULT
from pn2code.unfold.net import UnfoldedTransition, Unfolding
from pn2code.unfold.unfold import unfold
from pn2code.verify.exploring.irrelevant_elements import irrelevant
from pn2code.verify.exploring.symmetry import Symmetries, symmetries

MAGIC = "pn2code-elements 1"
MOST_COUNTERS = 50_000
MOST_ELEMENTS = 300_000


class NotPossibleError(Exception):
    """A reduction does not fit the net; the text is the reason, a clause."""


@frozen
class Elements:
    """The table.

    Args:
        unfolding: the unfolded net.
        irrelevant: for each element whether the ways to dead markings can do without.
        symmetries: groups of permutations that are proved to be symmetries of it; None: were not looked for.
    """

    unfolding: Unfolding
    irrelevant: tuple[bool, ...]
    symmetries: Symmetries | None

    def text(self) -> str:
        """In the form that the explorer reads: numbers, in lines for people."""
        return "\n".join(self._lines()) + "\n"

    def _lines(self) -> Iterator[str]:
        u = self.unfolding
        yield MAGIC
        sizes = [colours(p.colset) for p in u.net.places]
        yield _row(len(sizes), *sizes)
        yield _row(len(u.places))
        for p in u.places:
            yield _row(p.place, ordinal(u.net.places[p.place].colset, p.colour))
        yield _row(len(u.transitions))
        for t, is_irrelevant in zip(u.transitions, self.irrelevant, strict=True):
            yield _row(t.transition, int(not is_irrelevant), *_arcs(t))
        found = self.symmetries
        yield _row(len(found.rotations) if found else 0)
        for r in found.rotations if found else ():
            yield _row(r.order, int(r.reflection is not None))
            yield _row(*r.rotation)
            if r.reflection is not None:
                yield _row(*r.reflection)
        full = found.full if found else None
        yield _row(len(full.classes) if full else 0)
        if full:
            yield _row(*full.classes)
            for shape, points in full.counters:
                yield _row(shape, len(points), *points)
        yield "end"


def _row(*numbers: int) -> str:
    return " ".join(map(str, numbers))


def _arcs(t: UnfoldedTransition) -> Iterator[int]:
    for tokens in (t.pre, t.post):
        yield len(tokens)
        for p, n in tokens.items():
            yield p
            yield n
    for places in (t.inhibitors, t.resets):
        yield len(places)
        yield from places


def elements(net: FlatNet, *, wants_symmetry: bool = False) -> Elements:
    """The table of a net.

    Raises:
        NotPossibleError: the net has none.
        GameError: a declaration or an initial marking raises an exception.
    """
    _check(net)
    d = Diagnostics()
    u = unfold(net, d, max_places=MOST_COUNTERS, max_transitions=MOST_ELEMENTS)
    if u is None:
        raise NotPossibleError(d.errors[0].message)
    for fault in d.items:
        if fault.code == UNFOLDING_FAULT:
            raise NotPossibleError(f"an exception might be missed: {fault.message}")
    return Elements(u, irrelevant(u), symmetries(u) if wants_symmetry else None)


def _check(net: FlatNet) -> None:
    if net.timed:
        raise NotPossibleError("the net is timed")
    for t in net.transitions:
        if t.code is not None:
            raise NotPossibleError(f"transition `{t.name}` has a code segment")
    for p in net.places:
        if not 0 < colours(p.colset) <= MOST_COLOURS:
            raise NotPossibleError(
                f"the colours of place `{p.name}` are not finitely many, or more than {MOST_COLOURS:,}"
            )


# --- numbers of colours ---------------------------------------------------------------------------


def colours(c: Colset) -> int:
    """The number of colours of a colour set, of a subset those of its base; 0: it has no numbers."""
    match c.kind:
        case Kind.UNIT:
            return 1
        case Kind.BOOL:
            return 2
        case Kind.ENUM:
            return len(c.names)
        case Kind.INT | Kind.INDEX:
            if not isinstance(c.low, int) or not isinstance(c.high, int):
                return 0
            return max(c.high - c.low + 1, 0)
        case Kind.ALIAS | Kind.SUBSET:
            return colours(component(c))
        case Kind.PRODUCT | Kind.RECORD:
            total = 1
            for part in c.components:
                total *= colours(part) if part is not None else 1
            return total
        case Kind.UNION:
            each = [colours(part) if part is not None else 1 for part in c.components]
            return sum(each) if all(each) else 0
        case _:
            return 0


def ordinal(c: Colset, value: Value) -> int:
    """The number of a colour, as `number_of` of the generated net gives it: from 0, in the order of the colour set."""
    found: object = value
    match c.kind:
        case Kind.UNIT:
            return 0
        case Kind.BOOL:
            return int(bool(found))
        case Kind.ENUM:
            return int(getattr(found, "tag"))  # noqa: B009 - a Data
        case Kind.INT:
            assert isinstance(found, int) and isinstance(c.low, int)
            return found - c.low
        case Kind.INDEX:
            argument = getattr(found, "argument")  # noqa: B009 - a Data
            assert isinstance(c.low, int)
            return int(argument) - c.low
        case Kind.ALIAS | Kind.SUBSET:
            return ordinal(component(c), value)
        case Kind.PRODUCT | Kind.RECORD:
            total = 0
            for _, part, own in parts_of(c, value):
                total = total * colours(part) + ordinal(part, own)
            return total
        case Kind.UNION:
            tag = int(getattr(found, "tag"))  # noqa: B009 - a Data
            before: Sequence[Colset | None] = c.components[:tag]
            first = sum(colours(part) if part is not None else 1 for part in before)
            own_part = c.components[tag]
            if own_part is None:
                return first
            return first + ordinal(own_part, getattr(found, "argument"))  # noqa: B009 - a Data
        case _:
            raise ValueError(f"colours of `{c.name}` have no numbers")
