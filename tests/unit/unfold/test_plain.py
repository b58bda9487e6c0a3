"""Unfolding without names gives the net of `unfold`, or leaves it to that."""

from __future__ import annotations

import random
from collections.abc import Iterable
from pathlib import Path

import pytest

from helpers.netbuilder import flat
from helpers.pnml_nets import load
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.unfold.plain import PlainNet, plain
from pn2code.unfold.unfold import unfold

HEAD = """
    net N
      standard
      colset CH = with red | green | blue;
      colset N = int with 0..2;
      colset PAIR = product CH * N;
      colset MIX = product BOOL * N;
      var c, d: CH;  var n, m: N;  var b: BOOL;
      fun next red = green | next green = blue | next blue = red
      page Top
"""
TERMS = {
    "CH": ("c", "d", "red", "next c", "next d", "if n = m then c else d"),
    "N": ("n", "m", "1", "(n + 1) mod 3", "if b then n else m"),
    "BOOL": ("b", "true", "not b", "n = m"),
}
PATTERNS = {"CH": ("c", "d", "blue"), "N": ("n", "m", "0"), "BOOL": ("b", "false")}
PRODUCTS = {"PAIR": ("CH", "N"), "MIX": ("BOOL", "N")}
GUARDS = ("c <> d", "n < m", "b orelse n = 1", "c = red andalso n <> m", "next c = d", "not b")


def same(net: FlatNet, found: PlainNet | None) -> bool:
    """Whether it is the net that `unfold` gives, in its order; no transition may be lost to an exception."""
    u = unfold(net, Diagnostics())
    assert u is not None and not u.faults
    expected = PlainNet(
        u.initial,
        tuple(t.pre for t in u.transitions),
        tuple(t.post for t in u.transitions),
        tuple(t.transition for t in u.transitions),
        u.of_place,
    )
    return found == expected


def term(draw: random.Random, colset: str, terms: dict[str, tuple[str, ...]]) -> str:
    """A value of a colour set."""
    if colset in PRODUCTS:
        return f"({', '.join(term(draw, part, terms) for part in PRODUCTS[colset])})"
    found = draw.choice(terms[colset])
    return f"({found})" if " " in found else found


def inscription(draw: random.Random, colset: str, terms: dict[str, tuple[str, ...]]) -> str:
    """One or two summands."""
    summands = [
        f"{draw.choice((1, 1, 2))}`{term(draw, colset, terms)}"
        for _ in range(draw.choice((1, 1, 2)))
    ]
    return " ++ ".join(summands)


def random_net(seed: int) -> str:
    """A net in which variables are shared by arcs, bound by none, and tested by guards."""
    draw = random.Random(seed)
    colsets = [draw.choice(("CH", "N", "BOOL", "PAIR", "MIX")) for _ in range(3)]
    constants = {"CH": ("red", "blue"), "N": ("0", "2"), "BOOL": ("true", "false")}
    lines = [f"place P{i} : {c} = {inscription(draw, c, constants)}" for i, c in enumerate(colsets)]
    for t in range(4):
        guard = f" guard [{', '.join(draw.sample(GUARDS, 2))}]" if draw.random() < 0.5 else ""
        lines.append(f"trans T{t}{guard}")
        taken, put = draw.randrange(3), draw.randrange(3)
        lines.append(f"  in P{taken} : {inscription(draw, colsets[taken], PATTERNS)}")
        lines.append(f"  out P{put} : {inscription(draw, colsets[put], TERMS)}")
    return HEAD + "\n".join(f"        {line}" for line in lines)


def sizes(nets: Iterable[PlainNet | None]) -> list[int]:
    """Numbers of transitions."""
    return [len(n.pre) for n in nets if n is not None]


def test_random_nets() -> None:
    """Enumerations, numbers, truth values and products of them, with functions and conditions."""
    made = []
    for seed in range(25):
        net = flat(random_net(seed))
        made.append(plain(net))
        assert made[-1] is not None and same(net, made[-1]), random_net(seed)
    assert max(sizes(made)) > 20 and sum(n > 3 for n in sizes(made)) > 8


def test_nets_of_the_contest(shared: Path) -> None:
    """Symmetric nets with broadcasts, successors, comparisons and constants in patterns."""
    folder = shared / "mcc"
    if not folder.is_dir():
        pytest.skip(f"no nets of the Model Checking Contest at {folder}")
    for path in sorted(folder.glob("*.pnml"), key=lambda p: p.stat().st_size)[:4]:
        net = load(path)
        assert same(net, plain(net)), path.stem


@pytest.mark.parametrize(
    "lines",
    [
        "place P : N = 1`1\ntrans T\n  in P : n\n  out P : n div 0",
        "place P : N = 1`1\ntrans T guard [1 div (n - 1) = 5]\n  in P : n\n  out P : 0",
        "place P : N = 1`1\nplace Q : N\ntrans T\n  in P : n\n  inhibit Q",
        "place P : REAL = 1`0.5\ntrans T\n  in P : 0.5",
        "place P : LIST = 1`[1]\ntrans T\n  in P : 1 :: xs\n  out P : xs",
    ],
)
def test_what_is_left_to_the_other(lines: str) -> None:
    """Exceptions, inhibitors, and values of other kinds."""
    more = "colset LIST = list N;  var xs: LIST;\n      page Top"
    text = HEAD.replace("page Top", more) + "\n".join(f"        {x}" for x in lines.split("\n"))
    assert plain(flat(text)) is None
