"""Comparison of the token game with what the real CPN Tools engine recorded; see `pn2code.engine_comparison`."""

from __future__ import annotations

from pn2code.engine_comparison.graphs import (
    binding_text,
    engine_arcs,
    engine_nodes,
    our_arcs,
    our_nodes,
)

__all__ = ["binding_text", "engine_arcs", "engine_nodes", "our_arcs", "our_nodes"]
