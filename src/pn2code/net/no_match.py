"""Where `Bind`, raised by what an input arc wants, means that there is no binding.

    in P : n,  in Q : let val (x :: _) = f n in x end      # `Bind` of some n: not with that one

CPN Tools takes it so where it has tried a token or an equation to get a variable that the arc needs, or one that an
arc from the same place needs. Elsewhere it is an exception as others are: where no variable is needed, where all values
of a colour set are tried, and where a token is found by a known part of it. (All was found by experiment. Where both
tokens and all values are tried it means that the other values are not: it is taken for an exception here.)
"""

from __future__ import annotations

from pn2code.ml.core.terms import Pat, PRecord, PVar, Symbol, Var
from pn2code.net.conditions import TAKING, term_of, texts_of
from pn2code.net.flat import BindAll, BindEquation, BindTerm, FlatTransition
from pn2code.net.uses import pattern_variables, walk


def catches(pattern: Pat | None) -> bool:
    """Whether CPN Tools tries tokens to match a pattern, so that `Bind` means another one; it finds the others."""
    return not isinstance(pattern, PRecord) or all(isinstance(x, PVar) for _, x in pattern.fields)


def no_match_places(t: FlatTransition) -> frozenset[int]:
    """The places of input arcs that want nothing where computing it raises `Bind`."""
    tried: set[Symbol] = set()
    for step in t.plan:
        if isinstance(step, BindTerm):
            pattern = term_of(t, step.arc, step.term).pattern
            if catches(pattern):
                tried.update(pattern_variables(pattern))
        elif isinstance(step, BindEquation):
            tried.update(pattern_variables(step.pattern))
    needed: dict[int, set[Symbol]] = {}
    for arc in t.arcs:
        if arc.kind in TAKING and arc.inscription is not None:
            texts = (x for term in arc.inscription.terms for x in texts_of(term))
            found = {e.symbol for x in texts for e in walk(x) if isinstance(e, Var)}
            needed.setdefault(arc.place, set()).update(found)
    every = {step.symbol for step in t.plan if isinstance(step, BindAll)}
    return frozenset(p for p, own in needed.items() if own & tried and not own & every)
