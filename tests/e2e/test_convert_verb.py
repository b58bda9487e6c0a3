"""`pn2code convert` from the command line."""

from __future__ import annotations

import subprocess
from pathlib import Path

from helpers.netbuilder import write
from helpers.pnml_nets import load, philosophers, size
from helpers.processes import pn2code


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
