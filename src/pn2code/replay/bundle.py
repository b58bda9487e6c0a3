"""Many ES modules as one script: what the page needs of a bundler, and no more.

    bundle({"main.js": 'import { f } from "./f.js";\\nf();\\n', "f.js": "export function f() {}\\n"}, "main.js")

Each module becomes a function that is called once, after those that it imports. The forms that may be used are
`import { a, b } from "./x.js";` and `export` before a function, class or constant, each at the beginning of a line; all
else is refused, so that a mistake shows when the page is written and not when it is opened.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

_IMPORT = re.compile(r'^import \{([\w\s,]+)\} from "\./([\w/-]+\.js)";$', re.MULTILINE)
_EXPORT = re.compile(r"^export (?=(?:async )?(?:function|class|const) (\w+))", re.MULTILINE)
_NAME = re.compile(r"^export (?:async )?(?:function|class|const) (\w+)", re.MULTILINE)
_OTHER = re.compile(r"^\s*(import|export)\b(?!\()", re.MULTILINE)


class BadModule(Exception):
    """A module uses a form that is not known here, or imports what is not there: a mistake in pn2code."""


def modules(folder: Path) -> dict[str, str]:
    """The modules of a folder, by name."""
    return {p.name: p.read_text(encoding="utf-8") for p in sorted(folder.glob("*.js"))}


def bundle(sources: Mapping[str, str], main: str) -> str:
    """One script with everything that the main module needs.

    Raises:
        BadModule: a module cannot be taken.
    """
    rows = ['"use strict";', "{", "const modules = {};"]
    for name in _order(sources, main):
        rows.append(_wrapped(name, sources[name], sources))
    return "\n".join([*rows, "}", ""])


def _order(sources: Mapping[str, str], main: str) -> list[str]:
    """The modules that are needed, each after those that it imports."""
    order: list[str] = []
    open_: list[str] = []

    def visit(name: str) -> None:
        if name in order:
            return
        if name in open_:
            raise BadModule(f"modules need themselves: {' -> '.join([*open_, name])}")
        if name not in sources:
            raise BadModule(
                f"{open_[-1] if open_ else 'the page'} imports {name}, which is not there"
            )
        open_.append(name)
        for found in _IMPORT.finditer(sources[name]):
            visit(found[2])
        open_.pop()
        order.append(name)

    visit(main)
    return order


def _wrapped(name: str, text: str, sources: Mapping[str, str]) -> str:
    def imported(found: re.Match[str]) -> str:
        names = [n.strip() for n in found[1].split(",") if n.strip()]
        missing = set(names) - set(_NAME.findall(sources[found[2]]))
        if missing:
            raise BadModule(
                f"{name} imports {sorted(missing)[0]}, which {found[2]} does not export"
            )
        return f'const {{ {", ".join(names)} }} = modules["{found[2]}"];'

    exported = _NAME.findall(text)
    body = _EXPORT.sub("", _IMPORT.sub(imported, text))
    if other := _OTHER.search(body):
        line = body.count("\n", 0, other.end()) + 1
        raise BadModule(f"{name}:{line}: this form of `{other[1]}` cannot be bundled")
    result = f"return {{ {', '.join(exported)} }};"
    return f'modules["{name}"] = (() => {{\n{body}{result}\n}})();'
