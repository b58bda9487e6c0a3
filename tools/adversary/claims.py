"""What is claimed of a random cell: a property, and the same in Python, held against runs.

claim = never_both("Top.Supervisor.Idle1", "Top.D1.Told")
claim.text                                  # in the language of properties
claim.broken(moments, is_over=True)         # the number of the first moment that contradicts it, or None
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from pn2code.semantics.game.marking import PlaceMarking


@dataclass(frozen=True, slots=True)
class Moment:
    """A marking of a run: the numbers of tokens by the place's name, and what occurred just before ("": nothing).

    `held`: what the places hold, by name.
    """

    tokens: dict[str, int]
    fired: str = ""
    held: Mapping[str, PlaceMarking] = field(default_factory=dict)


Run = Sequence[Moment]
Broken = Callable[[Run, bool], int | None]
"""A run, and whether nothing comes after it: the number of the first moment that contradicts; None: there is none."""


@dataclass(frozen=True)
class Claim:
    """A property that runs can contradict.

    Args:
        text: in the language of properties.
        places: those that it is about.
        contradicts: finds what a run has against it.
        answer: the one that is contradicted so.
    """

    text: str
    places: tuple[str, ...]
    contradicts: Broken
    answer: str = "yes"
    most: int = 0
    """the greatest number of tokens, where it says one"""

    def broken(self, run: Run, *, is_over: bool) -> int | None:
        """The first moment of a run that contradicts the answer; `is_over`: nothing comes after the last one."""
        return self.contradicts(run, is_over)


def _asked(place: str) -> str:
    """A place as properties name it: by its path, or by its page where the path is that of a fusion set."""
    fused = place.removeprefix("Fusion.")
    return f'"{place}"' if fused == place else f"Sup'{fused}"


def _marked(place: str) -> str:
    return f"tokens({_asked(place)}) >= 1"


def _first(run: Run, is_bad: Callable[[Moment], bool]) -> int | None:
    return next((i for i, at in enumerate(run) if is_bad(at)), None)


def at_most(place: str, most: int) -> Claim:
    """The place never holds more tokens."""
    text = f"bound {_asked(place)} <= {most}"

    def broken(run: Run, _: bool) -> int | None:
        return _first(run, lambda at: at.tokens[place] > most)

    return Claim(text, (place,), broken, most=most)


def never_both(one: str, other: str) -> Claim:
    """They are never marked at once."""
    text = f"never {_marked(one)} && {_marked(other)}"
    return Claim(
        text,
        (one, other),
        lambda run, _: _first(run, lambda at: bool(at.tokens[one] and at.tokens[other])),
    )


def reached(one: str, other: str) -> Claim:
    """They can be marked at once: where the answer is no, no run shows it."""
    text = f"reachable {_marked(one)} && {_marked(other)}"
    both = never_both(one, other)
    return Claim(text, (one, other), both.contradicts, "no")


def followed(one: str, other: str) -> Claim:
    """After the first is marked the second one is at some time."""

    def broken(run: Run, is_over: bool) -> int | None:
        last = max((i for i, at in enumerate(run) if at.tokens[one]), default=-1)
        is_open = is_over and last >= 0 and not any(at.tokens[other] for at in run[last:])
        return last if is_open else None

    text = f"every {_marked(one)} is followed by {_marked(other)}"
    return Claim(text, (one, other), broken)


def followed_within(one: str, other: str, firings: int) -> Claim:
    """When the first becomes marked the second one is after so many firings at the latest."""

    def broken(run: Run, is_over: bool) -> int | None:
        for i, at in enumerate(run):
            if not at.tokens[one] or (i > 0 and run[i - 1].tokens[one]):
                continue
            near = run[i : i + firings + 1]
            is_whole = len(near) == firings + 1 or is_over
            if is_whole and not any(m.tokens[other] for m in near):
                return i
        return None

    text = f"every {_marked(one)} is followed by {_marked(other)} within {firings} firings"
    return Claim(text, (one, other), broken)


def silent(transition: str) -> Claim:
    """The transition never occurs."""
    text = f'ltl G !fires("{transition}")'
    return Claim(text, (), lambda run, _: _first(run, lambda at: at.fired == transition))


def not_before(one: str, other: str) -> Claim:
    """The first transition does not occur before the second one."""

    def broken(run: Run, _: bool) -> int | None:
        found = _first(run, lambda at: at.fired in (one, other))
        return found if found is not None and run[found].fired == one else None

    return Claim(f'ltl (!fires("{one}")) W fires("{other}")', (), broken)


def ends_with(place: str) -> Claim:
    """Nothing comes to rest without a token there."""

    def broken(run: Run, is_over: bool) -> int | None:
        return len(run) - 1 if is_over and not run[-1].tokens[place] else None

    return Claim(f"deadlock free except {_marked(place)}", (place,), broken)
