"""The last lines of what `pn2code verify` prints: durations, arms in space, notes, the verdict."""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.cli.verify_rows import row
from pn2code.verdict.whole import Said
from pn2code.verify.answers import outcome
from pn2code.verify.controller.premises import in_space

NOTE = "Note: "
"""How a note begins."""


def durations_of(said: Said) -> Iterator[str]:
    """How long parts of the work take, a row each."""
    for i, line in enumerate(said.durations.lines if said.durations is not None else ()):
        yield from ([""] if i == 0 else [])
        yield from row("Durations" if i == 0 else "", line)


def in_space_of(said: Said) -> Iterator[str]:
    """What is said of the arms in space."""
    for i, line in enumerate(said.geometry.lines if said.geometry is not None else ()):
        yield from ([""] if i == 0 else [])
        yield from row("Arms in space" if i == 0 else "", line)


def ending(said: Said) -> str:
    """The last lines: what a yes leaves to be remarked, then the verdict."""
    return "\n".join([*(f"{NOTE}{x}" for x in said.notes), closing(said)])


def closing(said: Said) -> str:
    """The last line; a yes about a cell names what it is not about."""
    text_ = outcome.closing(said.net, said.found, said.counts)
    things = in_space(said.config) if said.config is not None and said.control is not None else ()
    if not things or said.geometry is not None or said.verdict != "yes":
        return text_
    listed = " and ".join(filter(None, (", ".join(things[:-1]), things[-1])))
    return f"{text_.removesuffix('.')} ({listed} in space: `check --geometry`)."
