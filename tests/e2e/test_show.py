"""`pn2code show`, and the page that `pn2code run` writes."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
import trimesh

from helpers import netbuilder
from helpers.shown import PAIR, recorded
from pn2code.cli import main
from pn2code.replay import three
from pn2code.trace import whole_lines


def pn2code(*arguments: object) -> int:
    with pytest.raises(SystemExit) as left:
        main.app(list(map(str, arguments)))
    return int(left.value.code or 0)


@pytest.fixture(scope="module")
def run(root: Path, tmp_path_factory: pytest.TempPathFactory, quick_build: None) -> Path:
    out = tmp_path_factory.mktemp("shown") / "run"
    cell = root / "examples/minimal"
    assert pn2code("run", cell, "--backend", "fake", "--no-pictures", "--unchecked", "-o", out) == 0
    return out


@pytest.mark.cc
class TestRun:
    """The smallest cell, run once."""

    def test_the_folder_has_the_page_and_its_description(self, run: Path) -> None:
        text = (run / "replay.html").read_text(encoding="utf-8")
        assert text.startswith("<!DOCTYPE html>") and "SPDX-License-Identifier: MIT" in text
        described = json.loads((run / "run.json").read_text(encoding="utf-8"))
        assert described["pn2code"] == {"run": 2}
        assert described["kind"] == "run" and described["verdict"]["word"] == "finished"
        assert [r["name"] for r in described["cell"]["robots"]] == list(described["motion"])

    def test_show_writes_the_same_page_again(self, run: Path, tmp_path: Path) -> None:
        assert pn2code("show", run, "-o", tmp_path / "again.html") == 0
        assert (tmp_path / "again.html").read_bytes() == (run / "replay.html").read_bytes()

    def test_a_run_beside_itself_has_no_difference(self, run: Path, tmp_path: Path) -> None:
        file = tmp_path / "both.html"
        assert pn2code("show", run, "--compare", run, "-o", file) == 0
        assert (
            '"differences":{"step":null,"message":null,"pose":null,"end":null,' in file.read_text()
        )

    def test_its_trace_alone_is_shown_in_seconds(
        self, run: Path, root: Path, tmp_path: Path
    ) -> None:
        described = tmp_path / "trace.json"
        trace, cell = next(run.glob("*[!r].trace.jsonl")), root / "examples/minimal"
        options = ("-o", tmp_path / "a.html", "--description", described)
        assert pn2code("show", trace, cell, *options) == 0
        found = json.loads(described.read_text(encoding="utf-8"))
        whole = json.loads((run / "run.json").read_text(encoding="utf-8"))
        assert (found["clock"], found["cell"]) == ("seconds", None)
        assert found["course"] == whole["course"]
        assert found["end"] == whole["end"]

    def test_without_three_js_a_run_has_a_page_all_the_same(
        self, run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        missing = replace(three.LIBRARY, package="a_package_that_is_not_there")
        monkeypatch.setattr(three, "LIBRARY", missing)
        assert pn2code("show", run, "-o", tmp_path / "flat.html") == 0
        assert "three.js r130 is not installed: pip install" in (tmp_path / "flat.html").read_text()

    def test_the_cell_as_gltf(self, run: Path, tmp_path: Path) -> None:
        assert pn2code("show", run, "-o", tmp_path / "cell.glb") == 0
        scene = trimesh.load(tmp_path / "cell.glb")
        (robot,) = json.loads((run / "run.json").read_text())["cell"]["robots"]
        names = {name for link in robot["links"] for name in [f"{robot['name']}/{link['name']}"]}
        assert names <= set(scene.graph.nodes) and len(scene.geometry) > 5
        high = scene.bounds[:, 1]
        assert high[0] < 0.1 and 1.0 < high[1] < 4.0, "y is above"

    def test_a_gltf_has_one_run_with_arms(self, run: Path, tmp_path: Path) -> None:
        glb = tmp_path / "cell.glb"
        assert pn2code("show", run, "--compare", run, "-o", glb) == 2
        net = netbuilder.write(PAIR, tmp_path / "net.cpn")
        trace = recorded(net, tmp_path / "a.trace.jsonl", 20)
        assert pn2code("show", trace, net, "-o", glb) == 2
        assert not glb.exists()

    def test_no_page_where_none_is_wanted(self, root: Path, tmp_path: Path) -> None:
        cell, flags = root / "examples/minimal", ("--no-pictures", "--unchecked", "--no-replay")
        (tmp_path / "replay.html").write_text("of an earlier run")
        assert pn2code("run", cell, "--backend", "fake", *flags, "-o", tmp_path) == 0
        assert not (tmp_path / "replay.html").exists() and not (tmp_path / "run.json").exists()


@pytest.fixture
def trace(tmp_path: Path) -> Path:
    return recorded(netbuilder.write(PAIR, tmp_path / "net.cpn"), tmp_path / "a.trace.jsonl", 20)


def test_a_long_trace_is_shown_in_part(trace: Path, tmp_path: Path) -> None:
    described = tmp_path / "a.json"
    options = ("--steps", 5, "--description", described, "-o", tmp_path / "a.html")
    assert pn2code("show", trace, tmp_path / "net.cpn", *options) == 0
    found = json.loads(described.read_text(encoding="utf-8"))
    assert found["course"]["steps"] == 5
    assert found["verdict"]["word"] == "cut"


def test_a_trace_of_another_net_is_shown_as_far_as_it_goes(
    trace: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = netbuilder.write(PAIR.replace("[n < 40]", "[n < 3]"), tmp_path / "other.cpn")
    assert pn2code("show", trace, other, "-o", tmp_path / "a.html") == 1
    assert "the next is not possible in this net" in capsys.readouterr().err
    assert (tmp_path / "a.html").is_file()


def test_a_second_run_that_is_not_possible_is_said(
    trace: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = trace.read_text().splitlines()
    other = tmp_path / "b.trace.jsonl"
    again = lines[10].replace('"step": 10,', '"step": 11,')
    other.write_text("\n".join([*lines[:11], again, *lines[12:]]))
    options = ("--compare", other, "-o", tmp_path / "both.html")
    assert pn2code("show", trace, tmp_path / "net.cpn", *options) == 1
    out, err = capsys.readouterr()
    assert "first other step 11: Top." in out
    assert "in the second run the next step is not possible" in out
    assert "the second run is shown to step 10" in err


def test_what_cannot_be_shown_is_said(
    trace: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    net = tmp_path / "net.cpn"
    (tmp_path / "text.jsonl").write_text("hello\n")
    (tmp_path / "empty").mkdir()
    for arguments, why in (
        ((trace,), "no net is named"),
        ((tmp_path / "missing.jsonl", net), "cannot read"),
        ((tmp_path / "missing",), "cannot read"),
        ((tmp_path / "text.jsonl",), "neither the folder of a run nor a trace"),
        ((tmp_path / "text.jsonl", net), "neither the folder of a run nor a trace"),
        ((tmp_path / "empty",), "`pn2code run` writes it"),
        ((trace, net, "-o", tmp_path), "cannot write"),
    ):
        assert pn2code("show", *arguments) == 2
        assert why in " ".join(capsys.readouterr().err.split())


def test_a_trace_that_grows_for_ever_is_not_read_to_its_end(tmp_path: Path) -> None:
    """Of a very large trace only the steps that are shown are read."""
    net = netbuilder.write(PAIR, tmp_path / "net.cpn")
    file = recorded(net, tmp_path / "a.trace.jsonl", 20)
    with file.open("a", encoding="utf-8") as more:
        more.write("this is not a line of a trace\n" * 1000)
    assert pn2code("show", file, net, "--steps", 10, "-o", tmp_path / "a.html") == 0


def test_a_line_without_an_end_is_not_read(
    trace: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a gigabyte in one line nothing is kept, and nothing of it is told but its beginning."""
    monkeypatch.setattr(whole_lines, "LONGEST", 20_000)
    lines = trace.read_text().splitlines()
    long = lines[1].replace('"transition": "', '"transition": "' + "x" * 30_000)
    page = trace.with_suffix(".html")
    for text, most in ((f"{lines[0]}\n{long}\n", 6_000), (f"{lines[0]}\n{'x' * 10_000}\n", 6_000)):
        trace.write_text(text)
        assert pn2code("show", trace, trace.with_name("net.cpn"), "-o", page) == 1
        told = capsys.readouterr().err
        assert "is shown to step 0" in told and len(told) < most and "(: " not in told
        for engine, code in (("reference", 1), ("compiled", 2)):
            arguments = ("replay", trace, trace.with_name("net.cpn"), "--engine", engine)
            assert pn2code(*arguments) == code
            told = "".join(capsys.readouterr())
            assert "cannot be repeated" in told and "JSON" in told and len(told) < most


@pytest.mark.parametrize("moment", ["1e999", "NaN", "-1e999", "true", "1" + "0" * 400])
def test_moments_that_no_axis_has_are_passed_over(trace: Path, moment: str) -> None:
    text = trace.read_text().replace('"by": "reference"', '"by": "run"')
    trace.write_text(text.replace('"t": 0', f'"t": {moment}'))
    page = trace.with_suffix(".html")
    assert pn2code("show", trace, trace.with_name("net.cpn"), "-o", page) == 1
    assert 'id="data"' in page.read_text(encoding="utf-8")


def test_a_damaged_description_is_refused(
    trace: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    described, page = tmp_path / "run.json", tmp_path / "a.html"
    options = ("-o", page, "--description", described)
    assert pn2code("show", trace, trace.with_name("net.cpn"), *options) == 0
    whole = described.read_text(encoding="utf-8")
    data = json.loads(whole)
    packed = data["course"]["transition"]["deflate"]
    for old, new, said in (
        (f'"end":{data["end"]}', '"end":NaN', "`NaN` is no number of JSON"),
        (f'"end":{data["end"]}', '"end":1e999', "the number `1e999` is too large"),
        (packed, "AAAA", "the description of a run is damaged: not a packed array"),
        ('"refused":null', '"refused":[1]', "its `course.refused` does not say which step"),
        ('"refused":null', '"refused":{"step":"x","transition":"T","why":""}', "`course.refused`"),
        ('"steps":20', '"steps":2000', "its `course.steps` is not the number of its steps"),
        ('"final":[]', '"final":"Top.A"', "its `verdict.final` is no list of names"),
    ):
        assert old in whole
        described.write_text(whole.replace(old, new, 1), encoding="utf-8")
        assert pn2code("show", described, "--compare", described, "-o", page) == 2
        assert said in " ".join(capsys.readouterr().err.split())
