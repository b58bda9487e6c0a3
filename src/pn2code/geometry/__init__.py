"""Geometry over everything a net permits: each move from wherever the arm can be then, and all that can be at once."""
