"""How far an exploration is, in words for whoever listens to a command.

options = ExploreOptions(progress=telling(say, "exploring"))   # "exploring: 1,200 states, 310 a second, 20 waiting"
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from pn2code.base.how_far import Say


def telling(say: Say, what: str) -> Callable[[Mapping[str, Any]], None]:
    """Hears what an explorer says of its progress.

    Args:
        say: is told in words.
        what: is being done.
    """

    def tell(said: Mapping[str, Any]) -> None:
        states, waiting = said.get("states", 0), said.get("frontier", 0)
        if said.get("phase", "explore") != "explore" or not states:
            return
        rate = f", {said['rate']:,.0f} a second" if said.get("rate") else ""
        say(f"{what}: {states:,} states{rate}, {waiting:,} of them waiting")

    return tell
