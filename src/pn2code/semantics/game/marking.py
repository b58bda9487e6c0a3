"""Markings, bindings, and their texts and JSON forms."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from pn2code.base.frozen import frozen
from pn2code.base.readable import readable
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import FlatNet, FlatPlace, FlatTransition
from pn2code.semantics.evaluation.references import NOTHING, Held
from pn2code.semantics.values.colour_json import Json, JsonError, from_json, to_json
from pn2code.semantics.values.colours import Colours
from pn2code.semantics.values.data import Timed, Value
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet

PlaceMarking = MultiSet | TimedMultiSet
"""What a place holds; timed exactly if its colour set is."""

Binding = Mapping[Symbol, Value]
"""Values of net variables."""


@frozen
class Marking:
    """The state of a net: model time, and what each place holds, in the order of `FlatNet.places`.

    Where transitions change references, what these hold belongs to it.
    """

    time: int | float
    places: tuple[PlaceMarking, ...]
    references: Held = NOTHING


@frozen
class BindingElement:
    """A transition with values of its variables.

    Args:
        transition: index in `FlatNet.transitions`.
        values: (variable, value) in the order of `FlatTransition.variables`. The outputs of a code segment are
            not there before the transition has occurred.
    """

    transition: int
    values: tuple[tuple[Symbol, Value], ...]

    @property
    def binding(self) -> dict[Symbol, Value]:
        """The values by variable."""
        return dict(self.values)

    @staticmethod
    def make(t: FlatTransition, binding: Binding) -> BindingElement:
        """The element with those of the transition's variables that have values."""
        return BindingElement(t.index, tuple((s, binding[s]) for s in t.variables if s in binding))


# --- texts ---------------------------------------------------------------------------------------


def place_text(
    colours: Colours, c: Colset, tokens: PlaceMarking, *, earlier_first: bool = False
) -> str:
    """What a place holds, as CPN Tools prints it; `earlier_first` as in the nodes of its state spaces."""
    return readable(colours.multiset_text(c, tokens, earlier_first=earlier_first))


def variable_text(colours: Colours, symbol: Symbol, value: Value) -> str:
    """The value of a variable as CPN Tools prints it."""
    assert symbol.colset is not None, "a net variable has a colour set"
    return readable(colours.text(symbol.colset, value))


def element_text(colours: Colours, net: FlatNet, element: BindingElement) -> str:
    """`Top.T (n=1, p=red)`, for messages."""
    values = ", ".join(f"{s.name}={variable_text(colours, s, v)}" for s, v in element.values)
    return f"{net.transitions[element.transition].name} ({values})"


# --- JSON ----------------------------------------------------------------------------------------


def place_to_json(colours: Colours, c: Colset, tokens: PlaceMarking) -> Json:
    """`[[count, value], ...]` or `[[count, value, stamp], ...]`, sorted by value, then stamp."""
    counted: dict[tuple[Value, float], int] = {}
    for token in tokens:
        entry = (token.value, token.stamp) if isinstance(token, Timed) else (token, 0)
        counted[entry] = counted.get(entry, 0) + 1
    ordered = sorted(counted.items(), key=lambda item: (colours.key(c, item[0][0]), item[0][1]))
    return [
        [count, to_json(c, value), stamp] if c.timed else [count, to_json(c, value)]
        for (value, stamp), count in ordered
    ]


def place_from_json(c: Colset, data: Json) -> PlaceMarking:
    """The reverse of `place_to_json`; a token without a stamp in a timed place is stamped 0.

    Raises:
        JsonError: the data have another form.
    """
    if not isinstance(data, list):
        raise JsonError(f"{data!r} is not the marking of a place: a list of [count, value] is")
    tokens: list[Value] = []
    for entry in data:
        if not isinstance(entry, list) or len(entry) not in (2, 3) or not _is_count(entry[0]):
            raise JsonError(f"{entry!r} is not [count, value] or [count, value, stamp]")
        value = from_json(c, entry[1])
        token = Timed(value, entry[2] if len(entry) == 3 else 0) if c.timed else value
        tokens.extend([token] * entry[0])
    return place_of(c, tokens)


def _is_count(data: Json) -> bool:
    return isinstance(data, int) and not isinstance(data, bool) and data >= 0


def place_of(c: Colset, tokens: Iterable[Value]) -> PlaceMarking:
    """The marking of a place from its tokens, which are `Timed` if the colour set is timed."""
    if not c.timed:
        return MultiSet.of(tokens)
    return TimedMultiSet.of(token for token in tokens if isinstance(token, Timed))


def binding_to_json(element: BindingElement) -> dict[str, Json]:
    """The binding as in a trace."""
    found: dict[str, Json] = {}
    for symbol, value in element.values:
        assert symbol.colset is not None, "a net variable has a colour set"
        found[symbol.name] = to_json(symbol.colset, value)
    return found


def initial_differences(
    colours: Colours, places: Iterable[FlatPlace], own: Marking, other: Marking
) -> dict[str, Json]:
    """The places where another initial marking differs from the net's own, for the header of a trace."""
    return {
        p.name: place_to_json(colours, p.colset, other.places[p.index])
        for p in places
        if own.places[p.index] != other.places[p.index]
    }
