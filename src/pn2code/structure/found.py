"""What the structure of a net says: limits of the search, invariants, siphons, elements, and all of it together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from pn2code.base.frozen import frozen
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet
from pn2code.structure import flows
from pn2code.structure.bounds import MOST_PROGRAMS, MOST_WORK, PlaceBound
from pn2code.structure.coloured import ColouredInvariants
from pn2code.structure.skeleton import Skeleton


@frozen
class Limits:
    """Where the searches stop; they count work, so that the same net always gives the same answer.

    Args:
        flows: of the searches for invariants.
        siphons: most minimal siphons, and traps.
        siphon_work: see `siphons.minimal`.
        programs: most linear programs for bounds that are solved in floating point; 0: none at all.
        program_work: what those in integers may compute before.
    """

    flows: flows.Limits = field(default_factory=flows.Limits)
    siphons: int = 500
    siphon_work: int = 1_000_000
    programs: int = MOST_PROGRAMS
    program_work: int = MOST_WORK


@frozen
class PInvariant:
    """`sum of weight * tokens = constant`; None where the initial marking is not known."""

    weights: Mapping[int, int]
    constant: int | None


@frozen
class TInvariant:
    """If each of the modes (by index in `Skeleton.modes`) occurs so often, all places have as many tokens as before."""

    weights: Mapping[int, int]


@frozen
class Siphon:
    """A minimal siphon.

    Args:
        places: of it.
        marked: whether it has tokens in the initial marking.
        trap: the largest trap inside it.
        trap_is_marked: whether that has tokens at the start: then the siphon always has some.
    """

    places: frozenset[int]
    marked: bool
    trap: frozenset[int]
    trap_is_marked: bool


@frozen
class Elements:
    """Places and transitions that stand out.

    Args:
        isolated_places, isolated_transitions: without any arc.
        source_places: nothing puts tokens into them. sink_places: nothing takes tokens from them.
        constant_places: they have arcs, but their number of tokens never changes.
        never_marked: they have no token in any reachable marking.
        source_transitions: they need no token. sink_transitions: they put none.
        dead: transitions that never occur -> why.
    """

    isolated_places: tuple[int, ...]
    isolated_transitions: tuple[int, ...]
    source_places: tuple[int, ...]
    sink_places: tuple[int, ...]
    constant_places: tuple[int, ...]
    never_marked: tuple[int, ...]
    source_transitions: tuple[int, ...]
    sink_transitions: tuple[int, ...]
    dead: Mapping[int, str]


@frozen
class Analysis:
    """What the structure says.

    Args:
        skeleton: the net without colours.
        evaluator: of its declarations; None if they raise an exception.
        marking, initial: the initial marking and its numbers of tokens; None where it is not known.
        unknown: why it is not known: place -> reason.
        p_invariants: minimal semi-positive ones, of numbers of tokens.
        p_complete: whether these are all.
        p_basis: all invariants are integer combinations of these; None if the net is too large.
        uncovered: places in no semi-positive P-invariant -> why, where that is known.
        t_invariants, t_complete: minimal semi-positive T-invariants, over modes.
        coloured: the coloured invariants.
        siphons, siphons_complete: minimal siphons.
        traps, traps_complete: minimal traps.
        bounds: place -> its bound.
        elements: what stands out.
        classes: class -> whether the skeleton is of it.
        components, strongly_connected: connected parts, and whether each is strongly connected.
    """

    skeleton: Skeleton
    evaluator: Evaluator | None
    marking: tuple[MultiSet | TimedMultiSet | None, ...]
    initial: tuple[int | None, ...]
    unknown: Mapping[int, str]
    p_invariants: tuple[PInvariant, ...]
    p_complete: bool
    p_basis: tuple[PInvariant, ...] | None
    uncovered: Mapping[int, str]
    t_invariants: tuple[TInvariant, ...]
    t_complete: bool
    coloured: ColouredInvariants
    siphons: tuple[Siphon, ...]
    siphons_complete: bool
    traps: tuple[frozenset[int], ...]
    traps_complete: bool
    bounds: Mapping[int, PlaceBound]
    elements: Elements
    classes: Mapping[str, bool | None]
    components: int
    strongly_connected: bool

    @property
    def net(self) -> FlatNet:
        """The net."""
        return self.skeleton.net

    @property
    def commoner(self) -> bool | None:
        """Whether every minimal siphon contains a marked trap; None where not all of them are known."""
        if not all(s.trap_is_marked for s in self.siphons):
            return False
        return True if self.siphons_complete else None


@frozen
class Start:
    """The initial marking; None where it is not known, and then why."""

    evaluator: Evaluator | None
    marking: tuple[MultiSet | TimedMultiSet | None, ...]
    unknown: dict[int, str]

    @property
    def initial(self) -> tuple[int | None, ...]:
        """The numbers of tokens."""
        return tuple(None if m is None else len(m) for m in self.marking)
