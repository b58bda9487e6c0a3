"""What verbs about a net and its behaviour begin with: the net that a path means, ready to be played."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import typer

from pn2code.cell.config import CellConfig
from pn2code.cell.locate import locate
from pn2code.cli.options import DEFAULT_INT_BITS, Format, print_diagnostics, stop
from pn2code.diagnostics import Diagnostics, Severity
from pn2code.net import front
from pn2code.net.flat import FlatNet
from pn2code.semantics.files import Files
from pn2code.semantics.game import Game, GameError


@dataclass(frozen=True, slots=True)
class OpenNet:
    """A net, the cell beside it, if there is one, and what the front end knows of it."""

    flat: FlatNet
    config: CellConfig | None
    examined: front.Examined

    @property
    def storage(self) -> Mapping[str, str]:
        """How colour sets of reals are stored: name -> "float32"."""
        return self.config.storage if self.config else {}

    def game(self, *, seed: int, files: Path | None) -> Game:
        """The net at its start.

        Raises:
            GameError: a declaration or an initial marking raises an exception.
        """
        return Game(self.flat, self.storage, seed=seed, files=Files(files))


def open_net(
    path: Path, values: Mapping[str, str], form: Format = Format.FULL, *, int_bits: int = 31
) -> OpenNet:
    """The net that a path means, with `val`s replaced; leaves with a report when it is wrong.

    What is `unsupported-...` is said before the net is played: applying it will stop the run.
    """
    d = Diagnostics()
    found = locate(path, d)
    if found is None:
        stop(d, form)
    net_path, config = found
    replaced = {**(config.values if config else {}), **values}
    examined = front.examine(net_path, d, replaced, int_bits=int_bits)
    flat = examined.flat
    if flat is None or d.has_errors:
        stop(d, form)
    unsupported = [i for i in d.sorted() if i.code.startswith("unsupported-")]
    print_diagnostics((i for i in unsupported if i.severity is Severity.WARNING), form)
    return OpenNet(flat, config, examined)


def refuse_wide(config: CellConfig | None, int_bits: int) -> None:
    """Leaves when the programs of a cell are asked about with integers that they do not have."""
    if config is not None and int_bits != DEFAULT_INT_BITS:
        raise typer.BadParameter(
            f"the programs of a cell have integers of {DEFAULT_INT_BITS} bits, so nothing can be said of them "
            f"with {int_bits}; colour set `intinf` has larger ones",
            param_hint="--int-bits",
        )


@contextmanager
def playing(form: Format = Format.FULL) -> Iterator[None]:
    """An error of the net while it is played is reported like one found in checking it."""
    try:
        yield
    except GameError as error:
        d = Diagnostics()
        error.report(d)
        stop(d, form)
