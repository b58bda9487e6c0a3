"""Each key of cell.toml is in a test besides those of `test_every_key.py`, which look at all of them in the same way.

Those there show that each key is read, and what a wrong value says; what a key does to a cell other tests show. Here
keys of the schema are held against them: a key that is added must be in a test that uses it.
"""

from __future__ import annotations

import re
from pathlib import Path

from pn2code.cell_file import listing

TESTS = Path(__file__).parents[2]
GENERIC = ("test_every_key.py", "full_cell.py", "test_keys_have_tests.py")


def texts() -> str:
    files = [f for f in sorted(TESTS.rglob("*.py")) if f.name not in GENERIC]
    return "\n".join(f.read_text(encoding="utf-8") for f in files)


def test_each_key_of_the_schema_is_in_a_test() -> None:
    everything = texts()
    missing = []
    for section in listing.sections():
        for key in section.keys:
            # `key = ..` of a file, "key" of data, or a part of a table's name, as in [robots.arm.tcps.grip].
            used = (
                rf"(?:\b|\\n){key.name}\b\s*=|[\"']{key.name}[\"']|\[[\w.]*\b{key.name}\b[\w.]*\]"
            )
            if not key.name.isupper() and not re.search(used, everything):
                missing.append(f"{section.title} {key.name}")
    assert missing == []
