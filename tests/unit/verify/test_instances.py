"""Which parts of a net can be exchanged: page instances, pages drawn twice, parts of parts; and what is in the way."""

from __future__ import annotations

from random import Random

import pytest

from helpers.equal_parts import chosen_names, family
from helpers.netbuilder import flat
from helpers.questions import net_and_elaborator, predicate
from pn2code.net.predicate import Predicate
from pn2code.verify.exploring.find_instances import instances, why_none
from pn2code.verify.exploring.instances import Instances
from pn2code.verify.exploring.invariant_questions import AskedOf
from pn2code.verify.exploring.limits import Reduction

CELL = """
    net Cell
      standard
      var n, m: INT;
      globref last = 0;
      page Top
        place Zone = 1
        place Go1 : INT = 1`0
        place Go2 : INT = 1`0
        place Done : INT
        trans Take1 guard [n > 0] delay @+1
          in Go1 : n
          out Done : n
        trans Take2 guard [n > 0] delay @+1
          in Go2 : n
          out Done : n
        subst R1 = Robot (Go -> Go1, Zone -> Zone)
        subst R2 = Robot (Go -> Go2, Zone -> Zone)
      page Robot
        place Go port io : INT
        place Zone port io : UNIT
        place Busy : INT
        trans Enter code input (n); output (m); action let val k = n + 1 in (last := k; k) end
          in Go : n
          in Zone
          out Busy : m
        trans Leave
          in Busy : n
          out Zone
          out Go : List.foldl (fn (x, y) => x + y) 0 [n, 1]
"""


def found(text: str) -> Instances:
    return instances(flat(text), {})


def test_page_instances_with_what_the_supervisor_has_for_them() -> None:
    made = found(CELL)
    assert made.names() == ("exchanges of Top.R1, Top.R2",)
    assert made.order == 2
    net = made.net
    (pair,) = made.families
    of = [{net.places[p].name for p in part.places} for part in pair.parts]
    assert of == [{"Top.Go1", "Top.R1.Busy"}, {"Top.Go2", "Top.R2.Busy"}]
    by = [{net.transitions[t].name for t in part.transitions} for part in pair.parts]
    assert by[1] == {"Top.Take2", "Top.R2.Enter", "Top.R2.Leave"}
    zone = next(p.index for p in net.places if p.short == "Zone")
    assert made.orbits_of_places().count(zone) == 1


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("place Go2 : INT = 1`0", "place Go2 : INT = 1`1"),
        ("place Go2 : INT = 1`0", "place Go2 : INT = 2`0"),
        ("trans Take2 guard [n > 0]", "trans Take2 guard [n > 1]"),
        ("trans Take2 guard [n > 0]", "trans Take2 guard [n >= 1]"),
        ("trans Take2 guard [n > 0] delay @+1", "trans Take2 guard [n > 0] delay @+2"),
        ("trans Take2 guard [n > 0]", "trans Take2 guard [n > 0] priority 99"),
        (
            "trans Take2 guard [n > 0] delay @+1",
            "trans Take2 guard [n > 0] delay @+1 code action (last := 1)",
        ),
        ("in Go2 : n\n          out Done : n", "in Go2 : n\n          out Done : n + 1"),
        ("in Go2 : n\n          out Done : n", "both Go2 : n\n          out Done : n"),
        ("subst R2 = Robot (Go -> Go2, Zone -> Zone)", "subst R2 = Robot (Go -> Go2, Zone -> Own)"),
    ],
)
def test_one_detail_is_enough(old: str, new: str) -> None:
    text = CELL.replace(
        "        place Zone = 1\n", "        place Zone = 1\n        place Own = 2\n"
    )
    assert old in text
    assert found(text.replace(old, new)).families == ()


def test_a_page_drawn_twice_declares_other_symbols_for_itself() -> None:
    own = CELL[CELL.index("      page Robot") :]
    twice = CELL.replace("subst R2 = Robot", "subst R2 = Twin") + own.replace(
        "page Robot", "page Twin"
    )
    assert found(twice).names() == ("exchanges of Top.R1, Top.R2",)
    for old, new in (
        ("[n, 1]", "[n, 2]"),
        ("x + y", "x - y"),
        ("x + y", "y + x"),
        ("n + 1", "n - 1"),
    ):
        odd = own.replace("page Robot", "page Twin").replace(old, new)
        assert found(CELL.replace("subst R2 = Robot", "subst R2 = Twin") + odd).families == ()


def test_zero_and_minus_zero_are_two_values() -> None:
    text = """
        net N
          colset R = real;
          var x: R;
          place A1 : R = 1`1.0
          place A2 : R = 1`1.0
          place B : R
          trans T1
            in A1 : x
            out B : 0.0
          trans T2
            in A2 : x
            out B : 0.0
    """
    assert len(found(text).families) == 1
    assert found(text[::-1].replace("0.0"[::-1], "~0.0"[::-1], 1)[::-1]).families == ()


def test_arcs_that_read_what_another_one_changes_have_an_order() -> None:
    text = """
    net Order
      standard
      var n: INT;
      globref last = 0;
      page Top
        place A1 : INT = 1`0
        place A2 : INT = 1`0
        place B1 : INT
        place B2 : INT
        trans T1
          in A1 : n
          out A1 : (last := !last + 1; 1`(!last))
          out B1 : 1`(!last)
        trans T2
          in A2 : n
          out B2 : 1`(!last)
          out A2 : (last := !last + 1; 1`(!last))
    """
    assert found(text).families == ()
    lines = text.splitlines(keepends=True)
    put = next(i for i, line in enumerate(lines) if "out B2" in line)
    same = "".join([*lines[:put], lines[put + 1], lines[put], *lines[put + 2 :]])
    assert found(same).names() == ("exchanges of Top.T1, Top.T2",)


def test_numbers_of_instances_are_part_of_an_inscription() -> None:
    assert found(CELL.replace("[n, 1]", "[n, inst ()]")).families == ()


def test_chance_is_seen_by_all() -> None:
    net = flat(CELL.replace("val k = n + 1", "val k = discrete (0, n)"))
    assert why_none(net).startswith("transition `Top.R1.Enter` ")
    assert instances(net, {}).families == ()


def test_parts_of_parts() -> None:
    text = (
        CELL
        + """\
        place Left : INT = 1`0
        place Right : INT = 1`0
        trans Grip
          in Busy : n
          out Busy : n
          out Left : n
          out Right : n
        subst G1 = Gripper (At -> Left)
        subst G2 = Gripper (At -> Right)
      page Gripper
        place At port io : INT
        place Shut : INT
        trans Close
          in At : n
          out Shut : n
"""
    )
    made = found(text)
    assert made.names() == (
        "exchanges of Top.R2.G1, Top.R2.G2",
        "exchanges of Top.R1.G1, Top.R1.G2",
        "exchanges of Top.R1, Top.R2",
    )
    assert made.order == 8
    assert len(set(made.orbits_of_places())) == len({"Zone", "Go", "Done", "Busy", "Left", "Shut"})


def test_of_a_ring_half_a_turn_is_an_exchange() -> None:
    def ring(count: int) -> str:
        lines = ["net Ring", "  standard", "  page Top"]
        lines += [f"    place Fork{i} = 1" for i in range(count)]
        for i in range(count):
            lines.append(f"    subst P{i} = Eats (Left -> Fork{i}, Right -> Fork{(i + 1) % count})")
        lines += ["  page Eats", "    place Left port io : UNIT", "    place Right port io : UNIT"]
        lines += ["    place Has : UNIT", "    trans First", "      in Left", "      out Has"]
        lines += [
            "    trans Both",
            "      in Has",
            "      in Right",
            "      out Left",
            "      out Right",
        ]
        return "\n".join(lines) + "\n"

    assert [found(ring(count)).order for count in (2, 3, 4, 5)] == [2, 1, 2, 1]


def test_what_is_asked_has_to_stay_as_it_is() -> None:
    net = flat(CELL)
    (pair,) = instances(net, {}).families
    one, two = (part.places[-1] for part in pair.parts)

    def kept(questions: str, *predicates: Predicate) -> bool:
        return bool(instances(net, {}, AskedOf(questions, predicates)).families)

    assert kept("dead\nnot 0\n? invariant 1\n")
    assert not kept(f"within {one} 1 5\n? invariant 0\n")
    assert not kept(f"? bound {one} 0 1\n")
    assert not kept("enabled 0\n? invariant 0\n")
    assert kept(f"within {one} 1 5\nwithin {two} 1 5\nand 0 1\nnot 2\n? invariant 3\n")
    assert not kept(f"within {one} 1 5\nwithin {two} 1 4\nand 0 1\nnot 2\n? invariant 3\n")
    assert not kept(f"within {one} 1 5\nwithin {two} 1 5\nnot 1\nor 0 2\n? invariant 3\n")
    # Each question stays, not only all of them together.
    assert not kept(f"within {one} 1 5\nwithin {two} 1 5\n? invariant 0\n? invariant 1\n")
    # Along a path of representatives it is not always the same place.
    both = f"within {one} 1 5\nwithin {two} 1 5\n"
    assert not kept(f"{both}af 0\naf 1\nand 2 3\n? initially 4\n")
    assert kept(f"{both}and 0 1\naf 2\n? initially 3\n")
    assert not kept("true\nexa 0 0\n? initially 1\n")
    # The explorer does not answer what is about steps; so it need not stay.
    assert kept(f"within {one} 1 5\n? within-firings s0 s0 1\n")


def test_conditions_stay_but_for_the_order_of_what_commutes() -> None:
    text = CELL.replace(
        "subst R1 = Robot (Go -> Go1",
        "place A : INT\n        place B : INT\n        subst R1 = Robot (Out -> A, Go -> Go1",
    )
    text = text.replace("(Go -> Go2", "(Out -> B, Go -> Go2").replace(
        "place Busy : INT", "place Out port out : INT\n        place Busy : INT"
    )
    text = text.replace("in Busy : n", "in Busy : n\n          out Out : n")
    net, elaborator = net_and_elaborator(text)

    def kept(condition: str) -> bool:
        made = (predicate(net, elaborator, "p", condition),)
        return bool(instances(net, {}, AskedOf("pred 0\n? invariant 0\n", made)).families)

    assert kept("length A + length B <= 1")
    assert not kept("length A + 2 * length B <= 1")
    assert not kept("length A - length B <= 1")
    assert kept("length A <= 1 andalso length B <= 1")
    assert kept("length A <= 1 orelse length B <= 1")
    assert not kept("length A <= 1 andalso length B <= 2")
    assert not kept("if length A <= 1 then length B <= 1 else length B <= 2")
    # What is asked first decides here whether an exception is raised.
    assert not kept("hd A = 1 andalso hd B = 1")
    assert not kept("length A <= 1 andalso hd A = 1 andalso length B <= 1 andalso hd B = 1")
    assert not kept("List.all (fn x => x = length A) B")


def test_reductions_say_what_is_exchanged_and_what_is_not() -> None:
    net = flat(CELL)
    names, d = chosen_names(net, Reduction.SYMMETRY)
    assert names == ("exchanges of Top.R1, Top.R2",)
    assert not d.items
    names, d = chosen_names(net, Reduction.PARTIAL_ORDER, Reduction.SYMMETRY)
    assert names == ()
    assert ["equal parts are not exchanged then" in i.message for i in d].count(True) == 1
    names, d = chosen_names(flat(CELL.replace("Go2 : INT = 1`0", "Go2 : INT")), Reduction.SYMMETRY)
    assert names == ()
    assert "no two parts of the net can be exchanged" in d.items[0].message


def test_random_families_are_found_unless_one_is_odd() -> None:
    none = 0
    for seed in range(60):
        none += not found(family(Random(seed))).families
    assert 0 < none < 30
