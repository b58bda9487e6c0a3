"""Arcs of which CPN Tools makes code that it cannot compile, or that means something else.

    in A : h :: t    in A : l       1`h::t ++ 1`l

It writes the arcs from one place as one sum, and the value of each behind its coefficient without the parentheses, so
that `h :: t`, `n + 1` and `if b then x else y` no longer are what is counted. From a place with a clock it does so with
a single arc, too, if the coefficient is not 1. (Found by experiment.) What is a sum already is written as it is, but
for what binds variables.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from pn2code.ml.core.terms import Apply, Case, Exp, Handle, If, Lambda, Lit, Raise, While
from pn2code.net.engine_binding import TakingArc
from pn2code.net.engine_parts import inside


def loses_parentheses(arcs: Sequence[TakingArc]) -> Iterator[tuple[int, Exp]]:
    """Arcs whose value needs parentheses in the code that CPN Tools makes, and has none: which, and the value."""
    counts = Counter(arc.node.id for arc in arcs)
    for i, arc in enumerate(arcs):
        terms = arc.inscription.terms
        is_merged = counts[arc.node.id] > 1 and len(terms) == 1
        for term in terms:
            is_one = isinstance(term.coefficient, Lit) and term.coefficient.value == 1
            is_counted = arc.node.timed and not is_one and not term.whole
            if is_merged or (is_counted and (len(terms) == 1 or term.pattern is not None)):
                value = inside(term.value)
                if _is_open(value):
                    yield i, value


def _is_open(e: Exp) -> bool:
    """Whether a text needs parentheses behind a coefficient."""
    match e:
        case Apply(function, _):
            return function.span.start > e.span.start
        case If() | Case() | Handle() | Raise() | Lambda() | While():
            return True
        case _:
            return False
