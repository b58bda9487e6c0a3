"""Whether a formula that branches is about all paths: then it also holds where fewer of them are left."""

from __future__ import annotations

from pn2code.properties import meaning as m


def is_universal(f: m.Formula, positive: bool) -> bool:
    """Whether a formula (`positive` False: its opposite) says of all paths what is so of them, and no more."""
    if isinstance(f, m.Atom):
        return f.kind in ("true", "pred", "initial")
    match f.operator:
        case "not":
            return is_universal(f.parts[0], not positive)
        case "implies":
            a, b = f.parts
            return is_universal(a, not positive) and is_universal(b, positive)
        case "iff":
            return all(is_universal(x, sign) for x in f.parts for sign in (True, False))
        case operator if operator.startswith("E"):
            return not positive and all(is_universal(x, positive) for x in f.parts)
        case operator if operator.startswith("A"):
            return positive and all(is_universal(x, positive) for x in f.parts)
        case _:
            return all(is_universal(x, positive) for x in f.parts)
