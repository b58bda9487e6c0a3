"""Properties as they are written: names are not resolved, CPN ML is text."""

from __future__ import annotations

from dataclasses import field

from pn2code.base.frozen import frozen
from pn2code.diagnostics import SourceText, Span


@frozen
class Name:
    """A place or transition instance.

    Args:
        text: `Page'Name`, or the path if it was written in quotes.
        number: of the page instance; None: not written.
        quoted: whether it is a path.
    """

    text: str
    number: int | None
    quoted: bool
    span: Span = field(compare=False, repr=False)


@frozen
class Word:
    """`true`, `false`, `dead`, `initial`."""

    word: str
    span: Span = field(compare=False, repr=False)


@frozen
class Ml:
    """`{ .. }`: a condition in CPN ML; `text` without the braces."""

    text: SourceText
    span: Span = field(compare=False, repr=False)


@frozen
class Tokens:
    """`tokens(P, Q) <= 3`: numbers, or numbers of tokens in some places, compared with a CPN ML operator."""

    operator: str
    left: int | tuple[Name, ...]
    right: int | tuple[Name, ...]
    span: Span = field(compare=False, repr=False)


@frozen
class Marked:
    """A place as an item of `mutex`: it holds a token."""

    name: Name
    span: Span = field(compare=False, repr=False)


@frozen
class Enabled:
    """`enabled(T)`."""

    name: Name
    span: Span = field(compare=False, repr=False)


@frozen
class Fires:
    """`fires(T)`, `fires(T, { n = 3 })`.

    Args:
        name: the transition instance.
        condition: what its binding must be; None: any.
    """

    name: Name
    condition: Ml | None
    span: Span = field(compare=False, repr=False)


@frozen
class Operation:
    """An operator with its operands.

    Args:
        operator: "not", "and", "or", "implies", "iff"; of `ltl` "X", "F", "G", "U", "R", "W"; of `ctl` "AX", "EX",
            "AF", "EF", "AG", "EG", "AU", "EU", "AW", "EW", "AR", "ER".
        parts: its operands.
        step: of `EX<T>` and `AX<T>`.
    """

    operator: str
    parts: tuple[Formula, ...]
    step: Name | None
    span: Span = field(compare=False, repr=False)


Formula = Word | Ml | Tokens | Marked | Enabled | Fires | Operation


@frozen
class Fair:
    """`strong T`: enabled infinitely often, it occurs infinitely often. `weak T`: enabled from some point on.

    Args:
        strong: which of the two.
        name: the transition instance; None: all.
    """

    strong: bool
    name: Name | None


@frozen
class DeadlockFree:
    """`deadlock free except final`."""

    final: Formula | None


@frozen
class Bound:
    """`bound 1 <= P <= 3`; None: no limit on that side."""

    place: Name
    low: int | None
    high: int | None


@frozen
class Marking:
    """`always p`, `never p`, `reachable p`."""

    word: str
    condition: Formula


@frozen
class Mutex:
    """`mutex p, q, ..`."""

    items: tuple[Formula, ...]


@frozen
class Response:
    """`every p is followed by q`.

    Args:
        first, second: events.
        firings: most firings until then; None: no such limit.
        time: most units of model time until then, as written.
        fair: what is assumed.
    """

    first: Formula
    second: Formula
    firings: int | None = None
    time: str | None = None
    fair: tuple[Fair, ...] = ()


@frozen
class Branching:
    """`ctl f`."""

    formula: Formula


@frozen
class Linear:
    """`ltl f assuming ..`."""

    formula: Formula
    fair: tuple[Fair, ...] = ()


Property = DeadlockFree | Bound | Marking | Mutex | Response | Branching | Linear
