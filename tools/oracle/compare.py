"""One net, what the engine of CPN Tools said of it, and what pn2code says: where do they differ?

    seen = Seen(path)                          # the net, read and checked here
    seen.verdict(answer)                       # of `engine.check`, or of any other verb
    seen.marking(answer); seen.run(answer); seen.space(answer)
        -> a Verdict and a note: "agrees", "differs", "random" (the net draws, or leaves a choice to the engine),
           "engine" (it fails with an internal error), "unsupported" (and said so), "" (nothing to compare)

An exception of pn2code that is no diagnostic comes out: it is a bug whatever the engine says.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pn2code.diagnostics import Diagnostics, Severity
from pn2code.engine_comparison.graphs import (
    Arc,
    Node,
    engine_arcs,
    engine_nodes,
    our_arcs,
    our_nodes,
)
from pn2code.ml.core.terms import PVar
from pn2code.net import front
from pn2code.net.flat import ArcKind
from pn2code.net.uses import walk_pattern
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.evaluation.effects import Effect, Effects, outside, texts
from pn2code.semantics.game.graph import StateSpace, state_space
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.report import places
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.multiset import TimedMultiSet
from pn2code.trace.followed import Followed
from pn2code.trace.recording import recording
from pn2code.trace.replay_recording import follow
from pn2code.verify.exploring.explore import explore
from pn2code.verify.exploring.limits import Limits

SMALL = 150
"""Nodes up to which whole graphs are compared."""
WARNED = {
    "not unique": {"name-not-unique"},
    "is not assigned to a port": {"socket-unassigned"},
    "has type": {"socket-arcs", "port-assignment"},
    "which is not a port": {"port-assignment"},
}
"""What the editor says, and the warning of pn2code that says it: such nets are not refused here."""


NO_DECLARATION = "Not a declaration"
"""What the engine says of an empty one, too, of which pn2code warns."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether an answer is the same on both sides."""

    state: str
    note: str = ""


AGREES = Verdict("agrees")
NOTHING = Verdict("")
ENGINE = Verdict("engine", "the engine fails with an internal error")
UNCOMPILED = "Compile error when generating code"
"""So the engine refuses, when it is to run it, a net that it has accepted."""
LATE = Verdict("engine", "it accepts the net, and cannot compile the code that it makes of it")
GROUPS = Verdict("engine", "it loses count of variables where several arcs come from one place")
UNBOUND = ("No complete binding sequence", "Cannot bind", "IllegalBit")
TAKING = (ArcKind.INPUT, ArcKind.BOTH)
CLOCK = Verdict(
    "engine", "where nothing can occur any more it goes on to a time noted for tokens that are gone"
)
DEAD = "No more enabled transitions!"
LOOSE = Verdict(
    "engine", "it confuses the instances of a page that has a socket for a port only in some"
)
FUSED = Verdict(
    "engine",
    "it looks at each arc from places of one fusion set for itself, and takes too many tokens",
)
TWICE = Verdict("engine", "it takes a wrong binding where a variable is twice in one pattern")
UNRESTORED = Verdict("engine", "its state space tool does not restore what references hold")
RESETS = Verdict(
    "engine", "its state space tool does not carry out reset arcs at ports and fused places"
)
UNENTERED = Verdict(
    "engine", "its state space tool cannot be entered with a name or a fusion set of the net"
)
ORDER = Verdict("engine", "it asks conditions in another order, which was warned of")
FIELDS = Verdict(
    "engine", "it misses tokens of a record whose fields are in another order, which was warned of"
)
ORDER_WARNING = "guard-order"
FIELDS_WARNING = "engine-field-order"
SHARED_WARNING = "arcs-share-variables"
SPACE_WARNINGS = {"state-space-name", "state-space-fusion"}
ENTERING = "Exception raised entering state space tool"
SUBTRACT = re.compile(
    r"[Ee]xception Subtract (?:raised while executing .*\((\w+)\)|is raised .* transition (\w+) occured)"
    r"|Internal Error occured while transition (\w+) occured! Internal Error: rm "
)
"""It takes a token that is not there: from untimed places, then from timed ones."""
BROKEN = "InternalError"
"""So the engine names what is wrong with itself."""
CONFUSED = "InternalError: insert_transvar"
"""Where arcs from one place share variables: nothing is wrong with the net."""
DECLARES = re.compile(r"InternalError: Illegal \S+Dec|Uncaught Exception!: Compile")
"""Where an inscription declares something other than a value."""
LISTS = "InternalError: fun parse_guarditems"
"""Where a guard is a list that an operator makes."""
REPEATS = "InternalError: fun get_vids"
"""Where one side of a guard equation has a variable twice."""


def _transition(found: re.Match[str]) -> str:
    """The id of the transition that took too much, or its name."""
    return next(name for name in found.groups() if name)


def differs(note: str) -> Verdict:
    """The answers are different."""
    return Verdict("differs", " ".join(note.split())[:600])


class Seen:
    """A net as pn2code sees it."""

    def __init__(self, path: Path) -> None:
        self.d = Diagnostics()
        self.net = front.load(path, self.d, compute=compute)
        self.codes = {x.code for x in self.d.items}
        self.loose = any(
            x.code == "port-unassigned" and x.severity is Severity.WARNING for x in self.d.items
        )
        self.game: Game | None = None
        self.raised = ""
        if self.net is not None:
            try:
                self.game = Game(self.net, seed=1)
            except GameError as error:
                self.raised = error.message

    def unentered(self, message: str) -> bool:
        """Whether the state space tool fails with a message that was foreseen."""
        return ENTERING in message and not SPACE_WARNINGS.isdisjoint(self.codes)

    # --- verdict and marking

    def verdict(self, answer: dict[str, Any]) -> Verdict:
        """Whether both accept the net; what only the editor refuses has to be warned of."""
        failure = answer.get("failure")
        if failure is not None and failure["kind"] in ("timeout", "crash", "file"):
            return NOTHING
        wrong = [e for e in answer["errors"] if not self._warns(e)]
        if wrong and self.net is not None and all(CONFUSED in e["message"] for e in wrong):
            said = SHARED_WARNING in self.codes
            return ENGINE if said else differs("not warned of: " + wrong[0]["message"])
        for message, code in ((REPEATS, "guard-equation-repeats"), (LISTS, "guard-list-operator")):
            if wrong and all(e["message"].startswith(message) for e in wrong):
                said = code in self.codes
                return ENGINE if said else differs("not warned of: " + wrong[0]["message"])
        if wrong and all(DECLARES.match(e["message"]) for e in wrong):
            said = "declaration-in-inscription" in self.codes
            return ENGINE if said else differs("not warned of: " + wrong[0]["message"])
        if wrong and SHARED_WARNING in self.codes and all(self._grouped(e) for e in wrong):
            return GROUPS
        if failure is not None and failure["stage"] == "check" and failure["kind"] != "rejected":
            return NOTHING
        if self.raised and self._says_error(answer):
            return AGREES
        if bool(wrong) == (self.net is None):
            unsaid = [
                e["message"]
                for e in answer["errors"]
                if (codes := self._warning(e)) and codes.isdisjoint(self.codes)
            ]
            return differs(f"not warned of: {unsaid[0]}") if unsaid else AGREES
        if self.net is None:
            if failure is not None and UNCOMPILED in failure["message"]:
                return LATE
            return differs("refused here: " + "; ".join(e.message for e in self.d.errors[:3]))
        where = "; ".join(f"{e['what']}: {e['message']}" for e in wrong[:2])
        return differs(f"accepted here; the engine: {where}")

    @staticmethod
    def _warning(error: dict[str, Any]) -> set[str]:
        if error["by"] != "editor":
            return set()
        return next((codes for words, codes in WARNED.items() if words in error["message"]), set())

    def _warns(self, error: dict[str, Any]) -> bool:
        is_empty = error["message"] == NO_DECLARATION and "declaration-empty" in self.codes
        return is_empty or bool(self._warning(error))

    def _takes_too_many(self, message: str) -> bool:
        """Whether the engine ends in a transition with several arcs from what is one place here."""
        found = SUBTRACT.search(message)
        assert self.net is not None
        return found is not None and any(self._twice(_transition(found)).values())

    def _has_twice(self, message: str) -> bool:
        """Whether the engine ends in a transition with a pattern in which a variable is twice."""
        found = SUBTRACT.search(message)
        assert self.net is not None
        return found is not None and any(
            len(names) > len(set(names))
            for t in self.net.transitions
            if _transition(found) in (t.id, t.short)
            for a in t.arcs
            for term in (a.inscription.terms if a.inscription is not None else ())
            if term.pattern is not None
            for names in [[p.symbol for p in walk_pattern(term.pattern) if isinstance(p, PVar)]]
        )

    def _twice(self, transition: str) -> dict[int, bool]:
        """The places that a transition takes from: whether over several arcs."""
        all_of_them = self.net.transitions if self.net else ()
        found = [t for t in all_of_them if transition in (t.id, t.short)]
        taking = Counter(a.place for t in found[:1] for a in t.arcs if a.kind in TAKING)
        return {place: n > 1 for place, n in taking.items()}

    def _grouped(self, error: dict[str, Any]) -> bool:
        """Whether the engine finds no binding of a transition that takes from one place over several arcs."""
        return any(self._twice(error["id"]).values()) and any(
            words in error["message"] for words in UNBOUND
        )

    @staticmethod
    def _says_error(answer: dict[str, Any]) -> bool:
        return bool(answer["errors"]) or "failure" in answer

    def marking(self, answer: dict[str, Any]) -> Verdict:
        """The initial marking of every place instance, character for character."""
        rows = answer.get("marking")
        if self.net is not None and UNCOMPILED in answer.get("failure", {}).get("message", ""):
            return LATE
        if self.net is None or rows is None:
            return NOTHING
        if self.loose:
            return LOOSE
        if self.game is None:
            return differs(f"here the initial marking raises: {self.raised}")
        ours = {(r["id"], r["instance"]): r["marking"] for r in places(self.net, self.game.marking)}
        for row in rows:
            found = ours.get((row["id"], row["instance"]), "no such place")
            if "error" in row:
                return differs(f"{row['name']}: the engine says {row['error']}")
            if found != row["marking"]:
                return self._or_random(f"{row['name']}: {found} instead of {row['marking']}")
        return AGREES

    def _or_random(self, note: str) -> Verdict:
        assert self.net is not None
        if outside(Effects(self.net.program), self.net):
            return Verdict("random", note)
        return differs(note)

    # --- behaviour

    def run(self, answer: dict[str, Any]) -> Verdict:
        """A random run of the engine is possible here, with the same final marking."""
        if self.game is None or "steps" not in answer:
            return NOTHING
        if self.loose:
            return LOOSE
        followed = follow(recording(answer), self.game)
        if followed.why.startswith("in the end the time is") and answer["stop"] == DEAD:
            return (
                CLOCK
                if float(str(answer["final_time"]).replace("~", "-")) > followed.time
                else differs(followed.why)
            )
        if not followed.ok:
            return differs(f"step {followed.steps + 1}: {followed.why}")
        error = answer["stopped_by_error"] or ""
        if error and not followed.random and not self._raises(followed):
            return self._unraised(error)
        if answer["stop"] == DEAD and not followed.random and self._goes_on(followed):
            untold = FIELDS_WARNING not in self.codes
            return differs("the engine sees nothing enabled in the end") if untold else FIELDS
        return Verdict("random") if followed.random else AGREES

    def _goes_on(self, followed: Followed) -> bool:
        """Whether after the steps of a run something is enabled here, now or later."""
        game, settled = self._at_the_end(followed)
        return bool(game.enabled_in(settled))

    def _at_the_end(self, followed: Followed) -> tuple[Game, Marking]:
        """The token game after the steps of a run.

        Raises:
            GameError: one of them raises an exception.
        """
        assert self.net is not None
        game = Game(self.net, seed=1)
        for time, element in followed.occurrences:
            game.set_time(time)
            game.fire(element)
        return game, game.advance_time(game.marking)

    def _raises(self, followed: Followed) -> bool:
        """Whether after the steps of a run there is an exception here, too: in the search, or when something occurs."""
        try:
            game, settled = self._at_the_end(followed)
            for element in game.enabled_in(settled):
                game.occur(settled, element)
        except GameError:
            return True
        return False

    def _unraised(self, error: str) -> Verdict:
        """What to say of an exception that is only there."""
        if BROKEN in error:
            return ENGINE
        if self._takes_too_many(error):
            return FUSED
        if self._has_twice(error):
            return TWICE
        if ORDER_WARNING in self.codes:
            return ORDER
        return differs(f"the engine ends with {error}")

    def space(self, answer: dict[str, Any]) -> Verdict:
        """As `_space`; what differs where references change is the engine's."""
        found = self._space(answer)
        if found.state != "differs" or self.net is None:
            return found
        if FIELDS_WARNING in self.codes:
            return FIELDS
        changes = Effect.WRITE in Effects(self.net.program).of(*texts(self.net))
        return UNRESTORED if changes else found

    def _space(self, answer: dict[str, Any]) -> Verdict:
        """Sizes, dead and home markings and components by the compiled explorer; small graphs node by node."""
        if self.net is None or self.game is None or "nodes" not in answer:
            return NOTHING
        if self.loose:
            return LOOSE
        limits = Limits(max_states=20_000, processor_seconds=60.0, traces=0)
        d = Diagnostics()
        found = explore(self.net, {}, limits, d)
        if found is None:
            unsupported = [e for e in d.errors if e.code.startswith("unsupported-")]
            if unsupported:
                return Verdict("unsupported", unsupported[0].message)
            return differs("; ".join(e.message for e in d.errors[:2]))
        if found.error is not None and not answer["stopped_by_error"] and answer["entire"]:
            return differs(f"here the exploration ends with {found.error['message']}")
        if answer["stopped_by_error"]:
            if BROKEN in answer["stopped_by_error"]:
                return ENGINE
            if found.error is None and found.complete:
                return self._unraised(answer["stopped_by_error"])
            return AGREES
        if not answer["entire"] or found.error is not None:
            return NOTHING
        if not found.complete or found.graph is None:
            return differs(f"more than {found.nodes} nodes instead of {answer['nodes']}")
        theirs = {k: answer[k] for k in ("nodes", "arcs", "scc")} | {
            k: len(answer[k]) for k in ("dead", "home")
        }
        ours = {
            "nodes": found.nodes, "arcs": found.arcs, "scc": found.graph.scc_nodes,
            "dead": found.dead_count, "home": found.graph.home_count,
        }  # fmt: skip
        space = None
        if answer["nodes"] <= SMALL:
            space = state_space(self.game, max_nodes=2 * SMALL)
        if ours != theirs:
            if self._resets_merged():
                return RESETS
            if self.net.timed and (space is None or has_ties(space)):
                return Verdict("random", f"{ours} instead of {theirs}")
            return self._or_random(f"{ours} instead of {theirs}")
        if space is None or "graph" not in answer:
            return AGREES
        found = self._graph(space, answer["graph"])
        return RESETS if found != AGREES and self._resets_merged() else found

    def graph(self, answer: dict[str, Any]) -> Verdict:
        """A whole state space by the token game, node by node and arc by arc, whatever its size."""
        if self.game is None or "graph" not in answer:
            return NOTHING
        if self._takes_too_many(answer["stopped_by_error"] or ""):
            return FUSED
        if answer["stopped_by_error"] or not answer["entire"]:
            return differs(f"no entire state space: {answer['stopped_by_error'] or 'too large'}")
        try:
            space = state_space(self.game, max_nodes=2 * answer["nodes"] + 1)
        except GameError as error:
            return differs(f"here the state space raises: {error.message}")
        if self._resets_merged() and self._graph(space, answer["graph"]) != AGREES:
            return RESETS
        if len(answer["dead"]) != len(space.dead):
            return differs(f"{len(space.dead)} dead markings instead of {len(answer['dead'])}")
        return self._graph(space, answer["graph"])

    def _resets_merged(self) -> bool:
        """Whether a reset arc leads to a place that is several in the net: a port with its socket, or fused ones."""
        assert self.net is not None
        places = self.net.places
        return any(
            a.kind is ArcKind.RESET and len(places[a.place].member_ids) > 1
            for t in self.net.transitions
            for a in t.arcs
        )

    def _graph(self, space: StateSpace, graph: dict[str, Any]) -> Verdict:
        assert self.net is not None and self.game is not None
        ours: Counter[Node | Arc] = Counter(our_nodes(self.game, space))
        ours.update(our_arcs(self.game, space))
        theirs: Counter[Node | Arc] = Counter(engine_nodes(self.net, graph).values())
        theirs.update(engine_arcs(self.net, graph))
        if ours == theirs:
            return AGREES
        if self.net.timed and has_ties(space):
            return Verdict("random", "equal tokens with different stamps")
        return self._or_random(
            f"only here: {list(ours - theirs)[:1]}; only there: {list(theirs - ours)[:1]}"
        )


def has_ties(space: StateSpace) -> bool:
    """Whether equal tokens with different stamps lie in one place somewhere: the engine takes any of them."""
    return any(_tied(marking) for marking in space.nodes)


def _tied(marking: Marking) -> bool:
    timed = (held for held in marking.places if isinstance(held, TimedMultiSet))
    return any(len(set(stamps)) > 1 for held in timed for stamps in held.stamps.values())
