"""What is declared beside a net, e.g. for a monitor."""

from __future__ import annotations

from dataclasses import field

from pn2code.base.frozen import record
from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol


@record
class Aside:
    """What was declared beside a net; complete when its block has ended.

    Args:
        declarations: in order of evaluation, after those of the net.
        globals: the symbols of all names in scope at the end, those of the net included.
    """

    declarations: tuple[core.Dec, ...] = ()
    globals: dict[str, Symbol] = field(default_factory=dict)
