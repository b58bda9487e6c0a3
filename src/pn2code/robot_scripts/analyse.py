"""Finds the program in a robot's part of the net, or says why there is none."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field

from pn2code.base.frozen import record
from pn2code.cell.partition import Channel, Owner, Partition
from pn2code.diagnostics import Diagnostics, Note
from pn2code.ml.core import terms as core
from pn2code.net.flat import ArcKind, FlatArc, FlatPlace, FlatTransition, Term
from pn2code.robot_scripts import codes
from pn2code.robot_scripts.machine import Machine, Outcome, Step
from pn2code.robot_scripts.tokens import (
    at_once,
    delayed_tokens,
    initial_tokens,
    is_empty,
    unstamped,
)


def analyse(partition: Partition, owner: Owner, d: Diagnostics) -> Machine | None:
    """Understand a robot's part of the net; None when something was reported."""
    before = len(d.errors)
    analyser = _Analyser(partition, owner, d)
    machine = analyser.run()
    return machine if len(d.errors) == before else None


def dead_transitions(partition: Partition, owner: Owner) -> list[tuple[FlatTransition, FlatPlace]]:
    """The owner's transitions that can never occur: an input place can never hold a token.

    Channels count as filled by their writers.
    """
    net = partition.net
    own = [
        t
        for t, o in zip(net.transitions, partition.transition_owner, strict=True)
        if o == owner.index
    ]
    marked = {c.place for c in partition.channels}
    marked |= {p.index for p in net.places if p.initial is not None and not is_empty(p.initial[0])}
    changed = True
    alive: set[int] = set()
    while changed:
        changed = False
        for t in own:
            if t.index not in alive and _missing(t, marked) is None:
                alive.add(t.index)
                marked |= {a.place for a in t.arcs if a.kind in (ArcKind.OUTPUT, ArcKind.BOTH)}
                changed = True
    out = []
    for t in own:
        missing = _missing(t, marked)
        if t.index not in alive and missing is not None:
            out.append((t, net.places[missing]))
    return out


def _missing(t: FlatTransition, marked: set[int]) -> int | None:
    return next(
        (
            a.place
            for a in t.arcs
            if a.kind in (ArcKind.INPUT, ArcKind.BOTH) and a.place not in marked
        ),
        None,
    )


@record
class _Analyser:
    partition: Partition
    owner: Owner
    d: Diagnostics
    channels: dict[int, Channel] = field(default_factory=dict)

    def run(self) -> Machine | None:
        net = self.partition.net
        self.channels = {c.place: c for c in self.partition.channels}
        dead = dead_transitions(self.partition, self.owner)
        skipped = {t.index for t, _ in dead}
        steps = [
            self.step(t)
            for t, o in zip(net.transitions, self.partition.transition_owner, strict=True)
            if o == self.owner.index and t.index not in skipped
        ]
        known = sorted(
            (s for s in steps if s is not None),
            key=lambda s: (s.transition.priority, s.transition.index),
        )
        if len(known) != len(steps):
            return None
        if not known:
            self.d.error(
                codes.NOT_SEQUENTIAL,
                f"{self.owner.phrase} has no transition that can occur",
                net.places[0].origins[0] if not dead else dead[0][0].origin,
                notes=[
                    f"its page instance is `{self.owner.instance}`",
                    *(
                        Note(
                            f"`{t.short}` takes from place `{p.short}`, which can never hold a token",
                            p.origins[0],
                        )
                        for t, p in dead[:3]
                    ),
                ],
                hint="put a token on the place where the program begins, and give its ports sockets: messages come "
                "through them",
            )
            return None
        found = self.roles(known)
        if found is None:
            return None
        control, variables, sinks = found
        start = next(p for p in control if self.initial_count(p) == 1)
        return Machine(
            self.owner, net, tuple(known), tuple(control), start, tuple(variables), tuple(sinks), self.channels,
            tuple(dead),
        )  # fmt: skip

    # one transition

    def step(self, t: FlatTransition) -> Step | None:
        """A transition's tokens, one by one; None after a report."""
        before = len(self.d.errors)
        takes: list[tuple[int, Term, int, int]] = []
        outcomes = [Outcome((), ())]
        for number, arc in enumerate(t.arcs):
            if arc.kind in (ArcKind.INHIBITOR, ArcKind.RESET):
                self.d.error(
                    codes.UNSUPPORTED_PROGRAM,
                    f"{arc.kind.value} arc in a robot's part of the net",
                    arc.origin,
                    notes=[Note(f"transition `{t.short}`", t.origin)],
                    hint="put a value into the place that says whether it is empty, and test it in a guard",
                )
                continue
            if arc.kind is not ArcKind.OUTPUT:
                takes += self.inputs(t, arc, number)
            if arc.kind is not ArcKind.INPUT:
                outcomes = self.outputs(t, arc, outcomes)
        if len(self.d.errors) != before:
            return None
        return Step(t, tuple(takes), tuple(outcomes))

    def inputs(
        self, t: FlatTransition, arc: FlatArc, number: int
    ) -> Iterator[tuple[int, Term, int, int]]:
        assert arc.inscription is not None
        for i, term in enumerate(arc.inscription.terms):
            if term.delay is not None:
                self.d.error(
                    codes.UNSUPPORTED_TIME, f"transition `{t.short}` uses time stamps", term.origin
                )
            elif term.whole or not (
                isinstance(term.coefficient, core.Lit) and term.coefficient.value == 1
            ):
                self.d.error(
                    codes.UNSUPPORTED_PROGRAM,
                    "a robot takes one token at a time, but this inscription is a multi-set",
                    term.origin,
                    notes=[Note(f"transition `{t.short}`", t.origin)],
                    hint="write one token, e.g. `k`",
                )
            else:
                yield arc.place, term, number, i

    def outputs(self, t: FlatTransition, arc: FlatArc, so_far: list[Outcome]) -> list[Outcome]:
        assert arc.inscription is not None
        out = []
        for conditions, values, delay in delayed_tokens(
            arc.inscription.value, arc.inscription.form, self.partition.net.program
        ):
            if values is None:
                self.d.error(
                    codes.UNSUPPORTED_PROGRAM,
                    "the number of tokens that this inscription puts is not known before it is evaluated",
                    arc.origin,
                    notes=[Note(f"transition `{t.short}`", t.origin)],
                    hint="write one token, or `if c then 1`x else empty`",
                )
                return so_far
            for o in so_far:
                if not _contradict(o.conditions, conditions):
                    new = tuple(c for c in conditions if c not in o.conditions)
                    puts = tuple((arc.place, v) for v in values)
                    delays = tuple((arc.place, delay) for _ in values if delay is not None)
                    out.append(
                        Outcome((*o.conditions, *new), (*o.puts, *puts), (*o.delays, *delays))
                    )
        return out

    # roles of places

    def initial_count(self, place: int) -> int | None:
        """Number of tokens in the initial marking; None where it is not known."""
        initial = self.partition.net.places[place].initial
        if initial is None:
            return 0
        found = list(initial_tokens(*initial, self.partition.net.program))
        if len(found) != 1 or found[0][1] is None:
            return None
        return len(found[0][1])

    def roles(self, steps: list[Step]) -> tuple[list[int], list[int], list[int]] | None:
        net = self.partition.net
        local = sorted(
            {p for s in steps for p, *_ in s.takes}
            | {p for s in steps for o in s.outcomes for p, _ in o.puts}
        )
        local = [p for p in local if p not in self.channels]
        read = {p for s in steps for p, *_ in s.takes}
        sinks = [p for p in local if p not in read]
        exchanged = [p for p in local if p in read and self.is_variable(p, steps)]
        fixed = [p for p in local if p not in sinks and p not in exchanged]
        chosen = self.cover(steps, set(fixed), [*sinks, *exchanged])
        if chosen is None:
            self.explain(steps, self.nearly(steps, fixed, exchanged))
            return None
        control = sorted(chosen)
        if not self.begins_at_once(control) or not self.initial_control(control):
            return None
        if not self.puts_without_stamps(steps, {*control, *self.channels}):
            return None
        for p in exchanged:
            if p not in chosen and net.places[p].colset.timed:
                self.d.error(
                    codes.UNSUPPORTED_TIME,
                    f"place `{net.places[p].short}` has a timed colour set, but holds data only",
                    net.places[p].origins[0],
                    notes=[
                        f"control stands at {', '.join(f'`{net.places[c].short}`' for c in control)}"
                    ],
                    hint="in a script only the control token can wait for time: "
                    "make the colour set of this place untimed",
                )
                return None
        return (
            control,
            [p for p in exchanged if p not in chosen],
            [p for p in sinks if p not in chosen],
        )

    def is_variable(self, place: int, steps: list[Step]) -> bool:
        """Whether a place holds one token, and each transition puts back as many as it takes: one or none."""
        if self.initial_count(place) != 1:
            return False
        for s in steps:
            taken = _taken(s, place)
            if taken > 1 or any(_put(o, place) != taken for o in s.outcomes):
                return False
        return True

    def cover(self, steps: list[Step], chosen: set[int], more: list[int]) -> set[int] | None:
        """The chosen places, with some of `more` where needed, so that each step takes and puts exactly one.

        Backtracks: the first step that is short of one decides which place comes next.
        """
        for s in steps:
            counts = [sum(_taken(s, p) for p in chosen)]
            counts += [sum(_put(o, p) for p in chosen) for o in s.outcomes]
            if max(counts) > 1:
                return None
            if min(counts) == 1:
                continue
            for p in more:
                touches = _taken(s, p) or any(_put(o, p) for o in s.outcomes)
                if p not in chosen and touches:
                    found = self.cover(steps, chosen | {p}, more)
                    if found is not None:
                        return found
            return None
        return chosen

    def nearly(self, steps: list[Step], fixed: list[int], exchanged: list[int]) -> list[int]:
        """The control places as far as they can be guessed, so that the message names the odd one out."""
        guess = list(fixed)
        for p in sorted(exchanged, key=lambda p: -sum(_taken(s, p) for s in steps)):
            if all(_taken(s, p) + sum(_taken(s, q) for q in guess) <= 1 for s in steps):
                guess.append(p)
        return guess

    def explain(self, steps: list[Step], fixed: list[int]) -> None:
        """Say which element keeps the net from being a sequential program."""
        places = self.partition.net.places

        def names(which: list[int]) -> str:
            return ", ".join(f"`{places[p].short}`" for p in which)

        for s in steps:
            t = s.transition
            sources = [p for p in fixed for _ in range(_taken(s, p))]
            if len(sources) > 1:
                self.error(
                    t,
                    f"transition `{t.short}` takes tokens from {len(sources)} places: {names(sources)}",
                )
                return
            for o in s.outcomes:
                targets = [p for p in fixed for _ in range(_put(o, p))]
                if len(targets) > 1:
                    self.error(
                        t,
                        f"transition `{t.short}` puts tokens on {len(targets)} places: {names(targets)}",
                        hint="if one of them is a value that the program keeps, let it hold a token from the start, "
                        "which transitions replace; if one is a message, it needs a [[channel]]",
                    )
                    return
        for s in steps:
            t = s.transition
            if not any(_taken(s, p) for p in fixed):
                self.error(
                    t,
                    f"transition `{t.short}` does not take the control token",
                )
                return
            if any(not any(_put(o, p) for p in fixed) for o in s.outcomes):
                self.error(
                    t,
                    f"transition `{t.short}` does not pass on the control token",
                )
                return
        t = steps[0].transition
        self.error(
            t,
            f"the places of {self.owner.phrase} are not those of a sequential program",
        )

    def error(self, t: FlatTransition, message: str, hint: str = "") -> None:
        self.d.error(
            codes.NOT_SEQUENTIAL,
            message,
            t.origin,
            notes=[
                "a robot script is one thread of control: every transition moves one token among the places that "
                "tell where the program is; other places hold exactly one token (variables) or are channels"
            ],
            hint=hint,
        )

    def begins_at_once(self, control: list[int]) -> bool:
        """Whether the first token is there when the script starts; its stamp would be lost in the script."""
        for place in (self.partition.net.places[p] for p in control):
            if place.initial is not None and not at_once(
                *place.initial, self.partition.net.program
            ):
                self.d.error(
                    codes.UNSUPPORTED_TIME,
                    f"place `{place.short}`, where the program begins, has a time stamp in its initial marking",
                    place.origins[0],
                    notes=[f"the script of {self.owner.phrase} begins at the start"],
                    hint="leave the time stamp out, and let a first transition that has the delay move the token on",
                )
                return False
        return True

    def puts_without_stamps(self, steps: list[Step], places: set[int]) -> bool:
        """Whether what is put on these places has no time stamps of its own: scripts know delays only."""
        for s in steps:
            for place, value in (x for o in s.outcomes for x in o.puts):
                if place in places and unstamped(value)[1] is not None:
                    self.d.error(
                        codes.UNSUPPORTED_TIME,
                        f"transition `{s.transition.short}` puts a token with a time stamp (`@`)",
                        next(a.origin for a in s.transition.arcs if a.place == place),
                        notes=[Note(f"transition `{s.transition.short}`", s.transition.origin)],
                        hint="write a delay: `@+`",
                    )
                    return False
        return True

    def initial_control(self, control: list[int]) -> bool:
        places = self.partition.net.places
        counts = {p: self.initial_count(p) for p in control}
        marked = [p for p, n in counts.items() if n != 0]
        if len(marked) == 1 and counts[marked[0]] == 1:
            return True
        what = ", ".join(f"`{places[p].short}`" for p in control)
        computed = [p for p, n in counts.items() if n is None]
        if computed:
            self.d.error(
                codes.NOT_SEQUENTIAL,
                f"the initial marking of place `{places[computed[0]].short}`, which tells where {self.owner.phrase} "
                "is, is computed: how many tokens it has is not known before the run",
                places[computed[0]].origins[0],
                notes=[f"the places that tell where it is are {what}"],
                hint="write the token itself, or a constant that is one (`val start = ..`): no function, no condition",
            )
            return False
        found = "hold several tokens initially" if marked else "hold no token initially"
        self.d.error(
            codes.NOT_SEQUENTIAL,
            f"the places that tell where {self.owner.phrase} is {found}",
            places[marked[0] if marked else control[0]].origins[0],
            notes=[f"these places are {what}"],
            hint="put exactly one token on the place where the program begins",
        )
        return False


def _taken(s: Step, place: int) -> int:
    return sum(p == place for p, *_ in s.takes)


def _put(o: Outcome, place: int) -> int:
    return sum(p == place for p, _ in o.puts)


def _contradict(a: tuple[tuple[core.Exp, bool], ...], b: tuple[tuple[core.Exp, bool], ...]) -> bool:
    return any(x == y and holds != other for x, holds in a for y, other in b)
