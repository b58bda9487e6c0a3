"""The page of `pn2code play`: one HTML file with its scripts, which speaks with the server that it comes from.

found = page(described, port)
found.html, found.policy

What a net says is JSON in which `<`, `>` and `&` are escaped, and becomes texts, never markup; the content security
policy names the hashes of the only script and the only style, and the only host that may be asked.
"""

from __future__ import annotations

import re

from pn2code.base import resources
from pn2code.base.frozen import frozen
from pn2code.drawing.text import escape
from pn2code.play.trouble import Json
from pn2code.replay.bundle import bundle, modules
from pn2code.replay.page import embedded, hashed, unified

_MARK = re.compile(r"\{\{(\w+)\}\}")


@frozen
class Page:
    """The file, and its content security policy."""

    html: str
    policy: str


def page(described: Json, hosts: tuple[str, ...]) -> Page:
    """The page of a net.

    Args:
        described: see `described`.
        hosts: the names of the server, with the port.
    """
    folder = resources.templates_folder() / "web"
    script = bundle(modules(folder), "play.js")
    if re.search(r"</script|<!--", script, re.IGNORECASE):
        raise ValueError("a script of the page contains what would end it")
    names = ("page.css", "play.css")
    style = unified("\n".join((folder / n).read_text(encoding="utf-8") for n in names))
    sockets = " ".join(f"ws://{host}" for host in hosts)
    policy = (
        f"default-src 'none'; script-src {hashed(script)}; style-src {hashed(style)}; img-src data:; "
        f"connect-src 'self' {sockets}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
    values = {
        "title": escape(f"{described['title']}: play"),
        "style": style,
        "data": embedded(described),
        "scripts": f"<script>{script}</script>",
    }
    skeleton = (folder / "play.html").read_text(encoding="utf-8")
    return Page(_MARK.sub(lambda found: values[found[1]], skeleton), policy)
