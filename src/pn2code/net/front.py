"""The whole front end: a file goes in, a flat net comes out."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from pn2code.diagnostics import Diagnostics
from pn2code.net.check import check
from pn2code.net.flat import FlatNet
from pn2code.net.flatten import flatten
from pn2code.net.link import link
from pn2code.reading.cpn import read


def load(path: Path, d: Diagnostics, values: Mapping[str, str] | None = None) -> FlatNet | None:
    """Read, link, check and flatten a `.cpn` file; stops after the first stage with errors.

    Args:
        path: the file.
        d: gets errors and warnings of all stages.
        values: replacements for `val` declarations of the net: name -> CPN ML text.

    Returns:
        The flat net, or None if there were errors.
    """
    document = read(path, d)
    if document is None:
        return None
    net = link(document, d)
    if net is None:
        return None
    typed = check(net, d, values)
    return None if typed is None else flatten(typed, d)
