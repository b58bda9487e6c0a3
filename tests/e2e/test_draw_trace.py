"""`pn2code draw --trace`, and the pictures that `verify` makes of the same net."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from lxml import etree

from helpers import netbuilder
from pn2code.base.progress_line import Line
from pn2code.cli import main

SVG = "{http://www.w3.org/2000/svg}"

NET = """
net Twice
  standard
  var n : INT;
  page Top
    place A : INT = 2`1
    place B : INT = 1`7
    subst Left = Sub (Inp -> A)
    subst Right = Sub (Inp -> B)
  page Sub
    place Inp port in : INT
    trans Eat
      in Inp : n
"""
STEPS = [("Top.Left.Eat", 1), ("Top.Right.Eat", 7), ("Top.Left.Eat", 1)]


@pytest.fixture
def net(tmp_path: Path) -> Path:
    return netbuilder.write(NET, tmp_path / "twice.cpn")


@pytest.fixture
def trace(net: Path, tmp_path: Path) -> Path:
    rows: list[dict[str, object]] = [{"trace": 1, "net": "twice", "by": "reference"}]
    rows += [
        {"step": i, "t": 0, "transition": name, "binding": {"n": n}}
        for i, (name, n) in enumerate(STEPS, 1)
    ]
    path = tmp_path / "twice.trace.jsonl"
    path.write_text("\n".join(map(json.dumps, rows)) + "\n", encoding="utf-8")
    return path


def run(*arguments: object) -> int:
    with pytest.raises(SystemExit) as left:
        main.app(list(map(str, arguments)))
    return int(left.value.code or 0)


def tokens(path: Path) -> list[str]:
    root = etree.parse(path).getroot()
    return [
        span.text or ""
        for g in root.iter(f"{SVG}g")
        if g.get("class") == "tokens"
        for span in g.iter(f"{SVG}tspan")
    ]


def test_a_step_shows_the_instance_where_it_occurred(
    net: Path, trace: Path, tmp_path: Path
) -> None:
    out = tmp_path / "net.svg"
    draw = ("draw", net, "--trace", trace, "-o", out)
    assert run(*draw, "--step", 0) == 0
    assert tokens(out) == ["2`1", "2", "1`7", "1", "2`1", "2"]
    assert "#ff8800" not in out.read_text()
    assert run(*draw, "--step", 2) == 0
    assert tokens(out) == ["1`1", "1"]  # on the page Top; the second instance of Sub is empty
    assert out.read_text().count('stroke="#ff8800"') == 2  # the transition and its arc
    assert run(*draw, "--step", 2, "--page", "Sub", "--instance", 1) == 0
    assert tokens(out) == ["1`1", "1"] and "#ff8800" not in out.read_text()
    assert run(*draw) == 0
    assert tokens(out) == []


def test_html_has_all_steps_linked(net: Path, trace: Path, tmp_path: Path) -> None:
    out = tmp_path / "steps.html"
    assert run("draw", net, "--trace", trace, "-o", out, "--step", 1) == 0
    html = out.read_text(encoding="utf-8")
    assert "<script" not in html
    sections = re.findall(r'<section id="step-(\d)" class="step( chosen)?"', html)
    assert sections == [("0", ""), ("2", ""), ("3", ""), ("1", " chosen")]
    assert html.count("<svg") == 4 * 3
    assert set(re.findall(r'href="#([^"]+)"', html)) == {f"step-{n}" for n in range(4)}
    assert "Step 2 of 3: Top.Right.Eat" in html and "1`7" in html


def test_only_what_a_step_is_about_when_there_would_be_too_much(
    net: Path, trace: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "steps.html"
    monkeypatch.setattr("pn2code.verify.report.steps_page.MOST_FIGURES", 11)
    assert run("draw", net, "--trace", trace, "-o", out) == 0
    # Two figures with each step, three with the last one; the start is about nothing.
    html = out.read_text(encoding="utf-8")
    assert html.count("<svg") == 2 + 2 + 3 and html.count("No page is drawn here") == 1
    monkeypatch.setattr("pn2code.verify.report.steps_page.MOST_FIGURES", 3)
    assert run("draw", net, "--trace", trace, "-o", out) == 0
    html = out.read_text(encoding="utf-8")
    assert html.count("<svg") == 3 and html.count("No page is drawn here") == 3


def test_what_is_no_trace_of_the_net(
    net: Path, trace: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    draw = ("draw", net, "-o", tmp_path / "x.svg", "--format", "concise")
    assert run(*draw, "--trace", trace, "--step", 4) == 2
    assert "has no step 4" in capsys.readouterr().err
    assert run(*draw, "--step", 1) == 2
    assert "needs `--trace`" in capsys.readouterr().err
    assert run(*draw, "--trace", tmp_path / "no.jsonl") == 2
    assert "draw-trace" in capsys.readouterr().err
    trace.write_text(trace.read_text().replace("Left", "Middle"))
    assert run(*draw, "--trace", trace) == 2
    assert "no transition `Top.Middle.Eat`" in capsys.readouterr().err


@pytest.mark.cc
def test_pictures_of_a_state_space(
    net: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    graph, plot, told = tmp_path / "graph.html", tmp_path / "plot.svg", []
    turn_to = Line.turn_to
    monkeypatch.setattr(
        Line, "turn_to", lambda line, text: (told.append(text), turn_to(line, text))
    )
    assert run("verify", net, "-q", "--draw", graph, "--plot", plot) == 0
    assert "drawing the pictures" in told, "thousands of nodes take seconds"
    html = graph.read_text(encoding="utf-8")
    assert html.count('class="node') == 6 and len(re.findall(r'<tr id="arc-', html)) == 7
    assert etree.parse(plot).getroot().tag == f"{SVG}svg"
    assert (
        run("draw", net, "--trace", "twice.traces/twice.dead-6.trace.jsonl", "-o", "steps.html")
        == 0
    )
    assert run("verify", net, "--draw", "graph.pdf") == 2
