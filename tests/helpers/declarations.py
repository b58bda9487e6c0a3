"""Sheets of declarations (`helpers.random_declarations`): they compile, and do what the token game does."""

from __future__ import annotations

import traceback
from pathlib import Path

from helpers.compiled import FAST, SANITIZERS, Workshop, agrees, lowered
from helpers.netbuilder import load
from helpers.random_declarations import Sheet

OPTIMIZED = ("-O2",)
"""As the generated Makefile has it: some warnings come with it only."""
FLAGS = (SANITIZERS, FAST, OPTIMIZED)


def workshops(folder: Path, *flags: tuple[str, ...]) -> tuple[Workshop, ...]:
    """A workshop for each set of flags."""
    return tuple(Workshop.open(folder / str(i), f) for i, f in enumerate(flags or FLAGS))


def wrong(sheet: Sheet, workshop: Workshop, *only: int) -> str:
    """How a sheet, or some of its cases, fails; "" if it does not."""
    net, d = load(sheet.text(*only))
    if net is None or d.has_errors:
        return "refused: " + "; ".join(f"{e.message} ({e.origin.describe()})" for e in d.errors)
    program, d = lowered(net)
    if program is None:
        return "not compiled: " + "; ".join(f"{e.code}: {e.message}" for e in d.errors)
    try:
        built = workshop.build(program, workshop.folder / "sheet")
        for seed in (1, 2):
            agrees(net, built, seed=seed, steps=4 * len(sheet.cases))
    except AssertionError as failure:
        return str(failure)
    except Exception:  # a bug in pn2code: it is told with the case that has it
        return traceback.format_exc()
    return ""


def culprits(sheet: Sheet, workshop: Workshop) -> dict[int, str]:
    """The cases that fail alone, and how, where the sheet fails; -1 stands for a failure of none alone."""
    why = wrong(sheet, workshop)
    if not why:
        return {}
    found: dict[int, str] = {}
    waiting = [[c.number for c in sheet.cases]]
    while waiting:
        numbers = waiting.pop()
        own = wrong(sheet, workshop, *numbers)
        if own and len(numbers) == 1:
            found[numbers[0]] = own
        elif own:
            half = len(numbers) // 2
            waiting += [numbers[half:], numbers[:half]]
    return found or {-1: why}
