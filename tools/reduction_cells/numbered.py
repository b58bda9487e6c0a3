"""A cell whose parts are counted by numbers that guards look at, instead of tokens."""

from __future__ import annotations

import re
from random import Random

from tools.reduction_cells.flows import flow
from tools.reduction_cells.shops import shop

_COUNTED = (("Feeder", "h"), ("Done", "g"))
_OUT = re.compile(r" out (\w+) : (?:(\d+)`)?\(\)$")
_IN = re.compile(r" in (\w+) : (?:(\d+)`)?\(\)$")


def counters(r: Random) -> tuple[str, str]:
    """A net and its cell."""
    net, toml = shop(r) if r.random() < 0.5 else flow(r, many=r.random() < 0.5)
    return numbered(net, r), toml


def numbered(text: str, r: Random) -> str:
    """A net with one or two of its places as counters; which have no token of their own any more."""
    for name, n in _COUNTED:
        if r.random() < 0.8 and re.search(rf"\n\s*place {name}( = \d+)?\n", text):
            text = _with_number(text, name, n, is_exact=r.random() < 0.5)
    return text


def _with_number(text: str, name: str, n: str, *, is_exact: bool) -> str:
    text = text.replace("  var n: INT;", f"  var {n}: INT;\n  var n: INT;", 1)
    blocks = re.split(r"(?m)^(?=\s*(?:trans|page|place) )", text)
    return "".join(_block(b, name, n, is_exact=is_exact) for b in blocks)


def _block(block: str, name: str, n: str, *, is_exact: bool) -> str:
    lines = block.split("\n")
    head = lines[0].strip()
    if head.startswith(f"place {name}") and head.split()[1] == name:
        first = head.partition("=")[2].strip() or "0"
        lines[0] = f"    place {name} : INT = 1`{first}"
    if not head.startswith("trans "):
        return "\n".join(lines)
    taken = [i for i, x in enumerate(lines) if (m := _IN.search(x)) and m[1] == name]
    put = [i for i, x in enumerate(lines) if (m := _OUT.search(x)) and m[1] == name]
    for i, x in enumerate(lines):
        if x.strip() == f"inhibit {name}":
            lines[i] = f"      both {name} : 0"
    for i in taken:
        count = _IN.search(lines[i])
        assert count is not None
        much = int(count[2] or 1)
        sign = "=" if is_exact and much > 1 else ">="
        lines[i] = f"      in {name} : {n}\n      out {name} : {n} - {much}"
        asked = f"{n} {sign} {much}"
        lines[0] = (
            lines[0].replace(" guard [", f" guard [{asked}, ")
            if " guard [" in lines[0]
            else f"{lines[0]} guard [{asked}]"
        )
    for i in put:
        count = _OUT.search(lines[i])
        assert count is not None
        lines[i] = f"      in {name} : {n}\n      out {name} : {n} + {int(count[2] or 1)}"
    return "\n".join(lines)
