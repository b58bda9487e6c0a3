"""The whole front end: a file goes in, a flat net comes out."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostic, Diagnostics, TooManyDiagnosticsError
from pn2code.ml.codes import UNBOUND, UNKNOWN_COLOUR_SET
from pn2code.ml.core.computing import Compute
from pn2code.net import generative, guard_order
from pn2code.net.check import check
from pn2code.net.codes import (
    NEIGHBOUR_WRONG,
    PLACE_COLSET,
    PORT_IDLE,
    PORT_UNASSIGNED,
    SOCKET_UNASSIGNED,
)
from pn2code.net.flat import FlatNet
from pn2code.net.flatten import check_hierarchy, flatten
from pn2code.net.link import link
from pn2code.net.source import read
from pn2code.net.typed import TypedNet
from pn2code.reading.cpn import give_up
from pn2code.reading.document import Document


@frozen
class Examined:
    """What the front end made of a file.

    Args:
        document: what the file says; None if it is no net.
        flat: the flat net; None if there were errors.
        typed: the net before it was flattened; None without a flat net.
    """

    document: Document | None
    flat: FlatNet | None
    typed: TypedNet | None = None


def examine(
    path: Path,
    d: Diagnostics,
    values: Mapping[str, str] | None = None,
    *,
    int_bits: int = 31,
    drawn: bool = False,
    compute: Compute | None = None,
) -> Examined:
    """Read, link, check and flatten a `.cpn` file, going on after errors.

    What cannot be resolved is passed over, so that all that is wrong independently is reported in one run.

    Args:
        path: the file.
        d: gets errors and warnings of all stages.
        values: replacements for `val` declarations of the net: name -> CPN ML text.
        int_bits: width of `int`: 31, as in CPN Tools, or 64.
        drawn: whether the document will be drawn, that is, has its layout.
        compute: evaluates bounds of colour sets and priorities that cannot be folded
            (`semantics.evaluation.constants`); without it nets that need it are refused.
    """
    try:
        return _examine(path, d, values, int_bits, drawn, compute)
    except TooManyDiagnosticsError:
        give_up(str(path), d)
        return Examined(None, None)


def _examine(
    path: Path,
    d: Diagnostics,
    values: Mapping[str, str] | None,
    int_bits: int,
    drawn: bool,
    compute: Compute | None,
) -> Examined:
    before = len(d.errors)
    document = read(path, d, partial=True, drawn=drawn)
    first = len(d.items)
    net = link(document, d, partial=True) if document is not None else None
    if net is None:
        return Examined(document, None)
    linked = len(d.errors) == before
    typed = check(net, d, values, partial=True, int_bits=int_bits, compute=compute)
    if document is not None and document.unread:
        _drop_consequences(d, document.unread, first)
    if typed is None or not linked:
        return Examined(document, None)
    if len(d.errors) > before:
        check_hierarchy(typed, d)
        return Examined(document, None)
    flat = flatten(typed, d)
    if flat is not None and generative.refuse(flat, d):
        return Examined(document, None, typed)
    if flat is not None:
        guard_order.warn(flat, d)
    return Examined(document, flat, typed)


def _drop_consequences(d: Diagnostics, unread: frozenset[str], first: int) -> None:
    """Leave out what is said from the item `first` on only because lines of a text cannot be read.

    Such are names that those lines may declare, and ports and transitions beside them that lack something.
    """

    def follows(item: Diagnostic) -> bool:
        if item.code in (PORT_IDLE, PORT_UNASSIGNED, SOCKET_UNASSIGNED, NEIGHBOUR_WRONG):
            return True
        named = item.message.split("`")[1::2]
        return item.code in _OF_NAMES and bool(named) and named[-1] in unread

    d.items[first:] = [item for item in d.items[first:] if not follows(item)]


_OF_NAMES = (PLACE_COLSET, UNKNOWN_COLOUR_SET, UNBOUND)


def load(
    path: Path,
    d: Diagnostics,
    values: Mapping[str, str] | None = None,
    *,
    int_bits: int = 31,
    compute: Compute | None = None,
) -> FlatNet | None:
    """The flat net of a `.cpn` file; None if there were errors. See `examine`."""
    return examine(path, d, values, int_bits=int_bits, compute=compute).flat
