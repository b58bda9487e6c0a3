"""What is wrong with a value of a colour set, in the words of CPN Tools (`illegal_msg`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pn2code.ml.core.colsets import Colset, Kind
from pn2code.semantics.library.builtins_text import escaped
from pn2code.semantics.values.data import int_text

if TYPE_CHECKING:
    from pn2code.semantics.values.colours import Colours


def illegal(colours: Colours, c: Colset, value: Any) -> str:
    """The message about a value that is not legal."""
    base = c.components[0] if c.components else None
    text = colours.text(c, value)
    match c.kind:
        case Kind.ALIAS if base is not None:
            return colours.illegal_message(base, value)
        case Kind.SUBSET if base is not None:
            found = colours.illegal_message(base, value)
            return found or f"Illegal color: {text} is not in subset color set."
        case Kind.INDEX:
            number = int_text(value.argument)
            return f"Illegal color: {text}, index {number} not in range {range_text(colours, c)}."
        case Kind.PRODUCT | Kind.RECORD:
            return f"Illegal component in color: {text}"
        case Kind.UNION:
            return f"Illegal union color: {text}."
        case Kind.STRING:
            return f"Illegal color: {text}." + _wrong_string(c, value)
        case Kind.LIST if base is not None:
            return "Illegal color." + _wrong_list(colours, c, base, value)
        case _:
            return f" Illegal color: {text} not in range {range_text(colours, c)}."


def range_text(colours: Colours, c: Colset) -> str:
    """The bounds of a colour set of numbers: `(~2)..2`."""
    bounds: tuple[Any, Any] = c.low, c.high
    if c.kind is Kind.INDEX:
        return "..".join(map(int_text, bounds))
    return "..".join(colours.text(c, x) for x in bounds)


def _wrong_string(c: Colset, value: str) -> str:
    found = ""
    low, high = c.low, c.high
    if isinstance(low, str) and isinstance(high, str):
        wrong = [x for x in value if not low <= x <= high]
        if wrong:
            letters = ",".join(f'"{escaped(x)}"' for x in wrong)
            found += f' Range "{low}".."{high}" does not contain [{letters}].'
    if c.length is not None and not c.length[0] <= len(value) <= c.length[1]:
        first, last = c.length
        found += f" String length {len(value)} is out of range {first}..{last}."
    return found


def _wrong_list(colours: Colours, c: Colset, part: Colset, value: Any) -> str:
    found = ""
    wrong = [colours.text(part, x) for x in value if not colours.legal(part, x)]
    if wrong:
        found += f" Illegal values in list: {','.join(wrong)}."
    low: Any = c.low
    high: Any = c.high
    if low is not None and not low <= len(value) <= high:
        found += f" List length of {len(value)} out of range {low}..{high}."
    return found
