"""What is not known of a marking, since it was drawn at random in a run that is only told from outside.

Known tokens are in the marking itself. Beside them there may be *late* tokens, of which only the time stamp is not
known, and in *open* places any others. Tokens are taken from the known ones first: what is left over then allows
at least what the real marking allows, so that no run that is possible is refused.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.base.readable import readable
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset
from pn2code.net.flat import FlatArc, Form
from pn2code.semantics.game.demands import Demand
from pn2code.semantics.game.enabling import Enabling
from pn2code.semantics.game.marking import Marking, PlaceMarking
from pn2code.semantics.values.colours import Colours
from pn2code.semantics.values.data import Timed, Value
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet

MOST_WAYS = 50
"""Ways to take tokens that are tried."""


@frozen
class PartialMarking:
    """What is not known beside a marking.

    Args:
        late: (place, tokens whose stamp is not known), by place.
        open: places that may hold any other tokens.
        clock: the time is known with the digits that are printed only.
        references: references may hold drawn values.
    """

    late: tuple[tuple[int, MultiSet], ...] = ()
    open: frozenset[int] = frozenset()
    clock: bool = False
    references: bool = False

    def __bool__(self) -> bool:
        return self.anything

    @property
    def anything(self) -> bool:
        """Whether there is anything that is not known."""
        return bool(self.late or self.open or self.clock or self.references)

    def covers(self, place: int) -> bool:
        """Whether the place may hold tokens that are not known."""
        return place in self.open or any(index == place for index, _ in self.late)

    def late_in(self, place: int) -> MultiSet:
        """The late tokens of a place."""
        return dict(self.late).get(place, MultiSet())

    def with_late(self, place: int, tokens: MultiSet) -> PartialMarking:
        """With these late tokens besides."""
        return self._set_late(place, self.late_in(place) + tokens)

    def without_late(self, place: int, value: Value) -> PartialMarking:
        """Without one late token."""
        return self._set_late(place, self.late_in(place) - MultiSet.of([value]))

    def _set_late(self, place: int, tokens: MultiSet) -> PartialMarking:
        late = {**dict(self.late), place: tokens}
        return replace(self, late=tuple((p, m) for p, m in sorted(late.items()) if len(m)))

    def opened(self, place: int) -> PartialMarking:
        """With any other tokens in the place."""
        return replace(self, open=self.open | {place})

    def forget(self, marking: Marking, place: int) -> tuple[Marking, PartialMarking]:
        """Nothing is known of the place any more."""
        places = list(marking.places)
        places[place] = MultiSet() if isinstance(places[place], MultiSet) else TimedMultiSet()
        late = tuple((p, m) for p, m in self.late if p != place)
        return (
            replace(marking, places=tuple(places)),
            replace(self, late=late, open=self.open | {place}),
        )


def without_delay(arc: FlatArc) -> FlatArc | None:
    """For an output arc `tokens @+ delay`: the arc as if it were `tokens` alone."""
    inscription = arc.inscription
    if inscription is None or inscription.form not in _UNDELAYED:
        return None
    match inscription.value:
        case core.Apply(
            function=core.Builtin(name="Time.@+" | "Time.@++" | "Time.token@+" | "Time.token@++"),
            argument=core.RecordExp(fields=((_, tokens), _)),
        ):
            form = _UNDELAYED[inscription.form]
            return replace(arc, inscription=replace(inscription, value=tokens, form=form))
    return None


_UNDELAYED = {Form.TIMED_TOKEN: Form.TOKEN, Form.TIMED_MULTISET: Form.MULTISET}


EXACT = PartialMarking()
"""Everything is known."""


def alternatives(enabling: Enabling, marking: Marking, demands: list[Demand]) -> Iterator[Marking]:
    """The markings without the demanded tokens: each choice among equal tokens with different stamps (of many, some).

    The choice of the token game comes first.
    """
    usual = enabling.take(marking, demands)
    if isinstance(usual, Demand):
        return
    yield usual
    seen = {usual}
    ordered = sorted(demands, key=lambda d: d.early)
    for left in itertools.islice(_choices(marking, ordered), MOST_WAYS):
        if left not in seen:
            seen.add(left)
            yield left


def _choices(marking: Marking, demands: list[Demand]) -> Iterator[Marking]:
    if not demands:
        yield marking
        return
    demand, *others = demands
    tokens = marking.places[demand.place]
    if isinstance(tokens, MultiSet):
        ways: list[PlaceMarking] = [tokens - MultiSet({demand.value: demand.count})]
    else:
        stamps = [
            s for s in tokens.stamps.get(demand.value, ()) if s - demand.early <= marking.time
        ]
        chosen = dict.fromkeys(itertools.islice(itertools.combinations(stamps, demand.count), 1000))
        ways = [tokens - [Timed(demand.value, s) for s in choice] for choice in chosen]
    for way in ways:
        places = list(marking.places)
        places[demand.place] = way
        yield from _choices(replace(marking, places=tuple(places)), others)


def taken(
    enabling: Enabling,
    colours: Colours,
    marking: Marking,
    unknown: PartialMarking,
    demands: list[Demand],
) -> tuple[Marking, PartialMarking] | Demand:
    """What is left without the demanded tokens, known ones taken first; or the first demand that cannot be met."""
    for demand in sorted(demands, key=lambda d: d.early):
        for _ in range(demand.count):
            one = replace(demand, count=1)
            left = enabling.take(marking, [one])
            if isinstance(left, Marking):
                marking = left
                continue
            late = _like(colours, enabling, demand, unknown.late_in(demand.place))
            if late is not None:
                unknown = unknown.without_late(demand.place, late[0])
            elif demand.place not in unknown.open:
                return demand
    return marking, unknown


def _like(
    colours: Colours, enabling: Enabling, demand: Demand, tokens: MultiSet
) -> tuple[Value] | None:
    """A token that is printed like the demanded one: recorded reals have lost digits."""
    if tokens.coefficient(demand.value):
        return (demand.value,)
    c = enabling.net.places[demand.place].colset
    text = readable(colours.text(c, demand.value))
    return next(((v,) for v in tokens.counts if readable(colours.text(c, v)) == text), None)


def final_difference(
    colours: Colours,
    c: Colset,
    tokens: PlaceMarking,
    unknown: PartialMarking,
    place: int,
    recorded: str,
) -> str:
    """How a place differs from its recorded marking, as far as it is known; "" if it does not."""
    left = counted(recorded, c)
    for text, count in counted(readable(colours.multiset_text(c, tokens)), c).items():
        if left.get(text, 0) < count:
            return f"{count}`{text}"
        left[text] -= count
    for value, count in unknown.late_in(place).counts.items():
        text = readable(colours.text(c, value))
        like = [found for found in left if found.rsplit("@", 1)[0] == text]
        for _ in range(count):
            found = next((x for x in like if left[x] > 0), None)
            if found is None:
                return f"{count}`{text}, with stamps that are not known"
            left[found] -= 1
    extra = [text for text, count in left.items() if count]
    if extra and place not in unknown.open:
        return f"no {extra[0]}"
    return ""


def counted(text: str, c: Colset) -> dict[str, int]:
    """A printed multi-set: text of a token -> how many."""
    if text == "empty":
        return {}
    found: dict[str, int] = {}
    for line in text.split("+++\n" if c.timed else "++\n"):
        count, _, token = line.partition("`")
        found[token] = found.get(token, 0) + (int(count) if count.isdecimal() else 0)
    return found
