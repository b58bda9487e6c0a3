"""JSON as pages get it: as short as it can be, and with nothing in it that cannot be written in UTF-8."""

from __future__ import annotations

import json
from typing import Any


def page_json(data: Any) -> str:
    """The text of data; for a half of a surrogate pair, which nobody can write, there is a question mark."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return text.encode("utf-8", "replace").decode("utf-8")
