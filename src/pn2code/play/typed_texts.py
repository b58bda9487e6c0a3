"""What somebody types into the page, as CPN ML with the declarations of the net; what is wrong with it, with its place.

typist = Typist(net, elaborator)
typist.condition("length (Mark.Top'Free 1) > 2")      # Condition; BadText when it is wrong

The elaborator of a net is one for all sessions, so one text at a time is typed.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TypeVar

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostic, Diagnostics, Origin, SourceText
from pn2code.ml.core.instances import numbered
from pn2code.ml.core.terms import Exp
from pn2code.ml.core.types import Type
from pn2code.ml.elaborate import Elaborator
from pn2code.net import generative
from pn2code.net.flat import FlatNet, FlatPlace, FlatTransition, Form
from pn2code.net.forms import typed_marking
from pn2code.properties.marks import Looks, Marks
from pn2code.properties.names import Names

T = TypeVar("T")

MOST_TEXT = 20_000
"""Characters of a text."""


class BadText(Exception):
    """A text is wrong; the diagnostics say how (a user's matter).

    Args:
        diagnostics: what is wrong, errors first.
    """

    def __init__(self, diagnostics: tuple[Diagnostic, ...]) -> None:
        super().__init__("; ".join(i.message for i in diagnostics))
        self.diagnostics = diagnostics


@frozen
class Typed:
    """An expression, its type, and the places that it looks at."""

    exp: Exp
    type: Type
    looks: Looks


@frozen
class Condition:
    """An expression of type bool, with the places that it looks at."""

    text: str
    exp: Exp
    looks: Looks


class Typist:
    """Types texts with the declarations of a net.

    Args:
        net: the net.
        elaborator: knows its declarations.
    """

    def __init__(self, net: FlatNet, elaborator: Elaborator) -> None:
        self._net = net
        self._elaborator = elaborator
        self.lock = threading.RLock()

    def expression(self, text: str) -> Typed:
        """An expression of any type; `Mark.Page'Place n` is what a place holds.

        Raises:
            BadText: it is wrong.
        """
        with self._aside() as d:
            found = self._marks(d).expression(_source(text, "expression"))
            return Typed(*_good(found, d))

    def condition(self, text: str) -> Condition:
        """A condition on a marking.

        Raises:
            BadText: it is wrong.
        """
        with self._aside() as d:
            found = self._marks(d).condition(_source(text, "condition"))
            return Condition(text.strip(), *_good(found, d))

    def filters(self, text: str, t: FlatTransition) -> tuple[Exp, ...]:
        """Conditions on the variables of a transition, with commas between them, as in a guard.

        Raises:
            BadText: they are wrong.
        """
        with self._aside() as d:
            marks = self._marks(d)
            found: list[Exp] = []
            for part in filter(str.strip, _parts(text)):
                exp = marks.of_binding(_source(part.strip(), "condition"), t, d)
                if exp is None or d.has_errors:
                    raise BadText(tuple(d.sorted()))
                found.append(exp)
            return tuple(found)

    def marking(self, text: str, place: FlatPlace) -> tuple[Exp, Form, Origin]:
        """What a place shall hold.

        Raises:
            BadText: it is wrong.
        """
        with self._aside() as d:
            source = _source(text if text.strip() else "empty", "initial marking")
            found = typed_marking(self._elaborator, source, place.colset)
            exp, form = _good(found, d)
            if generative.refuse_beside(self._net.program.declarations, [exp], d):
                raise BadText(tuple(d.sorted()))
            return (
                numbered(exp, place.instance_number, self._elaborator.another),
                form,
                source.origin,
            )

    def _marks(self, d: Diagnostics) -> Marks:
        return Marks(self._net, self._elaborator, Names(self._net, d), d)

    @contextmanager
    def _aside(self) -> Iterator[Diagnostics]:
        """While the block lasts nobody else types anything."""
        d = Diagnostics()
        with self.lock, self._elaborator.aside(d):
            yield d


def _source(text: str, part: str) -> SourceText:
    clean = text.replace("\r\n", "\n")
    if len(clean) > MOST_TEXT:
        clean = clean[:MOST_TEXT]
    return SourceText(clean, Origin("what you typed", line=1, column=1, part=part))


def _good(found: T | None, d: Diagnostics) -> T:
    """The result, unless there is none."""
    if found is None or d.has_errors:
        raise BadText(tuple(d.sorted()))
    return found


def _parts(text: str) -> list[str]:
    """The parts between the commas that stand in no brackets and no string."""
    parts, depth, is_string, start = [], 0, False, 0
    i = 0
    while i < len(text):
        c = text[i]
        if is_string:
            i += c == "\\"
            is_string = c != '"'
        elif c == '"':
            is_string = True
        elif c in "([{":
            depth += 1
        elif c in ")]}":
            depth -= 1
        elif c == "," and depth == 0:
            parts.append(text[start:i])
            start = i + 1
        i += 1
    return [*parts, text[start:]]
