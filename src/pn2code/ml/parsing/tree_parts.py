"""What building any part of the syntax tree needs: spans, names, and the parts of a kind."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.diagnostics import NOWHERE, SourceText, Span
from pn2code.ml.parsing.lexer import Lexeme


@frozen
class Group:
    """Several nodes and the text they cover."""

    items: tuple[Any, ...]
    span: Span


@frozen
class Dots:
    """`...` in a record pattern."""

    span: Span


Children = list[Any]


class NotANameError(Exception):
    """A word stands where something gets a name, or where a label is, that is neither.

    Args:
        span: of the word.
        message: what is wrong.
    """

    def __init__(self, span: Span, message: str) -> None:
        super().__init__(message)
        self.span = span
        self.message = message


class TreeParts:
    """Helpers; `source` is set before each parse."""

    source: SourceText = SourceText("", NOWHERE)

    def _of(self, child: Any) -> Span:
        if isinstance(child, Lexeme):
            return Span(self.source, child.start, child.end)
        span: Span = child.span
        return span

    def _span(self, children: Children) -> Span:
        if not children:
            return Span(self.source, 0, 0)
        return self._of(children[0]).to(self._of(children[-1]))

    @staticmethod
    def _nodes(children: Iterable[Any]) -> tuple[Any, ...]:
        return tuple(c for c in children if not isinstance(c, Lexeme))

    @staticmethod
    def _texts(children: Iterable[Any], *kinds: str) -> tuple[str, ...]:
        return tuple(c.text for c in children if isinstance(c, Lexeme) and c.kind in kinds)

    def _name(self, token: Lexeme) -> str:
        """A name that is declared: one without points.

        Raises:
            NotANameError: it has points.
        """
        return short_name(token.text, self._of(token))

    def _names(self, children: Children) -> tuple[str, ...]:
        """The names among the parts, which are declared there."""
        return tuple(self._name(c) for c in children if isinstance(c, Lexeme) and c.kind == "ID")

    def _group(self, children: Children) -> Group:
        return Group(self._nodes(children), self._span(children))

    def _only(self, children: Children, kind: type) -> tuple[Any, ...]:
        return tuple(c for c in children if isinstance(c, kind))


def short_name(name: str, span: Span) -> str:
    """A name that is declared.

    Raises:
        NotANameError: it has points.
    """
    if is_long(name):
        raise NotANameError(
            span,
            f"`{name}` is the name of something inside a structure, which cannot be declared here",
        )
    return name


def is_long(name: str) -> bool:
    """Whether a name says in which structure to look: `List.map`."""
    return "." in name and name[0].isalpha()
