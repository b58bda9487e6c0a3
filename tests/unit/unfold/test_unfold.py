"""Unfolding: places of colours, transitions of bindings, and the same behaviour."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from helpers.pnml_nets import size, unfolded_size
from pn2code.diagnostics import Diagnostics
from pn2code.unfold.unfold import unfold

RING = """
    net Ring
      standard
      colset CH = with red | green | blue;
      colset PAIR = product CH * BOOL;
      var c: CH;  var b: BOOL;
      fun next red = green | next green = blue | next blue = red
      page Top
        place A : PAIR = 1`(red, true) ++ 2`(green, false)
        place B : CH
        place Done = 0
        trans Turn guard [c <> blue]
          in A : (c, b)
          out A : (next c, not b)
        trans Move
          in A : 1`(c, true) ++ 1`(c, false)
          out B : 2`c
        trans Stop
          both A : (blue, b)
          in B : c
          out Done : ()
"""


def test_places_and_transitions() -> None:
    u = unfold(flat(RING), Diagnostics())
    assert u is not None
    assert [(p.name, p.initial) for p in u.places] == [
        ("Top.A[(red,true)]", 1),
        ("Top.A[(green,false)]", 2),
        ("Top.A[(blue,true)]", 0),
        ("Top.Done", 0),  # of the unit token: a place of a P/T net, even if it is always empty
    ]
    assert [t.name for t in u.transitions] == [
        "Top.Turn[b=false,c=green]",
        "Top.Turn[b=true,c=red]",
    ]
    assert [(t.pre, t.post) for t in u.transitions] == [({1: 1}, {2: 1}), ({0: 1}, {1: 1})]
    assert u.of_place == ((0, 1, 2), (), (3,))


def test_same_size() -> None:
    text = RING.replace("= 1`(red, true) ++ 2`(green, false)", "= 2`(red, true) ++ 1`(red, false)")
    net = flat(text)
    u = unfold(net, Diagnostics())
    assert u is not None and len(u.of_place[1]) == 3
    assert unfolded_size(u) == size(net)


def test_counts_inhibitors_and_resets() -> None:
    net = flat(
        """
        net N
          standard
          colset S = int with 0..3;
          var n, m: S;
          page Top
            place P : S = 2`0 ++ 1`2
            place Q : S
            trans Put
              in P : 1`n
              out Q : 2`n ++ 1`((n + 1) mod 4)
            trans Take
              in Q : 1`n ++ 2`n
              inhibit P
            trans Clear
              in Q : n
              out Q : 3
              reset Q
              out P : n
        """
    )
    u = unfold(net, Diagnostics())
    assert u is not None
    take = next(t for t in u.transitions if t.name.startswith("Top.Take"))
    assert set(take.pre.values()) == {3} and take.inhibitors == u.of_place[0]
    clear = next(t for t in u.transitions if t.name.startswith("Top.Clear"))
    assert clear.resets == u.of_place[1]
    bounded = flat(
        """
        net N
          standard
          colset S = int with 0..3;
          var n: S;
          page Top
            place P : S = 2`0 ++ 1`2
            place Q : S
            place R : S = 1`1
            trans Put
              in P : n
              out Q : 2`n ++ 1`((n + 1) mod 4)
            trans Take
              in Q : 1`n ++ 1`n
              inhibit P
            trans Clear
              in R : n
              out R : (n + 1) mod 4
              reset Q
        """
    )
    small = unfold(bounded, Diagnostics())
    assert small is not None
    assert unfolded_size(small) == size(bounded)


def test_an_infinite_colour_set_with_finitely_many_colours() -> None:
    net = flat(
        """
        net N
          standard
          var n: INT;  var s: STRING;
          page Top
            place P : INT = 1`1
            place W : STRING = 1`"a"
            trans T guard [n < 5]
              in P : n
              out P : n + 1
              in W : s
              out W : if String.size s > 2 then s else s ^ "b"
        """
    )
    u = unfold(net, Diagnostics())
    assert u is not None
    assert [len(p) for p in u.of_place] == [5, 3]
    assert unfolded_size(u) == size(net) == (5, 4)


@pytest.mark.parametrize("coefficient", ["0", "none", "(2 * none)"])
def test_a_token_that_is_not_taken_must_be_there(coefficient: str) -> None:
    net = flat(
        f"""
        net N
          standard
          val none = 0;
          var n: INT;
          page Top
            place P : INT = 1`1 ++ 2`2
            trans Look
              in P : {coefficient}`n
            trans Take
              in P : n
        """
    )
    u = unfold(net, Diagnostics())
    assert u is not None
    assert unfolded_size(u) == size(net)


def test_a_counter_without_end_is_given_up() -> None:
    net = flat(
        """
        net N
          standard
          var n: INT;
          page Top
            place P : INT = 1`1
            trans T
              in P : n
              out P : n + 1
        """
    )
    d = Diagnostics()
    assert unfold(net, d, max_places=50) is None
    assert [e.message for e in d.errors] == ["the unfolded net has more than 50 places"]
    assert d.errors[0].code == "unfolding-too-large"


def test_a_binding_that_raises() -> None:
    net = flat(
        """
        net N
          standard
          var n, m: INT;
          page Top
            place P : INT = 1`4 ++ 1`2
            place Q : INT = 1`0 ++ 1`1
            trans T
              in P : n
              in Q : m
              out P : n div m
        """
    )
    d = Diagnostics()
    u = unfold(net, d)
    assert u is not None
    assert {f.name for f in u.faults} == {"Top.T[m=0,n=2]", "Top.T[m=0,n=4]"}
    assert {w.code for w in d.items} == {"unfolding-fault"}


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("out P : n\n          code input (n); action ()", "transition `Top.T` has a code segment"),
        ("out P : discrete(1, 2)", "transition `Top.T` uses `Random.discrete`"),
        ("out P : f n", "transition `Top.T` uses `Ref."),
        ("out Q : n", "place `Top.Q` is timed"),
    ],
)
def test_what_cannot_be_unfolded(line: str, said: str) -> None:
    net = flat(
        f"""
        net N
          standard
          colset TI = int timed;
          var n: INT;
          globref count = 0;
          fun f x = (count := x; x + !count)
          page Top
            place P : INT = 1`1
            place {"Q : TI" if "Q" in line else "Q : INT"}
            trans T {"code input (n); action ()" if "code" in line else ""}
              in P : n
              {line.partition(chr(10))[0]}
        """
    )
    d = Diagnostics()
    assert unfold(net, d) is None
    assert any(said in e.message for e in d.errors), [e.message for e in d.errors]
    assert {e.code for e in d.errors} == {"unsupported-unfolding"}
