"""The net in one piece with the steps of the simulator compiles without a warning, whatever its names are."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from tests.helpers.netbuilder import cpn

from pn2code.diagnostics import Diagnostics
from pn2code.emission import c_flags, runtime
from pn2code.net import front
from pn2code.simulate import programs

pytestmark = pytest.mark.cc

AWKWARD = """
net Awkward
  standard
  colset count = int with 0..9;
  colset sim = product count * count;
  colset size_t = count;
  var x: count;
  place sim : sim = 1`(1, 2)
  place sim_found : count = 1`1
  place P : size_t
  trans sim
    in sim_found : x
    out P : x
  trans sim_step
    in P : x
    out sim_found : x
  trans SIM_ROW
    in P : x
    out P : x
"""
NO_TRANSITIONS = """
net Still
  standard
  place P : INT = 1`1
"""
FLAGS = " ".join(
    (
        *(c_flags.STANDARD, *c_flags.FLOATS, "-O1", "-Wall", "-Wextra", "-Wpedantic", "-Werror"),
        *("-Wconversion", "-Wshadow", "-Iruntime/include", "-I."),
    )
)


@pytest.mark.parametrize("text", [AWKWARD, NO_TRANSITIONS])
def test_it_compiles_without_a_warning(text: str, tmp_path: Path) -> None:
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("there is no C compiler")
    net = tmp_path / "net.cpn"
    net.write_bytes(cpn(text))
    d = Diagnostics()
    flat = front.load(net, d)
    assert flat is not None
    files = programs.generated(flat, {}, d)
    assert files is not None
    for f in (*files, *runtime.emit(programs.HOST.name)):
        path = tmp_path / f.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f.text, encoding="utf-8")
    source = f"runtime/src/{programs.HOST.whole}"
    command = [compiler, *FLAGS.split(), '-DPN_NET_SOURCE="net.c"', "-c", source]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
