"""Orders in which variables get values: nets are accepted where the engine of CPN Tools accepts them (it was asked)."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose
from pn2code.net import engine_search

HEAD = """
    net N
      standard
      colset R = product INT * INT * INT;
      colset E = with e1 | e2;
      colset S = product E * E;
      colset L = list INT;
      colset TR = product INT * INT timed;
      var a, b, c, d, e: INT; var u, v, w: E; var l, m: L;
      place P : R
      place P2 : R
      place Q : INT
      place QE : S
      place T : TR
      place LL : L
      trans X
"""
ACCEPTED = (
    "P : 1`(a,b,1)++1`(a,b,c)", "P : 1`(a,b,c)++1`(c,1,1)", "P : 1`(a,1,1)++1`(a,b,1)++1`(b,2,2)",
    "P : 1`(a,b,1)++1`(b,c,1) | guard [c = a+b]", "P : 1`(a,b,1)++1`(b,c,1) | guard [b = 3]",
    "P : 1`(a,b,1)++1`(b,c,1) | guard [a = 3]", "P : 2`(a,b,1)++3`(a,b,1)", "QE : 1`(u,v)++1`(u,e1)",
    "P : 1`(a,b,c)++1`(a,b,d);Q : d", "P : 1`(a,b,c)++1`(a,b,d);Q : 1`c++1`d", "Q : 1`c++1`d++1`c",
    "LL : 1`(a::l)++1`l", "LL : 1`[a]++1`[a,b]", "P : 1`(a,b,1)++1`(c,d,1)++1`(a,c,1)", "P : 1`(a,a,1)++1`(a,b,1)",
    "P : 1`(a,b,1)++1`(b,c,1);P2 : (b,1,1)", "P : 1`(a,b,1)++1`(b,c,1);P2 : 1`(b,1,1)++1`(b,d,1)",
    "P : 1`(a,b,c)++1`(d,e,1)", "P2 : (a,b,c);P : 1`(a,b,d)++1`(a,c,e)", "Q : a;P : 1`(a,b,c)++1`(a,d,e)",
)  # fmt: skip
REFUSED = (
    "P : 1`(a,b,c)++1`(a,d,1)", "QE : 1`(u,v)++1`(v,w)", "T : 1`(a,b)++1`(a,d)", "LL : 1`(a::l)++1`(b::l)",
    "LL : 1`(a::l)++1`(a::m)", "P : 1`(a,b,1)++1`(c,d,1)++1`(a,e,1)", "P : 1`(a,b,c)++1`(d,b,c)",
    "Q : a;P : 1`(a,b,c)++1`(a,b,d)",
)  # fmt: skip


def said(case: str) -> list[str]:
    arcs, _, guard = case.partition(" | ")
    lines = [f"        {guard}"] * bool(guard) + [f"        in {a}" for a in arcs.split(";")]
    return [e.code for e in diagnose(HEAD + "\n".join(lines)).errors]


@pytest.mark.parametrize("case", ACCEPTED)
def test_accepted(case: str) -> None:
    assert said(case) == []


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case: str) -> None:
    assert said(case) == ["summands-share-variables"]


TURN = """
    net N
      standard
      colset E = with e1 | e2 | e3;
      colset S = product E * E;
      var u, v, w: E; var n, m: INT; var k: BOOL;
      fun turn e1 = e2 | turn e2 = e3 | turn e3 = e1;
      fun both e = (e, turn e);
      fun many e1 = 1 | many _ = 2;
      fun some e = many e`e;
      place A : E = 2`e1 ++ 3`e2
      place S : S = 1`(e1, e2)
      place K : BOOL = true
      place Q : INT
      place O : E
      trans X
"""
IN_ORDER = (
    "in A : some u;out O : v | u = turn v", "in A : u;out O : v | u = v",
    "in A : some u;out O : v | u = v, v = turn e1", "in A : u;out O : v | (u, v) = both u",
    "in A : u;out Q : n | (u, n) = (u, 3)", "in A : u;out Q : n + m | (n, m) = (3, n), n = 3",
    "in A : some u;out O : v | u = v andalso true", "in A : some u;in K : k;out O : v | u = (if k then v else e1)",
    "in A : some u;out O : w | u = turn v, v = turn w", "in A : (many u)`v;out O : u", "in A : (many u)`u;in A : u",
    "in A : (many u)`(turn u)", "in A : (many u)`u | u = e1", "in S : 1`(u, v) ++ (many u)`(v, u)",
    "in S : (many u)`(v, turn u)",
)  # fmt: skip
IN_CIRCLES = (
    "out O : v | u = v", "in A : some u;out O : v | u = v, k = true", "in A : some u;in A : some v | u = v",
    "in A : some u;out O : u | u = turn u", "in A : some u;out O : v | u = turn v, v = turn u",
    "in A : some u;out O : v | (u, v) = both u", "in A : some u;out O : w | u = v, v = w", "in A : (many u)`u",
    "in A : (many u)`u;in A : some u", "in A : (many u)`u ++ 1`v", "in S : (many u)`(u, v)",
    "in A : (many u)`u | u <> e1", "out Q : n | (n, m) = (3, n)",
)  # fmt: skip


def said_of(case: str) -> list[str]:
    arcs, _, guard = case.partition(" | ")
    lines = [f"        guard [{guard}]"] * bool(guard) + [f"        {a}" for a in arcs.split(";")]
    return [e.code for e in diagnose(TURN + "\n".join(lines)).errors]


@pytest.mark.parametrize("case", IN_ORDER)
def test_a_variable_that_nothing_could_bind_has_all_values(case: str) -> None:
    assert said_of(case) == []


@pytest.mark.parametrize("case", IN_CIRCLES)
def test_variables_that_need_each_other_are_refused(case: str) -> None:
    of_large_sets = {"unbound-variable"}
    found = set(said_of(case))
    assert found in ({"binding-circle"}, of_large_sets), found


@pytest.mark.parametrize("guard", ["", " guard [v0 = v1]"])
def test_a_wide_record_on_two_arcs_comes_to_an_end(guard: str) -> None:
    """Each of its components may find the token, and each subset of them: of 40 there are too many."""
    labels = range(40)
    record = " * ".join(f"f{i}: INT" for i in labels)
    value = ", ".join(f"f{i} = v{i}" for i in labels)
    names = ", ".join(f"v{i}" for i in labels)
    net = f"""
    net N
      standard
      colset R = record {record};
      var {names}: INT;
      place A : R
      place B : R
      trans T{guard}
        in A : {{{value}}}
        in B : {{{value}}}
    """
    assert not diagnose(net).items


DELAYED = """
    net N
      standard
      colset T = int timed;
      colset K = int with 0..3 timed;
      colset U = int;
      colset W = union V: U + X;
      var t: T; var k: K; var n: U; var w: W;
      place A : T
      place B : K
      place Q : U
      place D : W
      trans X
"""


@pytest.mark.parametrize(
    ("arcs", "codes"),
    [
        ("in A : t@+1", []),
        ("in A : 1`t@+1", []),
        ("in B : k@++1", []),  # of a small colour set all values are tried
        ("in A : t@++1;in Q : t", []),
        ("in A : t@++1", ["binding-circle"]),
        ("in A : 1`t@++1", ["binding-circle"]),
        ("in A : 1`3@+1 +++ 1`t@++1", ["binding-circle"]),
        ("in A : t@+t", ["binding-circle"]),
    ],
)
def test_a_long_delay_on_an_input_arc_is_no_pattern(arcs: str, codes: list[str]) -> None:
    """As the engine says: it was asked about each."""
    text = DELAYED + "\n".join(f"        {a}" for a in arcs.split(";"))
    assert [e.code for e in diagnose(text).errors] == codes


def test_what_is_taken_beyond_cpn_tools_is_not_refused_for_its_sake() -> None:
    found = diagnose(DELAYED + "        guard [n > 1]\n        in D : w as V n")
    assert [(e.severity.name, e.code) for e in found.items] == [("WARNING", "arc-as-pattern")]


def test_a_search_that_is_given_up_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    text = HEAD + "        in P : 1`(a,b,1)++1`(c,d,1)++1`(a,c,1)\n"
    assert "engine-order" not in {x.code for x in diagnose(text).items}
    monkeypatch.setattr(engine_search, "MOST", 1)
    found = diagnose(text)
    assert not found.errors
    assert "engine-order" in {x.code for x in found.items}
