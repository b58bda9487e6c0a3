"""Nets and cells, loaded from files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Literal

from pn2code.api.drawing import Drawing
from pn2code.api.errors import playing, refuse
from pn2code.api.marking import Marking
from pn2code.api.simulation import Simulation, simulate
from pn2code.api.verification import Verification, verify
from pn2code.diagnostics import Diagnostic, Diagnostics
from pn2code.diagnostics.suggestions import nearest
from pn2code.drawing.picture import picture
from pn2code.drawing.state import State, enabled_in
from pn2code.drawing.svg import Overlay
from pn2code.net.finding import Finder
from pn2code.net.flat import FlatNet
from pn2code.reading.document import RawPage
from pn2code.semantics.game.token_game import Game
from pn2code.verdict import checking
from pn2code.verdict.opened import OpenNet, read, with_inputs


class Net:
    """A net, and the cell beside it, if there is one. `load` makes them.

    Attributes:
        warnings: what was found that is no error.
        flat: the net as the rest of pn2code knows it; its form may change from version to version.
    """

    def __init__(
        self, opened: OpenNet, path: Path, values: Mapping[str, str], warnings: Sequence[Diagnostic]
    ) -> None:
        self.warnings = tuple(warnings)
        self.flat: FlatNet = opened.flat
        self._opened = opened
        self._path = path
        self._values = values

    def __repr__(self) -> str:
        """Its name, and how large it is."""
        return (
            f"<Net {self.name}: {len(self.places)} places, {len(self.transitions)} transitions"
            f"{', timed' if self.is_timed else ''}>"
        )

    @property
    def name(self) -> str:
        """The stem of the file's name."""
        return self.flat.name

    @property
    def is_cell(self) -> bool:
        """Whether it is the net of a robot cell (there is a cell.toml)."""
        return self._opened.config is not None

    @property
    def is_timed(self) -> bool:
        """Whether any place is."""
        return self.flat.timed

    @cached_property
    def pages(self) -> tuple[str, ...]:
        """The names of the pages, in the order of the file."""
        return tuple(page.name for page in self._pages)

    @cached_property
    def places(self) -> tuple[str, ...]:
        """The paths of the places of all page instances, such as "Top.Robot1.Waiting"; merged places count once."""
        return tuple(p.name for p in self.flat.places)

    @cached_property
    def transitions(self) -> tuple[str, ...]:
        """The paths of the transitions of all page instances."""
        return tuple(t.name for t in self.flat.transitions)

    @cached_property
    def game(self) -> Game:
        """The reference token game, which markings are played with."""
        with playing():
            return self._opened.game(seed=1, files=None)

    def place_index(self, name: str) -> int:
        """The position of a place in `places`.

        Args:
            name: its path, the end of it, or `Page'Place` as in CPN Tools.

        Raises:
            KeyError: there is no such place, or there are several.
        """
        found = self._finder.ending(name) or sorted(
            {instance.index for instance in self._finder.named(name)}
        )
        if len(found) == 1:
            return found[0]
        if found:
            raise KeyError(f"`{name}` may be {', '.join(f'`{self.places[i]}`' for i in found)}")
        close = nearest(name, self.places, cutoff=0.5)
        raise KeyError(f"there is no place `{name}`" + (f"; there is `{close}`" if close else ""))

    @cached_property
    def _finder(self) -> Finder:
        return Finder.of_places(self.flat)

    @property
    def _pages(self) -> tuple[RawPage, ...]:
        document = self._opened.examined.document
        return tuple(document.pages) if document is not None else ()

    # --- what it does ----------------------------------------------------------------------------

    def initial_marking(self) -> Marking:
        """The marking with which it begins.

        Raises:
            NetError: a declaration or an initial marking raises an exception.
        """
        return Marking(self, self.game.own_initial_marking)

    def simulate(
        self,
        steps: int | None = 1000,
        *,
        seed: int = 1,
        until: float | None = None,
        trace: str | Path | None = None,
        engine: Literal["any", "compiled", "reference"] = "any",
        files: str | Path | None = None,
    ) -> Simulation:
        """A run at random, as by `pn2code simulate`; both engines make the same run.

        Args:
            steps: most steps; None: no limit.
            seed: of all random numbers.
            until: no step after this model time.
            trace: a file for the run (docs/trace.md).
            engine: the compiled net, the reference token game, or whichever is possible.
            files: the folder that the net may read and write files in; None: none.

        Raises:
            NetError: the run could not be made. A run that the net itself ends with an exception is one: its `why` is
                "error".
            OSError: the trace cannot be written.
        """
        return simulate(
            self,
            self._opened,
            steps,
            seed=seed,
            until=until,
            trace=trace,
            engine=engine,
            files=files,
        )

    def verify(
        self,
        *properties: str,
        max_states: int | None = None,
        max_seconds: float | None = None,
        threads: int | None = None,
        unfold: bool = True,
        found: bool = True,
        traces: str | Path | None = None,
    ) -> Verification:
        """Explores the state space and answers, as `pn2code verify` does; of a cell, about the cell as it runs.

        Args:
            properties: as docs/properties.md describes them, e.g. "deadlock free".
            max_states, max_seconds: limits; what they leave open is answered "inconclusive".
            threads: None: as many as there are processors.
            unfold: ask the unfolded net where a limit ends the exploration (docs/verify.md).
            found: check the properties in NET.properties.toml and cell.toml, too.
            traces: a folder for the runs that show the answers; None: they are not kept.

        Raises:
            NetError: the net has no state space, or a property is wrong.
            ValueError: it is a cell, and was loaded with other integers than its programs have.
        """
        return verify(
            self._opened,
            properties,
            max_states=max_states,
            max_seconds=max_seconds,
            threads=threads,
            unfold=unfold,
            found=found,
            traces=Path(traces) if traces is not None else None,
        )

    # --- pictures --------------------------------------------------------------------------------

    def draw(self, page: str | None = None, *, marking: Marking | None = None) -> Drawing:
        """The pages as their author laid them out.

        Args:
            page: the name of one page; None: all, one below the other.
            marking: shows its tokens, and what is enabled.

        Raises:
            KeyError: the net has no such page.
        """
        if page is not None and page not in self.pages:
            close = nearest(page, self.pages, cutoff=0.5)
            raise KeyError(
                f"there is no page `{page}`" + (f"; there is `{close}`" if close else "")
            )
        document = self._opened.examined.document
        assert document is not None
        shown = [p for p in self._pages if page in (None, p.name)]
        overlays = [Overlay()] * len(shown)
        if marking is not None:
            with playing():
                state = State(self.flat, marking._state, enabled_in(self.game, marking._state))
            overlays = [state.overlay(p, state.shown_first(p), Overlay()) for p in shown]
        return Drawing(picture(document, list(zip(shown, overlays, strict=True))))

    def _repr_svg_(self) -> str:
        return self.draw().svg


def load(
    path: str | Path,
    *,
    values: Mapping[str, object] | None = None,
    int_bits: int = 31,
    inputs: str | Path | None = None,
) -> Net:
    """A net that is free of errors. What the cell beside it says of the net is looked at by `check` and `Net.verify`.

    Args:
        path: a .cpn, .cpnt or .pnml file, a cell.toml, or a folder with a cell.toml.
        values: replace `val`s of the net; a value is written as CPN ML (`"5"`, `"[1, 2]"`), numbers and truth values as
            Python has them.
        int_bits: the width of `int`: 31 as in CPN Tools, or 64.
        inputs: the folder with the input files of a cell, or its one input file; None: those beside cell.toml.

    Raises:
        NetError: the file is missing or malformed, or the net or the cell has errors.
    """
    d = Diagnostics()
    texts = _texts(values)
    opened = read(Path(path), texts, d, int_bits=int_bits)
    if opened is not None:
        opened = with_inputs(opened, d, None if inputs is None else Path(inputs))
    if opened is None or d.has_errors:
        raise refuse(d)
    return Net(opened, Path(path), texts, d.sorted())


def check(
    path: str | Path,
    *,
    values: Mapping[str, object] | None = None,
    inputs: str | Path | None = None,
) -> tuple[Diagnostic, ...]:
    """Everything that `pn2code check` says of a net, and of the cell beside it; nothing is raised for it.

    Args:
        path, values, inputs: as for `load`.
    """
    d = Diagnostics()
    given = None if inputs is None else Path(inputs)
    checking.check(Path(path), _texts(values), d, inputs=given)
    return tuple(d.sorted())


def _texts(values: Mapping[str, object] | None) -> dict[str, str]:
    return {name: _written(value) for name, value in (values or {}).items()}


def _written(value: object) -> str:
    """A value as CPN ML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value).replace("-", "~")
    return str(value)
