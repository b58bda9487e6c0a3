"""Reading JSON that strangers wrote."""

from __future__ import annotations

import json
import sys
from typing import Any

_DEPTH = 2_000
"""Python's JSON reader uses the C stack; the command's own recursion limit is too high for it."""


class BadJson(ValueError):  # noqa: N818
    """A text is no JSON; the message says why."""


def parse_json(text: str) -> Any:
    """The value of a JSON text.

    Raises:
        BadJson: it is none, or too deeply nested.
    """
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(min(limit, _DEPTH))
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        raise BadJson(str(error)) from None
    except RecursionError:
        raise BadJson("it is nested too deeply") from None
    finally:
        sys.setrecursionlimit(limit)
