"""`Predicate`, which is at home in `net`, where the compiler knows it too."""

from pn2code.net.predicate import Predicate, marking_type

__all__ = ["Predicate", "marking_type"]
