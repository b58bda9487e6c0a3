"""Conditions on bindings, `fires(T, { n = 3 })`: known answers, another judge, runs that are runs of the net."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from helpers import record_list_cell
from helpers.asked import Net
from helpers.netbuilder import write
from helpers.processes import pn2code
from pn2code.properties.judge import Graph
from pn2code.properties.split import MOST, NoSplitError, Split, groups
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.graph import state_space
from pn2code.semantics.game.token_game import Game

pytestmark = pytest.mark.cc

DRILLING = """
    net Drilling
      standard
      colset HOLE = int with 1..3;
      colset WHO = with left | right;
      var h : HOLE; var w : WHO; var n : INT;
      val worn = 2;
      place Plan : HOLE = HOLE.all ()
      place Done : HOLE
      place Tool : WHO = 1`left ++ 1`right
      place Wear : INT = 1`0
      trans Drill
        in Plan : h
        both Tool : w
        in Wear : n
        out Wear : n + 1
        out Done : h
      trans Again guard [n < 4]
        in Done : 2
        in Wear : n
        out Wear : n + 1
        out Plan : 2
"""
ROWS = [
    ("ltl F fires(Drill, { h = 1 })", "yes", None),
    ("ltl F fires(Drill, { h = 1 andalso w = left })", "no", None),
    ("ltl G (fires(Drill, { h = 1 }) -> X G !fires(Drill, { h = 1 }))", "yes", None),  # none twice
    ("ltl G (fires(Drill, { h = 2 }) -> X G !fires(Drill, { h = 2 }))", "no", None),
    ("ltl G !fires(Drill, { n > worn })", "no", None),
    ("ltl G !fires(Drill, { n > 6 })", "yes", None),
    ("ltl (!fires(Drill, { h = 3 })) W fires(Drill, { h = 1 })", "no", None),
    ("every fires(Again) is followed by fires(Drill, { h = 2 })", "yes", None),
    ("every fires(Again) is followed by fires(Drill, { h = 2 }) within 3 firings", "yes", 3),
    ("every fires(Again) is followed by fires(Drill, { h = 2 }) within 2 firings", "no", 3),
    ("every fires(Drill, { h = 1 }) is followed by fires(Drill, { h = 3 }) within 9 firings", "no", None),
    ("ltl F fires(Drill, { w = left }) assuming strong Drill", "no", None),
    ("ltl F dead", "yes", None),
    ("every fires(Drill) || fires(Again) is followed by dead within 6 firings", "yes", 6),
]  # fmt: skip


def asked(net: Path, folder: Path, *options: object) -> tuple[int, dict[str, Any]]:
    done = pn2code("verify", net, "--json", "--no-found", "--traces", folder, *options)
    return done.returncode, json.loads(done.stdout)


def test_known_answers(tmp_path: Path) -> None:
    net = write(DRILLING, tmp_path / "drilling.cpn")
    options = [x for text, _, _ in ROWS for x in ("--property", text)]
    code, said = asked(net, tmp_path, *options)
    found = [(p["holds"], p["answer"], p["value"]) for p in said["properties"]]
    assert code == 1
    assert [f for f, row in zip(found, ROWS, strict=True) if f != row] == []
    for p in said["properties"]:
        if p["evidence"] is not None:  # a run of the net itself
            done = pn2code("replay", p["evidence"]["trace"], net)
            assert done.returncode == 0, done.stdout


def test_tokens_with_odd_characters(tmp_path: Path) -> None:
    net = write(
        """
        net Odd
          standard
          var s : STRING;
          place A : STRING = 1`"a\\194\\133b" ++ 1`"\\226\\128\\168" ++ 1`"\\133\\r"
          place B : STRING
          trans Go
            in A : s
            out B : s
        """,
        tmp_path / "odd.cpn",
    )
    code, said = asked(net, tmp_path, "--property", "ltl G !fires(Go, { String.size s > 3 })")
    evidence = said["properties"][0]["evidence"]
    assert code == 1
    done = pn2code("replay", evidence["trace"], net)
    assert done.returncode == 0, done.stdout + done.stderr
    text = Path(evidence["trace"]).read_text(encoding="utf-8", errors="surrogateescape")
    fired = [x for x in map(json.loads, text.rstrip("\n").split("\n")) if "transition" in x]
    assert {x["transition"] for x in fired} == {"Top.Go"}
    assert "a\u00c2\u0085b" in [x["binding"]["s"] for x in fired]


def test_the_parts_are_the_net(tmp_path: Path) -> None:
    net = Net.load(write(DRILLING, tmp_path / "drilling.cpn"))
    properties = net.meaning([text for text, _, _ in ROWS])
    game = Game(net.flat, {}, files=Files(None))
    space = state_space(game, max_nodes=2000)
    answers: dict[str, bool] = {}
    for group in groups(properties):
        split = Split.of(net.flat, properties, group)
        parts = Graph.of(split.net, {}, split.properties)
        assert set(parts.markings) == set(space.nodes)
        assert len(state_space(Game(split.net, {}, files=Files(None)), max_nodes=2000).arcs) == len(
            space.arcs
        )
        answers |= {p.holds: parts.says(p.asked) for p in split.properties.properties}
    assert answers == {text: row == "yes" for text, row, _ in ROWS if "{" in text}
    # That a step occurs somewhere is seen without any parts.
    for step in properties.steps:
        occurs = any(
            a.element.transition == step.transition
            and game.evaluator.value(step.exp, dict(a.element.values)) is True
            for a in space.arcs
        )
        group = net.meaning([f"ltl G !fires(Drill, {{ {step.text} }})"])
        split = Split.of(net.flat, group, group.properties)
        assert (
            Graph.of(split.net, {}, split.properties).says(split.properties.properties[0].asked)
            != occurs
        )


def test_groups(tmp_path: Path) -> None:
    net = Net.load(write(DRILLING, tmp_path / "drilling.cpn"))
    one = [f"ltl G !fires(Drill, {{ n = {i} }})" for i in range(2 * MOST + 1)]
    assert [len(g) for g in groups(net.meaning(one))] == [MOST, MOST, 1]
    many = " && ".join(f"F fires(Drill, {{ n = {i} }})" for i in range(MOST + 1))
    with pytest.raises(NoSplitError, match="`property 1` has more than 4 conditions"):
        list(groups(net.meaning([f"ltl {many}"])))


def test_what_cannot_be_asked(tmp_path: Path) -> None:
    coded = "trans Again guard [n < 4] code output (w); action left"
    text = DRILLING.replace("trans Again guard [n < 4]", coded)
    text = text.replace("out Plan : 2\n", "out Plan : 2\n        both Tool : right\n")
    net = write(text, tmp_path / "code.cpn")
    done = pn2code("verify", net, "--property", "ltl F fires(Again, { w = left })")
    assert done.returncode == 1
    assert "`w` gets its value from the code segment" in done.stderr
    # An exception in a condition leaves it open; everything else is answered.
    raising = ["--property", "ltl G !fires(Drill, { 1 div n = 7 })", "--property", "ltl F dead"]
    code, said = asked(write(DRILLING, tmp_path / "d.cpn"), tmp_path, *raising)
    assert (code, [p["answer"] for p in said["properties"]]) == (3, ["inconclusive", "yes"])


def test_seconds_between_steps_of_a_cell(tmp_path: Path) -> None:
    """The parts of transitions have numbers that the cell's own net does not have."""
    folder = record_list_cell.write(tmp_path)
    first, second = "fires(Sup'Seen, { true })", "fires(Rob'Report, { true })"
    asked = f"every {first} is followed by {second} within 5 seconds"
    done = pn2code("verify", folder, "--no-medium", "--property", asked)
    assert done.returncode == 3, done.stderr
    assert "neither how long moves take nor how late" in " ".join(done.stdout.split())
