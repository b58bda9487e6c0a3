"""Functions whose value depends on more than the marking: no list of them lacks one that another one has."""

from __future__ import annotations

from pn2code.diagnostics import Origin, SourceText, Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import UNIT
from pn2code.ml.library.builtins import BUILTINS
from pn2code.net.builder import Builder
from pn2code.semantics.evaluation.effects import NONE, OUTSIDE, effects_of
from pn2code.unfold.purity import impure
from pn2code.verify.exploring.time_reduction import _builtin_reads

NAMES = [name for name, info in BUILTINS.items() if not info.unsupported]


def test_lists_of_functions_agree() -> None:
    program = Builder.empty("net", "net.cpn").net().program
    effects = effects_of(program)
    at = Span(SourceText("x", Origin("net.cpn")), 0, 1)
    unfolded, timed = [], []
    for name in NAMES:
        found = effects.of(core.Builtin(name, UNIT, at))
        if found != NONE and not impure(core.Builtin(name, UNIT, at), program):
            unfolded.append(name)
        if found & OUTSIDE and _builtin_reads(name, UNIT) is None:
            timed.append(name)
    assert (unfolded, timed) == ([], [])
