"""Scripts compute what CPN ML computes, also where nobody looks at it, and stop where the net raises an exception."""

from __future__ import annotations

from itertools import chain
from pathlib import Path
from random import Random

import pytest

from helpers.robots import Cell
from helpers.script_forms import (
    EXTRA,
    FORMS,
    LIST_FORMS,
    SENSORS,
    SITES,
    difference,
    random_form,
    script_page,
)
from helpers.thorough import amount

# Each form at two places, each place with several forms; one in three of these, but in `make thorough`.
CASES = chain.from_iterable(
    ((SITES[i % len(SITES)], form), (SITES[(i * 5 + 7) % len(SITES)], form))
    for i, form in enumerate(FORMS)
)


@pytest.mark.parametrize(
    ("site", "form"), [*CASES, *((site, FORMS[0]) for site in SITES)][:: amount(3, 1)]
)
def test_a_script_fails_where_its_page_does(tmp_path: Path, site: str, form: str) -> None:
    assert difference(tmp_path, site, form) == ""


@pytest.mark.parametrize("seed", range(amount(12, 24)))
def test_random_expressions(tmp_path: Path, seed: int) -> None:
    """More of them: `./dev fuzz --scripts N`."""
    random = Random(seed)
    site, form = random.choice(SITES), random_form(random)
    assert difference(tmp_path, site, form) == "", f"{site}: {form}"


@pytest.mark.parametrize(("i", "form"), [*enumerate(LIST_FORMS)])
def test_lists_fail_where_they_do_in_the_net(tmp_path: Path, i: int, form: str) -> None:
    for k, site in enumerate((SITES[i % len(SITES)], SITES[(i * 5 + 7) % len(SITES)])):
        folder = tmp_path / str(k)
        folder.mkdir()
        assert difference(folder, site, form) == "", site


@pytest.mark.parametrize("seed", range(7000, 7000 + amount(8, 600)))
def test_random_expressions_with_lists(tmp_path: Path, seed: int) -> None:
    random = Random(seed)
    site, form = random.choice(SITES), random_form(random, lists=0.5)
    assert difference(tmp_path, site, form) == "", f"{site}: {form}"


def body(folder: Path, site: str, form: str) -> str:
    page = script_page(site, form)
    channels = ("y out INT",) if "out y" in page else ()
    return Cell(folder, page, channels, extra=EXTRA, toml=SENSORS).body


@pytest.mark.parametrize(
    ("site", "form", "expected"),
    [
        (
            "guard",
            "let val y = 6 div n in if n = 0 then 1 else y end",
            "if computed(6 div n) and (",
        ),
        ("guard", "6 div n", "if 6 div n > 0 then"),
        ("guard", "if n = 0 then 1 else 6 div n", "if (if n = 0 then 1 else 6 div n) > 0 then"),
        ("code, unused", "6 div n", "compute 6 div n\ntool drill for 3 s\nmark"),
        (
            "code",
            "6 div n",
            "tool drill for 3 s\nmark Top.Robot.Go with j = j, n = n, got = 6 div n",
        ),
        (
            "output",
            "6 div n",
            "compute 6 div n\nmark Top.Robot.Go with j = j, n = n\nwrite y 6 div n",
        ),
        ("output", "if n <> 0 then 6 div n else 1", "j := u\nmark Top.Robot.Go"),
        ("output", "if n < 5 then n + 1 else 1", "j := u\nmark Top.Robot.Go"),
        ("unread", "6 div n", "compute 6 div n\nmark Top.Robot.Go"),
        ("input", "6 div n", "if j > 0 and 6 div n = data then"),
        ("guards", "6 div n", "if j > 0 and 6 div n > 0 then"),
    ],
)
def test_what_is_computed_beforehand(tmp_path: Path, site: str, form: str, expected: str) -> None:
    assert expected in body(tmp_path, site, form)


def test_a_guard_keeps_a_script_from_what_fails(tmp_path: Path) -> None:
    """A condition on the message comes first in the net, and the one on the data may fail."""
    page = """
    place Idle = 1
    place Data : INT = 1`0
    place Over
    trans Big guard [i > 1, 6 div n > 2]
      in x : i
      in Idle
      both Data : n
      out Over
    trans Small guard [i <= 1]
      in x : i
      in Idle
      both Data : n
      out Over
    """
    cell = Cell(tmp_path, page, ("x in INT",))
    assert "if i > 1 and 6 div n > 2 then" in cell.body


def test_two_measurements_are_two_values(tmp_path: Path) -> None:
    page = """
    place Idle : POSE = 1`{x=0.0,y=0.0,z=0.0,rx=0.0,ry=0.0,rz=0.0}
    place Over
    trans Look
      code input (p); output (w); action let val a = measure p val b = measure a in #x a - #x b end
      in Idle : p
      out Over
      out y : w
    """
    cell = Cell(tmp_path, page, ("y out REAL",))
    assert cell.messages == []
    assert "measure p into w\nmeasure w into w_2" in cell.body
