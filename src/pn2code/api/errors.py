"""What the library raises."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from pn2code.diagnostics import Diagnostic, Diagnostics, render
from pn2code.semantics.game.token_game import GameError


class NetError(Exception):
    """A net, a cell, a property or a run is wrong.

    Attributes:
        diagnostics: everything that was found, errors and warnings, as `pn2code check` would print them.
    """

    def __init__(self, diagnostics: tuple[Diagnostic, ...]) -> None:
        super().__init__(diagnostics)
        self.diagnostics = diagnostics

    def __str__(self) -> str:
        """As `pn2code` prints them."""
        return render.report(self.diagnostics)


def refuse(d: Diagnostics) -> NetError:
    """The error to be raised for what was reported."""
    return NetError(tuple(d.sorted()))


@contextmanager
def playing() -> Iterator[None]:
    """An exception of the net is raised as a `NetError`."""
    try:
        yield
    except GameError as error:
        d = Diagnostics()
        error.report(d)
        raise refuse(d) from None
