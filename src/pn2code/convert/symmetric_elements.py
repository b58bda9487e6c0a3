"""Sorts of PNML symmetric nets, and the elements of terms."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.convert.pnml import element
from pn2code.ml.core.colsets import Colset


@frozen
class SymmetricSort:
    """A colour set as a sort: its id; `colset` is looked through to what it is."""

    id: str
    colset: Colset


def subterm(term: str) -> str:
    """An operand."""
    return element("subterm", term)


def nested(tag: str, terms: list[str], *, always: bool = False) -> str:
    """An operator of the terms; of one alone, the term itself."""
    if len(terms) == 1 and not always:
        return terms[0]
    return element(tag, *map(subterm, terms))


def sum_of(terms: list[str]) -> str:
    """A sum of multi-sets."""
    some = [t for t in terms if t]
    return nested("add", some) if some else ""


def number_of(n: int, term: str) -> str:
    """So many tokens of a value."""
    count = element("numberconstant", element("positive"), value=n)
    return element("numberof", subterm(count), subterm(term))


def structure(tag: str, term: str) -> str:
    """The structured inscription around a term."""
    return element(tag, element("structure", term))


def user_sort(sort: SymmetricSort) -> str:
    """A sort by its name."""
    return element("usersort", declaration=sort.id)
