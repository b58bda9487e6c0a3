"""Checking: colour sets of places, forms of inscriptions, terms, binding plans, diagnostics."""

from __future__ import annotations

from collections.abc import Mapping
from textwrap import dedent, indent

import pytest

from helpers.netbuilder import cpn, diagnose
from pn2code.diagnostics import Diagnostic, Diagnostics
from pn2code.ml.core.terms import Lit, PCon, PRecord, PVar
from pn2code.net.check import check
from pn2code.net.flat import (
    ArcInscription,
    BindAll,
    BindEquation,
    BindRandom,
    BindStep,
    BindTerm,
    Form,
)
from pn2code.net.link import link
from pn2code.net.typed import TypedNet, TypedTransition
from pn2code.net.uses import pattern_variables
from pn2code.reading.cpn import read_data

BASE = """
      standard
      colset INTT = int timed;
      colset SMALL = int with 1..3;
      colset BIG = int with 1..1000;
      colset ALLBIG = int with 1..1000 declare all;
      colset COLOUR = with red | green | blue;
      colset PAIR = product INT * INT;
      colset REC = record a: INT * b: BOOL;
      colset LINT = list INT;
      colset U = union Ack: INT + Nil;
      var n, m, k: INT;
      var t, u: INTT;
      var s, s2: SMALL;
      var big: BIG;
      var allbig: ALLBIG;
      var c: COLOUR;
      var b: BOOL;
      var r: REC;
      var l: LINT;
      var pair: PAIR;
      fun f x = x + 1
"""


def net(body: str) -> str:
    return "net N" + BASE + indent(dedent(body).strip("\n"), " " * 6)


def run(body: str, values: Mapping[str, str] | None = None) -> tuple[TypedNet | None, Diagnostics]:
    d = Diagnostics()
    document = read_data(cpn(net(body)), "n.cpn", d)
    assert document is not None, list(d)
    linked = link(document, d)
    assert linked is not None, list(d)
    return check(linked, d, values), d


def typed(body: str) -> TypedNet:
    result, d = run(body)
    assert not list(d), "\n".join(f"{x.code}: {x.message}" for x in d)
    assert result is not None
    return result


def transition(body: str) -> TypedTransition:
    (t,) = typed(body).pages[0].transitions
    return t


def only_error(body: str) -> Diagnostic:
    result, d = run(body)
    assert result is None
    (item,) = d.errors
    return item


def plan(t: TypedTransition) -> list[str]:
    def show(step: BindStep) -> str:
        match step:
            case BindTerm(arc, term):
                return f"term {arc}.{term}"
            case BindEquation(guard, pattern, _):
                return f"guard {guard} " + ",".join(s.name for s in pattern_variables(pattern))
            case BindAll(symbol):
                return f"all {symbol.name}"
            case BindRandom(symbol):
                return f"random {symbol.name}"

    return [show(s) for s in t.plan]


def names(t: TypedTransition) -> list[str]:
    return [v.name for v in t.variables]


def inscription(t: TypedTransition, arc: int) -> ArcInscription:
    found = t.arcs[arc].inscription
    assert found is not None
    return found


# --- places ---


def test_place_colour_sets_and_initial_markings() -> None:
    page = typed(
        """
        place A : INT = 1`1 ++ 2`3
        place B : INT = 5
        place C : LINT = [1, 2]
        place D : INTT = 1`1@4
        place E : INTT = 3
        place F : INTT = (1`1 ++ 1`2) @+ 4
        place G : INT
        """
    ).pages[0]
    forms = {p.name: p.initial[1] if p.initial else None for p in page.places}
    assert forms == {
        "A": Form.MULTISET,
        "B": Form.TOKEN,
        "C": Form.TOKEN,
        "D": Form.TIMED_MULTISET,
        "E": Form.TOKEN,
        "F": Form.TIMED_MULTISET,
        "G": None,
    }


def test_unit_defaults() -> None:
    page = typed(
        """
        place A = 3
        place B : UNIT =  2
        trans T
          in A
          out B : 2
        """
    ).pages[0]
    assert [p.colset.name for p in page.places] == ["UNIT", "UNIT"]
    assert [p.initial[1] if p.initial else None for p in page.places] == [Form.MULTISET] * 2
    t = page.transitions[0]
    assert [inscription(t, i).form for i in (0, 1)] == [Form.MULTISET] * 2
    coefficient = inscription(t, 0).terms[0].coefficient
    assert isinstance(coefficient, Lit) and coefficient.value == 1


def test_unknown_colour_set() -> None:
    item = only_error("place A : COLOR")
    assert item.code == "place-colset"
    assert item.message == "place `A` has the unknown colour set `COLOR`"
    assert item.hint == "did you mean `COLOUR`?"
    assert item.span is not None and item.span.text == "COLOR"
    assert item.origin.line > 0


def test_no_unit_declared() -> None:
    messages = [(x.code, x.message) for x in diagnose("net N\n  place A")]
    assert messages == [("place-colset", "place `A` has no colour set, and `UNIT` is not declared")]


def test_broken_colour_set_has_no_consequences() -> None:
    d = diagnose(
        """
        net N
          colset INT = int;
          colset X = product INT * NOWHERE;
          var x: X;
          place A : X
          trans T
            in A : x
        """
    )
    assert len(d.errors) == 1, [x.message for x in d.errors]
    assert "NOWHERE" in d.errors[0].message


def test_type_error_in_an_inscription() -> None:
    item = only_error(
        """
        place A : INT
        trans T
          in A : "word"
        """
    )
    assert "INT" in item.message
    assert item.origin.element == "arc `A` -> `T`"
    assert item.origin.part == "inscription"
    assert item.origin.line > 0 and item.origin.column > 0


def test_all_independent_errors_are_reported() -> None:
    result, d = run(
        """
        place A : INT = true
        place B : NOWHERE
        trans T guard [1]
          in A : "word"
          in B : whatever
        trans U
          in A : m
          out A : k
        """
    )
    assert result is None
    assert len(d.errors) == 5


def test_empty_arc() -> None:
    item = only_error("place A : INT\ntrans T\n  in A")
    assert item.code == "arc-empty"
    assert item.message == "arc `A` -> `T` has no inscription"


def test_inhibitor_and_reset_arcs() -> None:
    result, d = run(
        """
        place A : INT
        trans T
          inhibit A : n
          reset A
        """
    )
    assert result is not None
    assert [x.code for x in d] == ["arc-inscription-ignored"]
    t = result.pages[0].transitions[0]
    assert [a.kind.value for a in t.arcs] == ["inhibitor", "reset"]
    assert [a.inscription for a in t.arcs] == [None, None]


def test_use_and_unknown_declarations() -> None:
    d = diagnose('net N\n  use "a.sml"\n  place A')
    assert [x.code for x in d.errors][0] == "used-file"


def test_reference_without_value() -> None:
    data = cpn("net N\n  standard\n  globref r = 1;\n  place A")
    d = Diagnostics()
    document = read_data(data.replace(b"<ml>1</ml>", b""), "n.cpn", d)
    assert document is not None
    linked = link(document, d)
    assert linked is not None
    assert check(linked, d) is not None
    assert [x.code for x in d] == ["declaration-empty"]
    assert d.items[0].message == "reference `r` has no value and is not declared"


def test_unknown_declaration() -> None:
    data = cpn("net N\n  standard\n  place A")
    d = Diagnostics()
    document = read_data(
        data.replace(b"</globbox>", b"<errordecl>color X =</errordecl></globbox>"), "n", d
    )
    assert document is not None
    linked = link(document, d)
    assert linked is not None
    assert check(linked, d) is None
    assert [x.code for x in d] == ["declaration-not-read"]
    assert "could not read this declaration and kept its text: `color X =`" in d.items[0].message


# --- terms ---


def test_terms_of_a_multiset() -> None:
    t = transition(
        """
        place A : INT
        trans T
          in A : 1`n ++ 2`m ++ 1`f n ++ 1`7
        """
    )
    found = inscription(t, 0)
    assert found.form is Form.MULTISET
    patterns = [term.pattern for term in found.terms]
    assert isinstance(patterns[0], PVar) and isinstance(patterns[1], PVar)
    assert patterns[2:] == [None, None]
    coefficients = [term.coefficient for term in found.terms]
    assert [x.value for x in coefficients if isinstance(x, Lit)] == [1, 2, 1, 1]
    assert [term.whole for term in found.terms] == [False] * 4
    assert plan(t) == ["term 0.0", "term 0.1"]


def test_patterns() -> None:
    t = transition(
        """
        place A : PAIR
        place B : REC
        place C : LINT
        place D : U
        place E : COLOUR
        trans T
          in A : (n, ~1)
          in B : {b = b, a = m}
          in C : n :: [k, 3]
          in D : Ack(k)
          in E : red
        """
    )
    pair = inscription(t, 0).terms[0].pattern
    assert isinstance(pair, PRecord) and isinstance(pair.fields[0][1], PVar)
    rec = inscription(t, 1).terms[0].pattern
    assert isinstance(rec, PRecord)
    assert [label for label, _ in rec.fields] == ["a", "b"]
    items = inscription(t, 2).terms[0].pattern
    assert isinstance(items, PCon) and items.constructor.name == "::"
    assert inscription(t, 4).terms[0].pattern is None
    assert plan(t) == ["term 0.0", "term 2.0", "term 1.0"]
    assert names(t) == ["b", "k", "m", "n"]


def test_timed_input_arcs() -> None:
    t = transition(
        """
        place A : INTT
        place B : INTT
        trans T
          in A : t @+ 3
          in B : 1`u @+ 1 +++ 2`u @+ 2
        """
    )
    first = inscription(t, 0).terms
    assert len(first) == 1
    assert isinstance(first[0].delay, Lit) and first[0].delay.value == 3
    assert isinstance(first[0].pattern, PVar)
    second = inscription(t, 1)
    assert second.form is Form.TIMED_MULTISET
    assert [x.delay.value for x in second.terms if isinstance(x.delay, Lit)] == [1, 2]


def test_unsupported_timed_input() -> None:
    item = only_error(
        """
        place A : INTT
        trans T
          in A : if true then 1`t @+ 3 else 1`t @+ 4
        """
    )
    assert item.code == "unsupported-timed-input"


def test_both_arc_has_terms() -> None:
    t = transition("place A : INT\ntrans T\n  both A : n")
    assert plan(t) == ["term 0.0"]


# --- plans ---


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        # a summand that shares a variable comes first
        ("in A : n\nin B : m\nin P : (n, k)", ["term 0.0", "term 2.0", "term 1.0"]),
        # repeated variables are tests
        ("in A : n\nin B : n", ["term 0.0"]),
        # guard equations, in either direction and in chains
        ("guard [k = f m, m = f n]\nin A : n\nout A : k", ["term 0.0", "guard 1 m", "guard 0 k"]),
        ("guard [f n = m]\nin A : n\nout A : m", ["term 0.0", "guard 0 m"]),
        ("guard [(m, k) = pair]\nin P : pair\nout A : m", ["term 0.0", "guard 0 m,k"]),
        # variables of arcs are bound there, and the equation tests
        ("guard [m = f n]\nin A : n\nin B : m", ["term 0.0", "term 1.0"]),
        # an equation may make a delay known
        ("guard [k = f n]\nin A : n\nin T : t @+ k", ["term 0.0", "guard 0 k", "term 1.0"]),
        # small colour sets
        ("guard [s > 1]\nin A : n\nout A : n", ["term 0.0", "all s"]),
        ("guard [s2 = f s]\nin A : n", ["term 0.0", "all s", "guard 0 s2"]),
        ("in A : f s", ["all s"]),
        # the variable that lets others be bound is enumerated first
        ("guard [n = f s, s2 < n]\nout A : n", ["all s", "guard 0 n", "all s2"]),
        # output only
        ("in A : n\nout B : n\nout S : s\nout C : c", ["term 0.0", "random c", "random s"]),
        ("in A : n\nout D : allbig", ["term 0.0", "random allbig"]),
        ("in A : n\ndelay @+ s\nout T : n", ["term 0.0", "random s"]),
        # code segments
        ("code input (n); output (m); action n + 1\nin A : n\nout A : m", ["term 0.0"]),
        ("code input (n, s); output (m); action n + s\nin A : n\nout A : m", ["term 0.0", "all s"]),
        # conditions on input arcs only test
        ("in A : n\nin B : if n > 1 then 1`7 else empty", ["term 0.0"]),
    ],
)
def test_plan(body: str, expected: list[str]) -> None:
    places = """
place A : INT
place B : INT
place P : PAIR
place T : INTT
place S : SMALL
place C : COLOUR
place D : ALLBIG
trans X
"""
    text = "\n".join("  " + line for line in body.split("\n"))
    assert plan(transition(places + text)) == expected


def test_plan_of_a_variable_twice() -> None:
    result, d = run("place P : PAIR\ntrans X\n  in P : (n, n)")
    assert result is not None
    (t,) = result.pages[0].transitions
    assert plan(t) == ["term 0.0"]
    assert [x.code for x in d] == ["pattern-repeats"]


def test_variables_are_sorted_code_outputs_last() -> None:
    t = transition(
        """
        place A : INT
        trans T code input (n); output (k, b); action (n, true)
          in A : n ++ m
          out A : 1`k
        """.replace("n ++ m", "1`n ++ 1`m")
    )
    assert names(t) == ["m", "n", "k", "b"]
    assert t.code is not None
    assert [s.name for s in t.code.outputs] == ["k", "b"]


@pytest.mark.parametrize(
    ("body", "name"),
    [
        ("in A : n\nout A : m", "m"),
        ("in A : n\nout A : n\nguard [m > n]", "m"),
        ("in A : f n", "n"),
        ("in A : if n > 1 then 1`n else empty", "n"),
        ("in A : n\nguard [n > 1 andalso m = n]\nout A : m", "m"),
        ("in A : n\nguard [m = f m]\nout A : m", "m"),
        ("in S : s\nin A : s`n", "n"),
        ("in A : n\nout B : big", "big"),
        ("in T : t @+ k", "k"),
        ("in A : n\ndelay @+ m", "m"),
        ("in A : n\ncode input (m); action ()", "m"),
    ],
)
def test_unbound_variable(body: str, name: str) -> None:
    places = """
place A : INT
place B : BIG
place S : SMALL
place T : INTT
trans X
"""
    item = only_error(places + "\n".join("  " + line for line in body.split("\n")))
    assert item.code == "unbound-variable"
    assert item.message.startswith(f"variable `{name}` of transition `X` gets no value")
    assert "is not a small colour set" in item.message
    assert name in item.hint
    assert item.span is not None
    assert item.origin.line > 0


def test_unbound_variable_says_why_a_summand_does_not_bind() -> None:
    item = only_error(
        """
        place A : INT
        place S : SMALL
        trans X
          in S : s
          in A : s`n
        """
    )
    assert "its coefficient has a variable" in item.notes[0].message


def test_code_output_that_is_bound() -> None:
    item = only_error(
        """
        place A : INT
        trans X code output (n); action 5
          in A : n
          out A : n
        """
    )
    assert item.code == "code-output-bound"


def test_priority_and_delay() -> None:
    body = """
        val P_HIGH = 100;
        place A : INT
        place T : INTT
        trans X priority P_HIGH delay @+ 3
          in A : n
          out T : n
        trans Y
          in A : n
    """
    x, y = typed(body).pages[0].transitions
    assert (x.priority, y.priority) == (100, 1000)
    assert x.delay is not None and y.delay is None


def test_output_arcs_take_all_before_the_first_delay_together() -> None:
    t = transition(
        """
        place A : INT
        place T : INTT
        trans X
          in A : n
          out T : 1`n ++ 1`(n + 1) @+ 3
        """
    )
    assert inscription(t, 1).form is Form.TIMED_MULTISET
    item = only_error(
        """
        place T : INTT
        trans X
          in T : 1`t ++ 1`u @+ 3
        """
    )
    assert item.origin.part == "inscription"


def test_values_replace_declarations() -> None:
    body = """
        val most = 3;
        place A : INT = most`1
    """
    result, d = run(body, {"most": "5"})
    assert result is not None and not list(d)
    _, d = run(body, {"most": "true"})
    assert d.errors
    _, d = run(body, {"nothing": "5"})
    assert d.errors
