"""Properties that are asked from the page: explored in the background, by the machinery of `pn2code verify`.

answer = ask(loaded, typist, "deadlock free", folder, limits, tell, interrupted)

They are about the net from its initial marking on (of a cell: about the cell as it runs), whatever the marking in play.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

from pn2code.base.deadline import Deadline
from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics
from pn2code.play.loading import Loaded
from pn2code.play.trouble import Json, Trouble, of_diagnostics, of_game, rows
from pn2code.play.typed_texts import Typist
from pn2code.semantics.game.errors import GameError
from pn2code.verdict import properties as own
from pn2code.verdict.whole import (
    MOST_COLOURS,
    Checks,
    Said,
    conclude,
    look,
    question,
    stem,
    trace_folder,
)
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import Exploration

MOST_SECONDS = 600.0
MOST_STATES = 20_000_000


@frozen
class Question:
    """What is asked.

    Args:
        text: a property (docs/properties.md).
        states: most markings.
        seconds: most time.
    """

    text: str
    states: int = MOST_STATES
    seconds: float = MOST_SECONDS


def ask(
    loaded: Loaded,
    typist: Typist,
    asked: Question,
    folder: Path,
    tell: Callable[[int, int, str], None],
    interrupted: Callable[[], bool],
) -> Json:
    """The answer: `verdict`, `why`, `complete`, `nodes`, `arcs`, and `trace`, a file that shows it, if there is one.

    Of a cell `nodes` and `arcs` are those of its net, `states` those of the cell as its programs run, where it was
    looked at. `tell` hears markings, occurrences, and what is explored beside the net; "": nothing yet.

    Raises:
        Trouble: the property is wrong, or the net has no state space.
    """
    opened, d = loaded.opened, Diagnostics()
    assert opened is not None, "the net has no errors"
    with typist.lock:
        plan = question(opened, [asked.text], None, d, found=False)
    if d.has_errors:
        raise of_diagnostics(d, "the property is wrong")
    # Half of the machine is for whoever plays meanwhile.
    limits = Limits(max_states=asked.states, deadline=Deadline.after(asked.seconds), threads=1)
    checks = Checks(controller=False, channel_model=False)
    under_way = ""

    def begin(text: str) -> None:
        nonlocal under_way
        under_way = text.removesuffix(" ...")

    with ExitStack() as stack:
        stack.enter_context(trace_folder(folder, wanted=True, needed=True))
        options = ExploreOptions(
            traces=folder,
            stem=stem(opened),
            colours=MOST_COLOURS,
            questions=plan.questions,
            predicates=plan.properties.predicates,
            evidence=stack.enter_context(own.unnamed_runs(plan, folder)),
            progress=lambda row: tell(
                int(row.get("states", 0)), int(row.get("arcs", 0)), under_way
            ),
            stage=begin,
            interrupted=interrupted,
        )
        try:
            looked = look(opened, plan, limits, options, folder, d, checks)
            if looked is None:
                raise of_diagnostics(d, "the state space cannot be explored")
            said = conclude(looked, opened, plan, limits, folder, d, checks)
            cell = looked.control.found if looked.control is not None else None
        except GameError as error:
            raise of_game(error) from None
    return _told(said, cell, d, interrupted())


def _told(said: Said, cell: Exploration | None, d: Diagnostics, is_stopped: bool) -> Json:
    if not said.answers:
        raise Trouble("there is no answer", rows(d.sorted()))
    answer = said.answers[0]
    evidence = answer.evidence
    return {
        "text": answer.about.holds,
        "verdict": answer.answer,
        "why": "stopped" if is_stopped and answer.answer == "inconclusive" else answer.why,
        "complete": said.found.complete and (cell is None or cell.complete),
        "states": None if cell is None else cell.nodes,
        "nodes": said.found.nodes,
        "arcs": said.found.arcs,
        "value": answer.value,
        "assumes": list(answer.assumes),
        "trace": str(evidence.trace) if evidence is not None and evidence.trace else "",
        "rows": rows(d.sorted()),
    }
