"""A run to a marking of which it is known that it is reachable: by walks and searches of the engine, as a trace.

    found = hunt(program, unfolding, questions.tables, {"p": "reach not sum 1 3 1 2"}, seconds=5.0)
    found["p"]                        # indices of unfolded transitions, loops left out

What is not found says nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from pn2code.contest.engine import Run, Task, ask
from pn2code.contest.tables import Tables
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.marking import BindingElement
from pn2code.trace.played import written
from pn2code.unfold.net import Unfolding

_MEBIBYTES = 512


def hunt(
    program: Path,
    unfolding: Unfolding,
    tables: Tables,
    wanted: Mapping[str, str],
    *,
    seconds: float,
) -> dict[str, tuple[int, ...]]:
    """Runs to what some questions look for, as far as walks and searches find it.

    Args:
        program: the engine.
        unfolding: the net; `tables`: the same for the engine.
        wanted: questions ("reach ..") by name.
        seconds: for all of them.
    """
    names = list(wanted)
    text = tables.text([f"{i} {wanted[n]}" for i, n in enumerate(names)])
    tasks = [Task(method, text, seconds, _MEBIBYTES) for method in ("run", "way")]
    found: dict[str, tuple[int, ...]] = {}
    for said in ask(program, tasks) if names and seconds > 0 else ():
        if isinstance(said, Run):
            found[names[said.number]] = _without_loops(unfolding, said.steps)
            if len(found) == len(names):
                break
    return found


def write(
    unfolding: Unfolding, storage: Mapping[str, str], steps: Sequence[int], path: Path
) -> bool:
    """Writes a run as a trace, played by the token game; False: it cannot be written.

    Raises:
        RuntimeError: the token game does not play it: then the unfolded net is wrong.
    """
    chosen = (unfolding.transitions[step] for step in steps)
    elements = [BindingElement(t.transition, t.binding) for t in chosen]
    try:
        return written(unfolding.net, storage, elements, path)
    except GameError as problem:
        raise RuntimeError(
            f"the unfolded net has a step that the net has not: {problem}"
        ) from problem


def _without_loops(unfolding: Unfolding, steps: Sequence[int]) -> tuple[int, ...]:
    """The same way, without what leads back to a marking where it was before."""
    passed = [unfolding.initial]
    seen = {unfolding.initial: 0}
    kept: list[int] = []
    for step in steps:
        now = unfolding.fire(passed[-1], unfolding.transitions[step])
        if now in seen:
            for later in passed[seen[now] + 1 :]:
                del seen[later]
            del kept[seen[now] :], passed[seen[now] + 1 :]
        else:
            kept.append(step)
            passed.append(now)
            seen[now] = len(kept)
    return tuple(kept)
