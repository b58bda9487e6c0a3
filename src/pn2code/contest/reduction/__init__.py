"""Structural reductions of place/transition nets: smaller nets with the same answer."""
