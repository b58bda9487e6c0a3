"""What a folder means that has no `cell.toml`."""

from __future__ import annotations

from pathlib import Path

import pytest

from pn2code.cell.locate import locate
from pn2code.diagnostics import Diagnostics


def test_a_folder_with_one_net_is_that_net(tmp_path: Path) -> None:
    net = tmp_path / "only.pnml"
    net.write_text("")
    (tmp_path / "notes.txt").write_text("")
    d = Diagnostics()
    assert locate(tmp_path, d) == (net, None)
    assert not list(d)


@pytest.mark.parametrize(
    ("names", "said", "hint"),
    [
        ((), "no net in the folder", "a folder with a cell.toml"),
        (("a.cpn", "b.cpn"), "2 nets in the folder", "`a.cpn`, `b.cpn`"),
    ],
)
def test_any_other_folder_is_an_error(
    tmp_path: Path, names: tuple[str, ...], said: str, hint: str
) -> None:
    for name in names:
        (tmp_path / name).write_text("")
    d = Diagnostics()
    assert locate(tmp_path, d) is None
    (error,) = d.errors
    assert said in error.message and "cell.toml" in error.message
    assert hint in (error.hint or "")
