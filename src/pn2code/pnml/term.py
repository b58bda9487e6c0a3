"""A term in translation: pieces of text with the elements that they came from, and when it needs parentheses."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.pnml.sorts import Sort
from pn2code.reading.xml import Node

Code = tuple[tuple[str, Node], ...]
"""Pieces of text with the elements that they came from."""


@frozen
class Term:
    """A term.

    Args:
        code: its text.
        sort: of the value, or of the elements of the multi-set; None for `empty` and numbers of any sort.
        many: whether it is a multi-set.
        atomic: whether the text needs no parentheses.
        most: of a multi-set `n ** CS.all()`: how many of each value there are; else 0.
        count: of a multi-set of n times one value: n; else 0.
    """

    code: Code
    sort: Sort | None
    many: bool = False
    atomic: bool = True
    most: int = 0
    count: int = 0


class TermError(Exception):
    """A term cannot be translated; it has been reported."""


def joined(separator: str, codes: list[Code], node: Node) -> Code:
    """Pieces with a separator between them."""
    pieces: list[tuple[str, Node]] = []
    for i, code in enumerate(codes):
        if i:
            pieces.append((separator, node))
        pieces.extend(code)
    return tuple(pieces)


def closed(term: Term, node: Node) -> Code:
    """The text of a term, in parentheses where it needs them."""
    return term.code if term.atomic else (("(", node), *term.code, (")", node))


def operand(term: Term, node: Node) -> Code:
    """A multi-set as an operand: only sums and differences need parentheses."""
    text = text_of_term(term)
    return closed(term, node) if " ++ " in text or " -- " in text else term.code


def summand(term: Term, node: Node) -> Code:
    """A multi-set in a sum: sums stand as they are, so that patterns stay visible."""
    return closed(term, node) if " -- " in text_of_term(term) else term.code


def text_of_term(term: Term) -> str:
    """The text of a term alone."""
    return "".join(text for text, _ in term.code)
