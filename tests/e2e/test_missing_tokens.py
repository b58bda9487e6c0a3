"""A firing that lacks a token changes nothing: what it has taken before is put back.

The search finds enabled bindings only; but an inscription may give something else when the transition occurs.
"""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from helpers.processes import pn2code
from pn2code import pipeline
from pn2code.diagnostics import Diagnostics, render
from pn2code.emission.write import write

pytestmark = pytest.mark.cc

NET = """
net Stale
  standard
  globref asked = 0;
  fun next () = (asked := !asked + 1; !asked);
  var n, k: INT;
  place A : INT = 1`1 ++ 2`2
  place B : INT = 1`1 ++ 1`3
  place C : INT
  place D : INT = 1`1 ++ 1`2
  place E = 3
  trans Go
    in E : 2`()
    in A : n
    in B : next ()
    in D : n
    out C : n
"""


@pytest.mark.parametrize("engine", ["compiled", "reference"])
def test_what_was_taken_is_put_back(tmp_path: Path, engine: str) -> None:
    net = tmp_path / "net.cpn"
    net.write_bytes(cpn(NET))
    done = pn2code("simulate", net, "--engine", engine, "--json")
    said = json.loads(done.stdout)
    assert (said["why"], said["steps"]) == ("error", 0), done.stderr
    assert {p["name"]: " ".join(p["marking"].split()) for p in said["places"]} == {
        "A": "1`1++ 2`2",
        "B": "1`1++ 1`3",
        "C": "empty",
        "D": "1`1++ 1`2",
        "E": "3`()",
    }


def test_a_binding_that_nobody_has_found_does_no_harm(tmp_path: Path) -> None:
    """`make coverage` fires bindings with one component changed, so that one token of several is missing."""
    text = NET.replace("in B : next ()", "in B : k").replace("1`1 ++ 1`3", "1`4 ++ 1`5")
    (tmp_path / "net.cpn").write_bytes(cpn(text))
    d = Diagnostics()
    made = pipeline.generate(tmp_path / "net.cpn", d)
    assert made is not None, render.report(d)
    out = tmp_path / "out"
    write(out, made.files)
    env = {k: v for k, v in os.environ.items() if not k.startswith(("MAKE", "CFLAGS"))}
    command = ["make", "coverage", "CC=gcc", "CFLAGS=-O1"]
    done = subprocess.run(command, cwd=out, env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
