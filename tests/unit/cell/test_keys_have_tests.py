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


# `key = ..` of a file (also after `\n` within a string), "key" of data, and the table's name in [robots.arm.tcps.grip].
USES = (r"(?:\\n|\b)(\w+)\s*=", r"[\"'](\w+)[\"']", r"\[([\w.]+)\]")


def used() -> set[str]:
    """All words that a test uses as the name of a key."""
    found: set[str] = set()
    for file in sorted(TESTS.rglob("*.py")):
        if file.name not in GENERIC:
            text = file.read_text(encoding="utf-8")
            found.update(
                word for use in USES for names in re.findall(use, text) for word in names.split(".")
            )
    return found


def test_each_key_of_the_schema_is_in_a_test() -> None:
    words = used()
    keys = [(section.title, key.name) for section in listing.sections() for key in section.keys]
    assert len(keys) > 100
    assert [f"{where} {key}" for where, key in keys if not key.isupper() and key not in words] == []
