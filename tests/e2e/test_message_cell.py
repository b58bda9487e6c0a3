"""What is hard to send arrives: 0, false, odd bytes, odd names of files. What cannot be sent is found out before."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers import message_cell, small_cell
from pn2code.cli.main import app
from pn2code.conform.cell import conform_cell
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]


def test_zeros_and_odd_names_from_end_to_end(tmp_path: Path) -> None:
    cell = message_cell.write(tmp_path / "cell", message_cell.ODD_NAMES)
    d = Diagnostics()
    made = generate(cell, d)
    assert made is not None and not d.items, [str(i) for i in d]
    found = conform_cell(cell, d)
    assert found is not None and found.complete and not found.deviates, found
    out = tmp_path / "out"
    result = run_cell(cell, RunOptions(out=out, backend="fake"), d)
    assert result is not None, [str(i) for i in d]
    lines = [json.loads(x) for x in (out / "cell.trace.jsonl").read_text().splitlines()]
    got = [x["binding"] for x in lines if str(x.get("transition")).endswith("Device.Report")]
    odd = 'a\0b"c\\ \xff\n'
    assert [(b["k"], b["b"], b["s"], b["c"]) for b in got] == [
        (0, False, odd, "green"),
        (5, True, odd, "green"),
    ]
    assert lines[-1]["why"] == "finished"


def test_verify_says_yes_of_zeros(tmp_path: Path) -> None:
    cell = message_cell.write(tmp_path / "cell")
    options = ["--json", "--no-medium", "--threads", "1", "--traces", str(tmp_path)]
    done = CliRunner().invoke(app, ["verify", str(cell), *options])
    assert done.exit_code == 0, done.output
    checks = {c["check"]: c for c in json.loads(done.stdout)["controller"]}
    assert (checks["messages"]["answer"], checks["messages"]["value"]) == (
        "yes",
        3,
    )  # texts there and back


# --- what cannot be sent ---

BASE = """
net cell
  standard
  colset NARROW = real with 0.0..0.1;
  fun rep (0, c) = "" | rep (n, c) = let val h = rep (n div 2, c) in if n mod 2 = 0 then h ^ h else h ^ h ^ c end
  var k: INT;
  var v: COLSET;
  page Top
    place flag : COLSET
    place done : INT
    subst Supervisor = Sup (flag -> flag, done -> done)
    subst Device = Dev (flag -> flag, done -> done)
  page Sup
    place flag port out : COLSET
    place done port in : INT
    place Ready = 1
    place Armed
    place Finished : INT
    trans Prepare
      in Ready : ()
      out Armed : ()
    place Asked
    trans Ask
      in Armed : ()
      out flag : VALUE
      out Asked : ()
    trans Finish
      in Asked : ()
      in done : k
      out Finished : k
  page Dev
    place flag port in : COLSET
    place done port out : INT
    place Waiting = 1
    place Over
    trans Accept
      in Waiting : ()
      in flag : v
      out Over : ()
    trans Answer
      in Over : ()
      out Waiting : ()
      out done : 1
"""
TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "flag"
file = "flag.txt"
[[channel]]
place = "done"
file = "done.txt"
[devices.device]
instance = "Device"
"""

CASES = [
    ("STRING", 'rep (4053, "x")', ""),
    ("STRING", 'rep (4054, "x")', "it has 4,056 bytes, but at most 4,055 are possible"),
    ("STRING", 'rep (1014, "\\001")', "it has 4,058 bytes"),
    ("REAL", "1.0 / 0.0", "is not a finite number"),
]


@pytest.mark.parametrize(("colset", "value", "words"), CASES)
def test_a_message_that_cannot_be_written_is_found_out(
    colset: str, value: str, words: str, tmp_path: Path
) -> None:
    net = BASE.replace("COLSET", colset).replace("VALUE", value)
    cell = small_cell.write(tmp_path / "cell", net, TOML)
    d = Diagnostics()
    made = generate(cell, d)
    if not words:
        assert made is not None, [str(i) for i in d]
        return
    assert made is None
    (error,) = d.errors
    assert error.code == "controller-check"
    assert error.message.startswith("messages: the message ") and words in error.message
    assert any("`Top.Supervisor.Prepare`, `Top.Supervisor.Ask`" in str(n) for n in error.notes)
    options = ["--no-found", "--json", "--threads", "1", "--traces", str(tmp_path)]
    done = CliRunner().invoke(app, ["verify", str(cell), *options])
    assert done.exit_code == 1
    said = json.loads(done.stdout)
    (check,) = [c for c in said["controller"] if c["check"] == "messages"]
    assert check["answer"] == "no" and check["evidence"][0]["steps"] == 2
    trace = Path(check["evidence"][0]["trace"])
    assert [json.loads(x).get("transition") for x in trace.read_text().splitlines()][1:3] == [
        "Top.Supervisor.Prepare",
        "Top.Supervisor.Ask",
    ]
    assert said["medium"][0]["answer"] == "no" and words in said["medium"][0]["why"]


def test_the_message_that_comes_first_is_blamed(tmp_path: Path) -> None:
    """Data stand before flags among the channels, but the supervisor gets no further than the flag."""
    net = BASE.replace("COLSET", "STRING").replace("VALUE", 'rep (4054, "x")')
    net = net.replace(
        "    place done : INT\n", "    place done : INT\n    place more : STRING\n", 1
    )
    net = net.replace("(flag -> flag, done -> done)", "(flag -> flag, done -> done, more -> more)")
    net = net.replace(
        "    place done port in : INT\n",
        "    place done port in : INT\n    place more port out : STRING\n",
        1,
    ).replace(
        "    place Over\n",
        "    place Over\n    place more port in : STRING\n    place Read : STRING\n"
        "    trans Take\n      in more : v\n      in Waiting : ()\n      out Read : v\n",
        1,
    )
    net = net.replace(
        "      out Finished : k\n", '      out Finished : k\n      out more : rep (4060, "y")\n', 1
    )
    toml = TOML + '[[channel]]\nplace = "more"\nfile = "more.txt"\nkind = "data"\n'
    cell = small_cell.write(tmp_path / "cell", net, toml)
    options = ["--no-found", "--no-medium", "--json", "--threads", "1", "--traces", str(tmp_path)]
    done = CliRunner().invoke(app, ["verify", str(cell), *options])
    assert done.exit_code == 1, done.output
    said = json.loads(done.stdout)
    (check,) = [c for c in said["controller"] if c["check"] == "messages"]
    assert "of channel `flag` cannot be sent" in check["says"], check
    assert check["evidence"][0]["steps"] == 2


def test_a_number_out_of_its_range_once_it_is_rounded(tmp_path: Path) -> None:
    """0.1 in single precision is a little more than 0.1, which a reader of 0.0..0.1 refuses."""
    net = BASE.replace("COLSET", "NARROW").replace("VALUE", "0.1")
    cell = small_cell.write(tmp_path / "cell", net, TOML + '[storage]\nNARROW = "float32"\n')
    d = Diagnostics()
    assert generate(cell, d) is None
    assert any("which a reader refuses" in e.message or "colour" in e.message for e in d.errors), [
        str(i) for i in d
    ]


def test_lists_and_strings_have_room(tmp_path: Path) -> None:
    """A firing that needs 12.5 MB: the supervisor gets them, and plays it."""
    net = BASE.replace("COLSET", "INT").replace("VALUE", 'String.size (rep (5000, "x")) mod 7')
    slow = 'fun rep (0, c) = "" | rep (n, c) = c ^ rep (n - 1, c)\n'
    net = re.sub(r"fun rep .*\n", slow, net)
    cell = small_cell.write(tmp_path / "cell", net, TOML)
    d = Diagnostics()
    made = generate(cell, d)
    assert made is not None and not d.items, [str(i) for i in d]
    (config,) = [f.text for f in made.files if f.path == "cell_config.c"]
    assert "memory: yes; " in config and "is worked out on the way" in config
    assert made.arena > 12_500_000 and f"s_arena[{made.arena}U" in config
    found = conform_cell(cell, d)
    assert found is not None and found.supervisor is not None and not found.deviates, found
    assert found.supervisor.sent == 1


# --- names of files, and other limits ---


@pytest.mark.parametrize(
    ("file", "words"),
    [
        ("a/b", "not a plain file name"),
        (".hidden", "not a plain file name"),
        ("x.tmp", "not a plain file name"),
        ("two\\nlines", "characters that cannot be printed"),
        ("ü" * 81, "has more than 160 bytes"),
        (" blank", "begins or ends with a blank"),
        ("supervisor.status", "is the status file of a program"),
        ("Device.Status", "is the status file of a program"),
        ("device.status", "is the status file of a program"),
        ("done.other", "differ only in the ending"),
        ("done", "differ only in the ending"),
    ],
)
def test_names_that_do_not_work_are_refused(file: str, words: str, tmp_path: Path) -> None:
    cell = small_cell.write(tmp_path / "cell", BASE, TOML.replace("flag.txt", file))
    d = Diagnostics()
    assert generate(cell, d) is None
    (error,) = [e for e in d.errors if words in e.message]
    assert (
        error.code == "cell-value"
        and error.origin.file.endswith("cell.toml")
        and error.origin.line > 6
    )


def test_an_input_file_does_not_replace_a_generated_one(tmp_path: Path) -> None:
    toml = TOML + '[[input]]\nplace = "Armed"\nfile = "net.c"\n'
    d = Diagnostics()
    assert generate(small_cell.write(tmp_path / "cell", BASE, toml), d) is None
    assert any("has the name of a generated file" in e.message for e in d.errors)


def test_a_long_name_of_a_device(tmp_path: Path) -> None:
    toml = TOML.replace("devices.device", f"devices.{'d' * 81}")
    d = Diagnostics()
    assert generate(small_cell.write(tmp_path / "cell", BASE, toml), d) is None
    assert any("has more than 80 characters" in e.message for e in d.errors)


def test_a_message_of_too_many_values(tmp_path: Path) -> None:
    wide = " * ".join(["INT"] * 1025)
    value = "(" + ", ".join(["1"] * 1025) + ")"
    net = BASE.replace("  fun rep", f"  colset WIDE = product {wide};\n  fun rep", 1)
    net = net.replace("COLSET", "WIDE").replace("VALUE", value)
    d = Diagnostics()
    assert generate(small_cell.write(tmp_path / "cell", net, TOML), d) is None
    (error,) = d.errors
    assert (
        error.code == "channel-limit"
        and "has 1,025 values, but at most 1,024 are possible" in error.message
    )
