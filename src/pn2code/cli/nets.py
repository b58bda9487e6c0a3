"""What verbs about a net and its behaviour begin with: the net that a path means, ready to be played."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import typer

from pn2code.base.deadline import CommandIsOverError, Deadline
from pn2code.base.progress_line import told
from pn2code.cell.codes import INPUT_MISSING
from pn2code.cell.config import CellConfig
from pn2code.cli.options import DEFAULT_INT_BITS, Exit, Format, print_diagnostics, stop
from pn2code.diagnostics import Diagnostics, Origin, Severity
from pn2code.semantics.game.token_game import GameError
from pn2code.verdict.opened import OpenNet, read, with_inputs


def open_net(
    path: Path,
    values: Mapping[str, str],
    form: Format = Format.FULL,
    *,
    int_bits: int = 31,
    warnings: Diagnostics | None = None,
    inputs: Path | None = None,
    has_own_marking: bool = False,
) -> OpenNet:
    """The net that a path means, with `val`s replaced; leaves with a report when it is wrong.

    The net of a cell begins with the tokens of its input files, as a run of the cell does.

    What is `unsupported-...` is said before the net is played: applying it will stop the run. So is that there is no
    input file. Other warnings are added to `warnings`, for verbs that tell them; `check` does.

    Args:
        path, values, int_bits: as for `verdict.opened.read`.
        form: of what is printed.
        warnings: gets the other warnings.
        inputs: the input files, if not those beside cell.toml.
        has_own_marking: it begins with the initial marking of the net, whatever files there are.
    """
    d = Diagnostics()
    with told("reading the net"):
        opened = read(path, values, d, int_bits=int_bits)
        if opened is not None and not has_own_marking:
            opened = with_inputs(opened, d, inputs)
    if opened is None or (d.has_errors and not has_own_marking):
        stop(d, form)
    found = [i for i in d.sorted() if i.severity is Severity.WARNING]
    urgent = [i for i in found if i.code.startswith("unsupported-")]
    if warnings is not None:
        warnings.rules = d.rules
        warnings.items += [i for i in found if i not in urgent]
    else:
        urgent += [i for i in found if i.code == INPUT_MISSING]
    print_diagnostics(urgent, form)
    return opened


def refuse_wide(config: CellConfig | None, int_bits: int) -> None:
    """Leaves when the programs of a cell are asked about with integers that they do not have."""
    if config is not None and int_bits != DEFAULT_INT_BITS:
        raise typer.BadParameter(
            f"the programs of a cell have integers of {DEFAULT_INT_BITS} bits, so nothing can be said of them "
            f"with {int_bits}; colour set `intinf` has larger ones",
            param_hint="--int-bits",
        )


@contextmanager
def in_time(
    seconds: float | None,
    net: Path,
    what: str,
    form: Format = Format.FULL,
    so_far: Callable[[], str] = str,
) -> Iterator[None]:
    """What takes longer from the start of the command on ends it with a warning; None: there is no limit.

    Args:
        what: was not done then: `the marking was computed`.
        so_far: what was done until then, behind it.
    """
    from pn2code.verify.codes import TIME_OVER

    try:
        with Deadline.of_command(seconds).enforced(CommandIsOverError):
            yield
    except CommandIsOverError:
        d = Diagnostics()
        hint = "give it more time with `--max-seconds`"
        d.warning(
            TIME_OVER, f"the time was up before {what}{so_far()}", Origin(str(net)), hint=hint
        )
        print_diagnostics(d.sorted(), form)
        raise typer.Exit(Exit.INCONCLUSIVE) from None


@contextmanager
def playing(form: Format = Format.FULL) -> Iterator[None]:
    """An error of the net while it is played is reported like one found in checking it."""
    try:
        yield
    except GameError as error:
        d = Diagnostics()
        error.report(d)
        stop(d, form)
