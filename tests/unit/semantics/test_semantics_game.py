"""The token game: enabling, occurrence, time, priorities, special arcs, errors."""

from __future__ import annotations

import random
import textwrap
from typing import Any

import pytest

from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.semantics.evaluation.evaluate import Limits
from pn2code.semantics.game import report, token_game
from pn2code.semantics.game.graph import state_space
from pn2code.semantics.game.marking import BindingElement, place_from_json, place_to_json
from pn2code.semantics.game.token_game import Game, GameError, NotEnabled
from pn2code.semantics.values.data import Timed
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet

HEAD = """net N
  standard
  colset INTT = int timed;
  colset SMALL = int with 1..3;
  colset PAIR = product INT * INT;
  colset F = real;  colset FF = product F * REAL;
  var n, m, k: INT;  var t, u: INTT;  var s: SMALL;  var b: BOOL;  var r, q: REAL;
"""


def game(body: str, head: str = HEAD, **options: Any) -> Game:
    """The game of a net: standard declarations, then the body, indented as one likes."""
    return Game(flat(head + textwrap.indent(textwrap.dedent(body).strip("\n"), "  ")), **options)


def bindings(g: Game) -> list[str]:
    """The enabled elements as `T(n=1)`."""
    found = []
    for e in g.enabled():
        values = ",".join(f"{s.name}={x}" for s, x in e.values)
        found.append(f"{g.net.transitions[e.transition].short}({values})")
    return found


def text(g: Game, place: str) -> str:
    return g.marking_text(f"Top.{place}").replace("\n", " ")


def play(g: Game, steps: int = 100) -> None:
    for _ in g.run(steps=steps):
        pass


# --- bindings ------------------------------------------------------------------------------------


def test_bindings_come_in_the_order_of_the_colours() -> None:
    g = game(
        """
        place P : INT = 1`5 ++ 2`1 ++ 1`3
        place Q : INT = 1`20 ++ 1`10
        trans T guard [n < 5]
          in P : n
          in Q : m
        """
    )
    assert bindings(g) == ["T(m=10,n=1)", "T(m=20,n=1)", "T(m=10,n=3)", "T(m=20,n=3)"]


def test_two_arcs_from_one_place_add_up() -> None:
    body = """
        place P : INT = {0}
        trans T
          in P : n
          in P : n
    """
    assert bindings(game(body.format("1`1"))) == []
    assert bindings(game(body.format("1`1 ++ 1`2"))) == []
    assert bindings(game(body.format("2`1"))) == ["T(n=1)"]


def test_equal_variables_in_a_pattern_must_be_equal() -> None:
    g = game(
        """
        place P : PAIR = 1`(1, 2) ++ 1`(3, 3)
        trans T
          in P : (n, n)
        """
    )
    assert bindings(g) == ["T(n=3)"]


def test_terms_that_are_not_patterns_are_tested() -> None:
    g = game(
        """
        fun twice (x, y) = 1`x ++ 1`(x + y);
        place P : INT = 1`1 ++ 1`2 ++ 1`4
        place Q : INT = 1`1
        trans T
          in Q : n
          in P : twice (n, 1) ++ 1`(n + 3)
        """
    )
    g.fire(g.enabled()[0])
    assert text(g, "P") == "empty"


def test_guard_equations_bind() -> None:
    g = game(
        """
        place P : INT = 1`4
        place Q : PAIR
        trans T guard [(m, k) = (n div 3, n mod 3)]
          in P : n
          out Q : (m, k)
        """
    )
    play(g)
    assert text(g, "Q") == "1`(1,1)"


def test_small_colour_sets_are_enumerated_and_bounds_kept() -> None:
    g = game(
        """
        place P : INT = 1`2 ++ 1`9
        place Q : BOOL
        trans Free
          in P : 2
          out Q : b
        trans Bounded
          in P : s
        """
    )
    assert bindings(g) == ["Free(b=False)", "Free(b=True)", "Bounded(s=2)"]


def test_a_coefficient_of_zero_still_needs_a_token() -> None:
    body = """
        place P : INT{0}
        place Q : INT
        trans T
          in P : 0`n
          out Q : n
    """
    assert bindings(game(body.format(""))) == []
    g = game(body.format(" = 1`3"))
    g.fire(g.enabled()[0])
    assert (text(g, "P"), text(g, "Q")) == ("1`3", "1`3")


def test_inhibitor_both_and_reset_arcs() -> None:
    g = game(
        """
        place P : INT = 1`1 ++ 1`2
        place Stop : INT
        place Bin : INT = 5`7
        place Keep : INT = 1`4
        trans T
          in P : n
          both Keep : 4
          inhibit Stop
          reset Bin
          out Bin : n
          out Stop : 1
        """
    )
    assert bindings(g) == ["T(n=1)", "T(n=2)"]
    g.fire(g.enabled()[1])
    # reset arcs come last: what the output arc put is lost as well
    assert [text(g, p) for p in ("P", "Stop", "Bin", "Keep")] == ["1`1", "1`1", "empty", "1`4"]
    assert bindings(g) == []


# --- time ----------------------------------------------------------------------------------------


def test_time_advances_when_nothing_is_enabled() -> None:
    g = game(
        """
        place P : INTT = 1`1@3 +++ 1`2@8
        place Q : INTT
        trans T delay @+2
          in P : t
          out Q : t @+ 1
        """
    )
    assert g.enabled() == []
    assert g.advance()
    assert (g.marking.time, bindings(g)) == (3, ["T(t=1)"])
    play(g)
    assert (g.marking.time, text(g, "Q")) == (8, "1`1@6+++ 1`2@11")
    assert not g.advance()
    assert g.marking.time == 8


def test_input_delays_take_tokens_early() -> None:
    g = game(
        """
        place P : INTT = 1`1@5 +++ 1`2@9
        place D : INT = 1`4
        trans T
          in P : t @+ n
          in D : n
        """
    )
    assert g.advance()
    assert (g.marking.time, bindings(g)) == (1, ["T(n=4,t=1)"])


def test_several_terms_have_delays_of_their_own() -> None:
    g = game(
        """
        place P : INTT = 1`1@5 +++ 1`2@9
        trans T
          in P : 1`1 @+ 0 +++ 1`2 @+ 3
        """
    )
    assert g.advance()
    assert g.marking.time == 6


def test_of_equal_colours_the_latest_available_is_taken() -> None:
    g = game(
        """
        place P : INTT = 1`1@0 +++ 1`1@3 +++ 1`1@9
        place C : INTT = 1`5@4
        trans T
          in P : t
          in C : u
        """
    )
    play(g)
    assert text(g, "P") == "1`1@9+++ 1`1@0"


def test_the_tightest_demand_chooses_first() -> None:
    # at time 0: one token is due, one may be taken early by the second term only
    g = game(
        """
        place P : INTT = 1`1@0 +++ 1`1@2
        trans T
          in P : 1`1 @+ 2 +++ 1`1 @+ 0
        """
    )
    assert g.advance()
    assert g.marking.time == 0


def test_only_available_tokens_inhibit_and_are_reset() -> None:
    g = game(
        """
        place P : INT = 2`1
        place I : INTT = 1`1@5
        place R : INTT = 1`1@0 +++ 1`2@7
        trans T
          in P : n
          inhibit I
          reset R
        """
    )
    play(g)
    assert (text(g, "P"), text(g, "R"), g.marking.time) == ("empty", "1`2@7", 0)


def test_time_in_expressions_is_the_model_time() -> None:
    g = game(
        """
        place P : INTT = 1`1@4
        place Q : INT
        trans T
          in P : t
          out Q : IntInf.toInt (time ())
        """
    )
    play(g)
    assert text(g, "Q") == "1`4"


def test_a_real_clock() -> None:
    g = game(
        """
        place P : INTT = 1`1
        place Q : INTT
        trans T delay @++1.25
          in P : t
          out Q : t
        trans U delay @+2
          in Q : t
          out Q : t @++ 0.5
        """,
        HEAD.replace("standard", "option realtimestamp true\n  standard"),
    )
    play(g, 2)
    assert (g.marking.time, text(g, "Q")) == (1.25, "1`1@3.75")


# --- priorities ----------------------------------------------------------------------------------

PRIORITIES = """
        place P : INT = 1`1 ++ 1`2
        place W : INTT = 1`1@5
        trans Low
          in P : n
        trans High priority 5
          in P : 2
        trans Later priority 1
          in W : t
"""


def test_a_smaller_number_goes_first() -> None:
    g = game(PRIORITIES)
    assert bindings(g) == ["High()"]
    low = next(t for t in g.net.transitions if t.short == "Low")
    element = BindingElement.make(low, {low.variables[0]: 1})
    with pytest.raises(NotEnabled, match=r"Top.High \(\) has a higher priority"):
        g.fire(element)
    g.fire(g.enabled()[0])
    assert bindings(g) == ["Low(n=1)"]  # what must wait for time does not hold it up
    play(g)
    assert g.marking.time == 5


# --- code segments, references -------------------------------------------------------------------


def test_code_segments_bind_their_outputs() -> None:
    g = game(
        """
        globref count = 0;
        place P : INT = 1`7
        place Q : INT
        place D : INTT
        trans T delay @+m code input (n); output (m, k); action (count := !count + 1; (n + 1, !count))
          in P : n
          out Q : 1`m ++ 1`k
          out D : 0
        """
    )
    (element,) = g.enabled()
    assert [s.name for s, _ in element.values] == ["n"]
    occurred = g.fire(element)
    assert {s.name: x for s, x in occurred.values} == {"n": 7, "m": 8, "k": 1}
    assert (text(g, "Q"), text(g, "D")) == ("1`1++ 1`8", "1`0@8")


def test_steps_are_counted() -> None:
    g = game(
        """
        place P : INT = 3`1
        place Q : INT
        trans T
          in P : n
          out Q : IntInf.toInt (step ())
        """
    )
    play(g)
    assert (g.steps, text(g, "Q")) == (3, "1`1++ 1`2++ 1`3")


# --- storage and overrides -----------------------------------------------------------------------

NARROW = """
        place P : FF = 1`(0.1, 0.1)
        place Q : FF
        place S : F
        trans T
          in P : (r, q)
          out Q : (r * 3.0, q * 3.0)
          out S : q
"""


def test_reals_are_narrowed_in_places_but_not_in_expressions() -> None:
    g = game(NARROW, storage={"F": "float32"})
    (element,) = g.enabled()
    assert {s.name: x for s, x in element.values} == {"r": 0.10000000149011612, "q": 0.1}
    g.fire(element)
    q = next(iter(g.marking.places[1]))
    assert q == (0.30000001192092896, 0.1 * 3.0)
    assert next(iter(g.marking.places[2])) == 0.10000000149011612


def test_a_real_that_is_not_finite_when_narrowed_is_an_error() -> None:
    body = NARROW.replace("r * 3.0", "r * 1E300")
    g = game(body, storage={"F": "float32"})
    with pytest.raises(GameError, match="illegal colour"):
        play(g)
    play(game(body))


def test_initial_markings_can_be_replaced() -> None:
    body = """
        place P : SMALL = 1`1
        place W : INTT
        trans T
          in P : s
    """
    g = game(body, initial={"Top.P": MultiSet.of([2, 2]), "Top.W": TimedMultiSet.of([Timed(4, 7)])})
    assert (text(g, "P"), text(g, "W")) == ("2`2", "1`4@7")
    with pytest.raises(GameError, match="illegal colour 9"):
        game(body, initial={"Top.P": MultiSet.of([9])})
    with pytest.raises(GameError, match=r"no place `Top.X`"):
        game(body, initial={"Top.X": MultiSet()})


def test_place_markings_as_json() -> None:
    g = game(
        """
        place P : INTT = 2`3@4 +++ 1`1@9 +++ 1`3@1
        place Q : PAIR = 2`(1, 2) ++ 1`(0, 5)
        trans T
          in P : t
        """
    )
    p, q = g.net.places
    data = place_to_json(g.colours, p.colset, g.marking.places[0])
    assert data == [[1, 1, 9], [1, 3, 1], [2, 3, 4]]
    assert place_from_json(p.colset, data) == g.marking.places[0]
    data = place_to_json(g.colours, q.colset, g.marking.places[1])
    assert data == [[1, [0, 5]], [2, [1, 2]]]
    assert place_from_json(q.colset, data) == g.marking.places[1]


# --- errors --------------------------------------------------------------------------------------


ERRORS = {
    "guard": (
        ["trans T guard [n div 0 = m]", "  in P : n", "  in P : m"],
        "guard of `Top.T` raised the exception `Div`",
    ),
    "inscription": (
        ["trans T", "  in P : n", "  out Q : hd []"],
        "raised the exception `Empty`",
    ),
    "delay": (
        ["place Later : INTT", "trans T delay @+(1073741823 + n)", "  in P : n", "  out Later : n"],
        "delay of `Top.T` raised the exception `Overflow`",
    ),
    "code segment": (
        ['trans T code action raise Fail "no"', "  in P : n"],
        r"code segment of `Top.T` raised the exception `Fail \(no\)`",
    ),
    "inscription of an output arc": (
        ["trans T", "  in P : n", "  out Q : n + 3"],
        "illegal colour 4: it is not in the colour set `SMALL`",
    ),
}


@pytest.mark.parametrize("part", ERRORS)
def test_errors_name_the_element(part: str) -> None:
    transition, message = ERRORS[part]
    g = game("\n".join(["place P : INT = 1`1", "place Q : SMALL", *transition]))
    before = g.marking
    with pytest.raises(GameError, match=message) as info:
        play(g)
    assert g.marking == before
    assert info.value.origin.part == part.removesuffix(" of an output arc")
    assert info.value.origin.page == "Top"


def test_errors_are_diagnostics() -> None:
    g = game(
        """
        fun f x = 10 div x;
        place P : INT = 1`0
        trans T guard [f n > 1]
          in P : n
        """
    )
    d = Diagnostics()
    with pytest.raises(GameError) as info:
        g.enabled()
    info.value.report(d)
    (error,) = d.errors
    assert error.code == "runtime-error"
    assert error.origin.element == "transition `T`"
    assert error.notes[0].message == "raised by `10 div x`"


def test_errors_of_initial_markings_and_declarations() -> None:
    with pytest.raises(GameError, match="initial marking of `Top.P` raised the exception `Empty`"):
        game("\n        place P : INT = hd []\n")
    with pytest.raises(GameError, match="illegal colour 7"):
        game("\n        place P : SMALL = 1`7\n")
    with pytest.raises(GameError, match="a declaration raised the exception `Div`"):
        game("\n        val x = 1 div 0;\n        place P : INT\n")


def test_endless_functions_are_given_up() -> None:
    body = """
        fun f x : bool = f x;
        place P : INT = 1`1
        trans T guard [f n]
          in P : n
    """
    with pytest.raises(GameError, match="no end after 10000 steps"):
        game(body, limits=Limits(steps=10_000)).enabled()


def test_initial_markings_may_take_longer(monkeypatch: pytest.MonkeyPatch) -> None:
    """They are computed once: sorting thousands of tokens is no endless function."""
    usual = Limits().steps
    assert token_game.AT_START.steps is not None and usual is not None
    assert token_game.AT_START.steps > usual
    monkeypatch.setattr(token_game, "AT_START", Limits(steps=300))
    head = "\n        fun f n = if n = 0 then 7 else f (n - 1);\n"
    with pytest.raises(
        GameError, match="initial marking of `Top.P` was given up: no end after 300"
    ):
        game(head + "        place P : INT = f 1000\n")
    with pytest.raises(GameError, match="a declaration was given up: no end after 300 steps"):
        game(head + "        val x = f 1000;\n        place P : INT\n")
    own = game(head + "        place P : INT = f 10\n")
    assert own.evaluator.limits == Limits()


def test_what_is_not_enabled_does_not_occur() -> None:
    g = game(
        """
        place P : INTT = 1`1@5 +++ 1`3@0
        place I : INT
        trans T guard [t < 3]
          in P : t
          inhibit I
        """
    )
    (t,) = g.net.transitions
    (x,) = t.variables

    def reason(value: int | None, **changes: Any) -> str:
        binding = {} if value is None else {x: value}
        with pytest.raises(NotEnabled) as info:
            g.fire(BindingElement.make(t, binding))
        return str(info.value)

    assert "variable `t` has no value" in reason(None)
    assert "the guard `t < 3` is false" in reason(3)
    assert "place `Top.P` lacks 1`2: it holds 1`1@5+++ 1`3@0 at time 0" in reason(2)
    assert "place `Top.P` lacks 1`1" in reason(1)
    g.set_time(5)
    g.marking = type(g.marking)(5, (g.marking.places[0], MultiSet.of([4])))
    assert "place `Top.I` inhibits it: it holds 1`4" in reason(1)


# --- pages, plays, spaces ------------------------------------------------------------------------


def test_a_page_instance_has_one_name_in_what_is_enabled_and_in_markings() -> None:
    g = game(
        """
      page Main
        place A : INT = 1`1
        place B : INT = 1`2
        subst One = Sub (Inp -> A)
        subst Two = Sub (Inp -> B)
      page Sub
        place Inp port in : INT
        place Count : INT = 1`0
        trans Move
          in Inp : n
          out Count : n
        """
    )
    enabled = report.enabled_text(g.net, 0, g.enabled()).split("\n")
    marking = report.marking_text(g.net, g.marking).split("\n")
    assert [line for line in enabled if line.startswith("Move")] == ["Move (Sub 1)", "Move (Sub 2)"]
    assert [line for line in marking if line and line[0] != " "] == ["Main", "Sub 1", "Sub 2"]


def test_page_instances_have_markings_of_their_own() -> None:
    g = game(
        """
      page Main
        place A : INT = 1`1
        place B : INT
        place C : INT
        subst One = Sub (Inp -> A, Outp -> B)
        subst Two = Sub (Inp -> B, Outp -> C)
      page Sub
        place Inp port in : INT
        place Outp port out : INT
        place Count : INT = 1`0
        trans Move
          in Inp : n
          out Outp : n + 1
          in Count : m
          out Count : m + 1
        """
    )
    for _ in g.run():
        pass
    found = {p.name: g.marking_text(p.name) for p in g.net.places}
    assert found == {
        "Main.A": "empty",
        "Main.B": "empty",
        "Main.C": "1`3",
        "Main.One.Count": "1`1",
        "Main.Two.Count": "1`1",
    }


SHUFFLE = """
        place P : INT = 1`1 ++ 1`2 ++ 1`3
        place Q : INT
        trans Forth
          in P : n
          out Q : n
        trans Back
          in Q : n
          out P : n
"""


def test_state_space_of_independent_tokens() -> None:
    g = game(SHUFFLE)
    space = state_space(g)
    assert (len(space.nodes), len(space.arcs), space.dead, space.complete) == (8, 24, (), True)
    assert space.nodes[0] == g.marking


def test_a_space_that_is_too_large_is_said_to_be_incomplete() -> None:
    space = state_space(game(SHUFFLE), max_nodes=5)
    assert (len(space.nodes), space.complete) == (5, False)


def test_a_random_play_stays_in_the_state_space() -> None:
    g = game(SHUFFLE)
    space = state_space(g)
    rng = random.Random(7)
    for _ in g.run(rng.choice, steps=50):
        assert g.marking in space.nodes


@pytest.mark.parametrize(("colset", "raises"), [("INT", False), ("LATER", True)])
def test_a_delay_is_evaluated_where_an_output_is_timed(colset: str, raises: bool) -> None:
    """As by the engine: with untimed outputs alone an exception in the delay does no harm."""
    g = game(f"""
        colset LATER = int timed;
        fun late n = if n > 0 then raise Fail "late" else n
        var n: INT;
        place A : INT = 1`1
        place B : {colset}
        trans T delay @+(late n)
          in A : n
          out B : n
    """)
    [element] = g.enabled()
    if raises:
        with pytest.raises(GameError, match="late"):
            g.fire(element)
    else:
        g.fire(element)
        assert len(g.marking.places[1]) == 1


def test_a_binding_has_the_zero_of_the_token() -> None:
    """Which of the two the guard sees decides whether it is true."""
    g = game("""
        var x: REAL;
        place A : REAL = 1`(~0.0)
        trans T guard [1.0 / x > 0.0]
          in A : x
        trans U guard [1.0 / x < 0.0]
          in A : x
    """)
    assert [e.transition for e in g.enabled()] == [1]
    t = g.net.transitions[0]
    element = BindingElement.make(t, dict.fromkeys(t.variables, 0.0))
    assert g.why_disabled(g.marking, element) == "the sign of a zero is not that of the token"
    [element] = g.enabled()
    g.fire(element)


@pytest.mark.parametrize(
    ("taken", "times"), [("n", 1), ("if discrete (1, 1) = 1 then n else n", 2)]
)
def test_what_an_element_takes_is_looked_for_once_where_it_is_always_the_same(
    taken: str, times: int
) -> None:
    g = game(
        f"""
        place P : INT = 1`1 ++ 1`2
        place Q : INT = 1`1 ++ 1`2
        trans T
          in P : n
          in Q : {taken}
        """
    )
    looked, own = [], g.enabling.demands
    g.enabling.demands = lambda t, b, **how: (looked.append(t), own(t, b, **how))[1]  # type: ignore[method-assign]
    [symbol] = g.net.transitions[0].variables
    for number in (1, 2):
        looked.clear()
        element = BindingElement(0, ((symbol, number),))
        assert g.why_disabled(g.marking, element) is None
        again = g.marking
        g.marking, _ = g.occur(g.marking, element)
        assert len(looked) == times
        # Of another marking, or another element, it is not what has just been found.
        assert g.occur(again, BindingElement(0, ((symbol, number),)))[0] == g.marking
    assert (text(g, "P"), text(g, "Q")) == ("empty", "empty")
