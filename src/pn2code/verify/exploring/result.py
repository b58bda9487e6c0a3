"""What an exploration has found, in terms of the net."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

from pn2code.base.frozen import frozen
from pn2code.ml.core.colsets import Colset
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.report import value_text
from pn2code.semantics.values.colour_json import from_json
from pn2code.verify.exploring.covering import Covering
from pn2code.verify.exploring.multiset_texts import multiset_text
from pn2code.verify.exploring.unfolded import Unfolded

LEAST_GROWING = 1_000
"""Markings from which on it says something that a place differs in most of them ..."""
GROWING = 0.2
"""... which is so when it does in more than this part of them."""
FAIRNESS = ("impartial", "fair", "just", "none")


@frozen
class Bounds:
    """Of one place: least and greatest number of tokens, and for each colour (JSON of the traces) the same.

    `lower_multiset` and `upper_multiset` are [[count, value], ...]; None: not computed. Of a multi-set with more
    colours than were wanted they have only so many; `lower_colours` and `upper_colours` say how many there are.
    `lower_text` and `upper_text`: what is printed of them, if it has been made (`written`).
    """

    lower: int
    upper: int
    lower_multiset: tuple[tuple[int, Any], ...] | None
    upper_multiset: tuple[tuple[int, Any], ...] | None
    lower_colours: int = 0
    upper_colours: int = 0
    lower_text: str | None = None
    upper_text: str | None = None

    def lower_written(self, colset: Colset) -> str | None:
        """The lower multi-set bound as a text; None: not computed."""
        return self.lower_text or multiset_text(colset, self.lower_multiset)

    def upper_written(self, colset: Colset) -> str | None:
        """The upper one."""
        return self.upper_text or multiset_text(colset, self.upper_multiset)


@frozen
class Seen:
    """What an answer may rest on.

    Args:
        markings: every marking that can be reached has been seen, and what occurs in it.
        arcs: the graph has been made, with all of its arcs.
        components: the graph has been gone through: components, home markings, liveness, fairness.
    """

    markings: bool = False
    arcs: bool = False
    components: bool = False


@frozen
class Graph:
    """What only the whole graph tells. Nodes are numbered breadth first; 1 is the initial marking.

    Args:
        scc_nodes, scc_arcs: strongly connected components, and arcs between different ones.
        home_count: number of home markings; `home`: the first of them.
        initial_is_home: whether the initial marking is one.
        live: for each transition.
        fairness: for each transition one of `FAIRNESS`; None: there is no infinite occurrence sequence.
        seconds: what it took.
    """

    scc_nodes: int
    scc_arcs: int
    home_count: int
    home: tuple[int, ...]
    initial_is_home: bool
    live: tuple[bool, ...]
    fairness: tuple[str, ...] | None
    seconds: float


@frozen
class Trace:
    """A run to a marking, a shortest one unless the marking has no number (0): a swarm gives none."""

    node: int
    file: Path
    steps: int

    @property
    def dead(self) -> str:
        """What the marking is called where nothing is enabled."""
        return f"the dead marking {self.node}" if self.node else "a dead marking"

    @property
    def raising(self) -> str:
        """What it is called where an exception is raised."""
        named = f"marking {self.node}" if self.node else "a marking"
        return f"{named}, in which an exception is raised"

    @staticmethod
    def of(found: Mapping[str, Any]) -> Trace:
        """From what the explorer prints."""
        return Trace(found["node"], Path(found["file"]), found["steps"])


COUNTED = "counted"
"""Why an exploration has ended: what is asked of a closed net is known without the rest of its markings."""


@frozen
class Known:
    """What is known of all markings of a net, where not all were counted (`net_by_counts`, `net_by_parts`).

    Each run comes to a dead marking, and no inscription raises an exception.

    Args:
        nodes, arcs, seconds: of the states that were explored.
        ends: whether each dead marking of a cell has a token in a final place; if not, that is not known.
        never: transitions that never occur; of others that did not occur in the part that was seen it is not known.
        symmetries: for people, what is exchanged; (): tokens were counted up to a limit.
    """

    nodes: int
    arcs: int
    seconds: float
    ends: bool
    never: tuple[int, ...]
    symmetries: tuple[str, ...] = ()


@frozen
class RaisedThere:
    """What CPN Tools may do in a reachable marking, and is not done here: raise an exception, or find other bindings.

    Args:
        transition: of which conditions are asked, by index.
        text: what is computed; "": not known.
        message: the exception.
        node: the marking; `trace`: the run to it; None: they are not known.
        kind: `outside`: nothing is raised, but `text` gives a variable a value outside its colour set; `bind`: it is
            raised here, too, but means that there is no binding (`net.outside`).
    """

    transition: int | None
    text: str
    message: str
    node: int | None
    trace: Trace | None
    kind: Literal["order", "outside", "bind"] = "order"


@frozen
class OtherOrders:
    """What is known of other orders of conditions (`net.other_orders`) in the markings that were seen.

    Args:
        why: "": nothing raises an exception in any order; "error": something does; else why that is not known:
            one of those of `Exploration`, "ways" (there are too many), "truncated".
        raised: of "error".
        more: whether CPN Tools might find other bindings: then what is wrong here need not be so there.
        of_cell: whether the net is that of a cell: then nothing that is said of its programs depends on it.
    """

    why: str
    raised: RaisedThere | None = None
    more: bool = False
    of_cell: bool = False


@frozen
class Exploration:
    """The state space, or the part of it that was seen.

    Args:
        complete: whether all that was wanted was done; else `why` says what was in the way: "states", "seconds",
            "memory", "processor", "interrupted", "error", "approximation", "messages" (see
            `ExploreOptions.heaps`), "infinite" (see `covering`), "counted" (see `known`).
        seen: what is complete, also where not all is.
        error: of "error": `message`, `where`, `transition` (index or None), `node` (None: not known),
            `binding` (texts, when it is an occurrence that raises it), `trace` (as those of `traces`, or None),
            `everywhere` (whether CPN Tools raises it, too, whatever it asks first; not there: yes).
        nodes, arcs, depth: of the graph.
        seconds: of exploration, compilation and analysis not included.
        bytes_per_state: of the tables; `peak_mib`: of the process.
        fired: for each transition the number of its arcs.
        bounds: for each place; None when nothing is known.
        dead_count: markings without successors; `dead`: their first nodes.
        graph: None when it was not computed, or is not complete.
        approximation: None, or its name and the probability that a marking was omitted.
        reductions: what was used to see less than everything; "partial-order" keeps whether there are dead markings and
            how many; with "symmetry" a node stands for all markings that are symmetric to it.
        symmetries: for people, of "symmetry".
        answers: what the explorer says of each question, in order.
        bindings: for each transition of `ExploreOptions.bindings` all with which it occurs, by variable, as in traces;
            None: they are not known.
        arena: bytes for lists and strings: "start" (before the first marking), "firing" (one occurrence), "marking";
            None where bounds are not known.
        different: for each place, how many multi-sets it held; 0 where that is not counted, since its colours are few.
        covering: of "infinite": the run that shows that places, or the time alone, grow without bound.
        known: of "counted": what is known of all markings nevertheless.
        orders: what CPN Tools may raise in another order; None: nothing, or it was not looked at.
        unfolded: what the unfolded net tells where a limit has ended the exploration; None: it was not looked at.
        swarm: how many searches of a swarm have seen what (`swarm.merging`); None: it was one exploration.
        sweep: of an exploration that has forgotten markings (`verify.exploring.progress`): `layers`, how many values
            the measure had; `most_known`, how many markings were known at a time; `forgettings`; `runs_lost`; None: it
            was another one.
        measure: for people, of `sweep`.
        told: whether the explorer has told what it has seen; else how many markings that were is all that is known.
    """

    complete: bool
    why: str
    error: Mapping[str, Any] | None
    nodes: int
    arcs: int
    depth: int
    seconds: float
    bytes_per_state: float
    peak_mib: float
    compile_seconds: float
    threads: int
    fired: tuple[int, ...]
    bounds: tuple[Bounds, ...] | None
    dead_count: int
    dead: tuple[int, ...]
    graph: Graph | None
    traces: tuple[Trace, ...]
    approximation: Mapping[str, Any] | None
    reductions: tuple[str, ...]
    seen: Seen = Seen()
    symmetries: tuple[str, ...] = ()
    answers: tuple[Mapping[str, Any], ...] = ()
    bindings: Mapping[int, Sequence[Mapping[str, Any]]] | None = None
    arena: Mapping[str, int] | None = None
    different: tuple[int, ...] = ()
    covering: Covering | None = None
    known: Known | None = None
    orders: OtherOrders | None = None
    told: bool = True
    unfolded: Unfolded | None = None
    swarm: Mapping[str, Any] | None = None
    sweep: Mapping[str, Any] | None = None
    measure: str = ""

    @property
    def is_reduced(self) -> bool:
        """Whether nodes and arcs are less than those of the whole space, and only some properties are known."""
        return bool({"partial-order", "symmetry"}.intersection(self.reductions))

    @property
    def knows_whole(self) -> bool:
        """Whether all reachable markings are known: explored, or as a set of those of the unfolded net."""
        return self.complete or (self.unfolded is not None and self.unfolded.is_whole)

    @property
    def is_counted(self) -> bool:
        """Whether a state stands for many markings: then bounds are no less than those of the markings."""
        return "counts" in self.reductions

    @property
    def knows_dead_transitions(self) -> bool:
        """Whether a transition without arcs never occurs in what was seen."""
        return self.told and "partial-order" not in self.reductions

    def growing(self) -> tuple[int, int] | None:
        """Of a space not seen to its end: the place that differs in most of its markings, and in how many; or None."""
        if self.seen.markings or self.nodes < LEAST_GROWING or not self.different:
            return None
        count, place = max((n, -i) for i, n in enumerate(self.different))
        return (-place, count) if count > self.nodes * GROWING else None

    @property
    def states_per_second(self) -> float:
        """Markings found in a second of exploration."""
        return self.nodes / self.seconds if self.seconds > 0 else 0.0

    @staticmethod
    def of(net: FlatNet, found: Mapping[str, Any], compile_seconds: float) -> Exploration:
        """From what the explorer prints."""
        graph = found.get("graph")
        return Exploration(
            complete=found["complete"],
            why=found["why"],
            error=_error(net, found["error"]),
            nodes=found["nodes"],
            arcs=found["arcs"],
            depth=found["depth"],
            seconds=found["seconds"],
            bytes_per_state=found["bytes_per_state"],
            peak_mib=found["peak_mib"],
            compile_seconds=compile_seconds,
            threads=found["threads"],
            fired=tuple(found["fired"]),
            bounds=_reduced_bounds(_bounds(found.get("bounds")), found.get("reductions") or ()),
            dead_count=found["dead_count"],
            dead=tuple(found["dead"]),
            graph=_graph(graph) if graph is not None else None,
            traces=tuple(Trace.of(t) for t in found.get("traces") or ()),
            approximation=found.get("approximate"),
            reductions=tuple(found.get("reductions") or ()),
            seen=Seen(**(found.get("seen") or {})),
            answers=tuple(found.get("queries") or ()),
            bindings=_bindings(found.get("bindings")),
            arena=found.get("arena"),
            different=tuple(found.get("different") or ()),
            told=found.get("told", True),
            swarm=found.get("swarm"),
            sweep=found.get("sweep"),
        )

    @property
    def error_trace(self) -> Trace | None:
        """The run to the marking in which an inscription raises an exception."""
        trace = self.error and self.error.get("trace")
        return Trace.of(trace) if trace else None

    def dead_transitions(self) -> tuple[int, ...]:
        """Transitions that never occur, by index."""
        return tuple(i for i, count in enumerate(self.fired) if count == 0)

    def live_transitions(self) -> tuple[int, ...]:
        """Transitions that can always become enabled again, by index."""
        return tuple(i for i, live in enumerate(self.graph.live) if live) if self.graph else ()


def _error(net: FlatNet, found: Mapping[str, Any] | None) -> Mapping[str, Any] | None:
    """With the binding as CPN ML texts, without what the code segment would have given."""
    if found is None or not found.get("binding"):
        return found
    transition = net.transitions[found["transition"]]
    outputs = transition.code.outputs if transition.code else ()
    binding = {
        s.name: value_text(s, from_json(s.colset, found["binding"][s.name]))
        for s in transition.variables
        if s.colset is not None and s not in outputs
    }
    return {**found, "binding": binding}


def _bindings(
    found: Mapping[str, Sequence[Mapping[str, Any]]] | None,
) -> Mapping[int, Sequence[Mapping[str, Any]]] | None:
    return None if found is None else {int(t): told for t, told in found.items()}


def _bounds(found: Sequence[Mapping[str, Any]] | None) -> tuple[Bounds, ...] | None:
    if not found:
        return None
    return tuple(
        Bounds(
            b["lower"],
            b["upper"],
            _multiset(b["lower_multiset"]),
            _multiset(b["upper_multiset"]),
            b["lower_colours"],
            b["upper_colours"],
        )
        for b in found
    )


def _reduced_bounds(
    found: tuple[Bounds, ...] | None, reductions: Sequence[str]
) -> tuple[Bounds, ...] | None:
    """Those that reductions keep: symmetries change the colours, not the number of tokens of a place."""
    if found is None or "partial-order" in reductions:
        return None
    if "symmetry" in reductions:
        return tuple(Bounds(b.lower, b.upper, None, None) for b in found)
    return found


def _multiset(found: Sequence[Sequence[Any]] | None) -> tuple[tuple[int, Any], ...] | None:
    return None if found is None else tuple((row[0], row[1]) for row in found)


def _graph(found: Mapping[str, Any]) -> Graph:
    fairness = found["fairness"]
    return Graph(
        scc_nodes=found["scc_nodes"],
        scc_arcs=found["scc_arcs"],
        home_count=found["home_count"],
        home=tuple(found["home"]),
        initial_is_home=found["initial_is_home"],
        live=tuple(found["live"]),
        fairness=None if fairness is None else tuple(fairness),
        seconds=found["seconds"],
    )
