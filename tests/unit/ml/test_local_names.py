"""Local names in inscriptions that CPN Tools takes for variables of the net, as its engine was seen to do."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose, flat

NET = """
    net Names
      colset INT = int;  colset S = int with 1..2;  colset L = list S;  colset P = product S * S;
      var n, m, max: S;  var l: L;
      structure Q = struct val n = 2 structure W = struct val n = 1 end end
      exception Ex of int
      page Top
        place A : L = 1`[1,2]
        place P : P
        place B : S
        place C : L
        trans T {guard}
          in A : l
          {arc}
"""


def variables(arc: str = "", guard: str = "") -> str:
    """The variables of T, with an arc or a guard, but for `l`."""
    net = flat(NET.format(arc=arc, guard=f"guard [{guard}]" if guard else ""))
    (t,) = net.transitions
    return "".join(v.name for v in t.variables if v.name != "l")


@pytest.mark.parametrize(
    ("text", "seen"),
    [
        ("case l of n :: _ => n | _ => 2", "n"),
        ("case l of [n] => 1 | _ => 2", ""),
        ("case 1 of n => let val m = n in m end", "n"),
        ("hd (List.map (fn n => 1) l)", ""),
        ("hd (List.map (fn n => n) l)", "n"),
        ("(fn (n, m) => n) (1, 2)", "n"),
        ("(fn n => let val n = n in n end) 1", "n"),
        ("let val n = 1 in n end", ""),
        ("let val n = 1 in (let val m = n in m end) end", ""),
        ("let val m = 1 val n = m in n end", "m"),
        ("let val f = fn n => n in f 1 end", "n"),
        ("let val rec f = fn n => n in f 1 end", "n"),
        ("let val (n as m) = 1 in n end", ""),
        ("(let val n = 1 in n end; n)", "n"),
        ("(raise Ex 1) handle Ex n => n", "n"),
        ("1 handle Ex n => 2", ""),
        ("Q.n", "n"),
        ("Q.W.n", "n"),
        ("Int.max (1, 2)", "max"),
        ("#n {n = 1, m = 2}", ""),
    ],
)
def test_names_that_count(text: str, seen: str) -> None:
    assert variables(arc=f"out B : {text}") == seen


@pytest.mark.parametrize(
    ("text", "seen"),
    [
        ("List.all (fn n => n > 0) l", "n"),
        ("List.all (fn n => true) l", ""),
        ("let val n = 1 in n = 1 end", ""),
        ("case l of n :: _ => n > 0 | _ => true", "n"),
    ],
)
def test_in_guards(text: str, seen: str) -> None:
    assert variables(guard=text) == seen


def test_in_an_input_inscription_they_are_tried() -> None:
    assert variables(arc="in P : (fn (n, m) => (n, m)) (1, 2)") == "mn"
    assert variables(arc="in B : (case l of n :: _ => n | _ => 1)`1") == "n"


def test_a_transition_says_that_it_has_one_more() -> None:
    d = diagnose(NET.format(arc="out B : hd (List.map (fn n => n) l)", guard=""))
    assert [(w.code, w.origin.part) for w in d.items] == [("local-name-of-variable", "inscription")]
    assert "variable `n`" in d.items[0].message


def test_no_word_about_one_that_is_used_besides() -> None:
    arc = "in B : n\n          out C : List.map (fn n => n) l"
    assert not diagnose(NET.format(arc=arc, guard="")).items


def test_one_of_a_large_colour_set_has_no_value() -> None:
    text = NET.replace("var n, m", "var n: INT;  var m")
    d = diagnose(text.format(arc="out C : List.map (fn n => n) l", guard=""))
    (error,) = d.errors
    assert error.code == "unbound-variable" and "local name" in error.message
    assert [n.message for n in error.notes] == ["the transition is here"]
    assert not diagnose(
        text.format(arc="out C : List.map (fn n => n) l", guard="guard [n = 2]")
    ).items


def test_a_code_output_may_not_be_seen_in_the_guard() -> None:
    text = NET.replace("{guard}", "{guard} code input (l); output (n); action hd l")
    arc = "out C : List.map (fn n => n) l"
    assert not diagnose(text.format(arc=arc, guard="")).items
    found = diagnose(text.format(arc=arc, guard="guard [List.all (fn n => n > 0) l]"))
    assert [e.code for e in found.errors] == ["code-output-bound"]


OPENED = """
net Opened
  colset INT = int;
  colset INTT = int timed;
  var n, k : INT;
  page Top
    place A : INT = 1`1
    place B : INTT {place}
    trans T {trans}
      in A : n
      out B : {out}
"""


@pytest.mark.parametrize("text", ["let fun f x = x in f 1 end", "let open List in hd l end"])
def test_declarations_that_keep_cpn_tools_from_checking(text: str) -> None:
    for arc, guard in ((f"out B : {text}", ""), ("", f"guard [{text} = 1]")):
        d = diagnose(NET.format(arc=arc, guard=guard))
        assert [w.code for w in d.items] == ["declaration-in-inscription"]


def test_opening_keeps_cpn_tools_from_checking_whatever_the_inscription_is() -> None:
    opening, other = "let open List in hd [1] end", "let fun open' x = x in open' 1 end"
    for text, wanted in ((opening, ["declaration-in-inscription"]), (other, [])):
        for place, trans in (
            (f"= {text}", ""),
            ("", f"code input (n); output (k); action {text};"),
            ("", f"delay @+{text}"),
        ):
            net = OPENED.format(place=place, trans=trans, out="k" if "code" in trans else "n")
            assert [w.code for w in diagnose(net).items] == wanted
