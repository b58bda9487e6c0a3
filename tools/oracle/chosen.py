"""Which random nets are worth asking the engine about, many at once.

    few, many = chosen(17)      # two nets: of few markings, of many; net 17 is the same every time

Neither draws at random, counts steps or has references, whose values the engine does not restore; neither raises an
exception, which would end a pack; and both leave out what the engine is known to lose count of: variables twice in a
pattern or shared by arcs from one place, ``2`(h :: t)`` at timed places, ports without sockets, equal tokens with
different stamps. Nets with these: `--alone`. Arcs that take a sum of tokens are only in the second.
"""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from random import Random

from tools.oracle.compare import TAKING, Seen, has_ties
from tools.oracle.together import numbered
from tools.oracle.writer import rich_net

from helpers.netbuilder import cpn
from helpers.random_nets import random_net
from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.semantics.evaluation.effects import Effects, texts
from pn2code.semantics.evaluation.used_symbols import variables
from pn2code.semantics.game.graph import state_space
from pn2code.semantics.game.token_game import Game, GameError

TRIES = 200
LEAST, MOST, MOST_ARCS = 4, 40, 160
"""Nodes and arcs of a state space that tells something and does not take long."""
_VARIABLE = re.compile(r"\b[vwx](?:C\d+|[A-Z]+)_n\d+\b")
STEPS = 30
"""Of a random walk that shows that a net goes on, and raises nothing."""


def written(seed: int, number: int) -> str:
    """A random net, its names with a number."""
    return numbered((rich_net if number % 2 else random_net)(Random(seed)), number)


def chosen(number: int) -> tuple[str, str]:
    """A net with a small state space, and one that goes on for long.

    Raises:
        RuntimeError: none was found, so the nets have changed very much.
    """
    few = many = ""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "net.cpn"
        for t in range(TRIES):
            text = written(number * TRIES + t, number)
            if _is_odd(text):
                continue
            path.write_bytes(cpn(text))
            size = _size(path)
            if size == "few" and not few:
                few = text
            elif size == "many" and not many:
                many = text
            if few and many:
                return few, many
    raise RuntimeError(f"no net {number} among {TRIES}")


def _size(path: Path) -> str:
    """ "few" or "many" markings, or "" if it is not to be asked about."""
    seen = Seen(path)
    if seen.net is None or seen.game is None or seen.loose or not _is_fit(seen.net):
        return ""
    try:
        space = state_space(seen.game, max_nodes=MOST, max_arcs=MOST_ARCS)
        if space.complete:
            is_fit = len(space.nodes) >= LEAST and not has_ties(space)
            return "few" if is_fit and not any(map(_adds, seen.net.transitions)) else ""
        return "many" if _goes_on(seen.net) else ""
    except GameError:
        return ""


def _is_fit(net: FlatNet) -> bool:
    effects = Effects(net.program)
    actions = [t.code.action for t in net.transitions if t.code is not None]
    return not effects.of(*texts(net), *actions) and not any(map(_shares, net.transitions))


def _shares(t: FlatTransition) -> bool:
    """Whether arcs from one place share a variable."""
    seen: dict[int, set[Symbol]] = {}
    for arc in t.arcs:
        if arc.kind in TAKING and arc.inscription is not None:
            own = variables(arc.inscription.value).intersection(t.variables)
            before = seen.setdefault(arc.place, set())
            if before & own:
                return True
            before |= own
    return False


def _is_odd(text: str) -> bool:
    """Whether an input arc has a variable twice, or several times a list that is taken apart."""
    arcs = [line for line in text.splitlines() if line.startswith(("      in ", "      both "))]
    found = [_VARIABLE.findall(arc) for arc in arcs]
    return any(len(set(names)) < len(names) for names in found) or any(
        "`" in arc and "::" in arc for arc in arcs
    )


def _adds(t: FlatTransition) -> bool:
    """Whether an arc takes a sum of tokens: the state-space tool sometimes never comes back then."""
    return any(a.kind in TAKING and a.inscription and len(a.inscription.terms) > 1 for a in t.arcs)


def _goes_on(net: FlatNet) -> bool:
    """Whether a random walk is long, and never has very many bindings to choose from."""
    game, r = Game(net, seed=1), Random(1)
    for _ in range(STEPS):
        if not game.advance():
            return False
        elements = game.enabled()
        if len(elements) > MOST_ARCS:
            return False
        game.fire(r.choice(elements), checked=False)
    return True
