"""Counters written as tokens: the net does the same, step by step; and what is no such counter stays."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest

from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.marking import BindingElement, Marking
from pn2code.semantics.game.token_game import Game
from pn2code.verify.exploring.numbers_as_tokens import Written, numbers_as_tokens

HEAD = """standard
colset SMALL = int with 0..9;
colset SUBSET = int with 0..9;
colset COLOUR = int with 1..2;
val parts = 3;
fun half n = n div 2;
globref seen = 0;
fun noted () = !seen;
var n, m : INT;
var c : COLOUR;
var s : SMALL;
page Top
"""
LINE = """  place Left : INT = 1`parts
  place Tray
  place Done : INT = 1`0
  place Finished
  trans Bring
    guard [n > 0]
    in Left : n
    out Left : n - 1
    out Tray
  trans Stow
    in Tray
    in Done : n
    out Done : n + 1
  trans Finish
    guard [n = parts]
    in Done : n
    out Finished
"""
MOST_MARKINGS = 400


def net_of(folder: Path, pages: str) -> FlatNet:
    file = folder / "net.cpnt"
    file.write_text(HEAD + pages, encoding="utf-8")
    d = Diagnostics()
    net = front.load(file, d)
    assert net is not None and not d.has_errors, [str(x) for x in d]
    return net


def written(net: FlatNet) -> Written:
    return numbers_as_tokens(net, {}, range(len(net.places)))


def shorts(net: FlatNet, made: Written) -> set[str]:
    return {net.places[p].short for p in made.places}


def steps(game: Game, marking: Marking, gone: set[str]) -> dict[str, BindingElement]:
    """What can occur, without the variables of counters."""
    return {
        f"{e.transition} {[(s.name, v) for s, v in e.values if s.name not in gone]}": e
        for e in game.enabled_in(marking)
    }


def after(game: Game, marking: Marking, element: BindingElement) -> Marking:
    game.marking = marking
    game.fire(element, checked=False)
    return game.marking


def assert_alike(net: FlatNet, made: Written) -> int:
    """That both do the same from each marking on; how many markings were compared."""
    one, other = (Game(x, files=Files(None)) for x in (net, made.net))
    todo = [(one.marking, other.marking)]
    seen = {repr(todo[0])}
    for mine, its in todo:
        for p in range(len(net.places)):
            held, tokens = list(mine.places[p]), list(its.places[p])
            if p not in made.places:
                assert held == tokens
            elif held:
                assert held == [len(tokens)]
        there, here = steps(one, mine, {"n", "m"}), steps(other, its, {"n", "m"})
        assert there.keys() == here.keys()
        for name, element in there.items():
            pair = after(one, mine, element), after(other, its, here[name])
            if repr(pair) not in seen and len(todo) < MOST_MARKINGS:
                seen.add(repr(pair))
                todo.append(pair)
    return len(todo)


def test_parts_that_are_counted_by_numbers(tmp_path: Path) -> None:
    net = net_of(tmp_path, LINE)
    made = written(net)
    assert shorts(net, made) == {"Left", "Done"} and made.added == 1
    assert [t.name for t in made.net.transitions] == [t.name for t in net.transitions]
    assert not any(t.guards for t in made.net.transitions)
    assert assert_alike(net, made) == 11


COUNTING = "    code action (seen := !seen + 1)\n"
STAYS = {
    "the guard is missing": ("    guard [n > 0]\n", ""),
    "it may become negative": ("out Left : n - 1", "out Left : n - 2"),
    "it is seen by another arc": ("    out Tray\n", "    out Tray : n`()\n"),
    "it is seen by a code segment": (
        "    out Tray\n",
        "    out Tray\n    code\n      input (n);\n      action (print (INT.mkstr n))\n",
    ),
    "it is multiplied": ("out Left : n - 1", "out Left : n - n"),
    "another function is asked": ("[n > 0]", "[half n > 0]"),
    "a reference is asked": ("    guard [n > 0]\n", f"    guard [n > !seen]\n{COUNTING}"),
    "a function asks a reference": ("    guard [n > 0]\n", f"    guard [n > noted ()]\n{COUNTING}"),
    "chance decides": ("[n > 0]", "[n > discrete (0, 1)]"),
    "it becomes a constant, whatever it was": ("out Left : n - 1", "out Left : 0"),
    "another number than 0 is left out": ("[n > 0]", "[n > 0, n <> 2]"),
    "its place has limits, its variable has none": ("Left : INT", "Left : SUBSET"),
    "its variable has limits, its place has none": (
        "    guard [n > 0]\n    in Left : n\n    out Left : n - 1\n",
        "    guard [s > 0]\n    in Left : s\n    out Left : s - 1\n",
    ),
    "two counters are compared": ("    guard [n > 0]\n", "    guard [n > m]\n    both Done : m\n"),
    "it begins negative": ("Left : INT = 1`parts", "Left : INT = 1`(~3)"),
    "it holds two numbers": ("Left : INT = 1`parts", "Left : INT = 1`parts ++ 1`1"),
    "it begins with an assignment": ("Left : INT = 1`parts", "Left : INT = (seen := 2; 1`parts)"),
    "its colour set has limits": ("Left : INT", "Left : SMALL"),
    "it has no bound": (
        "  trans Stow\n",
        "  trans More\n    in Left : n\n    out Left : n + 1\n  trans Stow\n",
    ),
    "another guard may raise an exception": (
        "    guard [n > 0]\n",
        "    guard [10 div m > 1, n > 0]\n    both Seen : m\n",
    ),
    "another guard may raise Overflow": (
        "    guard [n > 0]\n",
        "    guard [n > 0, m * m > 1]\n    both Seen : m\n",
    ),
    "another arc may raise an exception": (
        "    out Tray\n",
        "    out Tray\n    both Seen : half (10 div m)\n    both Tray : m`()\n    both Seen : m\n",
    ),
    "it may be reset": ("  trans Stow\n", "  trans Stow\n    reset Left\n"),
}  # fmt: skip


@pytest.mark.parametrize("why", STAYS)
def test_what_stays_a_number(why: str, tmp_path: Path) -> None:
    old, new = STAYS[why]
    assert old in LINE
    text = LINE.replace(old, new) + "  place Seen : INT = 1`0\n" * ("Seen" in new)
    if "SMALL" in new:
        text = text.replace("in Left : n", "in Left : s").replace("Left : n - 1", "Left : s - 1")
        text = text.replace("[n > 0]", "[s > 0]")
    net = net_of(tmp_path, text)
    assert "Left" not in shorts(net, written(net))


def test_a_limit_that_may_be_passed_stays(tmp_path: Path) -> None:
    """`n = 2` is no longer so when there are three: `n >= 2` would be."""
    net = net_of(tmp_path, LINE.replace("[n = parts]", "[n = 2]"))
    assert shorts(net, written(net)) == {"Left"}
    net = net_of(tmp_path, LINE.replace("[n = parts]", "[n < 3]"))
    assert shorts(net, written(net)) == {"Left"}
    net = net_of(tmp_path, LINE.replace("[n = parts]", "[n <= 3]"))
    assert shorts(net, written(net)) == {"Left", "Done"}


OPERATIONS = (
    ("n >= 1", "n", "n - 1", "in"),
    ("n > 1", "n", "n - 2", "in"),
    ("2 <= n", "n", "n", "in"),
    ("0 < n", "n", "n - 1", "in"),
    ("n <> 0", "n", "n - 1", "in"),
    ("n = 0", "n", "1 + n", "in"),
    ("", "0", "2", "in"),
    ("", "1", "0", "in"),
    ("n < 1", "n", "1", "in"),
    ("n = 3", "n", "n - 1", "in"),
    ("n <= 3", "n", "n", "in"),
    ("n <= 2", "n", "n + 1", "in"),
    ("", "n", "n + 1", "in"),
    ("n > 0, n < 4", "n", "n - 1", "in"),
    ("n >= 1", "n", "", "both"),
    ("n = parts", "n", "", "both"),
    ("", "0", "", "both"),
    ("n >= 2", "n", "", "in"),
    ("", "0", "", "in"),
)


def random_net(r: Random) -> str:
    """Tokens go round between places, and counters change with them; often they count places."""
    first = r.randrange(4)
    text = f"  place A = {r.randrange(1, 4)}`()\n  place B\n  place C\n  place P : COLOUR = 1`1 ++ 1`2\n"
    text += f"  place Count : INT = 1`{first}\n  place Other : INT = 1`{r.randrange(3)}\n"
    for i in range(r.randrange(3, 6)):
        guard, taken, put, kind = r.choice(OPERATIONS)
        counter = r.choice(("Count", "Count", "Other"))
        a, b = r.sample("ABC", 2)
        text += f"  trans T{i}\n"
        text += f"    guard [{guard}]\n" if guard else ""
        text += f"    {kind} {counter} : {taken}\n" + (
            f"    out {counter} : {put}\n" if put else ""
        )
        text += f"    in {a}\n" if r.random() < 0.8 else ""
        text += f"    out {b}\n" if r.random() < 0.4 else ""
        text += "    both P : c\n" if r.random() < 0.3 else ""
    return text


def test_random_counters_do_the_same(tmp_path: Path) -> None:
    compared = converted = 0
    for seed in range(50):
        net = net_of(tmp_path, random_net(Random(seed)))
        made = written(net)
        converted += len(made.places)
        if made.places:
            compared += assert_alike(net, made)
    assert converted > 15 and compared > 150
