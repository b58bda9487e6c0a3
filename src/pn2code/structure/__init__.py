"""Structural analysis: what follows from the net itself, without its state space.

    analysis = analyse(flat)                 # everything, see `analysis`
    bounds(flat)[place.index].bound          # proven bounds alone, for whoever packs markings

Everything here is *sound*: what it claims holds in every reachable marking. It is not complete: where an inscription
is beyond it, it says less. Docs: docs/structure.md.
"""

from pn2code.structure.analysis import Sum, analyse, bounds, bounds_and_sums
from pn2code.structure.found import Analysis, Limits

__all__ = ["Analysis", "Limits", "Sum", "analyse", "bounds", "bounds_and_sums"]
