"""Names of those things that `verify` and `time` add to a net, given to pages, places and programs: no confusion."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from pn2code.cli.main import app

pytestmark = pytest.mark.cc

_PAGES = """standard
fun work () = ();
var b : BOOL;
page TOP
  place go
  place done : BOOL
  subst supervisor = Supervisor (go -> go, done -> done)
  subst dev = Dev (go -> go, done -> done)
page Supervisor
  place go port out
  place done port in : BOOL
  place idle = ()
  place calm
  place over
  place bad
  trans Order
    in idle
    out go
    out calm
  trans Again
    in calm
    in done : false
    AGAIN
  trans Forever
    in bad
    in done : b
    out bad
    out go
  trans End
    in calm
    in done : true
    out over
page Dev
  place go port in
  place done port out : BOOL
  place owes = ()
  place told
  trans Take
    in owes
    in go
    out told
  trans Work
    code action (work ())
    in told
    out owes
    out done : b
"""
_TOML = """[net]
file = "cell.cpnt"
[supervisor]
instance = "supervisor"
final = ["over"]
[[channel]]
place = "go"
file = "go.robcad"
[[channel]]
place = "done"
file = "done.robcad"
[primitives]
work = { command = "tool", action = "work", duration_s = 1.0 }
[devices.DEVICE]
instance = "dev"
[sensors.b]
variable = "b"
seed = 1
"""


def _said(folder: Path, verb: str, top: str, device: str, again: str) -> dict[str, Any]:
    pages = _PAGES.replace("TOP", top).replace("AGAIN", again).replace("dev =", f"{device} =")
    config = _TOML.replace("DEVICE", device).replace('"dev"', f'"{device}"')
    (folder / "cell.cpnt").write_text(pages, encoding="utf-8")
    (folder / "cell.toml").write_text(config, encoding="utf-8")
    options = ["--json", *(["--traces", str(folder / "traces")] if verb == "verify" else [])]
    done = CliRunner().invoke(app, [verb, str(folder), *options])
    found: dict[str, Any] = json.loads(done.stdout)
    return found


@pytest.mark.parametrize(("top", "device"), [("Top", "restocker"), ("medium", "restocker")])
def test_a_program_is_no_end_of_the_medium(tmp_path: Path, top: str, device: str) -> None:
    """Steps of `restocker` are called `medium.restocker...`; an end was what begins with `medium.rest`."""
    found = _said(tmp_path, "verify", top, device, "out go\n    out bad")
    whole = found["medium"][0]
    assert (whole["answer"], whole["why"]) == ("no", None)  # not because of another check
    assert whole["evidence"]


def test_a_page_is_called_as_the_steps_of_a_cell(tmp_path: Path) -> None:
    """Page `cell`, owner `supervisor`, places `idle`, `calm`, `over`: so are the places that say where it is."""
    cycle = _said(tmp_path, "time", "cell", "dev", "out idle")["layouts"][0]["cycle"]
    assert [e["final"] for e in cycle["endings"]] == [["cell.supervisor.over"]]
    assert cycle["most_s"] is None and "cell.dev.Work" in cycle["repeats"]


def test_endings_have_runs_of_their_own(tmp_path: Path) -> None:
    """Two final places with the same last word, and with signs that a file cannot have in its name."""
    pages = _PAGES.replace("TOP", "Top").replace("AGAIN", 'out "b.D/ne"')
    pages = pages.replace("place over", 'place "a.D/ne"\n  place "b.D/ne"')
    text = pages.replace("    out over", '    out "a.D/ne"')
    (tmp_path / "cell.cpnt").write_text(text, encoding="utf-8")
    config = _TOML.replace("DEVICE", "dev").replace('["over"]', '["a.D/ne", "b.D/ne"]')
    (tmp_path / "cell.toml").write_text(config, encoding="utf-8")
    out = tmp_path / "out"
    done = CliRunner().invoke(app, ["time", str(tmp_path), "--json", "-o", str(out)])
    endings = json.loads(done.stdout)["layouts"][0]["cycle"]["endings"]
    last = {}
    for e in endings:
        rows = map(json.loads, Path(e["fastest"]).read_text(encoding="utf-8").splitlines())
        (place,) = e["final"]
        last[place] = [row["transition"] for row in rows if "transition" in row][-1]
    assert last == {
        "Top.supervisor.a.D/ne": "Top.supervisor.End",
        "Top.supervisor.b.D/ne": "Top.supervisor.Again",
    }


def test_a_final_place_has_a_comma_in_its_name(tmp_path: Path) -> None:
    pages = _PAGES.replace("TOP", "Top").replace("AGAIN", "out idle")
    pages = pages.replace("place over", 'place "a, b"').replace("out over", 'out "a, b"')
    (tmp_path / "cell.cpnt").write_text(pages, encoding="utf-8")
    config = _TOML.replace("DEVICE", "dev").replace('["over"]', '["a, b"]')
    (tmp_path / "cell.toml").write_text(config, encoding="utf-8")
    done = CliRunner().invoke(app, ["time", str(tmp_path), "--json"])
    endings = json.loads(done.stdout)["layouts"][0]["cycle"]["endings"]
    assert [e["final"] for e in endings] == [["Top.supervisor.a, b"]]


_PARTS = """standard
var n : INT;
page Top
  place P : INT = 1`0 ++ 1`1
  place Q
  trans T
    in P : n
    out Q
  trans "T#1"
    in P : n
    out Q
  trans "T#2"
    guard [n = 0]
    in P : n
    out Q
"""


def test_a_transition_is_called_as_a_part_of_another_one(tmp_path: Path) -> None:
    """`T#1` and `T#2` are what a transition with a condition on its binding becomes: the run was no run."""
    (tmp_path / "net.cpnt").write_text(_PARTS, encoding="utf-8")
    asked = 'ltl G (fires("Top.T", { n = 1 }) -> X G !fires("Top.T#2"))'
    options = ["--property", asked, "--json", "--traces", str(tmp_path)]
    done = CliRunner().invoke(app, ["verify", str(tmp_path / "net.cpnt"), *options])
    (found,) = json.loads(done.stdout)["properties"]
    assert (found["answer"], "property-evidence" in done.output) == ("no", False)
    rows = map(json.loads, Path(found["evidence"]["trace"]).read_text().splitlines())
    steps = [row["transition"] for row in rows if "transition" in row]
    assert steps == ["Top.T", "Top.T#2"]


_TOLD = """standard
var n : INT;
page Top
  place dat : INT
  place go
  place done
  subst Supervisor = Supervisor (dat -> dat, go -> go, done -> done)
  subst Dev = Dev (dat -> dat, go -> go, done -> done)
page Supervisor
  place dat port out : INT
  place go port out
  place done port in
  place Idle = ()
  place Waiting
  place Finished
  trans Order
    in Idle
    out dat : 2
    out go
    out Waiting
  trans End
    in Waiting
    in done
    out Finished
page Dev
  place dat port in : INT
  place go port in
  place done port out
  place Idle = ()
  place Told
  place Odd
  trans Take
    in Idle
    in go
    out Told
  trans Look
    guard [n = 1]
    in Told
    in dat : n
    out Idle
    out done
  trans Otherwise
    guard [n <> 1]
    in Told
    in dat : n
    out Odd
    out done
"""


def test_a_transition_has_an_id_as_those_that_look_at_registers(tmp_path: Path) -> None:
    """`Otherwise` comes although a message is there: nothing has to be passed over before."""
    text, net = tmp_path / "cell.cpnt", tmp_path / "cell.cpn"
    text.write_text(_TOLD, encoding="utf-8")
    assert CliRunner().invoke(app, ["convert", str(text), "-o", str(net)]).exit_code == 0
    drawn = net.read_text(encoding="utf-8")
    own = re.findall(r'<trans id="(\w+)"', drawn[: drawn.index("<text>Look</text>")])[-1]
    net.write_text(drawn.replace(f'"{own}"', f'"register-look-{own}"'), encoding="utf-8")
    channels = (
        f'[[channel]]\nplace = "{name}"\nfile = "{name}.robcad"\nkind = "{kind}"\n'
        for name, kind in (("dat", "data"), ("go", "flag"), ("done", "flag"))
    )
    head = '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]\n'
    config = head + "".join(channels) + '[devices.dev]\ninstance = "Dev"\n'
    (tmp_path / "cell.toml").write_text(config, encoding="utf-8")
    never = ["--property", "never tokens(Dev'Odd) = 1", "--traces", str(tmp_path / "traces")]
    done = CliRunner().invoke(app, ["verify", str(tmp_path), "--json", *never])
    assert json.loads(done.stdout)["properties"][0]["answer"] == "no"
