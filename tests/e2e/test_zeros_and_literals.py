"""What scripts and files make of values at the edges: zeros with a sign, no numbers, odd texts, the least integer.

In each cell the supervisor sends a value, and the device answers 1 or 2 by what it makes of it. What the run answers is
what the state space shows, and nothing else.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import cpn
from pn2code.cli.main import app

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

NET = """
net cell
  standard
  var k: INT;
  var x: VALUE;
  var y, z: KEPT;
  page Top
    place data : VALUE
    place flag : INT
    place done : INT
    subst Supervisor = Sup (data -> data, flag -> flag, done -> done)
    subst Device = Dev (data -> data, flag -> flag, done -> done)
  page Sup
    place data port out : VALUE
    place flag port out : INT
    place done port in : INT
    place Start = 1
    place Armed
    place Finished : INT
    trans Ask
      in Start : ()
      out data : SENT
      out flag : 1
      out Armed : ()
    trans Finish
      in Armed : ()
      in done : k
      out Finished : k
  page Dev
    place data port in : VALUE
    place flag port in : INT
    place done port out : INT
    place Waiting = 1
    place Got : KEPT
    trans Accept
      in Waiting : ()
      in flag : 1
      in data : x
      out Got : MADE
    trans Yes guard [TEST]
      in Got : y
      out Waiting : ()
      out done : 1
    trans No guard [not (TEST)]
      in Got : y
      out Waiting : ()
      out done : 2
"""
TOML = '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]\n' + "".join(
    f'[[channel]]\nplace = "{place}"\nfile = "{place}.robcad"\nkind = "{kind}"\n'
    for place, kind in (("data", "data"), ("flag", "flag"), ("done", "flag"))
)  # fmt: skip
DEVICE = '[devices.device]\ninstance = "Device"\n'
POSITIVE = "1.0 / y > 0.0"
ODD = '"\\228\\000\\r\\n\\t\\127\\\\\\""'
PAIR = NET.replace("    place Got", "    place Kept : KEPT = 1`1.0\n    place Got", 1)
PAIR = PAIR.replace(
    "      in data : x\n", "      in data : x\n      in Kept : z\n      out Kept : x / x\n"
)
PAIR = PAIR.replace("guard [TEST]", "").replace(
    "in Got : y\n", "in Got : y\n      both Kept : y\n", 1
)
PAIR = PAIR.replace("[not (TEST)]", "[not (Real.== (y, z))]")
at = PAIR.index("    trans No")
PAIR = PAIR[:at] + PAIR[at:].replace("in Got : y\n", "in Got : y\n      both Kept : z\n")

FAKE = ("--backend", "fake", "--no-pictures", "--unchecked")
"""What a run checks first, `verify` has said before."""


def cell(folder: Path, net: str, **texts: str) -> Path:
    for name in sorted(texts, key=len, reverse=True):
        net = net.replace(name, texts[name])
    (folder / "cell.cpn").write_bytes(cpn(net))
    (folder / "cell.toml").write_text(TOML + DEVICE, encoding="utf-8")
    return folder


def answers(folder: Path) -> tuple[list[str], int]:
    """Whether each answer can be given, as the state space shows, and the one that a run gives."""
    asked = [f"reachable {{ cf ({n}, Mark.Sup'Finished 1) > 0 }}" for n in (1, 2)]
    words = ["verify", folder, "--json", "--no-medium", "--traces", folder / "traces"]
    for text in asked:
        words += ["--property", text]
    found = CliRunner().invoke(app, [str(w) for w in words])
    said = json.loads(found.stdout)
    assert all(c["answer"] == "yes" for c in said["controller"]), said["controller"]
    ran = CliRunner().invoke(app, ["run", str(folder), *FAKE, "-o", str(folder / "run")])
    assert ran.exit_code == 0, ran.output
    lines = (folder / "run" / "supervisor.trace.jsonl").read_text(encoding="utf-8").splitlines()
    (given,) = (
        row["binding"]["k"]
        for row in map(json.loads, lines)
        if str(row.get("transition", "")).endswith("Finish")
    )
    return [p["answer"] for p in said["properties"]], given


@pytest.mark.parametrize(
    ("value", "sent", "kept", "made", "test", "expected"),
    [
        ("REAL", "~0.0", "REAL", "x", POSITIVE, 2),  # in a file
        ("INT", "7", "REAL", "if x = 1 then 0.0 else ~0.0", POSITIVE, 2),  # in a script
        ("REAL", "0.0", "REAL", "Real.min (x, ~0.0)", POSITIVE, 2),
        ("REAL", "0.0", "REAL", "Real.max (~0.0 * (x + 1.0), x)", POSITIVE, 1),
        ("STRING", ODD, "STRING", "x", f"y = {ODD}", 1),
        ("INT", "~1073741824", "INT", "x", "y = ~1073741824", 1),
        ("INT", "0", "INT", "x + ~1073741824", "y < 0", 1),
    ],
)
def test_a_run_gives_the_answer_that_was_shown(
    value: str, sent: str, kept: str, made: str, test: str, expected: int, tmp_path: Path
) -> None:
    texts = {"VALUE": value, "SENT": sent, "KEPT": kept, "MADE": made, "TEST": test}
    shown, given = answers(cell(tmp_path, NET, **texts))
    assert shown == [["no", "yes"], ["yes", "no"]][expected == 1]
    assert given == expected


def test_tokens_that_are_no_numbers_are_one(tmp_path: Path) -> None:
    texts = {"VALUE": "REAL", "SENT": "0.0", "KEPT": "REAL", "MADE": "x / x"}
    shown, given = answers(cell(tmp_path, PAIR, **texts))
    assert (shown[0], given) == ("yes", 1)
