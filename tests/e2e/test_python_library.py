"""pn2code as a Python library: the examples of docs/library.md as printed, and the same answers as the command."""

from __future__ import annotations

import doctest
import json
import subprocess
import sys
from pathlib import Path

import pytest

import pn2code
from helpers.netbuilder import write
from helpers.processes import pn2code as command
from helpers.small_cell import TOML
from helpers.small_cell import write as write_cell

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

TIMED = """
    net Later
      standard
      colset JOB = int timed;
      var j : JOB;
      place Waiting : JOB = 1`1@5 +++ 1`2@9
      place Done : JOB
      trans Do delay @+3
        in Waiting : j
        out Done : j
"""


def test_the_examples_of_the_manual(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(root)
    result = doctest.testfile(str(root / "docs" / "library.md"), module_relative=False)
    assert result.attempted > 20
    assert result.failed == 0


def test_the_library_is_loaded_when_it_is_asked_for() -> None:
    code = (
        "import sys, pn2code; pn2code.__version__; print('pn2code.api' in sys.modules); pn2code.load; "
        "print('pn2code.api' in sys.modules); print(all(hasattr(pn2code, n) for n in pn2code.__all__))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "True", "True"]
    with pytest.raises(AttributeError, match="no attribute `lode`"):
        _ = pn2code.lode


def test_a_cell_gets_the_answers_of_the_command(tmp_path: Path) -> None:
    folder = write_cell(tmp_path / "cell")
    with pytest.raises(ValueError, match="31 bits"):
        pn2code.load(folder, int_bits=64).verify()
    net = pn2code.load(folder)
    assert net.is_cell and not net.is_timed
    found = net.verify("deadlock free", traces=tmp_path / "runs")
    said = command(
        "verify", str(folder), "--json", "--property", "deadlock free", "-o", str(tmp_path / "tr")
    )
    row = json.loads(said.stdout)
    assert [c["answer"] for c in row["controller"]] == [
        c["answer"] for c in found.report["controller"]
    ]
    assert [m["answer"] for m in row["medium"]] == [m["answer"] for m in found.report["medium"]]
    assert [p["answer"] for p in row["properties"]] == [a.answer for a in found.answers]
    assert {0: "yes", 1: "no", 3: "inconclusive"}[said.returncode] == found.verdict
    trace = found["deadlock free"].trace
    assert (trace is None) == (found["deadlock free"].answer != "no")
    assert trace is None or trace.is_file()


def test_a_timed_net(tmp_path: Path) -> None:
    net = pn2code.load(write(TIMED, tmp_path / "later.cpn"))
    start = net.initial_marking()
    assert start.time == 0 and start.enabled() == ()
    ready = start.advanced()
    assert ready.time == 5
    (only,) = ready.enabled()
    assert only.values == {"j": 1}
    after = ready.fire(only)
    assert after["Done"] == (pn2code.Token(1, 1, 8),)
    assert (
        after["Later'Waiting" if "Later" in net.pages else f"{net.pages[0]}'Waiting"][0].time == 9
    )
    with pytest.raises(ValueError, match="lacks"):
        after.fire(only)
    run = net.simulate()
    assert run.why == "finished" and run.final.time == 9
    assert run.final == net.simulate(engine="reference").final


def test_limits_leave_answers_open(root: Path) -> None:
    net = pn2code.load(root / "examples" / "philosophers" / "philosophers.cpn", values={"n": 6})
    found = net.verify("deadlock free", max_states=10, unfold=False)
    assert not found.is_complete
    assert found.verdict == "inconclusive"
    assert net.verify("deadlock free", max_states=10, max_seconds=600).verdict == "no"


def test_what_is_wrong_is_raised(tmp_path: Path) -> None:
    path = write(TIMED, tmp_path / "later.cpn")
    net = pn2code.load(path)
    with pytest.raises(pn2code.NetError) as raised:
        net.verify("bound Nowhere <= 1")
    assert "Nowhere" in str(raised.value)
    with pytest.raises(KeyError, match="there is `"):
        net.initial_marking()["Waitin"]
    with pytest.raises(KeyError, match="no page"):
        net.draw("Nowhere")
    broken = tmp_path / "broken.cpn"
    broken.write_bytes(
        path.read_bytes().replace(b"int timed", b"INTT timed").replace(b"<int/>", b"<id>X</id>")
    )
    with pytest.raises(pn2code.NetError) as raised:
        pn2code.load(broken)
    assert raised.value.diagnostics == pn2code.check(broken)


def test_check_says_what_the_command_says_of_a_cell(tmp_path: Path) -> None:
    folder = write_cell(tmp_path, toml=TOML.replace("moveHome =", "moveHom ="))
    said = json.loads(command("check", str(folder), "--json").stdout)["diagnostics"]
    assert [item.code for item in pn2code.check(folder)] == [item["code"] for item in said]
    assert said


def test_pictures_show_the_tokens(tmp_path: Path) -> None:
    net = pn2code.load(write(TIMED, tmp_path / "later.cpn"))
    picture = net.initial_marking().draw(net.pages[0])
    picture.save(tmp_path / "net.svg")
    assert (tmp_path / "net.svg").read_text(encoding="utf-8") == picture._repr_svg_()
    assert "1`1@5" in picture.svg and "1`1@5" not in net.draw().svg.replace("1`1@5 +++", "")
    assert net.initial_marking()._repr_svg_().startswith("<svg") or "<svg" in picture.svg


def test_programs_are_those_of_the_command(tmp_path: Path) -> None:
    path = write(TIMED, tmp_path / "later.cpn")
    made = pn2code.generate(path)
    assert made.write(tmp_path / "a") == len(made.files)
    assert made.write(tmp_path / "a") == 0
    assert command("generate", str(path), "-o", str(tmp_path / "b")).returncode == 0
    for name, text in made.files.items():
        assert (tmp_path / "b" / name).read_text(encoding="utf-8") == text
