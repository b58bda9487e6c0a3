"""Characters beyond Latin-1: strings are bytes, as in the engine, and people see what was written."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from helpers.processes import pn2code

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

NET = """
net cell
  standard
  colset SIZED = product STRING * INT;
  var s: STRING;
  page Top
    place A : STRING = 1`"NAME"
    place PLACE : SIZED
    trans TRANS
      in A : s
      out PLACE : (s ^ "GREET", String.size s + length (String.explode "GREET"))
"""
WORDS = {"NAME": "Łódź é", "GREET": "ž–€", "PLACE": "Überprüfung → Ω", "TRANS": "Naprzód ń"}
AFTER = '1`("Łódź éž–€",16)'
"""As the engine counts: Ł, ź, ž are two bytes each, – and € three, ó and é one."""


def net(folder: Path, text: str = NET) -> Path:
    data = cpn(text)
    for word, meant in WORDS.items():
        data = data.replace(word.encode(), meant.encode())
    file = folder / "cell.cpn"
    file.write_bytes(data.replace(b"iso-8859-1", b"UTF-8").replace(b"ISO-8859-1", b"UTF-8"))
    return file


def test_markings_and_bindings(tmp_path: Path) -> None:
    file = net(tmp_path)
    assert '1`"Łódź é"' in pn2code("marking", file).stdout
    rows = json.loads(pn2code("marking", file, "--json").stdout)["places"]
    assert [r["marking"] for r in rows] == ['1`"Łódź é"', "empty"]
    assert [r["name"] for r in rows] == ["A", WORDS["PLACE"]]
    done = pn2code("enabled", file)
    assert done.stdout == 'Naprzód ń (Top)\n  s = "Łódź é"\n'
    for engine in ("compiled", "reference"):
        done = pn2code("simulate", file, "--engine", engine, "--json")
        assert json.loads(done.stdout)["places"][1]["marking"] == AFTER
        assert AFTER in pn2code("simulate", file, "--engine", engine).stdout


def test_reports_and_pictures(tmp_path: Path) -> None:
    file, traces = net(tmp_path), tmp_path / "traces"
    page, graph = tmp_path / "report.html", tmp_path / "graph.html"
    asked = """always { Mark.Top'A 1 = ["Łódź é"] }"""
    done = pn2code("verify", file, "--full", "--traces", traces, "--property", asked)
    assert done.returncode == 1 and "Łódź é" in done.stdout, done.stderr
    (run,) = traces.glob("*.jsonl")
    done = pn2code("verify", file, "--full", "--report", page, "--draw", graph, "-o", traces)
    picture = tmp_path / "net.svg"
    assert pn2code("draw", file, "--trace", run, "-o", picture).returncode == 0
    for text in (done.stdout, page.read_text(), graph.read_text(), picture.read_text()):
        assert "Łódź éž–€" in text
        assert "\x81" not in text and "Å" not in text
    assert pn2code("replay", run, file).returncode == 0


@pytest.mark.usefixtures("here")
def test_messages(tmp_path: Path) -> None:
    text = NET.replace('(s ^ "GREET"', '(if s = "" then s else raise Fail ("GREET" ^ s)')
    file = net(tmp_path, text)
    said = pn2code("simulate", file, "--engine", "reference").stderr
    assert "raised the exception `Fail (ž–€Łódź é)`" in said and 's = "Łódź é"' in said
    assert 's = "Łódź é"' in pn2code("simulate", file, "--engine", "compiled").stderr
    assert "ž–€Łódź é" in pn2code("verify", file).stderr
    file = net(
        tmp_path,
        NET.replace("place A : STRING", "place A : SHORT").replace(
            "  var s", '  colset SHORT = string with "a".."z";\n  var s'
        ),
    )
    assert "Łódź é" in pn2code("marking", file).stderr


def test_a_recording_of_the_engine(tmp_path: Path) -> None:
    """As the engine's texts were recorded: in the characters that are meant."""
    step = {"step": 1, "time": "0", "page": "Top", "instance": 1, "transition": "Naprz_d",
            "id": "ID17", "binding": {"s": '"Łódź é"'}}  # fmt: skip
    recorded = {"steps": [step], "final_time": "0"}
    file = net(tmp_path)
    rows = json.loads(pn2code("marking", file, "--json").stdout)["places"]
    final = [{"id": rows[1]["id"], "instance": 1, "marking": AFTER}]
    enabled = json.loads(pn2code("enabled", file, "--json").stdout)["enabled"]
    step["id"], step["transition"] = enabled[0]["id"], "Naprz"
    path = tmp_path / "recorded.json"
    path.write_text(json.dumps({**recorded, "final_marking": final}))
    done = pn2code("replay", path, file, "--json")
    assert done.returncode == 0, done.stdout + done.stderr
