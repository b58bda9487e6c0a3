"""Exploring a net: the compiled explorer, its options and reductions, and what it has found."""
