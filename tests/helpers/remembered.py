"""Answers that depend on nothing but files and versions, kept from one run of the tests to the next, as objects are.

    found = remembered("misra", [*files, cppcheck.__version__], lambda: look())      # look() gives what JSON can say

What is asked is told apart by the contents of all files and by all texts that are given. Where nothing is kept from one
run to the next, as in `.ci/run`, it is looked at each time (`helpers.remembering_cc`).
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from helpers.remembering_cc import KEPT

SUFFIX = ".answer"


def remembered(name: str, parts: Iterable[Path | str], look: Callable[[], Any]) -> Any:
    """What `look` gives, or gave.

    Args:
        name: of the question.
        parts: all that the answer depends on: files, by their contents and names, and texts.
        look: finds the answer. What it raises is not kept.
    """
    kept = os.environ.get(KEPT)
    if not kept:
        return look()
    digest = hashlib.sha256(f"{name}\0{sys.version}".encode())
    for part in parts:
        data = part.read_bytes() if isinstance(part, Path) else part.encode()
        label = part.name if isinstance(part, Path) else ""
        digest.update(f"\0{label}\0{len(data)}\0".encode())
        digest.update(data)
    answer = Path(kept) / f"{name}-{digest.hexdigest()}{SUFFIX}"
    if answer.exists():
        answer.touch()
        return json.loads(answer.read_text(encoding="utf-8"))
    found = look()
    part_of = answer.with_suffix(f".{os.getpid()}")
    part_of.write_text(json.dumps(found), encoding="utf-8")
    part_of.replace(answer)
    return found
