"""The option `--sweep` of `verify`, and what it goes with."""

from __future__ import annotations

from collections.abc import Sequence

import typer

from pn2code.verify.exploring.limits import Reduction


def wanted_sweep(
    given: bool | None, reductions: Sequence[Reduction], others: Sequence[tuple[str, bool]]
) -> bool | None:
    """What `Limits.sweeps` is to be: a default is left out where it does not go with other options.

    Args:
        given: what the option says; None: nothing.
        reductions: those that are wanted.
        others: options that need markings which a sweep has forgotten, or another order, and whether they are given.

    Raises:
        typer.BadParameter: options do not go together.
    """
    in_the_way = [option for option, is_given in others if is_given]
    in_the_way += [f"--reduce {r.value}" for r in reductions if r is not Reduction.TIME]
    if given and in_the_way:
        raise typer.BadParameter(
            f"it goes in an order of its own, and forgets markings: `{in_the_way[0]}` does not go with that",
            param_hint="--sweep",
        )
    return False if in_the_way else given
