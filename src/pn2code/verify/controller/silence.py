"""When somebody waits for others while it owes an answer, in terms of the places of the cell as it runs."""

from __future__ import annotations

from pn2code.base.frozen import frozen


@frozen
class Ready:
    """When a script that has come to a control place need not wait any longer: one of its transitions can occur there.

    Args:
        messages: for each of its messages the places that are marked if it is there.
        transition: it has to be enabled as well, since its guard or its tokens may leave the script waiting for the
            messages of another one; None: where its messages are there, the script goes on, or stops.
        places: its own places, which tell then whether it is.
    """

    messages: tuple[tuple[int, ...], ...]
    transition: int | None = None
    places: tuple[int, ...] = ()


@frozen
class Silence:
    """When somebody waits for others while it owes an answer (I8 of docs/protocol.md): for how long, nobody knows.

    Args:
        owes: the place that is marked while it does.
        states: the control places at which it may have to wait for a message, with the transitions there.
        steps: of its own, which it takes before it waits, and of the clock: while time goes on, it may be this that
            it waits for; whoever waits for a message still does so when nobody waits for time any more.
        answers: of each channel to the supervisor, its place and that of what the supervisor has seen.
        unanswered: where its script ends without an answer, see `unanswered`; "": it always answers.
        awaited: for which messages of others than the supervisor it waits, in words: "`away` of robot `maker`".
    """

    who: str
    owes: int
    states: tuple[tuple[int, tuple[Ready, ...]], ...]
    answers: tuple[tuple[int, int], ...]
    steps: tuple[int, ...] = ()
    unanswered: str = ""
    awaited: tuple[str, ...] = ()
