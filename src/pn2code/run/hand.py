"""A person's hand in a run on the wall clock: what sensors say, who stands still, what fails, which messages are late.

    hand = Hand(choices, channels, wishes, patience)
    hand.look(engine)                              # again and again: takes the wishes that have come
    hand.asked("robot1", "camera", own, permitted) # what it says; None: a person has been asked
    hand.answer("robot1")                          # the same, later

Nobody is waited for when nobody is there, nor for longer than it is said: then the sensor says what it would have said.
"""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field
from typing import Any, Protocol

from pn2code.base.frozen import frozen, record
from pn2code.channels.scalars import Malformed
from pn2code.run.choices import Choice
from pn2code.run.late_files import Fate
from pn2code.tdl.requests import Scalar

Json = dict[str, Any]
Key = tuple[str, str]

BY = "person"
"""Who has chosen, in traces."""
MOST_SECONDS = 3600.0
MOST_NEXT = 20
"""Values that wait for a sensor's next questions."""
WAYS = ("ask", "own", "always")


class People(Protocol):
    """Those who watch a run, and what they ask for."""

    def present(self) -> int:
        """How many people are there."""

    def taken(self) -> Iterable[Mapping[str, Any]]:
        """What they have wished since the last call."""


@frozen
class Said:
    """What a sensor says, and who has chosen it ("": nobody); `why` in words, for the record."""

    value: Scalar | None
    by: str = ""
    why: str = ""


@record
class _Way:
    """How a sensor comes to its value."""

    way: str = "ask"
    value: Scalar | None = None
    next: list[Scalar] = field(default_factory=list)


@frozen
class _Question:
    number: int
    choice: Choice
    own: Scalar | None
    values: tuple[Scalar, ...]
    """that are permitted; empty: not listed"""
    permitted: Callable[[Iterable[Scalar]], Sequence[Scalar]]
    line: int
    began: float
    until: float


class Body(Protocol):
    """What a hand moves: a run."""

    def stand(self, party: str) -> None:
        """A robot or device stands still from now on."""

    def go_on(self, party: str, seconds: float) -> None:
        """It goes on where it was; it has stood so long."""

    def stood(self, party: str, seconds: float) -> None:
        """The run has ended while it stood, and it has stood so long."""

    def fail(self, party: str) -> None:
        """What it is doing fails."""

    def promise(self, party: str, channel: str, fate: Fate | None) -> None:
        """What becomes of its next message."""


class Hand:
    """What people want, and what has come of it.

    Args:
        choices: the sensors that are asked.
        channels: which channels a robot or device writes; it has all robots and devices.
        wishes: where wishes come from.
        patience: how long a person has for an answer, in seconds of the wall clock.
        clock: of the wall.
    """

    def __init__(
        self,
        choices: Mapping[Key, Choice],
        channels: Mapping[str, tuple[str, ...]],
        wishes: People,
        patience: float,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._choices, self._channels = dict(choices), dict(channels)
        self._wishes, self._clock = wishes, clock
        self.patience = patience
        self._ways = {key: _Way() for key in choices}
        self._questions: dict[str, _Question] = {}
        self._answers: dict[str, Said] = {}
        self._held: dict[str, tuple[float, float]] = {}
        """Since when a party stands, and until when at most (s of the wall clock)."""
        self._fates: dict[Key, Fate] = {}
        self._numbers = itertools.count(1)
        self._refused: tuple[int, str] = (0, "")

    # --- sensors -----------------------------------------------------------------------------------

    def asked(
        self,
        party: str,
        sensor: str,
        own: Scalar | None,
        permitted: Callable[[Iterable[Scalar]], Sequence[Scalar]],
        line: int = 0,
    ) -> Said | None:
        """What a sensor says; None: a person is asked (`answer`).

        Args:
            party, sensor: who asks what, in which line of its script.
            own: what the sensor says by itself.
            permitted: of values, those with which the program can go on.
        """
        choice, way = self._choices.get((party, sensor)), self._ways.get((party, sensor))
        if choice is None or way is None:
            return Said(own)
        wanted: list[Scalar] = []
        if way.next:
            wanted = [way.next.pop(0)]
        elif way.way == "always" and way.value is not None:
            wanted = [way.value]
        if wanted and permitted(wanted):
            return Said(wanted[0], BY)
        if wanted:
            self._refuse(
                f"{sensor} cannot say {choice.text(wanted[0])} to {party} here: its program could not go on"
            )
        if way.way == "own" or not self._wishes.present():
            return Said(own)
        listed = choice.values()
        values = tuple(permitted(listed)) if listed is not None else ()
        if listed is not None and not set(values) - {own}:
            return Said(own)  # there is nothing to choose
        now = self._clock()
        number = next(self._numbers)
        self._questions[party] = _Question(
            number, choice, own, values, permitted, line, now, now + self.patience
        )
        return None

    def answer(self, party: str, sees: Callable[[], Scalar | None] | None = None) -> Said | None:
        """What the person has answered; None: nothing yet, and there is still time.

        Args:
            sees: what the sensor sees now, of one that sees the scene: that may have changed since it was asked.
        """
        if (said := self._answers.pop(party, None)) is not None:
            return said
        question = self._questions.get(party)
        if question is None:
            return Said(None)
        why = "nobody was there any more to answer"
        if self._wishes.present():
            if self._clock() < question.until:
                return None
            why = f"nobody answered within {self.patience:g} s"
        del self._questions[party]
        own = question.own if sees is None else sees()
        text = question.choice.text(own) + (" is seen now" if sees is not None else "")
        return Said(own, "", f"sensor {question.choice.sensor}: {text}, as {why}")

    # --- holding -----------------------------------------------------------------------------------

    def holds(self, party: str) -> bool:
        """Whether a robot or device has to stand still."""
        return party in self._held

    def look(self, body: Body) -> None:
        """Takes what people have wished; ends what was to last so long."""
        for wish in self._wishes.taken():
            problem = self._take(wish, body)
            if problem:
                self._refuse(problem)
        now = self._clock()
        for party, (_, until) in list(self._held.items()):
            if now >= until or not self._wishes.present():
                self._release(party, body)

    def ended(self, body: Body) -> None:
        """The run has ended: tells who stands still, and since when."""
        now = self._clock()
        for party, (since, _) in self._held.items():
            body.stood(party, now - since)
        self._held.clear()

    def _release(self, party: str, body: Body) -> None:
        since, _ = self._held.pop(party)
        body.go_on(party, self._clock() - since)

    def _refuse(self, text: str) -> None:
        self._refused = (self._refused[0] + 1, text)

    # --- wishes ------------------------------------------------------------------------------------

    def _take(self, wish: Mapping[str, Any], body: Body) -> str:
        """Does it; why not, if not."""
        party = wish.get("party")
        match wish.get("do"):
            case "answer":
                return self._answer(wish)
            case "way" | "next":
                return self._set(wish)
            case "hold" if self._is_party(party):
                seconds = _seconds(wish.get("seconds"))
                if seconds is None:
                    return f"a time from 0 to {MOST_SECONDS:g} s is expected"
                now = self._clock()
                if party not in self._held:
                    body.stand(str(party))
                since = self._held.get(str(party), (now, 0.0))[0]
                self._held[str(party)] = (since, now + (seconds or math.inf))
                return ""
            case "go" if self._is_party(party):
                if party in self._held:
                    self._release(str(party), body)
                return ""
            case "fail" if self._is_party(party):
                body.fail(str(party))
                return ""
            case "lose" | "delay" | "let" as what if wish.get("channel") in self._channels.get(
                str(party), ()
            ):
                return self._message(what, str(party), str(wish["channel"]), wish, body)
        return "what is not understood is not done"

    def _is_party(self, name: object) -> bool:
        return isinstance(name, str) and name in self._channels

    def _answer(self, wish: Mapping[str, Any]) -> str:
        number = wish.get("number")
        asked = (x for x in self._questions.items() if x[1].number == number)
        party, question = next(asked, ("", None))
        if question is None:
            return "this question is not open any more"
        value = question.choice.value(str(wish.get("value")))
        if isinstance(value, Malformed):
            return value.text
        if not question.permitted([value]):
            return f"with {question.choice.text(value)} the program of {party} could not go on"
        del self._questions[party]
        after = self._clock() - question.began
        own = question.choice.text(question.own)
        why = f"sensor {question.choice.sensor}: {question.choice.text(value)}, chosen by a person after {after:.1f} s"
        self._answers[party] = Said(value, BY, f"{why}; by itself it would have said {own}")
        return ""

    def _set(self, wish: Mapping[str, Any]) -> str:
        key = (str(wish.get("party")), str(wish.get("sensor")))
        choice, way = self._choices.get(key), self._ways.get(key)
        kind = wish.get("way") if wish["do"] == "way" else "next"
        if choice is None or way is None or kind not in (*WAYS, "next"):
            return "what is not understood is not done"
        if kind in ("always", "next"):
            value = choice.value(str(wish.get("value")))
            if isinstance(value, Malformed):
                return value.text
            if kind == "next":
                if len(way.next) >= MOST_NEXT:
                    return f"{MOST_NEXT} values wait already for {choice.sensor}"
                way.next.append(value)
                return ""
            way.value = value
        way.way = str(kind)
        return ""

    def _message(
        self, what: str, party: str, channel: str, wish: Mapping[str, Any], body: Body
    ) -> str:
        self._fates.pop((party, channel), None)
        fate: Fate | None = None
        if what == "delay":
            seconds = _seconds(wish.get("seconds"))
            if not seconds:
                return f"a time above 0 and up to {MOST_SECONDS:g} s is expected"
            fate = Fate(seconds)
        elif what == "lose":
            fate = Fate(None)
        if fate is not None:
            self._fates[party, channel] = fate
        body.promise(party, channel, fate)
        return ""

    def fulfilled(self, party: str, channel: str) -> None:
        """A message had the fate that was promised."""
        self._fates.pop((party, channel), None)

    # --- what pages are told ---------------------------------------------------------------------------

    def described(self) -> Json:
        """What does not change."""
        return {
            "patience": self.patience,
            "sensors": [
                {
                    "party": c.party,
                    "sensor": c.sensor,
                    "variable": c.variable,
                    "says": c.says,
                    "allowed": c.allowed,
                    "values": c.texts(),
                }
                for c in self._choices.values()
            ],
            "parties": [
                {"name": name, "channels": channels} for name, channels in self._channels.items()
            ],
        }

    def told(self) -> Json:
        """How things are now."""
        now = self._clock()
        return {
            "present": self._wishes.present(),
            "questions": [
                {
                    "number": q.number,
                    "party": party,
                    "sensor": q.choice.sensor,
                    "variable": q.choice.variable,
                    "says": q.choice.says,
                    "allowed": q.choice.allowed,
                    "line": q.line,
                    "values": [q.choice.text(v) for v in q.values],
                    "own": q.choice.text(q.own),
                    "left": max(q.until - now, 0.0),
                }
                for party, q in self._questions.items()
            ],
            "ways": [
                {
                    "way": way.way,
                    "value": "" if way.value is None else self._choices[key].text(way.value),
                    "next": [self._choices[key].text(v) for v in way.next],
                }
                for key, way in self._ways.items()
            ],
            "held": {
                party: None if until == math.inf else max(until - now, 0.0)
                for party, (_, until) in self._held.items()
            },
            "fates": [
                {"party": party, "channel": channel, "late": fate.late}
                for (party, channel), fate in self._fates.items()
            ],
            "refused": list(self._refused),
        }


def _seconds(value: object) -> float | None:
    """A number of seconds; nothing is 0, which has no end; None: it is no number that is meant."""
    if value is None:
        return 0.0
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return float(value) if 0.0 <= value <= MOST_SECONDS else None
