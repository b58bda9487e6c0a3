"""Random nets whose whole graphs are compared: as they are, and with fuel, which makes every graph finite.

Net number 17 is the same net on every machine.
"""

from __future__ import annotations

import re
from random import Random

from helpers.random_nets import random_net

FUEL = 5
"""Steps that a net with fuel can make, at most."""
WIDTHS = (4, 0, 1, 8, 0)
"""Of the counters of packed places, net by net: 0: no place is packed; 1: most nets turn out to need more."""
_STAMP = re.compile(r"@(\d+)")


def with_fuel(text: str, steps: int = FUEL) -> str:
    """The net, but each occurrence takes a token from a place of which all pages have a part."""
    lines = []
    for line in text.splitlines():
        lines.append(line)
        word = line.split()[0] if line.split() else ""
        if word == "page":
            lines.append(f"    place Fuel fusion Fuel : UNIT = {steps}`()")
        elif word == "trans":
            lines.append(f"{' ' * (len(line) - len(line.lstrip()))}  in Fuel : ()")
    return "\n".join(lines) + "\n"


def with_real_time(text: str) -> str:
    """The net with a real clock: stamps and delays are reals."""
    first, _, rest = text.partition("\n")
    stamped = _STAMP.sub(r"@\1.0", rest)
    return f"{first}\n  option realtimestamp true\n{stamped}"


def numbered(number: int) -> str:
    """The net of a number: three of four have fuel, and one in eight a real clock."""
    text = random_net(Random(number))
    if number % 8 == 5:
        text = with_real_time(text)
    return with_fuel(text, FUEL - number % 3) if number % 4 else text
