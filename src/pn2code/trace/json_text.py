"""Reading JSON that strangers wrote."""

from __future__ import annotations

import json
import re
import sys
from typing import Any

_DEPTH = 2_000
"""Python's JSON reader uses the C stack; the command's own recursion limit is too high for it."""


_STRING = re.compile(r'"(?:[^"\\]|\\.)*"', re.DOTALL)


class BadJson(ValueError):
    """A text is no JSON; the message says why."""


def parse_json(text: str, *, once: bool = False) -> Any:
    """The value of a JSON text.

    Args:
        text: the text.
        once: whether no object may have a member twice; else the last one counts.

    Raises:
        BadJson: it is none, or too deeply nested.
    """
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(min(limit, _DEPTH))
    try:
        return json.loads(text, object_pairs_hook=_object if once else None)
    except json.JSONDecodeError as error:
        raise BadJson(str(error)) from None
    except RecursionError:
        raise BadJson("it is nested too deeply") from None
    finally:
        sys.setrecursionlimit(limit)


def is_deep(text: str) -> bool:
    """Whether a text has more brackets outside its strings than any small message, and so may be nested very deeply.

    While something is evaluated in another thread, Python's own limit may be more than the C stack permits.
    """
    if text.count("[") + text.count("{") <= _DEPTH:
        return False
    plain = _STRING.sub("", text)
    return plain.count("[") + plain.count("{") > _DEPTH


def _object(members: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(members)
    if len(found) != len(members):
        name = next(n for i, (n, _) in enumerate(members) if n in dict(members[:i]))
        raise BadJson(f"`{name}` is there twice")
    return found
