"""The live page: the modules of the replay page, fed by the server that it comes from."""

from __future__ import annotations

import pn2code
from pn2code.live.described import Json
from pn2code.replay import three
from pn2code.replay.served import Served, served


def page(
    described: Json, hosts: tuple[str, ...], library: three.Three | str | None = None
) -> Served:
    """The page.

    Args:
        described: see `described`.
        hosts: the names of the server, with the port.
        library: what draws the arms, or why it is not there; None: it is looked for.
    """
    if library is None:
        library = three.find()
    needs_arms = bool(described["cell"])
    data = {
        "runs": [described],
        "differences": None,
        "names": [],
        "generator": f"pn2code {pn2code.__version__}",
        "missing": library if needs_arms and isinstance(library, str) else "",
    }
    libraries = [library.text] if needs_arms and isinstance(library, three.Three) else []
    return served(
        f"{described['title']}: live",
        data,
        hosts,
        skeleton="live.html",
        main="live.js",
        styles=("page.css", "live.css"),
        libraries=libraries,
    )
