"""The net that a path means, and the cell beside it: what everything about behaviour begins with."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from pn2code import registers
from pn2code.base.frozen import frozen
from pn2code.cell.config import CellConfig
from pn2code.cell.locate import locate
from pn2code.diagnostics import Diagnostics
from pn2code.input_files import Given, begin, begin_as
from pn2code.net import emptiness, front
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.token_game import Game
from pn2code.trace.script import Trace, TraceRefusedError


@frozen
class OpenNet:
    """A net, the cell beside it, if there is one, and what the front end knows of it.

    `given`: the markings that files gave; they are the initial markings of `flat`. `inputs`: where these files are, if
    not beside cell.toml.
    """

    flat: FlatNet
    config: CellConfig | None
    examined: front.Examined
    given: tuple[Given, ...] = ()
    inputs: Path | None = None

    @property
    def storage(self) -> Mapping[str, str]:
        """How colour sets of reals are stored: name -> "float32"."""
        return self.config.storage if self.config else {}

    @property
    def initial(self) -> str | None:
        """The markings that files gave, as the header of a trace has them; None: there are none."""
        rows = (f"{json.dumps(g.name)}: {g.marking}" for g in self.given)
        return f"{{{', '.join(rows)}}}" if self.given else None

    def game(self, *, seed: int, files: Path | None) -> Game:
        """The net at its start.

        Raises:
            GameError: a declaration or an initial marking raises an exception.
        """
        return Game(self.flat, self.storage, seed=seed, files=Files(files))


def read(
    path: Path, values: Mapping[str, str], d: Diagnostics, *, int_bits: int = 31
) -> OpenNet | None:
    """The net that a path means; None after an error that was reported.

    Args:
        path: a .cpn, .cpnt or .pnml file, a cell.toml, or a folder with a cell.toml.
        values: replace `val`s of the net, over those of cell.toml.
        d: gets the errors and warnings.
        int_bits: width of `int`.
    """
    found = locate(path, d)
    if found is None:
        return None
    net_path, config = found
    replaced = {**(config.values if config else {}), **values}
    examined = front.examine(net_path, d, replaced, int_bits=int_bits, compute=compute)
    if examined.flat is None or d.has_errors:
        return None
    emptiness.warn(examined.flat, d)
    examined, config = registers.examined(examined, config, d)
    if examined.flat is None or d.has_errors:
        return None
    return OpenNet(examined.flat, config, examined)


def as_traced(opened: OpenNet, trace: Path) -> OpenNet:
    """The net as a trace says that it began; what cannot be read of the trace is told when it is repeated."""
    try:
        initial = Trace.open(trace, opened.flat).header.initial
    except (TraceRefusedError, OSError):
        return opened
    begun = begin_as(opened.flat, initial)
    return opened if begun is None else replace(opened, flat=begun.net, given=begun.given)


def with_inputs(opened: OpenNet, d: Diagnostics, inputs: Path | None = None) -> OpenNet:
    """The net as a run of its cell begins it (`input_files`).

    Args:
        opened: the net.
        d: gets what is wrong with the files.
        inputs: other files than those beside cell.toml, as for `input_files.begin`.
    """
    begun = begin(opened.flat, opened.config, d, given=inputs)
    return replace(opened, flat=begun.net, given=begun.given, inputs=inputs)
