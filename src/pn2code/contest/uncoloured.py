"""A coloured net without its colours, for what is too large to be unfolded.

    tables = uncoloured(net, game)      # a place for each place; None: arcs do not always move as many tokens

Each step of the coloured net is one of this net, with the same numbers of tokens in the places of the file, which are
all that formulas speak of. So what is not reachable here is not reachable there, and what places hold at most here they
do not exceed there (Jensen 1997: the colour-free net; used so by LoLA and TAPAAL). The opposite does not follow: two
tokens that are taken together need not have the same colour. Nor is a transition enabled that is enabled here:
`Tables.at_first` says which are enabled in the initial marking of the coloured net, and weaker.py takes for granted
that a transition may be disabled. What is reachable is found by the token game (playing.py).
"""

from __future__ import annotations

from itertools import islice, product

from pn2code.contest.tables import Tables
from pn2code.ml.core.terms import Apply, Builtin, Exp, Lit, RecordExp
from pn2code.net.flat import ArcInscription, ArcKind, FlatNet, FlatTransition, Form
from pn2code.semantics.evaluation.used_symbols import variables
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.colours import NotFinite
from pn2code.semantics.values.data import MlException, MlLimit
from pn2code.semantics.values.multiset import MultiSet

MOST_VALUES = 2000
"""Bindings for which the tokens of one inscription are counted, to see that they are always as many."""


class _VaryingError(Exception):
    """An inscription gives more or fewer tokens, or nobody knows."""


def uncoloured(net: FlatNet, game: Game) -> Tables | None:
    """The net without colours; None if it cannot be made.

    Args:
        net: a net without time, inhibitor and reset arcs.
        game: the net's token game, in its initial marking.
    """
    pre: list[dict[int, int]] = []
    post: list[dict[int, int]] = []
    try:
        for t in net.transitions:
            sides: tuple[dict[int, int], dict[int, int]] = ({}, {})
            for arc in t.arcs:
                if arc.kind not in (ArcKind.INPUT, ArcKind.OUTPUT, ArcKind.BOTH):
                    return None
                if arc.inscription is None:
                    return None
                for kind, side in zip((ArcKind.INPUT, ArcKind.OUTPUT), sides, strict=True):
                    if arc.kind in (kind, ArcKind.BOTH):
                        n = _tokens(arc.inscription, t, game)
                        side[arc.place] = side.get(arc.place, 0) + n
            pre.append({p: n for p, n in sides[0].items() if n})
            post.append({p: n for p, n in sides[1].items() if n})
        initial = game.own_initial_marking
        at_first = frozenset(t.id for t in game.enabled_transitions(initial))
    except (_VaryingError, GameError, MlException, MlLimit, NotFinite):
        return None
    return Tables(
        tuple(map(len, initial.places)),
        tuple(pre),
        tuple(post),
        {name: (p.index,) for p in net.places for name, _ in p.member_ids},
        {t.id: (t.index,) for t in net.transitions},
        at_first=at_first,
    )


def _tokens(inscription: ArcInscription, t: FlatTransition, game: Game) -> int:
    if inscription.form is Form.TOKEN:
        return 1
    if inscription.form is not Form.MULTISET:
        raise _VaryingError
    return _size(inscription.value, t, game)


def _size(e: Exp, t: FlatTransition, game: Game) -> int:
    """How many tokens a multi-set has, whatever the binding."""
    match e:
        case Apply(Builtin("Ms.++"), RecordExp(((_, a), (_, b)))):
            return _size(a, t, game) + _size(b, t, game)
        case Apply(Builtin("Ms.`"), RecordExp(((_, Lit(int(n))), _))) if n >= 0:
            return n
    free = [s for s in t.variables if s.uid in {v.uid for v in variables(e)}]
    values = []
    for symbol in free:
        if symbol.colset is None:
            raise _VaryingError
        values.append(list(islice(game.colours.all(symbol.colset), MOST_VALUES + 1)))
    number = 1
    for known in values:
        number *= len(known)
    if number > MOST_VALUES:
        raise _VaryingError
    sizes = set()
    for chosen in product(*values):
        env = {s.uid: value for s, value in zip(free, chosen, strict=True)}
        sizes.add(len(MultiSet.of(game.evaluator.evaluate(e, env))))
    if len(sizes) != 1:
        raise _VaryingError
    return sizes.pop()
