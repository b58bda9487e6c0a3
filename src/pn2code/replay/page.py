"""The replay page: one HTML file with everything in it, that opens without a server or a network.

    page(described)                       # of one run
    page(described, other)                # two runs, side by side

Nothing in a description becomes code: it travels as JSON in which `<`, `>` and `&` are escaped, the page writes texts
as texts, and its content security policy names the hashes of the only scripts and the only style that may be used.
"""

from __future__ import annotations

import base64
import hashlib
import re
from typing import Any

import pn2code
from pn2code.base import resources
from pn2code.base.page_json import page_json
from pn2code.drawing.text import escape
from pn2code.replay import three
from pn2code.replay.bundle import bundle, modules
from pn2code.replay.description import Json
from pn2code.replay.differences import differences

NAME = "replay.html"
_MARK = re.compile(r"\{\{(\w+)\}\}")


def page(
    described: Json,
    other: Json | None = None,
    library: three.Three | str | None = None,
    names: tuple[str, str] = ("first run", "second run"),
) -> str:
    """The HTML file.

    Args:
        described: the run; other: a second one to compare it with.
        library: what draws the arms, or why it is not there; None: it is looked for.
        names: what two runs are called beside each other.
    """
    folder = resources.templates_folder() / "web"
    if library is None:
        library = three.find()
    needs_arms = any(d is not None and d.get("cell") for d in (described, other))
    scripts = []
    if needs_arms and isinstance(library, three.Three):
        scripts.append(unified(library.text))
    scripts.append(bundle(modules(folder), "main.js"))
    style = unified((folder / "page.css").read_text(encoding="utf-8"))
    data: dict[str, Any] = {
        "runs": [described] if other is None else [described, other],
        "differences": differences(described, other) if other is not None else None,
        "names": list(names) if other is not None else [],
        "generator": f"pn2code {pn2code.__version__}",
        "missing": library if needs_arms and isinstance(library, str) else "",
    }
    for script in scripts:
        if re.search(r"</script|<!--", script, re.IGNORECASE):
            raise ValueError("a script of the page contains what would end it")
    values = {
        "title": escape(f"{described['title']}: {'replay' if other is None else 'two runs'}"),
        "policy": _policy(scripts, style),
        "style": style,
        "data": embedded(data),
        "scripts": "\n".join(f"<script>{script}</script>" for script in scripts),
    }
    skeleton = (folder / "page.html").read_text(encoding="utf-8")
    return _MARK.sub(lambda found: values[found[1]], skeleton)


def embedded(data: Any) -> str:
    """JSON that is safe inside a `script` element: nothing in it can end the element or begin a comment."""
    text = page_json(data)
    for character in "<>&\u2028\u2029":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return text


def _policy(scripts: list[str], style: str) -> str:
    hashes = " ".join(hashed(script) for script in scripts)
    return (
        f"default-src 'none'; script-src {hashes}; style-src {hashed(style)}; img-src data: blob:; "
        "base-uri 'none'; form-action 'none'"
    )


def hashed(text: str) -> str:
    """A script or a style in a content security policy."""
    digest = hashlib.sha256(text.encode("utf-8")).digest()
    return f"'sha256-{base64.b64encode(digest).decode('ascii')}'"


def unified(text: str) -> str:
    """Line ends as a browser counts them when it checks a hash."""
    return text.replace("\r\n", "\n").replace("\r", "\n")
