"""Equal parts of a net that are exchanged: orbits, runs and answers are those of all markings."""

from __future__ import annotations

import json
from pathlib import Path
from random import Random

import pytest

from helpers.equal_parts import compare, family, line
from helpers.explored import Explorers
from helpers.netbuilder import flat
from helpers.questions import ask
from helpers.thorough import amount
from pn2code.trace.replay import replay
from pn2code.verify.exploring import net_by_parts
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.find_instances import instances
from pn2code.verify.exploring.limits import Limits

pytestmark = pytest.mark.cc


@pytest.mark.parametrize("part", range(3))
def test_random_families(explorers: Explorers, part: int) -> None:
    """Equal parts, parts of parts, and parts of which one differs in a detail; also with two threads, depth first."""
    said = []
    for seed in range(part, amount(12, 600), 3):
        text = family(Random(seed))
        more = ("--threads", 2, "--order", "dfs") if seed % 4 == 3 else ()
        try:
            said.append(compare(explorers, flat(text), *more))
        except AssertionError as difference:
            raise AssertionError(f"net {seed}:\n{text}\n{difference}") from difference
    assert said.count("same") > len(said) // 3, said


def test_states_of_many_equal_robots(explorers: Explorers) -> None:
    """As many as there are ways to distribute them, not as many as there are ways to do so one by one."""
    nodes = []
    for k in (2, 3, 4):
        net = flat(line(k))
        found = instances(net, {})
        assert found.order == [2, 6, 24][k - 2]
        table = explorers.folder / "parts"
        table.write_text(found.text())
        own = explorers.explore(net, "--reduce", "symmetry", "--instances", table).report
        whole = explorers.explore(net).report
        assert own["complete"] and whole["complete"]
        nodes.append((own["nodes"], whole["nodes"]))
    # Each of k robots is in one of 4 states; in one of these is one of them at most.
    assert nodes == [(9, 15), (16, 54), (25, 189)]


QUESTIONS = (
    ("pred 0\n? invariant 0", "length A1 + length A2 <= 2"),
    ("pred 0\n? invariant 0", "length A1 + length A2 <= 1"),
    ("pred 0\n? invariant 0", "length A1 <= 1 andalso length A2 <= 1"),
    ("pred 0\nnot 0\n? invariant 1", "length B1 = 1 andalso length B2 = 1"),
    ("? bound {zone} 0 1", "true"),
    ("dead\nnot 0\n? invariant 1", "true"),
)
ZONE = """
    net Zone
      standard
      place Free1 : INT = 1`1
      place Free2 : INT = 1`1
      place A1 : INT
      place A2 : INT
      place B1 : INT
      place B2 : INT
      place Zone = 1
      var n: INT;
      trans Go1 code input (n); action ()
        in Free1 : n
        out A1 : n
      trans Go2 code input (n); action ()
        in Free2 : n
        out A2 : n
      trans In1
        in A1 : n
        in Zone
        out B1 : n
      trans In2
        in A2 : n
        in Zone
        out B2 : n
"""


def test_questions_about_states_have_the_same_answers(explorers: Explorers) -> None:
    answers = []
    for number, (questions, condition) in enumerate(QUESTIONS):
        asked = ask(explorers, ZONE, [condition], name=f"zone{number}")
        zone = next(p.index for p in asked.flat.places if p.short == "Zone")
        lines = questions.format(zone=zone).split("\n")
        table = asked.folder / "parts"
        table.write_text(instances(asked.flat, {}).text())
        _, (plain,) = asked.say(lines)
        found, (own,) = asked.say(lines, "--reduce", "symmetry", "--instances", table)
        assert own["answer"] == plain["answer"]
        answers.append(own["answer"])
        if own.get("trace"):
            assert own["steps"] == plain["steps"]
            assert replay(Path(own["trace"]), asked.flat).ok
    assert set(answers) == {"yes", "no"}


BRANCHING = (
    "dead\nef 0\nag 1\n? initially 2",
    "dead\naf 0\n? initially 1",
    "pred 0\nax 0\n? initially 1",
    "pred 0\neg 0\n? initially 1",
    "pred 0\nnot 0\nef 1\n? initially 2",
)


def test_formulas_about_paths_have_the_same_answers(explorers: Explorers) -> None:
    asked = ask(explorers, ZONE, ["length A1 = length A2"], name="paths")
    table = asked.folder / "parts"
    table.write_text(instances(asked.flat, {}).text())
    more = ("--reduce", "symmetry", "--instances", table)
    answers = []
    for questions in BRANCHING:
        _, (plain,) = asked.say(questions.split("\n"))
        _, (own,) = asked.say(questions.split("\n"), *more)
        assert own["answer"] == plain["answer"]
        answers.append(own["answer"])
    assert set(answers) == {"yes", "no"}
    # Of runs nothing is said, since they are not those of representatives.
    _, (own,) = asked.say(["true", "? within-firings s0 f0 3"], *more)
    assert (own["answer"], own["why"]) == ("unknown", "reduction")


def test_the_run_to_an_exception_is_a_run_of_the_net(explorers: Explorers) -> None:
    net = flat(
        ZONE.replace("out B1 : n", "out B1 : n div (n - 1)").replace(
            "out B2 : n", "out B2 : n div (n - 1)"
        )
    )
    found = instances(net, {})
    assert found.families
    table = explorers.folder / "parts"
    table.write_text(found.text())
    stem = explorers.folder / "raises."
    said = explorers.explore(
        net, "--reduce", "symmetry", "--instances", table, "--error-trace-to", stem
    ).report
    assert said["error"]["message"] == "Div"
    trace = Path(said["error"]["trace"]["file"])
    last = json.loads(trace.read_text().splitlines()[1])["transition"]
    assert net.transitions[said["error"]["transition"]].name.endswith(last[-1])
    assert replay(trace, net).ok


def test_a_table_that_does_not_fit_is_refused(explorers: Explorers) -> None:
    net = flat(ZONE)
    table = explorers.folder / "parts"
    good = instances(net, {}).text()
    for bad in (good[:-4], good.replace("1\n2", "1\n9", 1), "pn2code-elements 1\n", ""):
        table.write_text(bad)
        said = explorers.explore(net, "--reduce", "symmetry", "--instances", table).report
        assert said["error"]["kind"] == "reduction"
    # Nor are parts that hold something else at first, whatever the table says.
    table.write_text(good)
    other = flat(ZONE.replace("Free1 : INT = 1`1", "Free1 : INT = 1`2"))
    said = explorers.explore(other, "--reduce", "symmetry", "--instances", table).report
    assert said["error"]["kind"] == "reduction"


def test_a_closed_net_of_which_not_all_markings_are_counted() -> None:
    net = flat(line(3) + "    trans Never\n      in In : n\n      inhibit In\n")
    done = {p.index for p in net.places if p.short == "Done"}
    known = net_by_parts.look(net, {}, Limits(), ExploreOptions(), done)
    assert known is not None
    assert known.symmetries == ("exchanges of Top.R1, Top.R2, Top.R3",)
    assert (known.nodes, known.ends) == (16, True)
    assert {net.transitions[t].short for t in known.never} == {"Never"}
    assert len(known.never) == 3
    # Of a place that only one of them has, another one is no end; and without any none is.
    one = net_by_parts.look(net, {}, Limits(), ExploreOptions(), {min(done)})
    assert one is not None
    assert one.symmetries == ("exchanges of Top.R2, Top.R3",)
    assert (one.nodes, one.ends, one.never) == (33, True, known.never)
    none = net_by_parts.look(net, {}, Limits(), ExploreOptions(), ())
    assert none is not None
    assert (none.nodes, none.ends, none.never) == (16, False, known.never)
    # What goes on for ever comes to no end.
    again = line(2) + "    trans Again\n      in Done : n\n      out Free : n\n"
    assert net_by_parts.look(flat(again), {}, Limits(), ExploreOptions(), done) is None
