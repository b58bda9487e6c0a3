"""Packed places: with counters of a few bits a net does what it does with arrays, and what the token game does."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered, run
from helpers.netbuilder import flat
from helpers.thorough import amount
from pn2code.lowering.nets.packing import Packing
from pn2code.net.flat import FlatNet

pytestmark = pytest.mark.cc

NETS: dict[str, str] = {
    "all kinds of small colour sets": """
        net Cell
          standard
          colset FLAG = bool with (off, on);
          colset RGB = with red | green | blue;
          colset PH = index ph with 1..5;
          colset N = int with ~2..6;
          colset PAIR = product RGB * N;
          colset REC = record who: PH * flag: FLAG * none: UNIT;
          colset EVEN = subset N by (fn n => n mod 2 = 0);
          colset EVENS = product EVEN * FLAG;
          colset ANY = union A: N + B + C: PAIR + D: EVEN;
          colset LETTER = with a | b | c' | d;
          fun prior a = d | prior b = a | prior c' = b | prior d = c'
          var f, g: FLAG; var c: RGB; var i, j: PH; var n, m: N; var p: PAIR; var e: EVEN; var x: ANY;
          var r: REC; var l: LETTER;
          fun next (ph k) = ph (if k = 5 then 1 else k + 1)
          place U = 3
          place F : FLAG = 1`off ++ 2`on
          place K : RGB = RGB.all()
          place I : PH = PH.all()
          place M : N = 1`(~2) ++ 1`0 ++ 2`6
          place P : PAIR = 1`(green, 3)
          place R : REC = 1`{who = ph 2, flag = true, none = ()}
          place E : EVEN = 1`2 ++ 1`(~2)
          place D : EVENS = 1`(4, true) ++ 1`(0, false)
          place X : ANY = 1`B ++ 1`A 3 ++ 1`C (blue, ~1) ++ 1`D 4
          place L : LETTER = 2`b ++ 1`d
          trans Pair
            in K : c
            in M : n
            out P : (c, n)
          trans Unpair guard [n > ~1]
            in P : (c, n)
            out K : c
            out M : n
            in U : ()
          trans Ring
            in I : 1`i ++ 1`(next i)
            in F : f
            out R : {who = i, flag = not f, none = ()}
            out I : if f then 2`i else 1`i ++ 1`(next i)
          trans Unring
            in R : {who = j, flag = f, none = ()}
            out F : f
            out U : 2`()
          trans Even guard [e < 4]
            in E : e
            out D : (e, e > 0)
          trans Odd
            in D : (e, f)
            in F : g
            out X : if f then 1`A e else 1`C (red, e)
            out E : e
          trans Take
            in X : x
            in L : l
            out L : prior l
            out X : case x of A n => C (green, n) | B => A 1 | C (_, n) => A n | D n => B
    """,
    "lists of tokens, tests and resets": """
        net Cell
          standard
          colset S = index site with 1..4;
          colset MES = product S * S;
          var s, r: S;
          var n: INT;
          fun mes s = S.all() -- 1`s
          fun others s = MES.mult (1`s, mes s)
          place Unused : MES = MES.all()
          place Sent : MES
          place Got : MES
          place Idle : S = S.all()
          place Busy : S
          place Token = 1
          place Waste : S
          place Pairs : MES
          trans Send
            in Token : ()
            in Idle : s
            in Unused : others s
            out Busy : s
            out Sent : others s
          trans Receive
            in Sent : (s, r)
            both Idle : 1`r
            out Got : (s, r)
            out Waste : 1`s ++ 1`r
          trans Done
            in Busy : s
            in Got : others s
            reset Waste
            out Unused : others s
            out Idle : s
            out Token : ()
          trans Clean
            in Waste : 2`s
            inhibit Busy
            out Waste : mes s
            out Pairs : MES.mult (S.all() -- 1`s, 1`s) ++ List.map (fn x => (x, s)) (mes s)
          trans Unpair
            in Pairs : MES.mult (S.all() -- 1`s, 1`s)
            in Waste : s
    """,
    "values outside of the colour set": """
        net Cell
          standard
          colset D = int with 0..7;
          colset DD = product D * D;
          var n, m: D;
          var k: INT;
          place P : D = 1`0 ++ 1`3 ++ 1`7
          place Q : DD = 1`(0, 1) ++ 1`(7, 7) ++ 1`(3, 5)
          place K : INT = 1`(~3) ++ 1`2 ++ 1`9
          trans Next
            both P : n
            in K : k
            in P : n + k
            out P : (n + 2) mod 8
          trans Pair guard [n + 1 > m]
            both P : n
            in Q : (m, n + k)
            in K : k
            out Q : (n, m)
            out K : k + 1
    """,
    "nothing that is put is outside": """
        net Cell
          standard
          colset D = int with 0..7;
          var n: D;
          place P : D = 1`0 ++ 1`3 ++ 1`5
          trans T
            in P : n
            out P : n + 1
    """,
    "multisets beside packed places": """
        net Cell
          standard
          colset D = int with 0..3;
          colset TD = D timed;
          colset WORDS = list STRING;
          var n: D;
          var w: WORDS;
          var t: TD;
          var k: INT;
          place P : D = D.all()
          place W : WORDS = 1`["a"] ++ 1`[]
          place T : TD = 1`(2@1) +++ 1`(3@4)
          place K : INT = 1`5
          trans Grow guard [length w < 4]
            in P : n
            in W : w
            out W : (Int.toString n) :: w
            out T : n@+2
          trans Back
            in T : t
            in K : k
            out P : t
            out K : (k * 3 + 1) mod 7
    """,
}  # fmt: skip


def _program(net: FlatNet, packing: Packing, workshop: Workshop, folder: Path) -> Path:
    compiled, d = lowered(net, packing=packing)
    assert compiled is not None, [(e.code, e.message) for e in d.errors]
    text = "".join(str(p.packed) for p in compiled.places)
    assert "Packed" in text
    return workshop.build(compiled, folder)


@pytest.mark.parametrize("name", NETS)
def test_packed_net_and_token_game_agree(name: str, workshop: Workshop, tmp_path: Path) -> None:
    net = flat(NETS[name])
    for width in (5, 32) if "sub" in NETS[name] or "mult" in NETS[name] else (32,):
        program = _program(net, Packing({}, width), workshop, tmp_path / str(width))
        assert max(agrees(net, program, seed=seed, steps=60) for seed in range(1, amount(3, 5))) > 0


def test_a_counter_that_overflows_is_a_full_place(workshop: Workshop, tmp_path: Path) -> None:
    net = flat(
        """
        net Cell
          standard
          place A = 7
          place B
          place C
          trans T
            in A : ()
            out C : ()
            out B : 2`()
        """
    )
    packing = Packing({"Top.A": 3, "Top.B": 2, "Top.C": 4})
    lines = run(_program(net, packing, workshop, tmp_path), 1, 20)
    assert [line["marking"]["Top.B"] for line in lines[:-1]] == [[], [[2, None]]]
    assert lines[-1]["error"] == "place is full" and "place `B`" in lines[-1]["where"]
    wider = packing.wider("Top.B").wider("Top.B")
    assert wider.of("Top.B") == 8
    assert len(run(_program(net, wider, workshop, tmp_path / "wider"), 1, 20)) == 8


def test_random_nets_agree(workshop: Workshop, tmp_path: Path) -> None:
    rng = random.Random(2024)
    for i in range(amount(2, 4)):
        net = flat(_random_net(rng))
        program = _program(net, Packing({}, 16), workshop, tmp_path / str(i))
        for seed in (1, 2):
            agrees(net, program, seed=seed, steps=40)


def test_random_arithmetic_agrees(workshop: Workshop, tmp_path: Path) -> None:
    """Also where it is computed without tests for overflow, beside what raises Overflow or Div."""
    rng = random.Random(77)
    count = 16
    places = "".join(f"  place B{k} : INT = 1`0\n" for k in range(count))
    transitions = "".join(
        f"  trans T{k} guard [{_number(rng, 1)} <= {_number(rng, 2)}]\n"
        "    in A : (k, l)\n    out A : (k, l)\n"
        f"    in B{k} : b\n    out B{k} : {_number(rng, 4)}\n"
        for k in range(count)
    )
    net = flat(
        "net Cell\n  standard\n  colset K = int with 0..9;\n  colset L = int with ~7..20;\n"
        "  colset P = product K * L;\n  var k : K; var l : L; var b : INT;\n  val seven = 7;\n"
        f"{places}  place A : P = 1`(0, ~7) ++ 1`(3, 20) ++ 1`(9, 12)\n{transitions}"
    )
    program = _program(net, Packing({}, 8), workshop, tmp_path)
    assert sum(agrees(net, program, seed=seed, steps=60) for seed in range(8)) > 24


def _number(rng: random.Random, depth: int) -> str:
    """A random expression of type int."""
    if depth == 0 or rng.random() < 0.15:
        return rng.choice(("k", "l", "k", "l", "b", "seven", "3", "~2", "1000", "1000000"))
    one, other = _number(rng, depth - 1), _number(rng, depth - 1)
    match rng.randrange(9):
        case 0 | 1 | 2 | 3:
            return f"({one} {rng.choice('+-*')} {other})"
        case 4 | 5:
            return f"({one} {rng.choice(('div', 'mod'))} {rng.choice(('3', '8', 'seven', other))})"
        case 6:
            return f"(~ ({one}))"
        case 7:
            return f"(if {one} > {rng.randrange(6)} then {other} else {rng.randrange(9)})"
    return f"({one} mod {rng.randint(1, 9)})"


def _random_net(rng: random.Random) -> str:
    """Places with a few colour sets, transitions with random arcs between them."""
    colsets = ["UNIT", "FLAG", "N", "PAIR", "INT"]
    variables = {"UNIT": "()", "FLAG": "f", "N": "n", "PAIR": "(n, f)", "INT": "k"}
    values = {
        "UNIT": ["()"],
        "FLAG": ["true", "false"],
        "N": ["1", "2", "3", "4"],
        "PAIR": ["(1, true)", "(2, false)", "(4, true)"],
        "INT": ["1", "(~5)", "12"],
    }
    put = {
        "UNIT": ["()", "2`()"],
        "FLAG": ["f", "not f", "1`f ++ 1`(not f)", "if f then 1`f else empty"],
        "N": ["n", "5 - n", "if n > 2 then 2`n else 1`1", "N.all() -- 1`n"],
        "PAIR": ["(n, f)", "(n, not f)", "PAIR.mult (1`n, FLAG.all())"],
        "INT": ["k", "(k + 1) mod 13"],
    }
    lines = [
        "net Random",
        "  standard",
        "  colset FLAG = bool;",
        "  colset N = int with 1..4;",
        "  colset PAIR = product N * FLAG;",
        "  var n: N; var f: FLAG; var k: INT;",
    ]
    places = [(f"P{i}", rng.choice(colsets)) for i in range(7)]
    for name, colset in places:
        tokens = " ++ ".join(
            f"{rng.randint(1, 3)}`{v}"
            for v in rng.sample(values[colset], rng.randint(1, len(values[colset])))
        )
        lines.append(f"  place {name} : {colset} = {tokens}")
    for t in range(6):
        lines.append(f"  trans T{t}")
        taken = rng.sample(places, rng.randint(1, 3))
        for name, colset in taken:
            text = variables[colset]
            kind = rng.choice(["in", "in", "in", "both"])
            text = rng.choice([text, text, f"2`{text}"])
            if colset == "N" and rng.random() < 0.3:
                text = "1`n ++ 1`(5 - n)"
            lines.append(f"    {kind} {name} : {text}")
        if rng.random() < 0.2:
            others = [p for p, _ in places if p not in {q for q, _ in taken}]
            lines.append(f"    {rng.choice(['inhibit', 'reset'])} {rng.choice(others)}")
        bound = {c for _, c in taken}
        known = {
            "UNIT": True,
            "FLAG": bool(bound & {"FLAG", "PAIR"}),
            "N": bool(bound & {"N", "PAIR"}),
            "PAIR": "PAIR" in bound or {"N", "FLAG"} <= bound,
            "INT": "INT" in bound,
        }
        for name, colset in rng.sample(places, rng.randint(1, 2)):
            if known[colset]:
                lines.append(f"    out {name} : {rng.choice(put[colset])}")
    return "\n".join(lines)
