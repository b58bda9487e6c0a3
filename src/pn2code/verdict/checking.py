"""Whether a net, and the cell beside it, are well-formed: everything that `pn2code check` says.

checked = check(Path("examples/riveting"), {}, d)
checked.is_fine, checked.file                     # True, examples/riveting/cell.cpn
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from pn2code import registers
from pn2code.base.frozen import frozen
from pn2code.base.kept_answers import KeptAnswers
from pn2code.cell.channel_table import ChannelRow, rows
from pn2code.cell.locate import locate
from pn2code.diagnostics import Diagnostics, Severity
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.input_files import begin
from pn2code.net import emptiness, free_variables, front, idle_places
from pn2code.net.front import Examined
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.evaluation.effects import Effects, outside
from pn2code.semantics.game.errors import GameError, GivenUpError
from pn2code.semantics.game.token_game import Game

if TYPE_CHECKING:
    from pn2code.cell.config import CellConfig
    from pn2code.cell.partition import Partition
    from pn2code.net.flat import FlatNet


@frozen
class Checked:
    """What was looked at.

    Args:
        file: the file of the net; what was given where that means none.
        examined: what the front end made of it.
        is_fine: whether there are no errors.
        channels: of a cell that could be divided among its programs.
    """

    file: Path
    examined: Examined
    is_fine: bool
    channels: tuple[ChannelRow, ...] = ()


def check(
    path: Path,
    values: Mapping[str, str],
    d: Diagnostics,
    *,
    int_bits: int = 31,
    inputs: Path | None = None,
    kept: KeptAnswers | None = None,
) -> Checked:
    """Looks at a net or cell without running it.

    Args:
        path: a .cpn, .cpnt or .pnml file, a cell.toml, or a folder with a cell.toml.
        values: replace `val`s of the net, over those of cell.toml.
        d: gets the errors and warnings.
        int_bits: width of `int`.
        inputs: the input files of the cell, if not those beside cell.toml.
        kept: what earlier commands have found of its robots and scene.
    """
    found = locate(path, d)
    if found is None:
        described = path / "cell.toml"
        where = described if described.is_file() else path
        return Checked(where, Examined(None, None), is_fine=False)
    file, config = found
    replaced = {**(config.values if config else {}), **values}
    result = front.examine(file, d, replaced, int_bits=int_bits, compute=compute)
    if result.flat is not None:
        emptiness.warn(result.flat, d)
        if not d.has_errors:
            _begins(result.flat, d)
    channels: tuple[ChannelRow, ...] = ()
    if config is not None:
        if not d.has_errors:
            result, config = registers.examined(result, config, d)
            assert config is not None, "it was found above"
        partition = examine_cell(file, config, result, d, inputs=inputs, kept=kept)
        if partition is not None:
            channels = rows(partition, config)
            own = {i for i, owner in enumerate(partition.transition_owner) if owner == 0}
            free_variables.remark(partition.net, d, own)
            idle_places.remark(partition.net, d, is_cell=True)
        if partition is not None and not d.has_errors:
            _unneeded(config, d)
    else:
        if result.flat is not None:
            free_variables.remark(result.flat, d)
            idle_places.remark(result.flat, d, is_cell=False)
        _properties(file, None, result, d)
        if inputs is not None and result.flat is not None:
            begin(result.flat, None, d, given=inputs)
    return Checked(
        file, result, is_fine=result.flat is not None and not d.has_errors, channels=channels
    )


def _begins(net: FlatNet, d: Diagnostics) -> None:
    """The exception that an initial marking raises, or its colour that is none: CPN Tools refuses such a net.

    What is drawn at random, or read from files, may be otherwise in a run.
    """
    if outside(Effects(net.program), net):
        return
    try:
        Game(net, seed=1)
    except GivenUpError:
        return
    except GameError as error:
        if not error.is_unavailable:
            error.report(d)


def _unneeded(config: CellConfig, d: Diagnostics) -> None:
    """Warnings that cell.toml accepts, and that there are not."""
    from pn2code.cell.codes import ACCEPT_UNNEEDED
    from pn2code.diagnostics.accepted import elements

    found = [i for i in d if i.severity is Severity.WARNING]
    for rule in config.accepted:
        if any(rule.accepts(i) for i in found):
            continue
        alike = [i for i in found if i.code == rule.code]
        about = "; ".join(" and ".join(f"`{x}`" for x in elements(i)) for i in alike)
        near = did_you_mean(rule.code, [i.code for i in found]) if not alike else ""
        hint = near or (f"there is one about {about}" if about else "remove the entry")
        what = " and ".join(f"`{x}`" for x in rule.elements)
        d.warning(
            ACCEPT_UNNEEDED,
            f"there is no warning `{rule.code}`{' about ' if what else ''}{what} to be accepted",
            rule.origin,
            hint=hint,
        )


def examine_cell(
    net: Path,
    config: CellConfig,
    result: Examined,
    d: Diagnostics,
    *,
    ahead: bool = True,
    inputs: Path | None = None,
    kept: KeptAnswers | None = None,
) -> Partition | None:
    """What cell.toml says of the net; the robots' programs; the robots and the scene, in all layouts; properties.

    Args:
        net: the file of the net.
        config: the cell.
        result: what the front end made of the net.
        d: gets the errors.
        ahead: whether files beside the cell and the robots' places are looked at, which takes longer.
        inputs: the input files, if not those beside cell.toml.
        kept: what earlier commands have found of its robots and scene.

    Returns:
        Who runs what; None after an error in that.
    """
    # Most nets have no cell, and these load NumPy and the like.
    from pn2code.division import check_geometry, divided
    from pn2code.robot_scripts.translate import lower_robots

    if result.flat is None or d.has_errors:
        check_geometry(config, d, to_run=True)
        return None
    partition = divided(result.flat, config, d, to_run=True, kept=kept)
    programs = lower_robots(partition, config, d) if partition is not None else None
    _properties(net, config, result, d)
    if ahead and partition is not None and programs is not None and not d.has_errors:
        from pn2code.verdict.ahead import look_ahead

        if partition.net.timed:  # a timer is a place whose token has a time
            from pn2code.verify.controller import long_timers, short_timers

            short_timers.warn(partition, config, d)
            long_timers.warn(partition, config, d)
        look_ahead(partition, config, programs, d, inputs, kept)
    return partition


def _properties(net: Path, config: CellConfig | None, result: Examined, d: Diagnostics) -> None:
    """Whether what is asked about the net, and of the end of a run, can be understood; it is not answered."""
    if result.flat is not None and config is not None and config.report.conditions:
        from pn2code.properties.failing import Failing

        Failing.of(config, result.flat, result.typed.elaborator if result.typed else None, d)
    beside = net.with_suffix(".properties.toml").is_file()
    if result.flat is None or not (beside or (config is not None and "property" in config.raw)):
        return
    from pn2code.verdict.asked import gather
    from pn2code.verdict.opened import OpenNet

    gather(OpenNet(result.flat, config, result), (), None, d, found=True)
