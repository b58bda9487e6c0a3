"""Times in messages: a place of a `time` colour set is a channel, in nets with an integer and with a real clock."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers import small_cell
from pn2code.cli.main import app
from pn2code.conform.cell import conform_cell
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

NET = """
net cell
  standard
  colset TT = time;
  colset DUE = product INT * TT;
  colset WAITED = int timed;
  var k: INT;
  var s, u: TT;
  var w: WAITED;
  page Top
    place order : DUE
    place done : TT
    subst Supervisor = Sup (order -> order, done -> done)
    subst Device = Dev (order -> order, done -> done)
  page Sup
    place order port out : DUE
    place done port in : TT
    place Ready : WAITED = 1`1@3
    place Asked : INT
    place Finished : DUE
    trans Ask
      in Ready : w
      out order : (w, ModelTime.fromInt 3)
      out Asked : w
    trans Finish
      in Asked : k
      in done : s
      out Finished : (k, s)
  page Dev
    place order port in : DUE
    place done port out : TT
    place Waiting = 1
    place Last : TT = 1`0
    place Told : DUE
    trans Accept
      in Waiting : ()
      in order : (k, u)
      out Told : (k, u)
    trans Late guard [u > s]
      in Told : (k, u)
      in Last : s
      out Last : u
      out done : u
      out Waiting : ()
    trans Early guard [u <= s]
      in Told : (k, u)
      both Last : s
      out done : s
      out Waiting : ()
"""
TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "order"
file = "order.txt"
[[channel]]
place = "done"
file = "done.txt"
[devices.device]
instance = "Device"
"""
REAL_CLOCK = (
    NET.replace("  standard\n", "  standard\n  option realtimestamp true\n")
    .replace("Last : TT = 1`0", "Last : TT = 1`0.5")
    .replace("1`1@3", "1`1@3.0")
)


@pytest.mark.parametrize(("net", "at"), [(NET, 3), (REAL_CLOCK, 3.0)])
def test_a_time_goes_to_a_device_and_back(net: str, at: float, tmp_path: Path) -> None:
    cell = small_cell.write(tmp_path / "cell", net, TOML)
    d = Diagnostics()
    made = generate(cell, d)
    assert made is not None and not d.errors, [str(i) for i in d]
    found = conform_cell(cell, d)
    assert found is not None and found.complete and not found.deviates, found
    out = tmp_path / "out"
    result = run_cell(cell, RunOptions(out=out, backend="fake"), d)
    assert result is not None, [str(i) for i in d]
    lines = [json.loads(x) for x in (out / "cell.trace.jsonl").read_text().splitlines()]
    late = [x["binding"] for x in lines if str(x.get("transition")).endswith("Device.Late")]
    assert [b["u"] for b in late] == [at]
    assert lines[-1]["why"] == "finished"
    if net != NET:
        return  # of a real clock not all moments at which something may happen late can be tried out
    options = ["--json", "--no-medium", "--threads", "1", "--traces", str(tmp_path)]
    done = CliRunner().invoke(app, ["verify", str(cell), *options])
    assert done.exit_code == 0, done.output
    said = json.loads(done.stdout)
    assert {c["check"]: c["answer"] for c in said["controller"]}["messages"] == "yes"


def test_a_time_that_a_script_cannot_hold_is_found_out(tmp_path: Path) -> None:
    net = NET.replace("ModelTime.fromInt 3", "ModelTime.fromIntInf (IntInf.pow (2, 30))")
    cell = small_cell.write(tmp_path / "cell", net, TOML)
    d = Diagnostics()
    assert generate(cell, d) is None
    (error,) = d.errors
    assert error.code == "controller-check"
    assert "`#2` of colour set `TT` is `1073741824`, which a reader refuses" in error.message


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("Last : TT = 1`0", "Last : TT = 1`1073741824", "integers of robot scripts have 31 bits"),
        ("out done : s\n", "out done : s + 1\n", "`IntInf.+` cannot be used in a robot script"),
        ("out done : s\n", "out done : time ()\n", "cannot be used in a robot script"),
    ],
)
def test_what_scripts_cannot_do_with_times_is_said(
    old: str, new: str, words: str, tmp_path: Path
) -> None:
    assert NET.count(old) == 1
    cell = small_cell.write(tmp_path / "cell", NET.replace(old, new), TOML)
    d = Diagnostics()
    assert generate(cell, d) is None
    assert words in " ".join(e.message for e in d.errors), [str(e) for e in d.errors]
