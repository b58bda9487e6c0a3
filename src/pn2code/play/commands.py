"""What pages ask for, and the answers: each command is a JSON object with its name in `do`.

player = Player(session, tell)
player.answer({"do": "fire", "transition": 3})     # {"ok": True, "result": {...}, "state": {...}}

docs/play.md lists the commands. What a page says is data from outside: each argument is looked at.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pn2code.play import bindings, nearby, running, saving
from pn2code.play.session import Session
from pn2code.play.trouble import Json, Trouble, of_game, rows
from pn2code.play.typed_texts import MOST_TEXT, BadText
from pn2code.play.view import View, binding_rows, entries, shortened
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.marking import BindingElement, place_text
from pn2code.semantics.game.report import time_text
from pn2code.semantics.values.colours import TEXTS

Tell = Callable[[Json], None]

MOST_ANSWER = 200_000
"""Characters of the value of an expression."""
MOST_ROWS = 500
_SILENT = frozenset({"bindings", "place", "entries", "space"})
"""Commands that change nothing that a page shows."""
_READING = frozenset({"state", "evaluate", *_SILENT})
"""Commands after which lists of bindings and nodes are still those of the marking."""
_NODE_TEXT = 120
_MAX_SEED = 2**63 - 1


class Player:
    """Carries out the commands of one page.

    Args:
        session: its game.
        tell: is given what is to be sent while a command takes long.
    """

    def __init__(self, session: Session, tell: Tell) -> None:
        self.session = session
        self.tell = tell
        self.view = View(session)
        self._listed: tuple[BindingElement, ...] = ()
        self._listed_at = -1
        self._space: nearby.Space | None = None
        self._space_at = -1
        self._changes = 0
        self._commands: Mapping[str, Callable[[Json], Any]] = {
            "state": lambda said: None,
            "fire": self._fire,
            "bindings": self._bindings,
            "choose": self._choose,
            "step": lambda said: self._reached(self.session.step()),
            "undo": lambda said: self.session.undo(),
            "redo": lambda said: self.session.redo(),
            "go": lambda said: self.session.go(_whole(said, "position")),
            "reset": lambda said: self.session.begin(),
            "advance": lambda said: self.session.advance(),
            "run": self._run,
            "seed": lambda said: self.session.set_seed(_whole(said, "seed", most=_MAX_SEED)),
            "edit": lambda said: self.session.edit(_whole(said, "place"), _text(said, "text")),
            "place": self._place,
            "evaluate": self._evaluate,
            "entries": self._entries,
            "space": self._around,
            "visit": self._visit,
            "dead": self._dead,
        }

    def again(self) -> Json:
        """The page was loaded again: it is told everything.

        As any command in the thread of the game: what an earlier one has still to say must not count as told.
        """
        self.view = View(self.session)
        return self.view.state()

    def answer(self, said: Json) -> Json:
        """Carries out a command; the answer has what has changed."""
        done: Json
        try:
            work = self._commands.get(str(said.get("do")))
            if work is None:
                raise Trouble("there is no such command")
            done = {"ok": True, "result": work(said)}
        except Trouble as trouble:
            done = {"ok": False, "message": trouble.message, "rows": trouble.rows}
        except GameError as error:
            told = of_game(error)
            done = {"ok": False, "message": told.message, "rows": told.rows}
        finally:
            self._changes += said.get("do") not in _READING
        return done if said.get("do") in _SILENT else {**done, "state": self.view.state()}

    # --- steps -----------------------------------------------------------------------------------

    def _fire(self, said: Json) -> Json | None:
        return self._reached(self.session.fire_any(_whole(said, "transition")))

    @staticmethod
    def _reached(breakpoint: Any) -> Json | None:
        return None if breakpoint is None else {"breakpoint": breakpoint.monitor.name}

    def _bindings(self, said: Json) -> Json:
        session = self.session
        t = session.transition(_whole(said, "transition"))
        text = _text(said, "filter", default="")
        try:
            filters = session.typist.filters(text, t) if text.strip() else ()
        except BadText as bad:
            raise Trouble(str(bad), rows(bad.diagnostics)) from None
        found = bindings.listed(session.game, t, filters)
        self._listed, self._listed_at = found.elements, self._changes
        return {
            "transition": t.index,
            "rows": [binding_rows(session, e) for e in found.elements],
            "seen": found.seen,
            "cut": found.is_cut,
        }

    def _choose(self, said: Json) -> Json | None:
        if self._listed_at != self._changes:
            raise Trouble("the list of bindings is of another marking: list them again")
        number = _whole(said, "number", most=len(self._listed) - 1)
        return self._reached(self.session.fire(self._listed[number]))

    # --- runs ------------------------------------------------------------------------------------

    def _run(self, said: Json) -> Json:
        session = self.session
        text = _text(said, "condition", default="")
        engine = _text(said, "engine", default="auto")
        if engine not in ("auto", "compiled", "reference"):
            raise Trouble("the engine is `auto`, `compiled` or `reference`")
        try:
            condition = session.typist.condition(text) if text.strip() else None
        except BadText as bad:
            raise Trouble(str(bad), rows(bad.diagnostics)) from None
        wish = running.Wish(
            steps=_whole(said, "steps", most=running.MOST_STEPS),
            until=_number(said, "until"),
            condition=condition,
            breakpoints=frozenset(_wholes(said, "breakpoints")),
            engine=engine,
        )
        ended = running.run(session, wish, self._progress)
        return {
            "why": ended.why,
            "text": ended.text,
            "steps": ended.steps,
            "seconds": ended.seconds,
            "engine": ended.engine,
        }

    def _progress(self, steps: int, time: float) -> None:
        self.tell({"progress": steps, "time": time_text(time)})

    # --- what is there ---------------------------------------------------------------------------

    def _place(self, said: Json) -> Json:
        return self.view.place(_whole(said, "place", most=len(self.session.net.places) - 1))

    def _evaluate(self, said: Json) -> Json:
        kind, text = self.session.evaluate(_text(said, "text"))
        return {"type": kind, "text": shortened(text, MOST_ANSWER)}

    def _entries(self, said: Json) -> Json:
        start = _whole(said, "from")
        end = min(_whole(said, "to"), start + MOST_ROWS)
        return {"rows": entries(self.session, start, end)}

    # --- the state space -------------------------------------------------------------------------

    def _around(self, said: Json) -> Json:
        depth = _whole(said, "depth", most=nearby.MOST_DEPTH)
        most = _whole(said, "nodes", most=nearby.MOST_NODES)
        found = nearby.around(self.session, depth, max(most, 1))
        self._space, self._space_at = found, self._changes
        here = found.nodes[0].marking
        return {
            "nodes": [
                {
                    "depth": n.depth,
                    "dead": n.is_dead,
                    "open": n.is_open,
                    "failure": n.failure,
                    "time": time_text(n.marking.time) if self.session.net.timed else "",
                    "changes": self._differences(here, n.marking),
                }
                for n in found.nodes
            ],
            "arcs": [
                [a.source, a.target, a.element.transition, binding_rows(self.session, a.element)]
                for a in found.arcs
            ],
            "why": found.why,
        }

    def _differences(self, here: Any, there: Any) -> list[list[Any]]:
        """The places that hold something else than now: [place, text]."""
        found: list[list[Any]] = []
        for p, one, other in zip(self.session.net.places, here.places, there.places, strict=True):
            if one != other:
                text = " ".join(place_text(TEXTS, p.colset, other).split())
                found.append([p.index, shortened(text, _NODE_TEXT)])
        return found

    def _visit(self, said: Json) -> None:
        if self._space is None or self._space_at != self._changes:
            raise Trouble("the state space is that of another marking: draw it again")
        number = _whole(said, "node", most=len(self._space.nodes) - 1)
        nearby.follow(self.session, nearby.path(self._space, number))

    def _dead(self, said: Json) -> Json:
        most = _whole(said, "nodes", most=nearby.MOST_SEARCHED)
        elements = nearby.to_dead(self.session, max(most, 1), self._progress)
        nearby.follow(self.session, elements)
        return {"steps": len(elements)}

    # --- traces ----------------------------------------------------------------------------------

    def load(self, path: Path) -> Json:
        """Loads a trace; the answer is that of a command."""
        done: Json
        self._changes += 1
        self.session.stop.clear()
        try:
            done = {"ok": True, "result": {"text": saving.load(self.session, path)}}
        except Trouble as trouble:
            done = {"ok": False, "message": trouble.message, "rows": trouble.rows}
        except OSError as problem:
            done = {"ok": False, "message": f"the trace cannot be read: {problem}", "rows": []}
        return {**done, "state": self.again()}


# --- arguments -------------------------------------------------------------------------------------


def _whole(said: Json, name: str, most: int = 2**53) -> int:
    value = said.get(name)
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= most:
        raise Trouble(f"`{name}` must be a whole number from 0 to {most:,}")
    return value


def _wholes(said: Json, name: str) -> list[int]:
    value = said.get(name, [])
    if not isinstance(value, list) or not all(type(x) is int for x in value):
        raise Trouble(f"`{name}` must be a list of whole numbers")
    return value


def _number(said: Json, name: str) -> float | int | None:
    value = said.get(name)
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise Trouble(f"`{name}` must be a number")
    return value


def _text(said: Json, name: str, default: str | None = None) -> str:
    value = said.get(name, default)
    if not isinstance(value, str):
        raise Trouble(f"`{name}` must be a text")
    if len(value) > MOST_TEXT:
        raise Trouble(f"`{name}` has more than {MOST_TEXT:,} characters")
    return value
