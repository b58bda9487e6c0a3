"""Places, arcs, transitions and predicates of a net as IR."""
