"""`pn2code contest` as the contest calls it: its words, its limits, its errors."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.pnml_nets import arc, net, place, transition
from pn2code.cli.main import app
from pn2code.contest import portfolio
from pn2code.contest.engine import Answer
from pn2code.contest.examinations import Asked, Part
from pn2code.contest.tables import Tables

FORMULAS = """<?xml version="1.0"?>
<property-set xmlns="http://mcc.lip6.fr/">{}</property-set>
"""
PROPERTY = "<property><id>{}</id><description>d</description><formula>{}</formula></property>"
ONE_IN_Q = (
    "<integer-le><integer-constant>1</integer-constant>"
    "<tokens-count><place>q</place></tokens-count></integer-le>"
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two tokens go from p to q, from where one of them can come back."""
    text = net(
        place("p", "", "2"),
        place("q"),
        place("home", "", "1"),
        transition("go"),
        transition("back"),
        arc("p", "go"),
        arc("go", "q"),
        arc("q", "back", "1"),
        arc("home", "back"),
        arc("back", "p"),
        kind="ptnet",
    )
    (tmp_path / "model.pnml").write_text(text)
    return tmp_path


def said(folder: Path, examination: str, *options: str) -> list[str]:
    """The lines that are printed."""
    done = CliRunner().invoke(app, ["contest", str(folder), examination, *options])
    assert done.exit_code == 0, done.output
    return done.stdout.splitlines()


def values(lines: list[str]) -> dict[str, str]:
    """Formula -> what is said of it."""
    return {line.split()[1]: line.split()[2] for line in lines}


def write(folder: Path, examination: str, *formulas: str) -> None:
    """A file of formulas, named a, b, .."""
    named = [PROPERTY.format("abcdefgh"[i], f) for i, f in enumerate(formulas)]
    (folder / f"{examination}.xml").write_text(FORMULAS.format("".join(named)))


@pytest.mark.parametrize(
    ("method", "techniques"),
    [("explore", "EXPLICIT"), ("diagrams", "DECISION_DIAGRAMS"), ("", "")],
)
def test_state_space(folder: Path, method: str, techniques: str) -> None:
    """Two methods can tell; together, whichever is first."""
    lines = said(folder, "StateSpace", *(("--only", method) if method else ()))
    sizes = ["STATES 6", "TRANSITIONS 6", "MAX_TOKEN_IN_PLACE 2", "MAX_TOKEN_PER_MARKING 3"]
    assert [line.partition(" TECHNIQUES ")[0] for line in lines] == [
        f"STATE_SPACE {size}" for size in sizes
    ]
    assert all(line.endswith(techniques) for line in lines)


def test_a_state_space_that_cannot_be_counted(folder: Path) -> None:
    assert said(folder, "StateSpace", "--only", "walk") == ["CANNOT_COMPUTE"]


def test_diagrams_alone(folder: Path) -> None:
    """They answer what is asked of markings, of branching and of linear time."""
    write(folder, "UpperBounds", "<place-bound><place>q</place></place-bound>")
    assert said(folder, "UpperBounds", "--only", "diagrams") == [
        "FORMULA a 2 TECHNIQUES DECISION_DIAGRAMS"
    ]
    assert said(folder, "Liveness", "--only", "diagrams") == [
        "FORMULA Liveness FALSE TECHNIQUES DECISION_DIAGRAMS"
    ]
    write(
        folder,
        "LTLCardinality",
        f"<all-paths><finally><globally>{ONE_IN_Q}</globally></finally></all-paths>",
    )
    assert said(folder, "LTLCardinality", "--only", "diagrams") == [
        "FORMULA a TRUE TECHNIQUES DECISION_DIAGRAMS"
    ]


@pytest.mark.parametrize(
    ("examination", "value"),
    [
        ("ReachabilityDeadlock", "TRUE"),
        ("OneSafe", "FALSE"),
        ("QuasiLiveness", "TRUE"),
        ("Liveness", "FALSE"),
        ("StableMarking", "FALSE"),
    ],
)
def test_examinations_of_the_whole_net(folder: Path, examination: str, value: str) -> None:
    assert values(said(folder, examination)) == {examination: value}


def test_reachability(folder: Path) -> None:
    write(
        folder,
        "ReachabilityCardinality",
        f"<exists-path><finally>{ONE_IN_Q}</finally></exists-path>",
        f"<all-paths><globally>{ONE_IN_Q}</globally></all-paths>",
        f"<all-paths><globally><negation>{ONE_IN_Q}</negation></globally></all-paths>",
    )
    assert values(said(folder, "ReachabilityCardinality")) == {
        "a": "TRUE",
        "b": "FALSE",
        "c": "FALSE",
    }


def test_bounds(folder: Path) -> None:
    bounds = [
        f"<place-bound>{p}</place-bound>"
        for p in ("<place>q</place>", "<place>p</place><place>home</place>")
    ]
    write(folder, "UpperBounds", *bounds)
    assert values(said(folder, "UpperBounds")) == {"a": "2", "b": "3"}


def test_evidence_of_bounds(folder: Path) -> None:
    """After the answers, in a file: no step raises p + q, which is 2 at first."""
    write(folder, "UpperBounds", "<place-bound><place>q</place></place-bound>")
    file = folder / "evidence.jsonl"
    assert values(said(folder, "UpperBounds", "--evidence", str(file))) == {"a": "2"}
    (row,) = map(json.loads, file.read_text().splitlines())
    (case,) = row["certificate"]["cases"]
    assert (row["name"], row["rests_on"]) == ("a", None)
    assert case["if"] == [{"sum": {"q": -1}, "at_most": -3}]
    w = case["weights"]
    assert 0 <= -w["q"] == -w["p"] and "home" not in w
    assert 2 * w["p"] == case["at_first"] > case["at_most"]


def test_paths(folder: Path) -> None:
    """A dead marking goes on for ever; a formula of CTL that asks for reachability is one."""
    write(
        folder,
        "CTLCardinality",
        f"<all-paths><finally>{ONE_IN_Q}</finally></all-paths>",
        f"<all-paths><globally><exists-path><finally>{ONE_IN_Q}</finally></exists-path></globally></all-paths>",
        f"<exists-path><globally><negation>{ONE_IN_Q}</negation></globally></exists-path>",
        f"<negation><exists-path><finally>{ONE_IN_Q}</finally></exists-path></negation>",
    )
    assert values(said(folder, "CTLCardinality")) == {
        "a": "TRUE",
        "b": "TRUE",
        "c": "FALSE",
        "d": "FALSE",
    }
    write(
        folder,
        "LTLCardinality",
        f"<all-paths><finally><globally>{ONE_IN_Q}</globally></finally></all-paths>",
        f"<all-paths><next><next>{ONE_IN_Q}</next></next></all-paths>",
    )
    assert values(said(folder, "LTLCardinality")) == {"a": "TRUE", "b": "FALSE"}


def test_a_method_alone(folder: Path) -> None:
    """What it cannot answer is not known."""
    assert said(folder, "ReachabilityDeadlock", "--only", "reach") == [
        "FORMULA ReachabilityDeadlock TRUE TECHNIQUES STUBBORN_SETS"
    ]
    assert said(folder, "Liveness", "--only", "ltl", "--max-seconds", "5") == [
        "FORMULA Liveness CANNOT_COMPUTE"
    ]


def test_no_time(folder: Path) -> None:
    assert said(folder, "StateSpace", "--max-seconds", "0") == ["CANNOT_COMPUTE"]


def test_nets_that_the_engine_does_not_have(tmp_path: Path) -> None:
    """Nothing is said of them but that."""
    text = net(
        place("p", "", "2"),
        transition("t"),
        arc("p", "t", kind="inhibitor"),
        kind="ptnet",
    )
    (tmp_path / "model.pnml").write_text(text)
    done = CliRunner().invoke(app, ["contest", str(tmp_path), "ReachabilityDeadlock"])
    assert done.exit_code == 0 and done.stdout == "CANNOT_COMPUTE\n"
    assert "inhibitor arcs" in done.stderr


def test_methods_that_contradict_each_other(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is an error of the program, and no answer."""

    def contradicting(
        program: Path, lanes: object, said: object, **more: object
    ) -> Iterator[Answer]:
        del program, lanes, said, more
        yield Answer(0, True, True, "ONE")
        yield Answer(0, False, True, "OTHER")

    monkeypatch.setattr(portfolio, "ask", contradicting)
    tables = Tables((1,), ({0: 1},), ({},), {"p": (0,)}, {"t": (0,)})
    lines = [Asked(name, (Part("reach", "reach dead"),)) for name in "ab"]
    with pytest.raises(RuntimeError, match="a: OTHER contradicts"):
        list(portfolio.answers(folder, tables, lines, seconds=1.0, only="walk"))


def test_wrong_inputs(folder: Path, tmp_path: Path) -> None:
    """Each is said where it is."""
    runner = CliRunner()
    missing = runner.invoke(app, ["contest", str(folder), "CTLCardinality"])
    assert missing.exit_code == 1 and "CTLCardinality.xml: No such file" in missing.output
    assert missing.stdout == "CANNOT_COMPUTE\n"
    write(folder, "CTLCardinality", "<all-paths><sometimes/></all-paths>")
    unknown = runner.invoke(app, ["contest", str(folder), "CTLCardinality"])
    assert unknown.exit_code == 0 and "a: line 2: `sometimes` is not known" in unknown.output
    assert "FORMULA a CANNOT_COMPUTE" in unknown.output
    write(
        folder,
        "CTLFireability",
        "<all-paths><globally><is-fireable><transition>no</transition></is-fireable></globally></all-paths>",
    )
    stranger = runner.invoke(app, ["contest", str(folder), "CTLFireability"])
    assert stranger.exit_code == 0 and "a: the net has no `no`" in stranger.output
    assert "FORMULA a CANNOT_COMPUTE" in stranger.output
    (folder / "model.pnml").write_text("<pnml>")
    damaged = runner.invoke(app, ["contest", str(folder), "StateSpace"])
    assert damaged.exit_code == 1 and damaged.stdout == "CANNOT_COMPUTE\n"
    assert runner.invoke(app, ["contest", str(folder), "Everything"]).exit_code == 2


@pytest.mark.parametrize(
    ("formula", "why"),
    [
        ("<integer-le><integer-constant>1</integer-constant></integer-le>", "not two"),
        (
            "<integer-le><integer-constant>x</integer-constant>"
            "<integer-constant>1</integer-constant></integer-le>",
            "`x` is no number",
        ),
        (f"<until><before>{ONE_IN_Q}</before></until>", "not two"),
        (f"<until><reach>{ONE_IN_Q}</reach><before>{ONE_IN_Q}</before></until>", "needs `before`"),
        (f"<until>{ONE_IN_Q}{ONE_IN_Q}</until>", "needs `before`"),
    ],
)
def test_formulas_that_are_wrong(folder: Path, formula: str, why: str) -> None:
    """A clear error, and no answer; the others are answered all the same."""
    right = f"<all-paths><finally>{ONE_IN_Q}</finally></all-paths>"
    write(folder, "CTLCardinality", f"<all-paths>{formula}</all-paths>", right)
    done = CliRunner().invoke(app, ["contest", str(folder), "CTLCardinality"])
    assert done.exit_code == 0 and done.stderr.startswith("pn2code: a: line 2: ")
    assert why in done.stderr
    assert values(done.stdout.splitlines()) == {"a": "CANNOT_COMPUTE", "b": "TRUE"}


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("<id>b</id>", "<id>a</id>", "a: several formulas have this name"),
        ("<id>b</id>", "<id/>", "line 2: a property without an id"),
        ("<formula>", "<no>", "a: line 2: a property without a formula"),
    ],
)
def test_properties_that_are_wrong(folder: Path, old: str, new: str, why: str) -> None:
    """Two formulas of one name would be two answers to one question."""
    right = f"<all-paths><finally>{ONE_IN_Q}</finally></all-paths>"
    write(folder, "CTLCardinality", right, f"<negation>{right}</negation>")
    path = folder / "CTLCardinality.xml"
    text = path.read_text().replace(old, new)
    path.write_text(text.replace("</formula>", "</no>") if new == "<no>" else text)
    done = CliRunner().invoke(app, ["contest", str(folder), "CTLCardinality"])
    assert why in done.stderr and "TRUE" not in done.stdout and "FALSE" not in done.stdout


def test_formulas_of_another_kind_are_not_known(folder: Path) -> None:
    """The others are answered all the same."""
    write(
        folder,
        "LTLCardinality",
        f"<all-paths><finally>{ONE_IN_Q}</finally></all-paths>",
        f"<all-paths><finally><exists-path>{ONE_IN_Q}</exists-path></finally></all-paths>",
        "<all-paths><finally><is-fireable><transition>?</transition></is-fireable></finally></all-paths>",
    )
    unknown = "CANNOT_COMPUTE"
    assert values(said(folder, "LTLCardinality")) == {"a": "TRUE", "b": unknown, "c": unknown}


def test_the_initial_marking_decides(folder: Path) -> None:
    """No method is needed."""
    true = f"<finally><negation>{ONE_IN_Q}</negation></finally>"
    for examination in ("CTLCardinality", "LTLCardinality"):
        write(folder, examination, f"<all-paths>{true}</all-paths>")
        lines = said(folder, examination, "--only", "walk")
        assert lines == ["FORMULA a TRUE TECHNIQUES REWRITING"]


def test_deep_formulas(folder: Path) -> None:
    """However deep: an answer, or a clear error."""
    for depth in (100, 3000):
        negations = "<negation>" * depth + ONE_IN_Q + "</negation>" * depth
        write(folder, "CTLCardinality", f"<all-paths><finally>{negations}</finally></all-paths>")
        done = CliRunner().invoke(app, ["contest", str(folder), "CTLCardinality"])
        assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
        assert (done.exit_code, bool(done.stderr)) in ((0, False), (1, True))


def test_what_is_said_of_the_initial_marking_alone(folder: Path) -> None:
    """Formulas of linear time may have parts that speak of no path."""
    none = f"<negation>{ONE_IN_Q}</negation>"
    later = f"<all-paths><finally>{ONE_IN_Q}</finally></all-paths>"
    write(folder, "LTLCardinality", ONE_IN_Q, none, f"<conjunction>{none}{later}</conjunction>")
    lines = said(folder, "LTLCardinality", "--max-seconds", "20")
    assert values(lines) == {"a": "FALSE", "b": "TRUE", "c": "TRUE"}


def test_a_reduced_net_that_the_engine_cannot_read_is_not_asked(tmp_path: Path) -> None:
    """Joined steps multiply weights, and put more tokens into a place than the engine counts."""
    text = net(
        place("p", "", "4000000"),
        place("q"),
        place("a", "", "1"),
        place("b"),
        transition("fill"),
        transition("there"),
        transition("back"),
        arc("p", "fill"),
        arc("fill", "q", "400"),
        arc("q", "there"),
        arc("a", "there"),
        arc("there", "b"),
        arc("b", "back"),
        arc("back", "a"),
        kind="ptnet",
    )
    (tmp_path / "model.pnml").write_text(text)
    one_in_a = ONE_IN_Q.replace("q", "a")
    write(
        tmp_path,
        "CTLCardinality",
        f"<all-paths><finally><negation>{one_in_a}</negation></finally></all-paths>",
        f"<exists-path><globally>{one_in_a}</globally></exists-path>",
    )
    lines = said(tmp_path, "CTLCardinality", "--max-seconds", "2")
    assert set(values(lines)) == {"a", "b"}
    assert Tables((1 << 30,), ({0: 1},), ({},), {}, {}).fits()
    assert not Tables((0,), ({0: 1},), ({0: (1 << 30) + 1},), {}, {}).fits()


def test_more_tokens_than_are_made(tmp_path: Path) -> None:
    """The front end makes each token; what is read straight into tables is only a number."""
    for tokens, wanted in (("Default,6000000", "CANNOT_COMPUTE\n"), ("6000000", "TRUE")):
        text = net(place("p", "", tokens), transition("t"), arc("p", "t"), kind="ptnet")
        (tmp_path / "model.pnml").write_text(text)
        done = CliRunner().invoke(app, ["contest", str(tmp_path), "ReachabilityDeadlock"])
        assert done.exit_code == 0 and wanted in done.stdout
        assert ("the initial marking cannot be made" in done.stderr) == (wanted != "TRUE")


def test_numbers_that_the_engine_does_not_read(tmp_path: Path) -> None:
    """Equations and reductions have no limit; what they do not know is not known."""
    text = net(
        place("p", "", "10000000000"),
        place("q"),
        transition("go"),
        arc("p", "go"),
        arc("go", "q"),
        kind="ptnet",
    )
    (tmp_path / "model.pnml").write_text(text)
    assert values(said(tmp_path, "ReachabilityDeadlock")) == {"ReachabilityDeadlock": "TRUE"}
    assert values(said(tmp_path, "OneSafe")) == {"OneSafe": "FALSE"}
    assert said(tmp_path, "StateSpace") == ["CANNOT_COMPUTE"]
    assert said(tmp_path, "QuasiLiveness", "--only", "walk") == [
        "FORMULA QuasiLiveness CANNOT_COMPUTE"
    ]
    bounds = [f"<place-bound>{p}</place-bound>" for p in ("<place>p</place>", "<place>q</place>")]
    write(tmp_path, "UpperBounds", *bounds)
    assert values(said(tmp_path, "UpperBounds")) == {"a": "10000000000", "b": "CANNOT_COMPUTE"}
