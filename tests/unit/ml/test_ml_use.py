"""`use "file"`: declarations from files beside the net."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from helpers.ml import shown, source
from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics
from pn2code.ml.elaborate import Elaborator
from pn2code.ml.typing.used_files import MAX_BYTES, MAX_NESTING
from pn2code.net.front import load


def messages(folder: Path | None, *texts: str) -> list[str]:
    d = Diagnostics()
    e = Elaborator(d, folder=folder)
    for text in texts:
        e.declarations(source(text))
    e.program()
    return [shown(x) for x in d]


def test_names_of_a_file_are_known_after_it(tmp_path: Path) -> None:
    (tmp_path / "a.sml").write_text("val one = 1\nfun twice x = 2 * x;\ninfix 5 plus;")
    text = 'val z = 0; use "a.sml"; fun a plus b = a + b; val two = twice one plus z'
    assert messages(tmp_path, text) == []


def test_the_name_may_be_computed_from_constants(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "a.sml").write_text("val one = 1")
    text = 'val base = "lib/"\nval _ = use (base ^ "a.sml")\nval two = one + 1'
    assert messages(tmp_path, text) == []
    assert messages(tmp_path, 'use (Int.toString (size [1]) ^ "a")') == [
        "used-file | the name of this file is not a constant that can be computed here"
        ' | Int.toString (size [1]) ^ "a"'
    ]
    assert messages(tmp_path, "use 3") == [
        "type-mismatch | name of a file is `int`, but `string` is expected | 3"
    ]


def test_files_use_files_relative_to_the_net(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "a.sml").write_text('use "lib/b.sml"; val two = one + 1')
    (tmp_path / "lib" / "b.sml").write_text("val one = 1")
    assert messages(tmp_path, 'use "lib\\\\a.sml"', "val three = two + one") == []


def test_errors_have_the_place_in_the_file(tmp_path: Path) -> None:
    path = tmp_path / "a.sml"
    path.write_text("val one = 1\nval two = one ^ 1\nval three = one + 2")
    d = Diagnostics()
    e = Elaborator(d, folder=tmp_path)
    e.use(source('"a.sml"'))
    e.declarations(source("val x = two + three"))
    (item,) = d.items
    assert item.origin.location() == f"{path}:2:11"
    assert item.code == "type-mismatch"


def test_files_that_cannot_be_used(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "large.sml").write_bytes(b" " * (MAX_BYTES + 1))
    (tmp_path / "a.sml").write_text('use "b.sml"; val one = 1')
    (tmp_path / "b.sml").write_text('use "a.sml"')
    os.mkfifo(tmp_path / "pipe")
    for name, message in (
        ("missing.sml", "there is no file `missing.sml`"),
        ("folder", "`folder` is not a file"),
        ("pipe", "`pipe` is not a file"),
        ("large.sml", "the file `large.sml` is too large"),
        ("a.sml", "the file `a.sml` uses itself"),
        ("x\\000y", "the file `x\0y` cannot be used here"),
        ("n" * 300, f"the file `{'n' * 77}...` cannot be read: file name too long"),
    ):
        found = messages(tmp_path, f'use "{name}"')
        assert [x.split(" | ")[:2] for x in found] == [["used-file", message]], name
    assert messages(None, 'use "a.sml"')[0].startswith(
        "used-file | the file `a.sml` cannot be used"
    )


def test_many_files(tmp_path: Path) -> None:
    """Each file uses the next twice: two to the power of their number, if nothing ended it."""
    for i in range(40):
        (tmp_path / f"f{i}.sml").write_text(f'use "f{i + 1}.sml"; use "f{i + 1}.sml"')
    (tmp_path / "f40.sml").write_text("val one = 1")
    assert "is one file too many" in messages(tmp_path, 'use "f0.sml"')[0]
    assert messages(tmp_path, f'use "f{41 - MAX_NESTING}.sml"')


def test_a_use_of_ones_own_is_none(tmp_path: Path) -> None:
    assert messages(tmp_path, 'fun use s = s ^ "!"; val x = use "missing.sml"') == []


@pytest.mark.parametrize("present", [True, False])
def test_a_net_uses_a_file(tmp_path: Path, present: bool) -> None:
    net = 'net N\n  standard\n  use "f.sml"\n  place A : INT = 1`(twice 2)'
    (tmp_path / "net.cpn").write_bytes(cpn(net))
    if present:
        (tmp_path / "f.sml").write_text("fun twice x = 2 * x")
    d = Diagnostics()
    loaded = load(tmp_path / "net.cpn", d)
    assert (loaded is not None) is present
    expected = [] if present else ["used-file", "unbound-identifier"]
    assert [x.code for x in d] == expected
