"""Which nets permit partial order and symmetry; which symmetries are found; what is irrelevant on ways to dead ones."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.unfold.unfold import unfold
from pn2code.verify.exploring.elements import NotPossibleError, colours, elements, ordinal
from pn2code.verify.exploring.irrelevant_elements import irrelevant
from pn2code.verify.exploring.limits import Reduction
from pn2code.verify.exploring.reductions import possible
from pn2code.verify.exploring.symmetry import Symmetries, symmetries

RING = """
    net Ring
      colset PH = with a | b | c | d;
      colset FORK = index f with 0..3;
      var p: PH;
      fun left a = f 0 | left b = f 1 | left c = f 2 | left d = f 3;
      fun right a = f 1 | right b = f 2 | right c = f 3 | right d = f 0;
      place Think : PH = PH.all ()
      place Eat : PH
      place Fork : FORK = FORK.all ()
      trans Take
        in Think : p
        in Fork : 1`(left p) ++ 1`(right p)
        out Eat : p
      trans Put
        in Eat : p
        out Think : p
        out Fork : 1`(left p) ++ 1`(right p)
"""


NEXT = "\n"


def found(text: str) -> Symmetries:
    u = unfold(flat(text), Diagnostics())
    assert u is not None
    return symmetries(u)


def useless_names(text: str) -> set[str]:
    u = unfold(flat(text), Diagnostics())
    assert u is not None
    return {t.name for t, own in zip(u.transitions, irrelevant(u), strict=True) if own}


def test_two_colour_sets_turn_together_with_a_reflection() -> None:
    s = found(RING)
    assert s.names() == ("rotations and reflections of PH with FORK",)
    (group,) = s.rotations
    assert group.order == 4
    assert sorted(group.rotation) == list(range(12))
    assert group.reflection is not None and s.full is None


def test_exchanges_of_all_and_of_some() -> None:
    text = """
        net N
          colset W = index w with 1..5;
          colset PAIR = product W * W;
          var x, y: W;
          place A : W = W.all ()
          place B : PAIR
          trans T guard [x <> y]
            in A : 1`x ++ 1`y
            out B : (x, y)
    """
    s = found(text)
    assert s.names() == ("exchanges in W",)
    assert s.full is not None
    assert s.full.classes == (0, 0, 0, 0, 0)
    assert len({shape for shape, _ in s.full.counters}) == 2
    s = found(text.replace("guard [x <> y]", "guard [x <> y, x <> w 2]"))
    assert s.full is not None
    assert s.full.classes == (0, 1, 0, 0, 0)
    s = found(text.replace("= W.all ()", "= 1`(w 1) ++ 1`(w 2) ++ 2`(w 3) ++ 1`(w 4)"))
    assert s.full is not None
    assert s.full.classes == (0, 0, 1, 0, 2)


def test_none() -> None:
    s = found(
        """
        net N
          colset S = int with 0..3;
          var n: S;
          place P : S = 1`0
          trans T guard [n < 3]
            in P : n
            out P : n + 1
        """
    )
    assert s == Symmetries((), None)


def test_numbers_of_colours() -> None:
    net = flat(
        """
        net N
          colset E = with a | b | c;
          colset I = index i with 2..4;
          colset R = record q: E * p: I;
          colset U = union none + one: E + two: R;
          fun big (_, x) = x <> 3;
          colset N = int with ~1..4;
          colset P = product E * N;
          colset S = subset P by big;
          place U : U = U.all ()
          place S : S = S.all ()
          place R : R = R.all ()
        """
    )
    u = unfold(net, Diagnostics())
    assert u is not None
    for place, numbers in enumerate((range(13), None, range(9))):
        own = [ordinal(net.places[place].colset, u.places[i].colour) for i in u.of_place[place]]
        wanted = list(numbers) if numbers is not None else [i for i in range(18) if i % 6 != 4]
        assert own == wanted
    assert [colours(p.colset) for p in net.places] == [13, 18, 9]


def test_rounds_are_useless() -> None:
    assert useless_names(RING) == {f"Top.{t}[p={x}]" for t in ("Take", "Put") for x in "abcd"}
    # A fork that is not put back, or that somebody looks at while it is in use: no round.
    assert useless_names(RING.replace("1`(left p) ++ 1`(right p)\n", "1`(left p)\n", 1)) == set()
    assert (
        useless_names(RING + "      trans Look\n        both Eat : p\n        out Fork : f 0\n")
        == set()
    )
    assert (
        useless_names(RING + "      trans Go\n        in Think : p\n        inhibit Fork\n")
        == set()
    )


def test_an_end_that_is_not_dead_may_still_need_its_beginning() -> None:
    text = """
        net N
          standard
          place A = 1
          place B
          place C = 1
          trans T
            in A
            out B
          trans S
            in B
            in C
            out A
            out C
    """
    assert useless_names(text) == {
        "Top.S"
    }  # but the marking with a token in B is dead without C: T is not


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("in P : n\ncode input (n); action ()", "transition `Top.T` has a code segment"),
        ("in L : l", "the colours of place `Top.L` are not finitely many, or more than 4,096"),
        ("in P : n\nout Q : n div (n - 1)", "an exception might be missed"),
    ],
)
def test_nets_without(line: str, why: str) -> None:
    net = flat(
        f"""
        net N
          standard
          colset S = int with 0..3;
          colset L = list S;
          var n: S;  var l: L;
          place P : S = 1`1
          place Q : S
          {"place L : L" if "L" in line else ""}
          trans T
            {line.replace(NEXT, NEXT + " " * 12)}
        """
    )
    with pytest.raises(NotPossibleError, match=why.split("`")[0]):
        elements(net)
    d = Diagnostics()
    chosen = possible(net, (Reduction.PARTIAL_ORDER, Reduction.SYMMETRY), d)
    assert (chosen.reductions, chosen.elements) == ((Reduction.PARTIAL_ORDER,), None)
    assert chosen.dependency is not None  # of transitions, which needs no list of binding elements
    (warning,) = d.items
    assert warning.message.startswith("the reduction `symmetry` is not possible: ")
    assert why.split("`")[0] in warning.message


def test_priorities_permit_symmetry_alone() -> None:
    net = flat(RING.replace("trans Put", "trans Put priority 5"))
    d = Diagnostics()
    chosen = possible(net, (Reduction.PARTIAL_ORDER, Reduction.SYMMETRY), d)
    assert chosen.reductions == (Reduction.SYMMETRY,)
    assert chosen.symmetry_names() == ("rotations and reflections of PH with FORK",)
    assert [w.message for w in d.items] == [
        "the reduction `partial-order` is not possible: transitions have different priorities"
    ]
