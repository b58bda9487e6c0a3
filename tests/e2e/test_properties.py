"""Properties with known answers, asked of the compiled explorer and of an independent judge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from random import Random

import pytest

from helpers.asked import Net
from helpers.explored import Explorers
from helpers.property_nets import MUTEX, OWN, SHARED, Row
from helpers.random_properties import Author
from helpers.thorough import amount
from pn2code.properties.meaning import TRUE, Bound, Fairness, Invariant, Linear, Op
from pn2code.verify.answers import confirm

pytestmark = pytest.mark.cc


@pytest.mark.parametrize("name", OWN)
def test_known_answers(explorers: Explorers, name: str) -> None:
    text, rows = OWN[name]
    check(explorers, Net.of(text), rows, name)


def check(explorers: Explorers, net: Net, rows: Sequence[Row], name: str) -> None:
    found = net.ask(explorers, [row[0] for row in rows], f"asked-{name}")
    wrong = []
    for row, answer in zip(rows, found.answers, strict=True):
        if answer.answer != ("yes" if row[1] else "no"):
            wrong.append(f"{row[0]}: {answer.answer} {answer.why}")
        if len(row) > 2 and answer.value != row[2]:
            wrong.append(f"{row[0]}: {answer.value}")
    net.judge(found)
    assert not wrong, "\n".join(wrong)


@pytest.mark.shared
@pytest.mark.parametrize("file", SHARED)
def test_known_answers_of_nets_by_others(explorers: Explorers, shared: Path, file: str) -> None:
    path = shared / file
    if not path.is_file():
        pytest.skip(f"the collection lacks {file}")
    check(explorers, Net.load(path), SHARED[file], path.stem)


def test_runs_that_show_something_else(explorers: Explorers) -> None:
    """What a run must show is looked at: each of these is refused."""
    net = Net.of(MUTEX)
    texts = ["never tokens(Want) = 2", "ltl G F tokens(Idle) = 2", "bound Want <= 1"]
    found = net.ask(explorers, texts, "asked-wrongly")
    invariant, lasso, bound = found.answers
    assert [a.answer for a in found.answers] == ["no", "no", "no"]
    assert lasso.evidence is not None and invariant.evidence is not None
    assert lasso.evidence.loop is not None
    short = replace(lasso.evidence, steps=lasso.evidence.steps + 1)
    straight = replace(lasso.evidence, loop=None)
    elsewhere = replace(lasso.evidence, loop=lasso.evidence.loop + 1)
    eventually = replace(lasso.about, asked=Linear(Op("F", (TRUE,))))
    fair = replace(lasso.about, asked=replace(lasso.about.asked, fair=(Fairness(True, 0),)))
    for answer, expected in (
        (replace(lasso, evidence=short), "steps, not"),
        (replace(lasso, evidence=straight), "ends where something is enabled"),
        (replace(lasso, evidence=elsewhere), "does not come back"),
        (replace(lasso, about=eventually), "the formula is true on the run"),
        (
            replace(invariant, about=replace(invariant.about, asked=Invariant(TRUE))),
            "decides nothing",
        ),
        (replace(bound, about=replace(bound.about, asked=Bound(1, 0, 9))), "has 2 tokens"),
        (replace(lasso, about=fair), None),
    ):
        said = confirm.problem(net.flat, {}, found.properties, answer)
        assert (said is None) if expected is None else expected in (said or ""), (said, expected)


def test_waits_that_are_not_too_long(explorers: Explorers) -> None:
    """Of runs for bounded responses the waits are measured."""
    net = Net.of(MUTEX)
    ask = "every {} is followed by {} within {}".format
    texts = [
        ask("fires(Enter)", "fires(Leave)", "1 firings"),
        ask("tokens(Crit) = 1", "tokens(Free) = 1", "1 firings"),
        ask("fires(Ask)", "{ cf (a, Mark.Top'Crit 1) = 1 }", "9 firings"),
    ]
    found = net.ask(explorers, texts, "asked-waits")
    assert [a.answer for a in found.answers] == ["no"] * 3
    assert found.answers[2].evidence is not None and found.answers[2].evidence.loop is not None
    for answer in found.answers:
        assert confirm.problem(net.flat, {}, found.properties, answer) is None
    for answer in found.answers[:2]:
        longer = replace(answer.about, asked=replace(answer.about.asked, firings=9))
        said = confirm.problem(net.flat, {}, found.properties, replace(answer, about=longer))
        assert said == "no wait in the run is too long"
    endless = found.answers[2]
    other = replace(endless.about, asked=replace(endless.about.asked, second=TRUE))
    said = confirm.problem(net.flat, {}, found.properties, replace(endless, about=other))
    assert said == "no wait in the run is too long"


@pytest.mark.parametrize("name", ["turns", "ending", "belt"])
def test_random_properties(explorers: Explorers, name: str) -> None:
    """Whatever is asked: the explorer and the judge agree, and runs show what they should."""
    net = Net.of(OWN[name][0])
    author = Author(Random(name), net.flat)
    found = net.ask(
        explorers, [author.property() for _ in range(amount(30, 300))], f"random-{name}"
    )
    net.judge(found)
    assert {a.answer for a in found.answers} == {"yes", "no"}


@pytest.mark.parametrize("name", OWN)
def test_what_a_part_says_is_so_of_the_whole(explorers: Explorers, name: str) -> None:
    """However early a limit ends the exploration: what is answered then is the answer, and its run shows it."""
    net = Net.of(OWN[name][0])
    author = Author(Random(f"part of {name}"), net.flat)
    texts = [author.property() for _ in range(amount(30, 200))]
    whole = net.ask(explorers, texts, f"whole-{name}")
    for states in (2, 3, 5, 9):
        found = net.ask(explorers, texts, f"part-{name}-{states}", "--max-states", states)
        for text, true, said in zip(texts, whole.answers, found.answers, strict=True):
            if said.answer != "inconclusive":
                assert said.answer == true.answer, (states, text)
            problem = confirm.problem(net.flat, {}, found.properties, said)
            assert problem is None, (states, text, problem)
