"""Instances of a page share one C function where their places are kept alike; all occurs as in the token game."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered, run
from helpers.netbuilder import flat
from pn2code.emission.c import emit
from pn2code.emission.output import OutputFile
from pn2code.ir.nodes import NetIR
from pn2code.lowering.nets.packing import Packing
from pn2code.lowering.passes.analysis import bounded
from pn2code.net.flat import FlatNet

CELL = """
net Cell
  standard
  colset LATE = int timed;
  colset POSE = record x: INT * y: INT;
  var n, k, old: INT;
  var late: LATE;
  var p: POSE;
  page Top
    place A : POSE = 1`{x = 1, y = 2}
    place B : POSE
    place C : POSE
    place Heap : POSE = 2`{x = 5, y = 0} ++ 1`{x = 7, y = 1}
    place Pile : POSE
    place Home : POSE
    place Budget fusion Money : INT = 1`3
    place Clock : LATE = 1`1@0
    place Watch : LATE = 1`2@1 +++ 1`3@4
    place Left : LATE
    place Right : LATE
    subst First = Work (In -> A, Out -> B, Tick -> Clock, Tock -> Left)
    subst Second = Work (In -> B, Out -> C, Tick -> Clock, Tock -> Left)
    subst Third = Work (In -> C, Out -> A, Tick -> Watch, Tock -> Right)
    subst Fourth = Work (In -> Heap, Out -> Pile, Tick -> Watch, Tock -> Right)
    subst Fifth = Work (In -> Pile, Out -> Heap, Tick -> Clock, Tock -> Right)
    trans Back guard [k < 6]
      in Left : late
      out Clock : late
      both Budget : k
    trans Again
      in Right : late
      out Watch : (late mod 5) + 1
  page Work
    place In port in : POSE
    place Out port out : POSE
    place Tick port io : LATE
    place Tock port out : LATE
    place Held : POSE
    place Spent fusion Money : INT = 1`3
    trans Take guard [n = #x p] priority 100
      in In : p
      in Spent : old
      out Held : POSE.set_x p (n + 1)
      out Spent : (old + n) mod 8
    trans Give
      code input (p); output (n); action (#x p * 3 + discrete (0, 3)) mod 7
      in Held : p
      out Out : {x = n, y = #y p}
    trans Wait delay @+1
      in Tick : late@+1
      out Tock : (late + 2) mod 9@+2
      inhibit Held
"""
ONE = {"Top.A", "Top.B", "Top.C", "Fusion.Money"}
"""Places that hold one token at most."""
HELD = {"Top.First.Held", "Top.Second.Held"}
"""These as well."""


def with_bounds(net: NetIR, small: set[str]) -> NetIR:
    """The net with slots where places are proven to hold one token."""
    return bounded(
        replace(
            net,
            places=tuple(
                replace(p, capacity=1, bound=1, proof="invariant") if p.name in small else p
                for p in net.places
            ),
        )
    )


def made(text: str, small: set[str]) -> tuple[FlatNet, NetIR, Mapping[str, OutputFile]]:
    """The flat net, its intermediate form with slots, and the generated files by path."""
    net = flat(text)
    ir, d = lowered(net)
    assert ir is not None, d.errors
    ir = with_bounds(ir, small)
    return net, ir, {f.path: f for f in emit(ir, "test")}


def functions(code: str, verb: str) -> list[str]:
    """The names of the functions of transitions."""
    return re.findall(rf"^PN_NET_SEARCH static bool (\w+)_{verb}\(", code, re.MULTILINE)


@pytest.mark.parametrize(
    ("small", "take", "wait"),
    [
        (set[str](), ["Work_Take"], ["Work_Wait"]),
        (ONE, ["Work_Take", "Work_Take_2"], ["Work_Wait"]),
        (ONE | HELD, ["Work_Take", "Third_Take", "Work_Take_2"], ["Work_Wait", "Work_Wait_2"]),
    ],
)
@pytest.mark.cc
def test_instances_share_code_where_their_places_are_kept_alike(
    small: set[str], take: list[str], wait: list[str], workshop: Workshop, tmp_path: Path
) -> None:
    """Slots beside arrays, timed places, a fusion set, priorities, code segments, random numbers, an inhibitor arc."""
    net, ir, files = made(CELL, small)
    code = files["net.c"].text
    fire = functions(code, "fire")
    assert fire == functions(code, "enumerate")
    assert [f for f in fire if "Take" in f] == take
    assert [f for f in fire if "Wait" in f] == wait
    program = workshop.build(ir, tmp_path)
    assert sum(agrees(net, program, seed=s, steps=60) for s in range(6)) > 100


def test_each_instance_is_traced_to_the_common_lines() -> None:
    _, ir, files = made(CELL, ONE)
    lines = files["net.c"].text.splitlines()
    blocks = {b.element: b for b in files["net.c"].blocks if b.kind == "transition"}
    assert set(blocks) == {t.name for t in ir.transitions}
    for page_instance in ("First", "Second", "Third"):
        block = blocks[f"Top.{page_instance}.Take"]
        assert (block.first, block.last) == (
            blocks["Top.First.Take"].first,
            blocks["Top.First.Take"].last,
        )
        text = "\n".join(lines[block.first - 1 : block.last])
        assert text.startswith("/* transition: page `Work`, transition `Take`")
        assert f" *     Top.{page_instance}.Take\n" in text
        assert "bool Work_Take_fire(" in text
        assert "Work_Take_2" not in text
        assert "Top.Fourth.Take" not in text
    assert blocks["Top.Fourth.Take"].first > blocks["Top.First.Take"].last


@pytest.mark.cc
def test_two_ports_of_one_socket_have_code_of_their_own(workshop: Workshop, tmp_path: Path) -> None:
    """Pair takes two tokens of one place: whether there are two of them is another question than one in each."""
    text = """
    net Cell
      standard
      var n, k: INT;
      page Top
        place A : INT = 1`1 ++ 1`2
        place B : INT = 1`2 ++ 1`3
        place C : INT = 1`3
        place D : INT
        subst First = Pair (One -> A, Other -> B, To -> D)
        subst Second = Pair (One -> B, Other -> A, To -> D)
        subst Third = Pair (One -> C, Other -> C, To -> D)
      page Pair
        place One port in : INT
        place Other port in : INT
        place To port out : INT
        trans Take
          in One : n
          in Other : n
          in Other : k
          out To : n + k
    """
    net, ir, files = made(text, set())
    assert functions(files["net.c"].text, "fire") == ["Pair_Take", "Third_Take"]
    program = workshop.build(ir, tmp_path)
    assert sum(agrees(net, program, seed=s, steps=5) for s in range(4)) > 0


@pytest.mark.cc
def test_errors_name_the_place_of_the_instance(workshop: Workshop, tmp_path: Path) -> None:
    text = """
    net Cell
      standard
      var n: INT;
      page Top
        place A : INT = 1`1
        place B : INT
        place C : INT = 1`2
        place D : INT = 1`3
        subst First = Move (From -> A, To -> B)
        subst Second = Move (From -> C, To -> D)
      page Move
        place From port in : INT
        place To port out : INT
        trans Go
          in From : n
          out To : n
    """
    _, ir, files = made(text, {"Top.A", "Top.B", "Top.C", "Top.D"})
    assert functions(files["net.c"].text, "fire") == ["Move_Go"]
    program = workshop.build(ir, tmp_path)
    said = [json.dumps(run(program, seed, 2)[-1]) for seed in range(6)]
    assert any("place is full" in line and "place `D`" in line for line in said), said
    assert not any("place `B`" in line for line in said)


def test_explorers_have_a_function_for_each_instance() -> None:
    """So that the compiler puts searches where they are called."""
    ir, d = lowered(flat(CELL), packing=Packing({}, successors=True))
    assert ir is not None, d.errors
    code = next(f.text for f in emit(ir, "test") if f.path == "net.c")
    names = [x for x in re.findall(r"bool (\w+)_fire\(", code) if "Take" in x]
    assert names == [f"{x}_Take" for x in ("First", "Second", "Third", "Fourth", "Fifth")]


@pytest.mark.cc
def test_names_of_the_net_do_not_meet_those_of_the_common_code(
    workshop: Workshop, tmp_path: Path
) -> None:
    """Colour sets, places and pages that are called like what is made for them."""
    text = """
    net Cell
      standard
      colset INT_slot = product INT * INT;
      colset INT_array_64 = record own: INT * at_own: INT;
      colset Move_places = int with 0..9;
      var own, at_own: INT;
      var x: INT_slot;
      var y: INT_array_64;
      var z: Move_places;
      page Top
        place A : INT = 1`1
        place B : INT
        place C : INT = 2`2
        place D : INT
        place INT_array_64 : INT_slot = 1`(1, 2)
        place P : INT_array_64 = 1`{own = 1, at_own = 2}
        place Q : Move_places = 1`3
        subst First = Move (own -> A, at_own -> B)
        subst Second = Move (own -> C, at_own -> D)
        subst Third = Move (own -> B, at_own -> A)
        trans Rest
          in INT_array_64 : x
          in P : y
          in Q : z
          out P : {own = #1 x, at_own = z}
          out Q : (z + #own y) mod 10
          out INT_array_64 : (#2 x, #at_own y)
      page Move
        place own port in : INT
        place at_own port out : INT
        trans floor
          in own : own
          out at_own : own + 1
        trans places guard [own > 2]
          in at_own : own
          out own : 1
    """
    net, ir, files = made(text, {"Top.A", "Top.B"})
    assert "Move_floor" in functions(files["net.c"].text, "fire")
    program = workshop.build(ir, tmp_path)
    assert sum(agrees(net, program, seed=s, steps=20) for s in range(3)) > 20
