"""How keys of TOML files are called in messages.

in_words(("supervisor", "final"), data)      # "`supervisor.final`"
in_words(("channel", 3, "file"), data)       # "`file` of `medida1` in `channel`"
in_words(("scene", "contacts", 0), data)     # "the 1st of `scene.contacts`"
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

_NAMES = ("place", "name", "file")
"""The keys by which an entry of an array is known to those who wrote it."""


def in_words(path: Sequence[str | int], data: object) -> str:
    """A key or a table, with its entry of an array by name; by number, counted from 1, where it has none.

    Args:
        path: of the key; entries of arrays are counted from 0.
        data: what the file says.
    """
    indices = [i for i, part in enumerate(path) if isinstance(part, int)]
    if not indices:
        return f"`{'.'.join(map(str, path))}`"
    at = indices[-1]
    for part in path[: at + 1]:
        data = _inner(data, part)
    entry = _of_entry(path[:at], int(path[at]), data)
    inner = ".".join(map(str, path[at + 1 :]))
    return f"`{inner}` of {entry}" if inner else entry


def _inner(data: object, key: str | int) -> object:
    if isinstance(data, Mapping):
        return data.get(key)
    if isinstance(data, list) and isinstance(key, int) and key < len(data):
        return data[key]
    return None


def _of_entry(array: Sequence[str | int], index: int, entry: object) -> str:
    shown = f"`{'.'.join(map(str, array))}`"
    if isinstance(entry, Mapping):
        for key in _NAMES:
            name = entry.get(key)
            if isinstance(name, str) and name:
                return f"`{name}` in {shown}"
    return f"the {_ordinal(index + 1)} of {shown}"


def _ordinal(n: int) -> str:
    ending = "th" if n % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(n % 10, "th")
    return f"{n}{ending}"
