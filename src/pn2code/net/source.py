"""A file becomes a `Document`: a `.cpn` file of CPN Tools, a `.pnml` file, or a net as text (`.cpnt`)."""

from __future__ import annotations

from pathlib import Path

from pn2code.diagnostics import Diagnostics
from pn2code.reading import cpn
from pn2code.reading.document import Document
from pn2code.reading.xml import read_bytes


def read(
    path: Path, d: Diagnostics, *, partial: bool = False, drawn: bool = True
) -> Document | None:
    """Read a net.

    Args:
        path: the file; messages and origins carry it as given. Its name or its root element says which format it has.
        d: gets the errors and warnings.
        partial: give what could be read even after errors, for a look at the rest of the net.
        drawn: whether the layout is needed.

    Returns:
        The document, or None if there were errors (if `partial`: only if this is no net at all).
    """
    data = read_bytes(path, d)
    if data is None:
        return None
    if path.suffix.lower() == ".cpnt":
        from pn2code.text_form import read as text_form  # most nets are drawn

        return text_form.read_data(data, str(path), d, partial=partial)
    if path.suffix.lower() != ".cpn":
        from pn2code.pnml import read as pnml  # most nets are no PNML

        if pnml.is_pnml(str(path), data):
            return pnml.read_data(data, str(path), d, partial=partial)
    return cpn.read_data(data, str(path), d, partial=partial, drawn=drawn)
