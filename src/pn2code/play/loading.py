"""The net that is to be played, as drawn and as played; one with errors is only drawn.

loaded = load(Path("net.cpn"), {}, d)
loaded.opened is None                      # it has errors: the page shows them, and nothing can occur
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from pn2code import registers
from pn2code.base.frozen import frozen
from pn2code.cell.locate import locate
from pn2code.diagnostics import Diagnostic, Diagnostics
from pn2code.ml.elaborate import Elaborator
from pn2code.monitors.functions import MonitorProgram
from pn2code.net import emptiness, front
from pn2code.reading.document import Document
from pn2code.semantics.evaluation.constants import compute
from pn2code.simulate.choose import monitors_of
from pn2code.verdict.opened import OpenNet, with_inputs


@frozen
class Loaded:
    """A net for pages.

    Args:
        path: of its file.
        document: as drawn.
        opened: as played; None: it has errors.
        problems: everything that was found, in order.
        monitors: its monitors; None: it has none.
    """

    path: Path
    document: Document
    opened: OpenNet | None
    problems: tuple[Diagnostic, ...] = ()
    monitors: MonitorProgram | None = None

    @property
    def elaborator(self) -> Elaborator | None:
        """Knows the declarations of the net."""
        typed = self.opened.examined.typed if self.opened is not None else None
        return typed.elaborator if typed is not None else None


def load(
    path: Path, values: Mapping[str, str], d: Diagnostics, *, inputs: Path | None = None
) -> Loaded | None:
    """Reads a net; None when there is nothing to draw, which was reported.

    Args:
        path: a .cpn, .cpnt or .pnml file, a cell.toml, or a folder with a cell.toml.
        values: replace `val`s of the net, over those of cell.toml.
        d: gets the errors and warnings.
        inputs: other input files than those beside cell.toml.
    """
    found = locate(path, d)
    if found is None:
        return None
    file, config = found
    replaced = {**(config.values if config else {}), **values}
    examined = front.examine(file, d, replaced, drawn=True, compute=compute)
    document = examined.document
    if document is None or not document.pages:
        return None
    opened: OpenNet | None = None
    monitors: MonitorProgram | None = None
    if examined.flat is not None and not d.has_errors:
        emptiness.warn(examined.flat, d)
        examined, config = registers.examined(examined, config, d)
        if examined.flat is None or d.has_errors:
            return None
        opened = with_inputs(OpenNet(examined.flat, config, examined), d, inputs)
        if d.has_errors:  # of the input files: the net itself is right
            return None
        monitors = monitors_of(examined, d)
    return Loaded(file, document, opened, tuple(d.sorted()), monitors)
