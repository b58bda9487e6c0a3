"""All sections and keys of cell.toml, for people: as text for a terminal, and as the tables of docs/cell.md.

print(text("supervisor"))       # `pn2code cell --keys --section supervisor`
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from dataclasses import dataclass

from pn2code.cell_file.keys import Key
from pn2code.cell_file.plain import plain
from pn2code.cell_file.whole import FILE, LAYOUT

WIDTH = 100


@dataclass(frozen=True, slots=True)
class Listed:
    """A section as it is written, with what it is for, and its keys."""

    title: str
    meaning: str
    keys: tuple[Key, ...]


def sections() -> Iterator[Listed]:
    """All of them; what is inside a table is a section of its own."""
    for key in FILE:
        if key.inner is LAYOUT:
            names = ", ".join(f"`{k.name}`" for k in LAYOUT if k.inner)
            words = (
                f"{key.meaning} The same keys as in the sections {names}; nothing need be there."
            )
            yield Listed(_title(key), words, (LAYOUT["description"],))
        else:
            yield from _listed(key, _title(key))


def _listed(key: Key, title: str) -> Iterator[Listed]:
    if key.of is not None:
        yield Listed(title, key.meaning, (key.of,))
    elif key.inner is not None:
        yield Listed(title, key.meaning, key.inner.keys)
        for k in key.inner:
            if k.inner is not None and "x" not in k.inner.names():
                shape = "[{title}.{name}]" if k.kind == "table" else "[[{title}.{name}]]"
                below = shape.format(title=title.strip("[]"), name=k.name)
                yield from _listed(k, below)


def _title(key: Key) -> str:
    name = f"{key.name}.{key.entry}" if key.kind == "named" else key.name
    return f"[[{name}]]" if key.kind == "tables" else f"[{name}]"


def kind_of(key: Key) -> str:
    """What the value of a key is, in words."""
    if key.words:
        return " or ".join(f'"{word}"' for word in key.words)
    match key.kind:
        case "numbers":
            count = " or ".join(map(str, key.counts))
            return f"list of {count} numbers" if count else "list of numbers"
        case "table" if key.inner is not None and "x" in key.inner.names():
            return "pose { x, y, z, roll, pitch, yaw }"
        case "tables" if key.inner is not None and "x" in key.inner.names():
            return "list of poses { x, y, z, roll, pitch, yaw }"
    words = {
        "text": "text",
        "whole": "whole number",
        "number": "number",
        "flag": "true or false",
        "scalar": "text, number, true or false",
        "texts": "list of texts",
        "tables": "list of tables",
    }
    return words.get(key.kind, "table") + _bounds(key)


def _bounds(key: Key) -> str:
    low = "" if key.low == float("-inf") else f" {'above' if key.above else 'from'} {key.low:.10g}"
    high = "" if key.high == float("inf") else f" to {key.high:.10g}"
    return low + high


def default_of(key: Key) -> str:
    """Its default as it is written in a file; "required" where it must be there."""
    if key.required is True:
        return "required"
    match key.default:
        case None | "":
            return ""
        case bool():
            return "true" if key.default else "false"
        case str():
            return f'"{key.default}"'
        case tuple():
            return f"[{', '.join(f'{v:g}' for v in map(float, key.default))}]"
        case _:
            return f"{key.default:.10g}"


def _where(section: Listed, key: Key) -> str:
    """The words of the deciding key with which it may be there."""
    return f"with {' or '.join(key.only)}: " if key.only else ""


def text(only: str = "") -> str:
    """The sections whose title contains a text, for a terminal."""
    out = []
    for section in sections():
        if only and only not in section.title:
            continue
        out.append(f"{section.title}\n{_indented(plain(section.meaning), 2)}")
        for key in section.keys:
            unit = f", {key.unit}" if key.unit else ""
            default = default_of(key)
            default = (
                f" ({default})" if default == "required" else f" = {default}" if default else ""
            )
            kind = f"{kind_of(key)}{unit}"
            out.append(f"  {key.name}{default}\n{_indented(kind, 6)}")
            out.append(_indented(_where(section, key) + plain(key.meaning), 6))
        out.append("")
    return "\n".join(out)


def _indented(words: str, by: int) -> str:
    return textwrap.fill(
        words,
        WIDTH,
        initial_indent=" " * by,
        subsequent_indent=" " * by,
        break_long_words=False,
        break_on_hyphens=False,
    )


def markdown() -> str:
    """The tables of docs/cell.md."""
    out = []
    for section in sections():
        out.append(f"### `{section.title}`\n\n{section.meaning}\n")
        out.append("| key | value | default | meaning |\n|---|---|---|---|")
        for key in section.keys:
            unit = f", {key.unit}" if key.unit else ""
            shown = f"`{key.name}`"
            default = default_of(key)
            default = default if default in ("", "required") else f"`{default}`"
            out.append(
                f"| {shown} | {kind_of(key)}{unit} | {default} | {_where(section, key)}{key.meaning} |"
            )
        out.append("")
    return "\n".join(out)
