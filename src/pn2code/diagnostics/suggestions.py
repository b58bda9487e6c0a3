"""Names that are written almost right."""

from __future__ import annotations

from collections.abc import Iterable


def nearest(name: str, *known: Iterable[str], cutoff: float = 0.6) -> str:
    """The known name that is most like `name`, "" if none is; one that differs in case only comes first.

    The name itself is none: where it is known, it was refused for another reason. Of several groups of known names an
    earlier one is preferred, even if a later one has a name that is more like it.
    """
    from difflib import get_close_matches  # only a mistake needs it

    groups = [sorted(k for k in names if k != name) for names in known]
    same = [k for names in groups for k in names if k.lower() == name.lower()]
    if same:
        return same[0]
    for names in groups:
        found = get_close_matches(name, names, n=1, cutoff=cutoff)
        if found:
            return found[0]
    return ""


def did_you_mean(name: str, known: Iterable[str], otherwise: str = "") -> str:
    """A hint: "did you mean `Gripper`?"; `otherwise` if no known name is like it."""
    near = nearest(name, known)
    return f"did you mean `{near}`?" if near else otherwise
