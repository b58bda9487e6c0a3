"""`pn2code convert` from the command line."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from helpers.netbuilder import flat, write
from helpers.pnml_nets import load, philosophers, size
from helpers.processes import pn2code
from pn2code.diagnostics import Diagnostics
from pn2code.unfold.unfold import unfold


def convert(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    return pn2code("convert", *arguments)


def test_formats(tmp_path: Path) -> None:
    net = tmp_path / "phil.pnml"
    net.write_text(philosophers(3), encoding="utf-8")
    for name, options in (("a.cpn", ()), ("b.pnml", ()), ("c.pnml", ("--unfold",))):
        done = convert(net, "-o", tmp_path / name, *options)
        assert done.returncode == 0 and not done.stderr, done.stderr
        assert size(load(tmp_path / name)) == (14, 27)
    done = convert(net, "-o", tmp_path / "d.pml")
    assert done.returncode == 0, done.stderr
    assert ":: d_step" in (tmp_path / "d.pml").read_text(encoding="utf-8")


def test_what_cannot_be_written_leaves_nothing(tmp_path: Path) -> None:
    net = write(
        """
        net N
          standard
          var s: STRING;
          page Top
            place P : STRING = 1`"a"
            trans T
              in P : s
        """,
        tmp_path / "n.cpn",
    )
    for name, code in (
        ("x.pnml", "unsupported-in-pnml"),
        ("x.cpn", "unsupported-in-cpn"),
        ("x.txt", "convert-format"),
    ):
        done = convert(net, "-o", tmp_path / name, "--format", "concise")
        assert done.returncode == 1, name
        assert f"[{code}]" in done.stderr
        assert not (tmp_path / name).exists()
    assert convert(net, "-o", tmp_path / "x.pnml", "--unfold").returncode == 0
    done = convert(net, "-o", tmp_path / "none" / "x.pnml", "--unfold")
    assert done.returncode == 2 and "cannot write" in done.stderr


def test_whole_numbers_without_bounds_are_no_sort_of_symmetric_nets(tmp_path: Path) -> None:
    """Neither among tokens nor in what is added to a variable."""
    net = write(
        """
        net N
          standard
          var n, k: INT;
          page Top
            place P : INT = 1`1 ++ 1`2 ++ 1`3
            place Q : INT
            trans T guard [n + 1 < k]
              in P : n
              in Q : k
        """,
        tmp_path / "n.cpn",
    )
    done = convert(net, "-o", tmp_path / "x.pnml", "--format", "concise")
    assert done.returncode == 1
    assert "unsupported-in-pnml" in done.stderr and "internal error" not in done.stderr


MANY = """
net Many
  standard
  colset C = int with 0..400;
  var a, b: C
  place X : C = 1`0
  place Y : C = 1`0
  place Both : C
  trans Up guard [a < 400]
    in X : a
    out X : a + 1
  trans Side guard [a < 400]
    in Y : a
    out Y : a + 1
  trans Meet
    in X : a
    in Y : b
    out Both : a
"""


def test_unfolding_has_a_limit_of_time(tmp_path: Path) -> None:
    """401 times 401 bindings take longer than no time at all; nothing is written then, and it says so."""
    net = write(MANY, tmp_path / "many.cpn")
    out = tmp_path / "many.pnml"
    done = pn2code("convert", net, "--unfold", "-o", out, "--max-seconds", "0.000001")
    assert done.returncode == 3
    assert "warning[time-over]: the time was up before the net was converted" in done.stderr
    assert f"`{out}` was not written" in " ".join(done.stderr.split())
    assert not out.exists()


def test_unfolding_says_how_far_it_is(tmp_path: Path) -> None:
    said: list[tuple[int, int]] = []
    u = unfold(flat(MANY.replace("400", "9")), Diagnostics(), progress=lambda *n: said.append(n))
    assert u is not None
    assert said == sorted(said) and len(u.places) - 1 <= said[-1][0] <= len(u.places)
    assert 0 < said[-1][1] <= len(u.transitions)


@pytest.mark.parametrize(
    ("verb", "option", "more"),
    [
        ("convert", "-o", ("--unfold",)),
        ("verify", "--report", ()),
        ("verify", "--draw", ()),
        ("verify", "--plot", ()),
    ],
)
def test_files_that_cannot_be_written_are_refused_first(
    tmp_path: Path, verb: str, option: str, more: tuple[str, ...]
) -> None:
    """Before anything is explored or unfolded, which this net would take long for."""
    net = write(MANY.replace("400", "5000"), tmp_path / "many.cpn")
    for name in ("nowhere/net", "folder"):
        ending = {"-o": ".pnml", "--report": ".html"}.get(option, ".svg")
        path = tmp_path / f"{name}{ending}"
        if name == "folder":
            path.mkdir()
        done = pn2code(verb, net, option, path, *more)
        assert done.returncode == 2
        assert "cannot write" in done.stderr


def test_who_converts_the_net_of_a_cell_is_told_which_net_the_cell_has(tmp_path: Path) -> None:
    """So that changes of the new file are not without effect, unseen."""
    assert pn2code("init", tmp_path / "cell", "--template", "empty").returncode == 0
    cell = tmp_path / "cell"
    done = convert(cell / "cell.cpn", "-o", cell / "cell.cpnt")
    assert done.returncode == 0
    assert "the net of the cell is still `cell.cpn`" in done.stdout
    assert 'write `file = "cell.cpnt"` under [net]' in done.stdout
    toml = cell / "cell.toml"
    toml.write_text(toml.read_text().replace('file = "cell.cpn"', 'file = "cell.cpnt"'))
    done = convert(cell, "-o", cell / "cell.cpnt")
    assert done.returncode == 0 and not done.stdout
    (cell / "cell.cpnt").rename(cell / "other.cpnt")
    done = pn2code("check", cell)
    assert done.returncode != 0 and "which has `cell.cpn`, `other.cpnt`" in done.stderr
