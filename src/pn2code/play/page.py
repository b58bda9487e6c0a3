"""The page of `pn2code play`: one HTML file with its scripts, which speaks with the server that it comes from."""

from __future__ import annotations

from pn2code.play.trouble import Json
from pn2code.replay.served import Served, served


def page(described: Json, hosts: tuple[str, ...]) -> Served:
    """The page of a net.

    Args:
        described: see `described`.
        hosts: the names of the server, with the port.
    """
    return served(
        f"{described['title']}: play",
        described,
        hosts,
        skeleton="play.html",
        main="play.js",
        styles=("page.css", "play.css"),
    )
