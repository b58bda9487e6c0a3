"""The verbs `check`, `marking`, `enabled`, `replay`, from the command line: shapes, exit codes, odd input."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from helpers.netbuilder import write
from pn2code.cli import main
from pn2code.diagnostics import Diagnostics
from pn2code.engine_comparison.compare import paths
from pn2code.net.front import load

NET = """
    net Cell
      standard
      colset P = product INT * STRING;  colset T = int timed;
      var n: INT;  var s: STRING;  var t: T;
      page Top
        place Buffer : P = 1`(1,"a") ++ 2`(~2,"b")
        place Later : T = 1`5@3
        place "" : INT
        place "Two Lines" : INT
        place Shared fusion F : INT = 1`7
        place Out : INT
        trans Pick guard [n > 0]
          in Buffer : (n, s)
          out Out : n
        subst Left = Sub (Inp -> Out)
        subst Right = Sub (Inp -> Out)
      page Sub
        place Inp port in : INT
        place Again fusion F : INT = 1`7
        place Own : INT
        trans Move
          in Inp : n
          out Own : n
"""
BROKEN = """
    net Broken
      standard
      colset L = list NOPE;
      var n: INT;
      page Top
        place A : INT = "a"
        place B : COLOUR
        place C : INT
        trans T guard [n]
          in A : n
          out C : n ^ "x"
        trans U
          in C : m
        subst S = Gone ()
"""


class Done(NamedTuple):
    code: int
    out: str
    err: str

    @property
    def data(self) -> Any:
        return json.loads(self.out)


class Cli:
    def __init__(self, capsys: pytest.CaptureFixture[str]) -> None:
        self.capsys = capsys

    def __call__(self, *arguments: object) -> Done:
        with pytest.raises(SystemExit) as left:
            main.app([str(a) for a in arguments])
        printed = self.capsys.readouterr()
        code = left.value.code
        return Done(code if isinstance(code, int) else 0, printed.out, printed.err)


@pytest.fixture
def cli(capsys: pytest.CaptureFixture[str]) -> Cli:
    return Cli(capsys)


@pytest.fixture
def net(tmp_path: Path) -> Path:
    path = tmp_path / "cell.cpn"
    write(NET, path)
    text = path.read_text(encoding="iso-8859-1")
    path.write_text(text.replace("Two Lines", "Two\nLines"), encoding="iso-8859-1")
    return path


def rows(data: Any) -> dict[tuple[str, int, str], str]:
    return {(r["page"], r["instance"], r["name"]): r["marking"] for r in data["places"]}


# --- check -----------------------------------------------------------------------------------------


def test_check(cli: Cli, net: Path) -> None:
    done = cli("check", net, "--json")
    assert done.code == 0
    assert done.data == {
        "file": str(net), "ok": True, "pages": 2, "places": 9, "transitions": 4, "arcs": 6,
        "diagnostics": done.data["diagnostics"],
    }  # fmt: skip
    assert f"{net}: 2 pages, 9 places, 4 transitions, 6 arcs: no errors" in cli("check", net).out


def test_check_reports_every_wrong_element_and_counts_all(cli: Cli, tmp_path: Path) -> None:
    path = tmp_path / "broken.cpn"
    write_broken(path)
    done = cli("check", path, "--json")
    assert done.code == 1
    data = done.data
    assert (data["ok"], data["places"], data["transitions"], data["arcs"]) == (False, 3, 3, 3)
    errors = [i for i in data["diagnostics"] if i["severity"] == "error"]
    assert {frozenset(i) for i in errors} == {
        frozenset(
            ("severity", "code", "message", "page", "element", "id", "line", "column", "hint")
        )
    }
    assert {i["code"] for i in errors} >= {
        "unknown-colour-set", "place-colset", "subpage-unknown", "unbound-identifier"
    }  # fmt: skip
    assert all(i["id"].startswith("ID") and i["line"] for i in errors)
    assert len({i["id"] for i in errors}) >= 7


def write_broken(path: Path) -> None:
    """A net with a substitution transition whose page is gone."""
    write(BROKEN.replace("subst S = Gone ()", "subst S = Other ()") + "      page Other\n", path)
    text = path.read_text(encoding="iso-8859-1")
    path.write_text(re.sub(r'subpage="[^"]*"', 'subpage="ID999"', text), encoding="iso-8859-1")


def test_a_terminal_gets_a_sensible_number(cli: Cli, tmp_path: Path) -> None:
    path = tmp_path / "many.cpn"
    lines = "".join(f"\n        place P{i} : INT = x{i}" for i in range(200))
    write(f"net Many\n      standard\n      page Top{lines}", path)
    done = cli("check", path)
    assert "There are 140 more" in done.err
    assert done.err.count("error[") == 60
    assert "200 errors" in done.out
    assert len(cli("check", path, "--json").data["diagnostics"]) == 200


@pytest.mark.parametrize("verb", ["check", "marking", "enabled"])
def test_files_that_are_no_nets(cli: Cli, verb: str, tmp_path: Path) -> None:
    missing = cli(verb, tmp_path / "none.cpn", "--json")
    assert missing.code == 2
    text = tmp_path / "text.cpn"
    text.write_text("no XML")
    assert cli(verb, text, "--json").code == 1
    empty = tmp_path / "empty.cpn"
    empty.write_bytes(b"")
    assert cli(verb, empty).code == 1


def test_check_of_what_is_missing_still_has_the_shape(cli: Cli, tmp_path: Path) -> None:
    data = cli("check", tmp_path / "none.cpn", "--json").data
    assert (data["ok"], data["pages"], data["arcs"]) == (False, 0, 0)
    assert [i["code"] for i in data["diagnostics"]] == ["file-missing"]


def test_what_cannot_run_here_is_a_warning_and_refuses_a_supervisor(
    cli: Cli, tmp_path: Path
) -> None:
    path = tmp_path / "sockets.cpn"
    write(
        """
        net Sockets
          standard
          page Top
            place A : UNIT = 1`()
            trans T code action ConnManagementLayer.closeConnection "c"
              in A : ()
        """,
        path,
    )
    done = cli("check", path, "--json")
    assert done.code == 0
    (warning,) = [i for i in done.data["diagnostics"] if i["severity"] == "warning"]
    assert warning["code"] == "unsupported-function"
    assert warning["element"] == "transition `T`"
    assert cli("check", path).out.endswith(
        "1 page, 1 place, 1 transition, 1 arc: no errors, 1 warning\n"
    )
    assert cli("enabled", path).code == 0
    refused = cli("generate", path, "-o", tmp_path / "out")
    assert refused.code == 1
    assert "error[unsupported-function]" in refused.err
    assert not (tmp_path / "out").exists()


# --- marking and enabled ---------------------------------------------------------------------------


def test_marking(cli: Cli, net: Path) -> None:
    data = cli("marking", net, "--json").data
    assert data["time"] == 0
    found = rows(data)
    assert found["Top", 1, "Buffer"] == '2`((~2),"b")++\n1`(1,"a")'
    assert found["Top", 1, "Later"] == "1`5@3"
    assert found["Sub", 2, "Own"] == "empty"
    assert found["Sub", 2, "Again"] == found["Sub", 1, "Again"] == found["Top", 1, "Shared"]
    assert ("Top", 1, "") in found
    assert found["Top", 1, "Two\nLines"] == "empty"
    *places, fusion = data["places"]
    assert all(set(r) == {"page", "instance", "name", "id", "marking"} for r in places)
    assert fusion == {
        "page": "", "instance": 1, "name": fusion["id"], "id": fusion["id"], "fusion": "F", "marking": "1`7",
    }  # fmt: skip


def test_marking_for_people(cli: Cli, net: Path) -> None:
    out = cli("marking", net).out
    assert out.splitlines()[:5] == [
        "time 0",
        "",
        "Top",
        '  Buffer  2`((~2),"b")++',
        '          1`(1,"a")',
    ]
    assert "Sub 2" in out
    assert "places are empty" in out
    assert "Own" not in out
    assert "  Two Lines  empty" in cli("marking", net, "--empty").out


def test_enabled(cli: Cli, net: Path) -> None:
    data = cli("enabled", net, "--json").data
    (element,) = data["enabled"]
    assert element.pop("id").startswith("ID")
    assert element == {
        "page": "Top",
        "instance": 1,
        "transition": "Pick",
        "binding": {"n": "1", "s": '"a"'},
    }
    assert cli("enabled", net).out.splitlines()[2:] == ["Pick (Top)", '  n = 1, s = "a"']


def test_an_error_of_the_net_is_a_diagnostic(cli: Cli, tmp_path: Path) -> None:
    path = tmp_path / "div.cpn"
    write("net D\n      standard\n      page Top\n        place A : INT = 1`(1 div 0)", path)
    done = cli("marking", path, "--json")
    assert done.code == 1
    assert "raised the exception `Div`" in done.err


def test_wide_integers(cli: Cli, tmp_path: Path) -> None:
    path = tmp_path / "wide.cpn"
    write("net W\n      standard\n      page Top\n        place A : INT = 1`(1073741823 + 1)", path)
    assert "Overflow" in cli("marking", path).err
    assert rows(cli("marking", path, "--json", "--int-bits", "64").data)["Top", 1, "A"] == (
        "1`1073741824"
    )
    assert cli("marking", path, "--int-bits", "7").code == 2


# --- replay ----------------------------------------------------------------------------------------


def recorded(net: Path, tmp_path: Path, *steps: dict[str, Any], **more: Any) -> Path:
    path = tmp_path / "run.json"
    path.write_text(json.dumps({"net": net.name, "steps": steps, **more}, indent=0))
    return path


def head(net: Path) -> dict[str, Any]:
    """The header of a trace."""
    digest = hashlib.sha256(net.read_bytes()).hexdigest()
    return {
        "trace": 1,
        "net": "cell",
        "source": net.name,
        "digest": digest,
        "by": "simulate",
        "initial": {},
    }


PICK = {"step": 1, "time": "0", "transition": "Pick", "page": "Top", "instance": 1,
        "binding": {"n": "1", "s": '"a"'}}  # fmt: skip
MOVE = {"step": 2, "time": "0", "transition": "Move", "page": "Sub", "instance": 2,
        "binding": {"n": "1"}}  # fmt: skip


def test_replay_of_a_recording(cli: Cli, net: Path, tmp_path: Path) -> None:
    trace = recorded(net, tmp_path, PICK, MOVE, final_time="0")
    done = cli("replay", trace, net, "--json")
    assert done.code == 0
    data = done.data
    assert (data["ok"], data["steps"], data["failed_step"], data["why"], data["time"]) == (
        True, 2, None, "", 0,
    )  # fmt: skip
    assert rows(data)["Sub", 2, "Own"] == "1`1"
    assert rows(data)["Sub", 1, "Own"] == "empty"
    assert "2 steps, each enabled when its turn came" in cli("replay", trace, net).out


def test_replay_says_which_step_fails(cli: Cli, net: Path, tmp_path: Path) -> None:
    trace = recorded(net, tmp_path, PICK, MOVE, MOVE)
    done = cli("replay", trace, net, "--json")
    assert done.code == 1
    assert (done.data["ok"], done.data["steps"], done.data["failed_step"]) == (False, 2, 3)
    assert "lacks 1`1" in done.data["why"]
    assert "step 3 cannot be repeated: `Move`" in cli("replay", trace, net).out


def test_replay_of_a_trace_of_another_net(cli: Cli, net: Path, tmp_path: Path) -> None:
    trace = tmp_path / "run.trace.jsonl"
    header = {**head(net), "net": "other"}
    step = {"step": 1, "t": 0, "transition": "Top.Nope", "binding": {}, "origin": "ID1"}
    trace.write_text("\n".join(map(json.dumps, (header, step))))
    done = cli("replay", trace, net, "--json")
    assert done.code == 1
    assert done.data["why"] == "the net has no such transition; the trace is of net `other`"
    assert done.data["failed_step"] == 1


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "is not a trace"),
        (b"7", "there is no list `steps`"),
        (b"{}", "there is no list `steps`"),
        (b'{"steps": [{}]}', "step 1 has no `transition`"),
        (b"\xff\xfe\x00", "no UTF-8"),
        (b'{"steps": [', "is not a trace"),
        (b"[" * 100_000, "nested too deeply"),
        (b'{"steps": [{"transition": "T", "time": {}}]}', "`time` of step 1"),
    ],
)
def test_files_that_are_no_traces(
    cli: Cli, net: Path, tmp_path: Path, content: bytes, said: str
) -> None:
    trace = tmp_path / "bad.json"
    trace.write_bytes(content)
    done = cli("replay", trace, net, "--json")
    assert done.code == 2
    assert said in done.err
    assert not done.out


def test_replay_of_a_net_with_errors_has_the_shape_too(cli: Cli, tmp_path: Path) -> None:
    broken = tmp_path / "broken.cpn"
    write_broken(broken)
    done = cli("replay", recorded(broken, tmp_path, PICK), broken, "--json")
    assert done.code == 1
    assert (done.data["ok"], done.data["steps"], done.data["failed_step"]) == (False, 0, None)
    assert "errors" in done.data["why"]
    assert "error[" in done.err


def test_traces_that_cannot_be_read(cli: Cli, net: Path, tmp_path: Path) -> None:
    assert cli("replay", tmp_path / "none.json", net).code == 2
    assert cli("replay", tmp_path, net).code == 2
    assert cli("replay", recorded(net, tmp_path, PICK), tmp_path / "none.cpn").code == 2


@pytest.mark.cc
def test_the_compiled_net_repeats_runs(cli: Cli, net: Path, tmp_path: Path) -> None:
    trace = recorded(net, tmp_path, PICK, MOVE, final_time="0")
    done = cli("replay", trace, net, "--engine", "compiled", "--json")
    assert done.code == 0, done.err
    data = done.data
    assert (data["ok"], data["steps"], data["engine"]) == (True, 2, "compiled")
    assert rows(data)["Sub", 2, "Own"] == "1`1"
    own = tmp_path / "own.trace.jsonl"
    flat = load(net, Diagnostics())
    assert flat is not None
    (origin,) = (t.id for t in flat.transitions if t.name == "Top.Pick")
    step = {
        "step": 1,
        "t": 0,
        "transition": "Top.Pick",
        "binding": {"n": 1, "s": "a"},
        "origin": origin,
    }
    own.write_text("\n".join(map(json.dumps, (head(net), step, {**step, "step": 2}))))
    for engine in ("compiled", "reference"):
        refused = cli("replay", own, net, "--engine", engine, "--json")
        assert refused.code == 1
        data = refused.data
        assert (data["ok"], data["steps"], data["failed_step"]) == (False, 1, 2)
        assert rows(data)["Top", 1, "Out"] == "1`1"
        assert "not enabled" in data["why"]


@pytest.mark.cc
def test_ties_that_the_compiled_net_decides_otherwise(cli: Cli, tmp_path: Path) -> None:
    path = tmp_path / "ties.cpn"
    write(
        """
        net Ties
          standard
          colset T = int timed;
          var t: T;
          page Top
            place A : T = 1`1@0 +++ 1`1@3
            place Go : T = 1`7@4
            trans Go
              in Go : 7
              in A : t
        """,
        path,
    )
    place = next(r for r in cli("marking", path, "--json").data["places"] if r["name"] == "A")
    step = {"time": "4", "transition": "Go", "page": "Top", "instance": 1, "binding": {"t": "1"}}
    for left, engine in (("1`1@0", "compiled"), ("1`1@3", "reference")):
        final = [{"id": place["id"], "instance": 1, "marking": left}]
        trace = recorded(path, tmp_path, step, final_marking=final)
        data = cli("replay", trace, path, "--engine", "compiled", "--json").data
        assert (data["ok"], data["engine"]) == (True, engine)
        assert ("stamps" in data["why"]) is (engine == "reference")


@pytest.mark.shared
def test_recordings_of_the_real_engine(cli: Cli, shared: Path) -> None:
    """A dozen of them through the command itself; `test_semantics_corpus` compares all."""
    corpus = shared / "corpus"
    tried = 0
    for path in paths(corpus)[::6]:
        trace = corpus / "traces" / f"{path}.json"
        if not trace.is_file():
            continue
        tried += 1
        done = cli("replay", trace, corpus / "nets" / path, "--json")
        assert done.code == 0, done.out[:500] + done.err
        data = done.data
        final = json.loads(trace.read_text(encoding="utf-8"))["final_marking"]
        ours = {(r["id"], r["instance"]): r["marking"] for r in data["places"]}
        assert {(f["id"], f["instance"]): f["marking"] for f in final}.items() <= ours.items()
        assert data["random"] == bool(data["why"])
    assert tried > 10
