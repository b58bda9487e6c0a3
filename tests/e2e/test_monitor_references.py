"""`make monitor` of a net with references: they are looked at like places, and nothing is found where all is well."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from helpers.netbuilder import write
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate
from pn2code.toolchain import build

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

NET = """
    net Kept
      standard
      globref count = 0;
      val last = ref (nil : string list);
      var n : INT;
      place A : INT = 1`0
      place B : INT
      trans Note guard [n < 5] code input (n); action (count := !count + 1; last := Int.toString n :: !last)
        in A : n
        out B : n
      trans Next guard [length (!last) > n]
        in B : n
        out A : n + 1
"""
MEDDLE = "((unsigned char *)pn_net.root[0].variable)[0] ^= 1U;"


def test_what_references_hold_is_looked_at(tmp_path: Path) -> None:
    d = Diagnostics()
    made = generate(write(NET, tmp_path / "kept.cpn"), d)
    assert made is not None, [str(e) for e in d.errors]
    folder = tmp_path / "kept"
    for file in made.files:
        path = folder / file.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(file.text, encoding="utf-8")

    def monitored() -> subprocess.CompletedProcess[str]:
        assert build.build(folder, made.files, d, target="supervisor.monitor") is not None
        return subprocess.run(
            [folder / "supervisor.monitor"], capture_output=True, text=True, check=False
        )

    done = monitored()
    assert done.returncode == 0, done.stderr
    net = folder / "net.c"
    head, name, rest = net.read_text().partition("static bool Next_fire(")
    assert name
    before, brace, after = rest.partition("{\n")
    net.write_text(f"{head}{name}{before}{brace}    {MEDDLE}\n{after}")
    done = monitored()
    assert done.returncode == 70
    assert (
        "the values of references have changed although nothing assigns any in Top.Next"
        in done.stderr
    )
