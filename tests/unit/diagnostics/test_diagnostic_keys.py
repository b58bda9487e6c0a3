"""Keys of TOML files in words: entries of arrays by their names, else counted from 1."""

from __future__ import annotations

import pytest

from pn2code.diagnostics.keys import in_words

DATA = {
    "channel": [{"place": "target", "file": "t.txt"}, {"kind": "data"}, {"place": 3, "file": "u"}],
    "scene": {"objects": [{"name": "belt"}]},
}


@pytest.mark.parametrize(
    ("path", "words"),
    [
        (("supervisor", "final"), "`supervisor.final`"),
        (("channel", 0, "file"), "`file` of `target` in `channel`"),
        (("channel", 1, "kind"), "`kind` of the 2nd of `channel`"),
        (("channel", 2), "`u` in `channel`"),
        (("channel", 10, "kind"), "`kind` of the 11th of `channel`"),
        (("scene", "objects", 0, "pose", "x"), "`pose.x` of `belt` in `scene.objects`"),
    ],
)
def test_words(path: tuple[str | int, ...], words: str) -> None:
    assert in_words(path, DATA) == words
