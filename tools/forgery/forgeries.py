"""One thing changed in a trace: a value, a member deleted, added or doubled, a line removed, repeated, exchanged.

for forgery in forgeries(text):
    forgery.what      # "line 12: binding.n: `3` -> `4`"
    forgery.text      # the whole file with this one change
"""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

Path = tuple[str | int, ...]


@dataclass(frozen=True, slots=True)
class Forgery:
    """A changed trace.

    Args:
        kind: "value", "deleted", "renamed", "added", "doubled", "exchanged", "line removed", "line repeated",
            "lines exchanged", "steps exchanged", "cut".
        line: the first line that is changed, from 1.
        what: the change in words.
        text: the whole file.
    """

    kind: str
    line: int
    what: str
    text: str


def forgeries(text: str) -> Iterator[Forgery]:
    """All of a trace."""
    lines = text.splitlines()
    rows = [json.loads(line) for line in lines]
    for i, row in enumerate(rows):
        for kind, what, new in _of_row(row):
            changed = [*lines[:i], new, *lines[i + 1 :]]
            yield _forgery(kind, i, what, changed)
        yield _forgery("line removed", i, _short(row), [*lines[:i], *lines[i + 1 :]])
        yield _forgery("line repeated", i, _short(row), [*lines[: i + 1], *lines[i:]])
        yield _forgery("cut", i, _short(row), [*lines[:i], lines[i][: len(lines[i]) // 2]])
        if i + 1 < len(rows):
            pair = [lines[i + 1], lines[i]]
            changed = [*lines[:i], *pair, *lines[i + 2 :]]
            yield _forgery("lines exchanged", i, _short(row), changed)
        steps = [k for k in range(i, len(rows)) if "transition" in rows[k]][:2]
        if len(steps) == 2 and steps[0] == i:
            yield _exchanged(lines, rows, *steps)
        if "transition" in row:
            yield _forgery(
                "line removed", i, f"{_short(row)}, others renumbered", _without(rows, i)
            )


def _exchanged(lines: list[str], rows: list[Any], i: int, k: int) -> Forgery:
    """Two steps whose numbers and times stay where they are."""
    stay = ("step", "t")
    changed = list(lines)
    for at, other in ((i, k), (k, i)):
        new = {key: rows[at if key in stay else other][key] for key in rows[at]}
        changed[at] = json.dumps(new)
    return _forgery("steps exchanged", i, f"{_short(rows[i])} with {_short(rows[k])}", changed)


def _without(rows: list[Any], i: int) -> list[str]:
    """Without a step, those after it renumbered."""
    later = [{**r, "step": r["step"] - 1} if "step" in r else r for r in rows[i + 1 :]]
    return [json.dumps(r) for r in (*rows[:i], *later)]


def _forgery(kind: str, i: int, what: str, lines: list[str]) -> Forgery:
    return Forgery(kind, i + 1, f"line {i + 1}: {kind}: {what}", "\n".join(lines) + "\n")


def _short(row: Any) -> str:
    return str(row.get("transition") or row.get("event") or "header")


def _of_row(row: dict[str, Any]) -> Iterator[tuple[str, str, str]]:
    for path, value in [((), row), *_walk(row, ())]:
        name = ".".join(map(str, path))
        if path:
            for other in _others(value):
                what = f"{name}: `{json.dumps(value)}` -> `{json.dumps(other)}`"
                yield "value", what, json.dumps(_with(row, path, other))
            yield "deleted", name, json.dumps(_with(row, path, _GONE))
        if isinstance(value, dict):
            yield "added", name, json.dumps(_with(row, path, {**value, "more": 1}))
            for key in value:
                renamed = {(f"{k}x" if k == key else k): v for k, v in value.items()}
                yield "renamed", f"{name}.{key}", json.dumps(_with(row, path, renamed))
                yield "doubled", f"{name}.{key}", _doubled(row, path, key)
            for a, b in zip(value, [*value][1:], strict=False):
                swapped = {**value, a: value[b], b: value[a]}
                yield "exchanged", f"{name}.{a} and {b}", json.dumps(_with(row, path, swapped))
        if isinstance(value, list):
            for i in range(len(value)):
                longer = [*value[: i + 1], *value[i:]]
                yield "doubled", f"{name}.{i}", json.dumps(_with(row, path, longer))


_GONE = object()
_MARK = "\0doubled\0"


def _doubled(row: dict[str, Any], path: Path, key: str) -> str:
    """A member that is there twice, with another value first: which counts is up to the reader."""
    table: Any = row
    for part in path:
        table = table[part]
    other = next(_others(table[key]))
    first = {_MARK: other, **table}
    return json.dumps(_with(row, path, first) if path else first).replace(
        json.dumps(_MARK), json.dumps(key)
    )


def _walk(node: Any, path: Path) -> Iterator[tuple[Path, Any]]:
    inner: Any = node.items() if isinstance(node, dict) else ()
    if isinstance(node, list):
        inner = enumerate(node)
    for key, value in inner:
        yield (*path, key), value
        yield from _walk(value, (*path, key))


def _with(row: Any, path: Path, value: Any) -> Any:
    """The row with another value at a path; without what is there for `_GONE`."""
    if not path:
        return value
    new = copy.deepcopy(row)
    table = new
    for part in path[:-1]:
        table = table[part]
    if value is _GONE:
        del table[path[-1]]
    else:
        table[path[-1]] = value
    return new


def _others(value: Any) -> Iterator[Any]:
    """Other values, of the same type first."""
    match value:
        case bool():
            yield not value
            yield int(value)
        case int():
            yield from (value + 1, value - 1, value + 0.5, str(value), bool(value))
        case float():
            yield from (value + 0.125, -value - 1.0, value * 1.0000001 + 1e-9, str(value), 1e300)
        case str():
            yield from (f"{value}x", value[:-1], value.swapcase() or "x", 7)
        case list():
            yield from ([*value, *value[-1:]] if value else [0], value[:-1] if value else {}, "")
        case dict():
            yield from ([], None)
        case None:
            yield from (0, [])
    if value is not None:
        yield None
