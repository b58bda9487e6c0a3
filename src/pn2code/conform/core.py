"""The compiled net against the token game: in every reachable marking the same binding elements and the same markings.

report = compare(net, storage, d)      # CoreReport(nodes=754, arcs=1121, complete=True, deviation=None)

The compiled explorer writes its whole graph; the token game then looks at each node by itself: what is enabled there,
and what comes of it. Equal at the first node and at each that is reached, the two graphs are equal. Beyond a stated
size runs of the compiled simulator are repeated step by step instead.
"""

from __future__ import annotations

import json
import subprocess
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.base.how_far import HowFar, Say, silent
from pn2code.conform.clock import Clock
from pn2code.conform.scheme import MOST_STATES
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.evaluation.references import Held
from pn2code.semantics.game.errors import GivenUpError
from pn2code.semantics.game.marking import Marking, binding_to_json, place_from_json, place_to_json
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.simulate import programs
from pn2code.trace.replay import replay
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits, Reduction

WALKS = 20
WALK_STEPS = 500


@frozen
class CoreReport:
    """What was compared.

    Args:
        nodes, arcs: of the state space, each looked at in both; 0 where it is larger than the limit.
        complete: whether that is the whole state space.
        walks, steps: random runs of the compiled simulator that were repeated, and their steps, where it is not, or
            where nodes that differ in time alone are one.
        deviation: in words; None: there is none.
        given_up: what the token game did not evaluate to its end; "": nothing.
        raises: whether there is no whole state space because the net ends with an error in it.
    """

    nodes: int
    arcs: int
    complete: bool
    walks: int = 0
    steps: int = 0
    deviation: str | None = None
    given_up: str = ""
    raises: bool = False


class _Differs(Exception):
    """The two differ; the text says where."""


def compare(
    net: FlatNet,
    storage: Mapping[str, str],
    d: Diagnostics,
    *,
    most: int = MOST_STATES,
    walks: int = WALKS,
    say: Say = silent,
) -> CoreReport | None:
    """Compares the whole graph, or samples of it; None after an error that was reported.

    Args:
        net: the net.
        storage: as for `Game`.
        d: gets the errors.
        most: nodes up to which the whole graph is compared.
        walks: random runs beyond that.
        say: hears in words how far it is.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        graph = Path(name) / "graph.jsonl"
        options = ExploreOptions(graph=graph, graph_limit=most)
        clock = Clock(net)
        reductions = (Reduction.TIME,) if clock.is_relative else ()
        limits = Limits(max_states=most, traces=0, reductions=reductions)
        found = explore(net, storage, limits, d, options)
        if found is None:
            return None
        if not found.complete or not graph.exists():
            sampled = _sampled(net, storage, walks, Path(name), d)
            raises = found.error is not None
            return sampled and replace(sampled, raises=raises)
        whole = _Whole(net, storage, clock).compared(graph, say)
        if whole.deviation or whole.given_up or not clock.is_relative:
            return whole
        # In relative time a graph does not say how long was waited: runs do.
        sampled = _sampled(net, storage, walks, Path(name), d)
        if sampled is None or sampled.deviation or sampled.given_up:
            return sampled
        return replace(whole, walks=sampled.walks, steps=sampled.steps)


class _Whole:
    def __init__(self, net: FlatNet, storage: Mapping[str, str], clock: Clock) -> None:
        self._net = net
        self._game = Game(net, storage, files=Files(None))
        self._clock = clock
        self._references: dict[int, Held] = {}

    def compared(self, graph: Path, say: Say) -> CoreReport:
        """The explorer's graph, node by node."""
        markings: list[tuple[float, Mapping[str, Any]]] = []
        leaving: list[dict[str, int]] = []
        rows: list[Mapping[str, Any]] = []
        with graph.open(encoding="utf-8", errors="surrogateescape") as lines:
            for line in lines:
                row = json.loads(line)
                if "node" in row:
                    markings.append((row["t"], row["marking"]))
                    leaving.append({})
                else:
                    rows.append(row)
        for row in rows:
            element = self._element_key(row["t"], row["transition"], row["binding"])
            text = f"{element} -> {_marking_key(*markings[row['to'] - 1])}"
            leaving[row["from"] - 1][text] = row["to"] - 1
        try:
            if not markings or _marking_key(*markings[0]) != self._key(self._game.marking):
                raise _Differs("the initial markings differ")
            self._references = {0: self._game.marking.references}
            more = HowFar(say, "comparing net.c", total=len(markings))
            for node, ((time, places), arcs) in enumerate(zip(markings, leaving, strict=True)):
                more()
                self._node(node, time, places, arcs)
        except GivenUpError as limit:
            return CoreReport(0, 0, False, given_up=str(limit))
        except (_Differs, GameError) as difference:
            return CoreReport(len(markings), len(rows), False, deviation=str(difference))
        return CoreReport(len(markings), len(rows), True)

    def _node(
        self, node: int, time: float, places: Mapping[str, Any], arcs: Mapping[str, int]
    ) -> None:
        """Raises `_Differs` unless the node has the arcs that the token game gives it.

        The graph does not say what references hold: from the initial marking on the token game finds it out.
        """
        net, game = self._net, self._game
        tokens = tuple(place_from_json(p.colset, places[p.name]) for p in net.places)
        if node not in self._references:
            raise _Differs(f"no node before it leads to {_short(places)}")
        at = time if net.real_time else int(time)
        marking = game.advance_time(Marking(at, tokens, self._references[node]))
        expected: dict[str, Held] = {}  # one arc for each binding element: equal ones are one
        for element in game.enabled_in(marking):
            after, occurred = game.occur(marking, element)
            name = net.transitions[element.transition].name
            key = self._element_key(marking.time, name, binding_to_json(occurred))
            expected[f"{key} -> {self._key(after)}"] = after.references
        for text in expected.keys() - arcs.keys():
            raise _Differs(f"only the token game has, at {_short(places)}: {text}")
        for text in arcs.keys() - expected.keys():
            raise _Differs(f"only the compiled net has, at {_short(places)}: {text}")
        for text, held in expected.items():
            if self._references.setdefault(arcs[text], held) != held:
                raise _Differs(f"references have other values, at {_short(places)} after: {text}")

    def _element_key(self, time: float, transition: str, binding: Mapping[str, Any]) -> str:
        shown = 0.0 if self._clock.is_relative else float(time)
        return json.dumps([shown, transition, binding], sort_keys=True)

    def _key(self, marking: Marking) -> str:
        counted = self._clock.relative(marking)
        places = {
            p.name: place_to_json(self._game.colours, p.colset, counted.places[p.index])
            for p in self._net.places
        }
        return _marking_key(counted.time, places)


def _sampled(
    net: FlatNet, storage: Mapping[str, str], walks: int, folder: Path, d: Diagnostics
) -> CoreReport | None:
    steps = 0
    with programs.program(net, storage, d) as program:
        if program is None:
            return None
        for seed, trace in _runs(program, walks, folder):
            result = replay(trace, net, storage, files=Files(None))
            steps += result.steps
            if result.given_up:
                return CoreReport(0, 0, False, seed, steps, given_up=result.why)
            if not result.ok:
                why = f"run with seed {seed}, step {result.steps + 1}: {result.why}"
                return CoreReport(0, 0, False, seed, steps, why)
    return CoreReport(0, 0, False, walks, steps)


def _runs(program: Path, walks: int, folder: Path) -> Iterator[tuple[int, Path]]:
    """Traces of random runs."""
    trace = folder / "walk.trace.jsonl"
    for seed in range(1, walks + 1):
        options = ["--steps", str(WALK_STEPS), "--seed", str(seed), "--trace", str(trace)]
        subprocess.run([str(program), *options], capture_output=True, check=False)
        yield seed, trace


def _marking_key(time: float, places: Mapping[str, Any]) -> str:
    held = {name: tokens for name, tokens in places.items() if tokens}
    return json.dumps([float(time), held], sort_keys=True)


def _short(places: Mapping[str, Any]) -> str:
    text = json.dumps({name: tokens for name, tokens in places.items() if tokens})
    return text if len(text) < 400 else f"{text[:400]}..."
