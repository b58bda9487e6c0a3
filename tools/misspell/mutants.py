"""Mistakes in a TOML file, made mechanically: every key and every value misspelt, deleted, duplicated, of a wrong type.

for mistake in mistakes(text):
    mistake.what      # "supervisor.final.0: name misspelt: `Finished` -> `FinishedZq`"
    mistake.text      # the whole file with this one mistake
"""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

ADDED = "Zq"
"""What a name gets at its end. It occurs in no example, so that a name that was only changed everywhere is seen."""

Path = tuple[str | int, ...]


@dataclass(frozen=True, slots=True)
class Mistake:
    """One mistake.

    Args:
        path: of the key or value.
        kind: "key misspelt", "name misspelt", "deleted", "duplicated", "wrong type".
        change: in words.
        text: the file.
        renamed: where a name is misspelt: the file with `ADDED` at the end of the name instead.
    """

    path: Path
    kind: str
    change: str
    text: str
    renamed: str = ""

    @property
    def what(self) -> str:
        """In words."""
        return f"{'.'.join(map(str, self.path))}: {self.kind}: {self.change}"


@dataclass(frozen=True, slots=True)
class Table:
    """A TOML table whose keys may come twice."""

    pairs: tuple[tuple[str, Any], ...]


def mistakes(text: str) -> Iterator[Mistake]:
    """All of them."""
    whole = _tree(tomllib.loads(text))
    for path, node in _walk(whole, ()):
        renamed: dict[str, str] = {}
        for kind, change, changed in _changes(path, node, whole):
            made = written(changed)
            if kind.endswith("misspelt"):
                renamed.setdefault(kind, made)  # the first one has `ADDED`
            yield Mistake(path, kind, change, made, renamed.get(kind, ""))


def as_toml(data: dict[str, Any]) -> str:
    """A file that says this."""
    return written(_tree(data))


def as_it_is(text: str) -> str:
    """The file as all mistakes are written."""
    return written(_tree(tomllib.loads(text)))


# --- the tree --------------------------------------------------------------------------------------


def _tree(value: Any) -> Any:
    if isinstance(value, dict):
        return Table(tuple((k, _tree(v)) for k, v in value.items()))
    return [_tree(v) for v in value] if isinstance(value, list) else value


def _walk(node: Any, path: Path) -> Iterator[tuple[Path, Any]]:
    inner: Any = ()
    if isinstance(node, Table):
        inner = node.pairs
    elif isinstance(node, list):
        inner = enumerate(node)
    for key, value in inner:
        yield (*path, key), value
        yield from _walk(value, (*path, key))


def _replaced(node: Any, path: Path, new: list[tuple[Any, Any]]) -> Any:
    """The tree with other pairs (key, value) in place of that at a path."""
    first, *rest = path
    if isinstance(node, Table):
        pairs: list[tuple[str, Any]] = []
        for key, value in node.pairs:
            if key != first:
                pairs.append((key, value))
            elif rest:
                pairs.append((key, _replaced(value, tuple(rest), new)))
            else:
                pairs += new
        return Table(tuple(pairs))
    items: list[Any] = []
    for i, value in enumerate(node):
        if i != first:
            items.append(value)
        elif rest:
            items.append(_replaced(value, tuple(rest), new))
        else:
            items += [v for _, v in new]
    return items


def _changes(path: Path, node: Any, whole: Any) -> Iterator[tuple[str, str, Any]]:
    key = path[-1]
    if isinstance(key, str):
        for other in _misspelt(key):
            yield "key misspelt", f"`{key}` -> `{other}`", _replaced(whole, path, [(other, node)])
    if isinstance(node, str):
        for other in _misspelt(node):
            shown = f"`{node[:30]}` -> `{other[:30]}`"
            yield "name misspelt", shown, _replaced(whole, path, [(key, other)])
    yield "deleted", "it is gone", _replaced(whole, path, [])
    yield "duplicated", "it is there twice", _replaced(whole, path, [(key, node), (key, node)])
    for other in _other_types(node):
        yield "wrong type", f"`{_value(other)}`", _replaced(whole, path, [(key, other)])


def _misspelt(name: str) -> Iterator[str]:
    yield name + ADDED
    yield name[:-1]
    if name.swapcase() != name:
        yield name.swapcase()


def _other_types(node: Any) -> Iterator[Any]:
    if not isinstance(node, str):
        yield "text"
    if not isinstance(node, int | float) or isinstance(node, bool):
        yield 3
    else:
        yield math.nan
    if not isinstance(node, bool):
        yield True
    if not isinstance(node, list):
        yield [node]
    if not isinstance(node, Table):
        yield Table((("key", node),))


# --- as text ---------------------------------------------------------------------------------------


def written(whole: Table) -> str:
    """The file: a line for each key of the outermost table."""
    return "".join(f"{_key(k)} = {_value(v)}\n" for k, v in whole.pairs)


def _key(key: str) -> str:
    return json.dumps(key, ensure_ascii=False)


def _value(value: Any) -> str:
    match value:
        case Table(pairs):
            return "{ " + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in pairs) + " }"
        case list():
            return "[" + ", ".join(map(_value, value)) + "]"
        case bool():
            return "true" if value else "false"
        case str():
            return json.dumps(value, ensure_ascii=False)
        case _:
            return repr(value)
