"""A page that comes from a local server and speaks with it: one HTML file, and its content security policy.

    found = served("philosophers: play", data, hosts, skeleton="play.html", main="play.js", styles=("page.css",))
    found.html, found.policy

What a net says is JSON in which `<`, `>` and `&` are escaped, and becomes texts, never markup; the content security
policy names the hashes of the only scripts and the only style, and the only host that may be asked.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from pn2code.base import resources
from pn2code.base.frozen import frozen
from pn2code.drawing.text import escape
from pn2code.replay.bundle import bundle, modules
from pn2code.replay.page import embedded, hashed, unified

_MARK = re.compile(r"\{\{(\w+)\}\}")


@frozen
class Served:
    """The file, and its content security policy."""

    html: str
    policy: str


def served(
    title: str,
    data: Any,
    hosts: tuple[str, ...],
    *,
    skeleton: str,
    main: str,
    styles: tuple[str, ...],
    libraries: Sequence[str] = (),
) -> Served:
    """The page.

    Args:
        title: of the window.
        data: what the page knows from the beginning.
        hosts: the names of the server, with the port.
        skeleton: its HTML.
        main: its main module.
        styles: its style sheets.
        libraries: scripts that come before.
    """
    folder = resources.templates_folder() / "web"
    scripts = [*(unified(text) for text in libraries), bundle(modules(folder), main)]
    for script in scripts:
        if re.search(r"</script|<!--", script, re.IGNORECASE):
            raise ValueError("a script of the page contains what would end it")
    style = unified("\n".join((folder / n).read_text(encoding="utf-8") for n in styles))
    sockets = " ".join(f"ws://{host}" for host in hosts)
    hashes = " ".join(hashed(script) for script in scripts)
    images = "data: blob:" if libraries else "data:"
    policy = (
        f"default-src 'none'; script-src {hashes}; style-src {hashed(style)}; img-src {images}; "
        f"connect-src 'self' {sockets}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
    values = {
        "title": escape(title),
        "style": style,
        "data": embedded(data),
        "scripts": "\n".join(f"<script>{script}</script>" for script in scripts),
    }
    text = (folder / skeleton).read_text(encoding="utf-8")
    return Served(_MARK.sub(lambda found: values[found[1]], text), policy)
