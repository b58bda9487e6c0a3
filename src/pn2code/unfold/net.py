"""The unfolded net."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import FlatNet
from pn2code.semantics.values.data import Value


@frozen
class UnfoldedPlace:
    """A colour in a place.

    Args:
        index: position in `Unfolding.places`.
        place: index in `FlatNet.places`.
        colour: the value.
        name: readable and unique: "Top.Buffer" for a place of one colour (unit), else "Top.Buffer[(1,red)]".
        initial: number of tokens at the start.
    """

    index: int
    place: int
    colour: Value
    name: str
    initial: int


@frozen
class UnfoldedTransition:
    """A binding of a transition.

    Args:
        index: position in `Unfolding.transitions`.
        transition: index in `FlatNet.transitions`.
        binding: (variable, value) in the order of `FlatTransition.variables`.
        name: readable and unique: "Top.Pick" or "Top.Pick[n=1,p=red]".
        pre: tokens taken: index of the place -> how many.
        post: tokens put.
        inhibitors: places that must be empty.
        resets: places that are empty afterwards, whatever is put.
        priority: smaller is more urgent.
    """

    index: int
    transition: int
    binding: tuple[tuple[Symbol, Value], ...]
    name: str
    pre: dict[int, int]
    post: dict[int, int]
    inhibitors: tuple[int, ...] = ()
    resets: tuple[int, ...] = ()
    priority: int = 1000


@frozen
class Fault:
    """A binding that raises an exception when it occurs; `pre` as in `UnfoldedTransition`."""

    name: str
    message: str
    pre: dict[int, int]
    inhibitors: tuple[int, ...] = ()


@frozen
class Unfolding:
    """A place/transition net with the behaviour of a coloured one: markings and occurrences correspond one to one.

    Args:
        net: the coloured net.
        places: ordered by place, then by colour. Only colours that could come there if tokens were never used up.
        transitions: ordered by transition, then by the values of the variables; only those that could occur then.
        of_place: for each `FlatPlace` the indices of its unfolded places.
        faults: bindings with an exception. They are no transitions; if one can be enabled, the net is wrong.
    """

    net: FlatNet
    places: tuple[UnfoldedPlace, ...]
    transitions: tuple[UnfoldedTransition, ...]
    of_place: tuple[tuple[int, ...], ...]
    faults: tuple[Fault, ...] = ()
    has_priorities: bool = False

    @property
    def initial(self) -> tuple[int, ...]:
        """The initial marking: tokens by place."""
        return tuple(p.initial for p in self.places)

    def is_enabled(self, marking: tuple[int, ...], t: UnfoldedTransition) -> bool:
        """Whether the tokens are there; priorities do not count."""
        return all(marking[p] >= n for p, n in t.pre.items()) and not any(
            marking[p] for p in t.inhibitors
        )

    def fire(self, marking: tuple[int, ...], t: UnfoldedTransition) -> tuple[int, ...]:
        """The marking after an enabled transition."""
        after = list(marking)
        for p, n in t.pre.items():
            after[p] -= n
        for p, n in t.post.items():
            after[p] += n
        for p in t.resets:
            after[p] = 0
        return tuple(after)
