"""Names that are written almost right."""

from __future__ import annotations

from collections.abc import Iterable


def nearest(name: str, known: Iterable[str], *, cutoff: float = 0.6) -> str:
    """The known name that is most like `name`, "" if none is; one that differs in case only comes first."""
    from difflib import get_close_matches  # only a mistake needs it

    names = list(known)
    same = [k for k in names if k.lower() == name.lower()]
    found = same or get_close_matches(name, names, n=1, cutoff=cutoff)
    return found[0] if found else ""


def did_you_mean(name: str, known: Iterable[str], otherwise: str = "") -> str:
    """A hint: "did you mean `Gripper`?"; `otherwise` if no known name is like it."""
    near = nearest(name, known)
    return f"did you mean `{near}`?" if near else otherwise
