"""Which traces there are where one was looked for that is not there.

    traces_there(Path("run/cell.trace.jsonl"))      # "in `run` there is `fasten.trace.jsonl`"

A run names its trace after the net, so that a name from a manual or another cell is easily a wrong one.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

_ENDING = ".trace.jsonl"
_MOST = 6


def traces_there(wanted: Path, otherwise: str) -> str:
    """A hint: the traces in the folder of a file that is not there, or in those of the folder where it would be."""
    if wanted.exists():
        return otherwise
    folder = wanted.parent
    if not folder.is_dir():
        above = next((p for p in folder.parents if p.is_dir()), None)
        missing = f"there is no folder `{folder}`"
        if above is None:
            return missing
        found = _names(above.glob(f"*/*{_ENDING}"), above)
        return f"{missing}; {_listed(found, above)}" if found else missing
    found = _names(folder.glob(f"*{_ENDING}"), folder)
    if not found:
        found = _names(folder.glob(f"*/*{_ENDING}"), folder)
    if not found:
        return f"there is no trace (`*{_ENDING}`) in `{folder}`"
    return _listed(found, folder)


def _names(paths: Iterable[Path], folder: Path) -> list[str]:
    try:
        return sorted(str(p.relative_to(folder)) for p in paths)
    except OSError:
        return []


def _listed(names: list[str], folder: Path) -> str:
    shown = [f"`{n}`" for n in names[:_MOST]]
    if len(names) > _MOST:
        shown.append(f"{len(names) - _MOST} more")
    listed = " and ".join(filter(None, (", ".join(shown[:-1]), shown[-1])))
    return f"in `{folder}` there {'is' if len(names) == 1 else 'are'} {listed}"
