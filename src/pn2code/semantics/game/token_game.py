"""The token game: what a net does, step by step.

    game = Game(net)
    while elements := game.enabled():
        game.fire(elements[0])

`Game` keeps the current marking, and gives the same as functions from markings to markings (`enabled_in`, `occur`,
`advance_time`), from which state spaces are made. What references hold that occurrences change is part of a marking;
the random source is not. Nets that change references while they search for bindings are the exception: how often that
happens is not determined, so there they are part of nothing.

Documented order of `enabled()`: transitions of the best priority in the order of `FlatNet.transitions`, the bindings of
each in the order of `enabling`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

from pn2code.diagnostics import NOWHERE, Origin
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.terms import Exp, Symbol
from pn2code.net.flat import ArcKind, FlatArc, FlatNet, FlatPlace, FlatTransition, Form
from pn2code.semantics.evaluation.evaluate import Evaluator, Limits
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.evaluation.random import occurrence_of
from pn2code.semantics.evaluation.references import NOTHING, Held, tracked
from pn2code.semantics.game.constant import constant_transitions
from pn2code.semantics.game.demands import Demand
from pn2code.semantics.game.enabling import Enabling
from pn2code.semantics.game.enabling_cache import EnablingCache
from pn2code.semantics.game.errors import GameError, running
from pn2code.semantics.game.marking import (
    Binding,
    BindingElement,
    Marking,
    PlaceMarking,
    element_text,
    place_of,
    place_text,
)
from pn2code.semantics.values.colours import NotFinite
from pn2code.semantics.values.data import Timed, Value, zero_signs
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet

__all__ = ["Binding", "BindingElement", "Game", "GameError", "Marking", "NotEnabled"]

AT_START = Limits(steps=10_000_000)
"""Of a declaration or an initial marking, which are computed once: a thousand sorted tokens take a million."""


class NotEnabled(ValueError):
    """A binding element was to occur that is not enabled; the message says why."""


class Game:
    """A net in play.

    Args:
        net: the net.
        storage: colour sets of reals that are stored in another way: name -> "float32".
        initial: markings that replace the initial markings of the places of these names.
        seed: of the random functions.
        still: they give the same numbers at each step, as in a run that the explorer has found.
        limits: of each evaluation; None: the usual ones, `AT_START` for what is computed once.
        output: is given what the net prints.
        files: what the net can do with files; nothing by default.

    Attributes:
        marking: the current marking.
        steps: number of occurrences so far; what `step()` gives.

    Raises:
        GameError: a declaration or an initial marking raises an exception, or is not legal.
    """

    def __init__(
        self,
        net: FlatNet,
        storage: Mapping[str, str] | None = None,
        initial: Mapping[str, PlaceMarking] | None = None,
        *,
        seed: int = 1,
        still: bool = False,
        limits: Limits | None = None,
        output: Callable[[str], None] = lambda text: None,
        files: Files | None = None,
    ) -> None:
        self.net = net
        self._float32 = frozenset(n for n, how in (storage or {}).items() if how == "float32")
        with running(replace(NOWHERE, file=net.file, part="declarations"), "a declaration"):
            self.evaluator = Evaluator(
                net.program,
                real_time=net.real_time,
                seed=seed,
                limits=limits or AT_START,
                output=output,
                files=files,
            )
        self.colours = self.evaluator.colours
        self.enabling = Enabling(net, self.evaluator)
        self._enabling_cache = EnablingCache(net, self.enabling)
        self._by_priority = sorted(net.transitions, key=lambda t: t.priority)
        self._references, self._assigning = tracked(net, self.evaluator)
        self._present: Held = (
            NOTHING  # what the references hold, as far as occurrences are concerned
        )
        self.start: int | float = 0.0 if net.real_time else 0
        # The marking without what an element takes that does the same in every marking, and which it was.
        self._taken: tuple[Marking, Marking, BindingElement] | None = None
        self._has_begun = False
        own = Marking(self.start, tuple(map(self._initial, net.places)))
        self.own_initial_marking = self.with_references(own)
        self.marking = self._with_overrides(self.own_initial_marking, initial or {})
        self._has_begun = True
        self.evaluator.limits = limits or Limits()
        self.evaluator.random.is_still = still
        self.steps = 0

    # --- the current marking ---------------------------------------------------------------------

    @property
    def steps(self) -> int:
        """How many occurrences there were; inscriptions see it, and which numbers they draw depends on it."""
        return self._steps

    @steps.setter
    def steps(self, count: int) -> None:
        self._steps = self.evaluator.steps = count

    def enabled(self) -> list[BindingElement]:
        """What is enabled at the current time, priorities respected, in the documented order."""
        return self.enabled_in(self.marking)

    def fire(self, element: BindingElement, *, checked: bool = True) -> BindingElement:
        """Lets an enabled element occur; gives it with the outputs of the code segment.

        Args:
            element: the element.
            checked: look once more whether it is enabled; without, the caller knows.

        Raises:
            NotEnabled: it is not enabled.
            GameError: an inscription raises an exception, or gives a token that is not legal.
        """
        why = self.why_disabled(self.marking, element) if checked else None
        if why is not None:
            raise NotEnabled(f"{element_text(self.colours, self.net, element)}: {why}")
        self.evaluator.steps = self.steps + 1
        try:
            self.marking, occurred = self.occur(self.marking, element)
        except GameError:
            self.evaluator.steps = self.steps
            raise
        self.steps += 1
        return occurred

    def advance(self) -> bool:
        """If nothing is enabled now, moves the time to where something is; whether anything is enabled then."""
        self.marking = self.advance_time(self.marking)
        return bool(self.enabled())

    def set_time(self, time: float) -> None:
        """Moves the clock forward, for replays of runs against another clock."""
        if time < self.marking.time:
            raise ValueError("model time does not go back")
        self.marking = replace(self.marking, time=time if self.net.real_time else int(time))

    def run(
        self,
        choose: Callable[[list[BindingElement]], BindingElement] = lambda elements: elements[0],
        steps: int | None = None,
    ) -> Iterator[BindingElement]:
        """Plays on, advancing time where needed, until nothing is enabled or so many steps are done."""
        done = 0
        while (steps is None or done < steps) and self.advance():
            yield self.fire(choose(self.enabled()))
            done += 1

    def marking_text(self, place: str) -> str:
        """What a place of that unique name holds, as CPN Tools prints it."""
        found = next(p for p in self.net.places if p.name == place)
        return place_text(self.colours, found.colset, self.marking.places[found.index])

    # --- functions of markings -------------------------------------------------------------------

    def enabled_in(self, marking: Marking) -> list[BindingElement]:
        """What is enabled at the marking's time, priorities respected, in the documented order."""
        self._enter(marking)
        elements: list[BindingElement] = []
        best: int | None = None
        for t in self._by_priority:
            if best is not None and t.priority > best:
                break
            for binding in self._enabling_cache.enabled(t, marking):
                best = t.priority
                elements.append(BindingElement.make(t, binding))
        return elements

    def bindings(self, t: FlatTransition, marking: Marking) -> Iterator[Binding]:
        """The bindings with which a transition is enabled at the marking's time, whatever other transitions are."""
        self._enter(marking)
        return iter(self._enabling_cache.enabled(t, marking))

    def enabled_transitions(self, marking: Marking) -> list[FlatTransition]:
        """The transitions of which `enabled_in` lists elements; no more than one binding of each is looked for."""
        self._enter(marking)
        return self._enabling_cache.best(self._by_priority, marking)

    def enabled_or_raising(
        self, marking: Marking
    ) -> tuple[list[FlatTransition], dict[int, GameError]]:
        """The same, where an inscription may raise an exception: the transitions of which one does, and which.

        The simulator of CPN Tools stops when it looks at such a transition; before that others may occur.
        """
        self._enter(marking)
        raising: dict[int, GameError] = {}
        found = self._enabling_cache.best(self._by_priority, marking, raising)
        return found, raising

    def why_disabled(
        self, marking: Marking, element: BindingElement, *, priorities: bool = True
    ) -> str | None:
        """Why an element is not enabled in a marking at its time; None if it is."""
        self._enter(marking)
        t = self.net.transitions[element.transition]
        reason = self.enabling.why_disabled(t, marking, element.binding)
        if reason is None and not self._has_signs_of_tokens(t, marking, element.binding):
            reason = "the sign of a zero is not that of the token"
        if reason is not None:
            return reason
        if t.index in self._constant:
            self._taken = self.enabling.left, marking, element
        if not priorities:
            return None
        for other in self.net.transitions:
            if other.priority < t.priority:
                binding = next(self.enabling.enabled(other, marking), None)
                if binding is not None:
                    text = element_text(self.colours, self.net, BindingElement.make(other, binding))
                    return f"{text} has a higher priority and is enabled"
        return None

    def _has_signs_of_tokens(self, t: FlatTransition, marking: Marking, binding: Binding) -> bool:
        """Whether the zeros in an enabled binding are those that a search finds: equal ones may differ in the sign."""
        mine = _signs(binding, binding)
        if not any(mine):
            return True
        return any(
            # As tuples: what is no number is found again, as in a multi-set.
            tuple(binding[name] for name in found) == tuple(found.values())
            and _signs(found, found) == _signs(binding, found)
            for found in self.enabling.enabled(t, marking)
        )

    def advance_time(self, marking: Marking) -> Marking:
        """The marking at the earliest time, from its own on, at which something is enabled.

        The marking as it is when nothing will ever be enabled.
        """
        if not self.net.timed or self.enabled_transitions(marking):
            return marking
        self._enter(marking)
        times: set[int | float] = set()
        for t in self.net.transitions:
            times |= self.enabling.thresholds(t, marking)
        for time in sorted(times):
            later = replace(marking, time=time)
            if self.enabled_transitions(later):
                return later
        return marking

    def occur(self, marking: Marking, element: BindingElement) -> tuple[Marking, BindingElement]:
        """The marking after an enabled element has occurred, and the element with its code segment's outputs.

        The order is that of the real engine: action, tokens taken, delay, tokens put, reset arcs.

        Raises:
            GameError: an inscription raises an exception, or gives a token that is not legal; or the tokens are
                not there (an inscription has another value the second time).
        """
        self._enter(marking)
        t = self.net.transitions[element.transition]
        self.evaluator.now = marking.time
        self.evaluator.random.start(self.evaluator.steps, occurrence_of(t.index))
        if t.index in self._assigning:
            self._present = Held(())  # anything, should an exception end this
        binding = {**element.binding, **self.action(t, element.binding)}
        left = self._left(marking, element)
        if isinstance(left, Demand):
            name = self.net.places[left.place].name
            raise GameError(f"place `{name}` lacks tokens when the transition occurs", t.origin)
        delay = self.delay(t, binding)
        places = list(left.places)
        for arc in t.arcs:
            if arc.kind in (ArcKind.OUTPUT, ArcKind.BOTH):
                places[arc.place] = self.put(places[arc.place], arc, binding, delay, marking.time)
        for arc in t.arcs:
            if arc.kind is ArcKind.RESET:
                places[arc.place] = reset(places[arc.place], marking.time)
        after = Marking(left.time, tuple(places), left.references)
        if t.index in self._assigning:
            after = self.with_references(after)
        return after, BindingElement.make(t, binding)

    @cached_property
    def _constant(self) -> frozenset[int]:
        return constant_transitions(self.net)

    def _left(self, marking: Marking, element: BindingElement) -> Marking | Demand:
        """The marking without what an element takes; what `why_disabled` has just found of it, if it must be that."""
        if self._taken is not None:
            left, before, looked = self._taken
            if before is marking and looked is element:
                return left
        t = self.net.transitions[element.transition]
        return self.enabling.take(marking, self.enabling.demands(t, element.binding))

    # --- references --------------------------------------------------------------------------------

    def with_references(self, marking: Marking) -> Marking:
        """The same tokens with what the references hold now."""
        if self._references is None:
            return marking
        self._present = self._references.contents()
        return replace(marking, references=self._present)

    def enter(self, marking: Marking) -> None:
        """For whoever evaluates expressions of their own: time and references are those of a marking."""
        self._enter(marking)
        self.evaluator.now = marking.time

    def _enter(self, marking: Marking) -> None:
        """The references hold what they hold in a marking.

        What somebody else (a monitor) has put into them since the last occurrence stays as long as one goes on from it.
        """
        if self._references is not None and marking.references is not self._present:
            self._references.restore(marking.references)
            self._present = marking.references

    # --- the parts of an occurrence ----------------------------------------------------------------

    def action(self, t: FlatTransition, binding: Binding) -> dict[Symbol, Value]:
        """Runs the code segment, gives its outputs; `self.evaluator.now` must be set."""
        if t.code is None:
            return {}
        with running(t.code.origin, f"the code segment of `{t.name}`"):
            result = self._acted(t.code.action, binding)
        outputs = t.code.outputs
        if len(outputs) == 1:
            return {outputs[0]: result}
        return dict(zip(outputs, result, strict=True)) if outputs else {}

    def _acted(self, action: Exp, binding: Binding) -> Any:
        """What a code segment gives; it may talk to other programs, as monitors do, and nothing else."""
        connections = self.evaluator.files.connections
        if connections is None:
            return self.evaluator.value(action, binding)
        with connections.computed_once():
            return self.evaluator.value(action, binding)

    def delay(self, t: FlatTransition, binding: Binding) -> Any:
        """The delay of the transition; it is not evaluated where no output arc leads to a timed place."""
        if t.delay is None or not any(map(self._puts_stamps, t.arcs)):
            return 0
        with running(t.origin, f"the delay of `{t.name}`", "delay"):
            return self.evaluator.value(t.delay, binding)

    def _puts_stamps(self, arc: FlatArc) -> bool:
        is_output = arc.kind in (ArcKind.OUTPUT, ArcKind.BOTH)
        return is_output and self.net.places[arc.place].colset.timed

    def put(
        self,
        tokens: PlaceMarking,
        arc: FlatArc,
        binding: Binding,
        delay: float,
        now: float,
    ) -> PlaceMarking:
        """What a place holds after an output arc has put its tokens."""
        assert arc.inscription is not None
        with running(arc.inscription.origin, "the inscription"):
            value = self.evaluator.value(arc.inscription.value, binding)
        colset = self.net.places[arc.place].colset
        put = self._tokens(value, arc.inscription.form, colset, arc.inscription.origin)
        if isinstance(tokens, MultiSet):
            return tokens + MultiSet.of(put)
        return tokens + [
            Timed(x.value, x.stamp + delay) if isinstance(x, Timed) else Timed(x, now + delay)
            for x in put
        ]

    # --- details ---------------------------------------------------------------------------------

    def _tokens(self, value: Any, form: Form, colset: Colset, origin: Origin) -> list[Value]:
        """The tokens that an inscription's value stands for, legal and as they are stored."""
        if form in (Form.TOKEN, Form.TIMED_TOKEN):
            return [self._checked(value, colset, origin)]
        stored: list[Value] = []
        before: Any = None
        for token in value:
            # 1000000`1 is a million times the same object.
            same = bool(stored) and token is before
            stored.append(stored[-1] if same else self._checked(token, colset, origin))
            before = token
        return stored

    def _checked(self, token: Value, c: Colset, origin: Origin) -> Value:
        value = token.value if isinstance(token, Timed) else token
        with running(origin, f"the test of colour set `{c.name}`"):
            legal = self.colours.legal(c, value)
        if not legal:
            text = self.colours.text(c, value)
            raise GameError(
                f"illegal colour {text}: it is not in the colour set `{c.name}`", origin
            )
        try:
            stored = self.colours.stored(c, value, self._float32)
        except NotFinite as infinite:
            raise GameError(f"illegal colour: {infinite}", origin) from None
        return Timed(stored, token.stamp) if isinstance(token, Timed) else stored

    def _initial(self, place: FlatPlace) -> PlaceMarking:
        if place.initial is None:
            return place_of(place.colset, ())
        exp, form = place.initial
        origin = replace(place.origins[0] if place.origins else NOWHERE, part="initial marking")
        return self.marking_of(place, exp, form, origin, f"the initial marking of `{place.name}`")

    def marking_of(
        self, place: FlatPlace, exp: Exp, form: Form, origin: Origin, doing: str
    ) -> PlaceMarking:
        """What a place holds that holds the value of an expression.

        Args:
            place: the place.
            exp, form: the expression.
            origin, doing: where and what it is, for messages.

        Raises:
            GameError: it raises an exception, or gives a token that is not legal.
        """
        with running(origin, doing):
            value = self.evaluator.value(exp)
        return self._stamped(place.colset, self._tokens(value, form, place.colset, origin))

    def _stamped(self, c: Colset, tokens: list[Value]) -> PlaceMarking:
        """The marking of a place; tokens without stamp get the current time if the place is timed."""
        if not c.timed:
            return place_of(c, tokens)
        now = self.marking.time if self._has_begun else self.start
        return place_of(c, [x if isinstance(x, Timed) else Timed(x, now) for x in tokens])

    def _with_overrides(self, own: Marking, initial: Mapping[str, PlaceMarking]) -> Marking:
        places = list(own.places)
        index = {p.name: p.index for p in self.net.places}
        for name, tokens in initial.items():
            if name not in index:
                raise GameError(
                    f"there is no place `{name}` to give an initial marking",
                    replace(NOWHERE, file=self.net.file),
                )
            place = self.net.places[index[name]]
            origin = place.origins[0] if place.origins else NOWHERE
            checked = [self._checked(token, place.colset, origin) for token in tokens]
            places[place.index] = self._stamped(place.colset, checked)
        return replace(own, places=tuple(places))


def _signs(binding: Binding, names: Iterable[Symbol]) -> list[tuple[bool, ...]]:
    """For each of the variables the signs of the zeros in its value."""
    return [tuple(zero_signs(binding[name])) for name in names]


def reset(tokens: PlaceMarking, now: float) -> PlaceMarking:
    """Empties a place; a timed one keeps what is not available yet."""
    if isinstance(tokens, MultiSet):
        return MultiSet()
    return TimedMultiSet.of(token for token in tokens if token.stamp > now)
