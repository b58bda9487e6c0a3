"""cell.toml: what is read, and what each mistake says."""

from __future__ import annotations

from pathlib import Path

import pytest

from pn2code.cell.config import CellConfig
from pn2code.cell.load import load, ml_literal
from pn2code.cell.partition import ChannelKind
from pn2code.diagnostics import Diagnostics

GOOD = """
[net]
file = "cell.cpn"

[supervisor]
instance = "Supervisor"
final = ["Finished"]

[[channel]]
place = "data1"
file = "data1.txt"
kind = "data"

[[channel]]
place = "flag1"
file = "flag1.txt"

[primitives]
go = { command = "move_joint" }
push = { command = "tool", action = "push", duration_s = 1.5 }

[robots.r1]
instance = "Robot1"
base = { x = 1.0 }

[report]
rows = ["data1"]
count = { pushes = "push" }

[layouts.near]
description = "close by"

[layouts.far]
robots.r1.base = { x = 9.0 }
"""


DEVICES = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
[devices.feeder]
instance = "Feeder"
"""


def read(
    tmp_path: Path, text: str, layout: str | None = None
) -> tuple[CellConfig | None, Diagnostics]:
    (tmp_path / "cell.toml").write_text(text, encoding="utf-8")
    d = Diagnostics()
    return load(tmp_path, d, layout=layout), d


def test_good_file(tmp_path: Path) -> None:
    config, d = read(tmp_path, GOOD)
    assert not d.items
    assert config is not None
    assert [(c.place, c.kind) for c in config.channels] == [
        ("data1", ChannelKind.DATA),
        ("flag1", ChannelKind.FLAG),
    ]
    assert config.primitives["push"].duration_s == 1.5
    assert config.layout == "near"
    assert config.geometry["robots"]["r1"]["base"] == {"x": 1.0}
    assert config.net_path == tmp_path / "cell.cpn"


def test_layout_replaces_geometry_but_not_the_programs(tmp_path: Path) -> None:
    near, _ = read(tmp_path, GOOD)
    far, d = read(tmp_path, GOOD, layout="far")
    assert not d.items
    assert near is not None and far is not None
    assert far.geometry["robots"]["r1"]["base"] == {"x": 9.0}
    assert near.logic_digest() == far.logic_digest()


def test_logic_digest_changes_with_logic(tmp_path: Path) -> None:
    one, _ = read(tmp_path, GOOD)
    other, _ = read(tmp_path, GOOD.replace('command = "move_joint"', 'command = "move_linear"'))
    assert one is not None and other is not None
    assert one.logic_digest() != other.logic_digest()


def test_a_cell_of_devices_alone(tmp_path: Path) -> None:
    config, d = read(tmp_path, DEVICES)
    assert config is not None and not d.items
    assert [p.name for p in config.programs] == ["feeder"]
    assert len(config.logic_digest()) == 64


@pytest.mark.parametrize(
    ("old", "new", "code", "line", "words"),
    [
        ("[net]", "[net", "cell-file", 2, "not a TOML file"),
        ('final = ["Finished"]', "reply_timout_s = 3", "cell-key", 7, "unknown key `reply_timout_s`"),
        ('final = ["Finished"]', "reply_timeout_s = -1", "cell-value", 7, "must be above zero"),
        ('instance = "Supervisor"', "", "cell-key", 5, "`supervisor.instance` is missing"),
        ('file = "data1.txt"', 'file = "a/b.txt"', "cell-value", 11, "not a plain file name"),
        ('file = "data1.txt"', 'file = "flag1.txt"', "cell-value", 16, "used by two channels"),
        ('kind = "data"', 'kind = "date"', "cell-value", 12, "`data` or `flag`"),
        ('"move_joint"', '"move_jont"', "cell-value", 19, "unknown robot command `move_jont`"),
        (', duration_s = 1.5', "", "cell-key", 20, "`primitives.push.duration_s` is missing"),
        ('instance = "Robot1"', "instance = 3", "cell-value", 23, "`instance` is `3`"),
        ('rows = ["data1"]', 'rows = ["data2"]', "cell-value", 27, "which is not a channel"),
        ('pushes = "push"', 'pushes = "pull"', "cell-value", 28, "not a tool action"),
        ("robots.r1.base = { x = 9.0 }", "speed = 1", "cell-key", 34, "unknown key `speed`"),
    ],
)  # fmt: skip
def test_mistakes(tmp_path: Path, old: str, new: str, code: str, line: int, words: str) -> None:
    text = GOOD.replace(old, new, 1)
    config, d = read(tmp_path, text)
    assert config is None
    found = [e for e in d.errors if e.code == code and words in e.message]
    assert found, [(e.code, e.message) for e in d.errors]
    assert found[0].origin.line == line


def test_unknown_layout_suggests(tmp_path: Path) -> None:
    config, d = read(tmp_path, GOOD, layout="fra")
    assert config is None
    assert d.errors[0].code == "cell-unknown-layout"
    assert "`far`" in d.errors[0].hint


def test_missing_file(tmp_path: Path) -> None:
    d = Diagnostics()
    assert load(tmp_path / "nowhere" / "cell.toml", d) is None
    assert d.errors[0].code == "file-missing"
    assert "there is no file" in d.errors[0].message
    assert "cell.toml" in d.errors[0].hint


@pytest.mark.parametrize(
    ("value", "text"),
    [(True, "true"), (-3, "~3"), (1.5, "1.5"), (-1e-9, "~1e~09"), ('a"b\\', '"a\\"b\\\\"')],
)
def test_ml_literals(value: object, text: str) -> None:
    assert ml_literal(value) == text


def test_positions_are_those_of_keys_not_of_what_looks_like_them_in_texts(tmp_path: Path) -> None:
    text = """
[[property]]
name = "empty"
holds = '''always {
  [] <> Mark.Cell'Buffer 1
[supervisor]
}'''

[capacity]
"Hold #1" = 0
'Tray.a' = 0 # a = 1
"""
    _, d = read(tmp_path, GOOD + text)
    start = GOOD.count("\n")
    assert [(e.origin.line - start, e.message.partition(" is ")[0]) for e in d.sorted()] == [
        (10, "capacity of `Hold #1`"),
        (11, "capacity of `Tray.a`"),
    ]


def test_axes_of_two_robots_may_have_one_name(tmp_path: Path) -> None:
    """A track of one and a turntable of another; each primitive says which it means."""
    text = GOOD.replace(
        "[robots.r1]",
        'ride = { command = "move_external", track = "own" }\n'
        'turn = { command = "move_external", turntable = "own" }\n[robots.r1]',
    )
    text += """
[robots.r1.axes.own]
from = 0.0
to = 1.0
[robots.r2]
instance = "Robot2"
[robots.r2.axes.own]
kind = "turntable"
from = -90.0
to = 90.0
"""
    config, d = read(tmp_path, text)
    assert config is not None, d
    assert config.primitives["ride"].along == (("own", True),)
    assert config.primitives["turn"].along == (("own", False),)
    assert config.external_axes("r2") == {"own": "turntable"}
