"""PNML files as documents and as nets that can be played."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.pnml_nets import (
    NAMESPACE,
    arc,
    const,
    document,
    enum,
    every,
    flat,
    graph,
    in_range,
    messages,
    named,
    net,
    number,
    op,
    philosophers,
    place,
    size,
    sort,
    transition,
    unfolded_size,
    var,
    variable,
)
from pn2code.diagnostics import Diagnostics
from pn2code.pnml.names import Names, is_free
from pn2code.semantics.game.token_game import Game
from pn2code.unfold.unfold import unfold

ABC = enum("Abc", "a", "b", "c") + variable("x", "Abc") + variable("y", "Abc")
RANGE = named("N", '<finiteintrange start="1" end="3"/>') + variable("n", "N") + variable("m", "N")
DOT = named("dot", "<dot/>")


def moved(condition: str = "", declarations: str = ABC, *, of: str = "Abc") -> str:
    """x moves from a place with all values to another, one time each."""
    v = "x" if of == "Abc" else "n"
    return net(
        place("P", of, every(of)),
        place("Q", of),
        transition("t", condition),
        arc("P", "t", number(1, var(v))),
        arc("t", "Q", number(1, var(v))),
        declarations=declarations,
    )


def enabled(text: str, tmp_path: Path) -> list[str]:
    """The bindings that are enabled at the start, as texts."""
    found = flat(text, tmp_path)
    game = Game(found)
    return [
        ",".join(f"{s.name}={game.colours.text(s.colset, v)}" for s, v in e.values if s.colset)
        for e in game.enabled()
    ]


# --- place/transition nets -------------------------------------------------------------------------


def test_place_transition_net(tmp_path: Path) -> None:
    text = net(
        place("p", "", "7"), place("q"), transition("t"), arc("p", "t", "2"), arc("t", "q", "3")
    )
    found = flat(text, tmp_path)
    assert [p.short for p in found.places] == ["p", "q"]
    assert size(found) == (4, 3)
    assert len(graph(found).nodes[-1].places[1]) == 9


def test_large_markings(tmp_path: Path) -> None:
    text = net(place("p", "", "50000"), transition("t"), arc("p", "t", "25000"))
    assert size(flat(text, tmp_path)) == (3, 2)


def test_names_missing_and_weights_in_white_space(tmp_path: Path) -> None:
    text = net(
        '<place id="p1"><initialMarking><text>\n 2 \n</text></initialMarking></place>',
        '<transition id="t1"/>',
        '<arc id="a" source="p1" target="t1"/>',
    )
    found = flat(text, tmp_path)
    assert found.places[0].short == "p1" and found.transitions[0].short == "t1"
    assert size(found) == (3, 2)


def test_inhibitor_reset_and_test_arcs(tmp_path: Path) -> None:
    text = net(
        place("p", "", "2"),
        place("q", "", "1"),
        transition("inhibited"),
        transition("cleared"),
        transition("tested"),
        arc("p", "inhibited", "", "inhibitor"),
        arc("p", "cleared", "", "reset"),
        arc("q", "cleared", "1"),
        arc("p", "tested", "1", "test"),
    )
    found = flat(text, tmp_path)
    names = [found.transitions[e.transition].short for e in Game(found).enabled()]
    assert names == ["cleared", "tested"]
    assert size(found) == (2, 3)


def test_zero_tokens_are_none(tmp_path: Path) -> None:
    text = net(place("p", "", "0"), transition("t"), arc("p", "t", "1"))
    assert size(flat(text, tmp_path)) == (1, 0)


# --- pages -----------------------------------------------------------------------------------------


def test_reference_nodes_are_what_they_stand_for(tmp_path: Path) -> None:
    first = net(place("p", "", "1"), transition("t"), arc("p", "t", "1"))
    second = (
        '<page id="page2"><referencePlace id="r" ref="r2"/><referencePlace id="r2" ref="p"/>'
        + '<referenceTransition id="rt" ref="t"/>'
        + place("q")
        + transition("back")
        + arc("rt", "q", "1")
        + arc("q", "back", "1")
        + arc("back", "r", "1")
        + "</page>"
    )
    text = first.replace("</net>", second + "</net>")
    found = flat(text, tmp_path)
    assert len({p.page for p in found.places}) == 1
    assert size(found) == (2, 2)


@pytest.mark.parametrize(
    ("on_the_other", "states"),
    [(arc("q", "t", "1"), (1, 0)), (place("r", "", "1"), (2, 1))],
    ids=["an arc", "a place"],
)
def test_arcs_from_page_to_page_count(
    on_the_other: str, states: tuple[int, int], tmp_path: Path
) -> None:
    """Of an arc on another page than both its nodes, and of one with an end on another page."""
    own = [place("p", "", "1"), place("q"), transition("t"), arc("p", "t", "1")]
    own += [arc("r", "t", "1")] if "place" in on_the_other else []
    text = net(*own).replace("</net>", f"<page id='two'>{on_the_other}</page></net>")
    assert size(flat(text, tmp_path)) == states


def test_pages_without_references_stay_pages(tmp_path: Path) -> None:
    text = net(place("p", "", "1"), transition("t"), arc("p", "t", "1"))
    other = "<page id='two'><name><text>Other</text></name>" + place("q", "", "1") + "</page>"
    d = Diagnostics()
    found = document(text.replace("</net>", other + "</net>"), d)
    assert found is not None and [p.name for p in found.pages] == ["page", "Other"]


def test_reference_without_end() -> None:
    text = net('<referencePlace id="a" ref="b"/>', '<referencePlace id="b" ref="a"/>')
    assert [m.partition(": ")[2] for m in messages(text)] == [
        "pnml-reference: referencePlace `a` leads to `a`, which stands for itself",
        "pnml-reference: referencePlace `b` leads to `b`, which stands for itself",
    ]


@pytest.mark.parametrize("prefix", ["", "p:"])
def test_namespaces_and_none(prefix: str) -> None:
    declared = f' xmlns:p="{NAMESPACE}"' if prefix else ""
    inner = f'<{prefix}place id="a"/><{prefix}transition id="t"/><{prefix}arc id="x" source="a" target="t"/>'
    text = (
        f'<{prefix}pnml{declared}><{prefix}net id="n" type="ptnet"><{prefix}page id="g">{inner}'
        f"</{prefix}page></{prefix}net></{prefix}pnml>"
    )
    d = Diagnostics()
    found = document(text, d)
    assert found is not None and not d.items
    assert found.elements == {"pages": 1, "places": 1, "transitions": 1, "arcs": 1}


# --- terms -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("condition", "expected"),
    [
        ("", ["a", "b", "c"]),
        (op("equality", var("x"), const("b")), ["b"]),
        (op("inequality", var("x"), const("b")), ["a", "c"]),
        (op("lessthan", var("x"), const("b")), ["a"]),
        (op("greaterthanorequal", var("x"), const("b")), ["b", "c"]),
        (op("equality", op("successor", var("x")), const("a")), ["c"]),
        (op("equality", op("predecessor", var("x")), const("c")), ["a"]),
        (op("not", op("equality", var("x"), const("a"))), ["b", "c"]),
        (
            op("or", op("equality", var("x"), const("a")), op("equality", var("x"), const("c"))),
            ["a", "c"],
        ),
        (
            op(
                "imply",
                op("greaterthan", var("x"), const("a")),
                op("equality", var("x"), const("b")),
            ),
            ["a", "b"],
        ),
        (
            op(
                "and",
                op("lessthanorequal", var("x"), const("b")),
                op("and", op("inequality", var("x"), const("a"))),
            ),
            ["b"],
        ),
    ],
)
def test_conditions(condition: str, expected: list[str], tmp_path: Path) -> None:
    assert enabled(moved(condition), tmp_path) == [f"x={v}" for v in expected]


@pytest.mark.parametrize(
    ("condition", "expected"),
    [
        (op("lessthan", var("n"), in_range(3, 1, 3)), ["1", "2"]),
        (op("equality", op("successor", var("n")), in_range(1, 1, 3)), ["3"]),
        (op("equality", op("predecessor", var("n")), in_range(3, 1, 3)), ["1"]),
        (op("gt", var("n"), '<numberconstant value="2"><integer/></numberconstant>'), ["3"]),
        (
            op("leq", op("addition", var("n"), var("n")), in_range(3, 1, 3)),
            ["1"],
        ),
    ],
)
def test_ranges(condition: str, expected: list[str], tmp_path: Path) -> None:
    assert enabled(moved(condition, RANGE, of="N"), tmp_path) == [f"n={v}" for v in expected]


def test_partitions(tmp_path: Path) -> None:
    parts = (
        '<partition id="Half" name="Half"><usersort declaration="Abc"/>'
        '<partitionelement id="low" name="low"><useroperator declaration="a"/><useroperator declaration="b"/>'
        '</partitionelement><partitionelement id="high" name="high"><useroperator declaration="c"/>'
        "</partitionelement></partition>"
    )
    part = op("partitionelementof", var("x"), refpartition="Half")
    assert enabled(moved(op("equality", part, const("high")), ABC + parts), tmp_path) == ["x=c"]
    other = op("partitionelementof", const("c"), refpartition="Half")
    assert enabled(moved(op("ltp", part, other), ABC + parts), tmp_path) == ["x=a", "x=b"]
    assert enabled(moved(op("gtp", part, other), ABC + parts), tmp_path) == []


def test_an_element_of_a_partition_is_all_values_in_it(tmp_path: Path) -> None:
    """Where values of the divided sort are wanted, as in the contest's VehicularWifi."""
    parts = (
        '<partition id="Half" name="Half"><usersort declaration="Abc"/>'
        '<partitionelement id="low" name="low"><useroperator declaration="a"/><useroperator declaration="b"/>'
        '</partitionelement><partitionelement id="high" name="high"><useroperator declaration="c"/>'
        "</partitionelement></partition>"
    )
    pair = named("Pair", f"<productsort>{sort('Abc')}{sort('Abc')}</productsort>")
    both = op("add", const("low"), const("high"))
    text = net(
        place("P", "Pair", op("tuple", const("a"), both)),
        place("Q", "Abc", const("low")),
        declarations=ABC + parts + pair,
    )
    assert [len(p) for p in Game(flat(text, tmp_path)).marking.places] == [3, 2]


def test_summands_that_share_a_variable(tmp_path: Path) -> None:
    """CPN Tools finds no order to bind them; a PNML net is none of its nets, and has a meaning."""
    pair = named("Pair", f"<productsort>{sort('Abc')}{sort('Abc')}</productsort>")
    tuples = [op("tuple", var("x"), var("y")), op("tuple", var("x"), var("z"))]
    text = net(
        place("P", "Pair", op("tuple", const("a"), every("Abc"))),
        transition("t"),
        arc("P", "t", op("add", *tuples)),
        declarations=ABC + pair + variable("z", "Abc"),
    )
    game = Game(flat(text, tmp_path))
    assert len(list(game.enabled())) == 6  # y and z are different tokens


def test_operators_of_the_net(tmp_path: Path) -> None:
    twice = (
        '<namedoperator id="skip" name="skip"><parameter>'
        '<variabledecl id="of" name="of"><usersort declaration="Abc"/></variabledecl></parameter>'
        f"<def>{op('successor', op('successor', var('of')))}</def></namedoperator>"
    )
    condition = op("equality", op("useroperator", var("x"), declaration="skip"), const("a"))
    assert enabled(moved(condition, ABC + twice), tmp_path) == ["x=b"]


def test_tuples_with_all_are_products(tmp_path: Path) -> None:
    pair = named("Pair", f"<productsort>{sort('Abc')}{sort('Abc')}</productsort>")
    text = net(
        place("P", "Pair", number(2, op("tuple", every("Abc"), const("b")))),
        place("Q", "Pair"),
        transition("t"),
        arc("P", "t", number(1, op("tuple", var("x"), const("b")))),
        arc("t", "Q", number(1, op("tuple", var("x"), every("Abc")))),
        declarations=ABC + pair,
    )
    found = flat(text, tmp_path)
    assert [len(p) for p in Game(found).marking.places] == [6, 0]
    assert size(found) == (27, 54)


def test_multi_sets_are_subtracted_as_far_as_they_are_there(tmp_path: Path) -> None:
    all_but = op("subtract", every("Abc"), number(1, var("x")))
    text = net(
        place("P", "Abc", op("subtract", every("Abc"), number(5, const("a")))),
        place("Q", "Abc"),
        transition("t"),
        arc("P", "t", number(1, var("x"))),
        arc("t", "Q", all_but),
        declarations=ABC,
    )
    found = flat(text, tmp_path)
    assert [len(p) for p in Game(found).marking.places] == [2, 0]
    assert size(found) == (4, 4)


def test_variable_on_an_input_arc_in_a_difference(tmp_path: Path) -> None:
    """`all - x` demands all others: x is bound by nothing but its sort."""
    text = net(
        place("P", "Abc", every("Abc")),
        transition("t"),
        arc("P", "t", op("subtract", every("Abc"), number(1, var("x")))),
        declarations=ABC,
    )
    found = flat(text, tmp_path)
    assert size(found) == (4, 3)


def test_no_token_is_wanted_of_which_there_are_to_be_none(tmp_path: Path) -> None:
    """CPN Tools wants one for 0`y, to bind y; in PNML y has any value of its sort."""
    text = net(
        place("P", "Abc", number(1, const("a"))),
        place("Q", "Abc"),
        transition("t", op("inequality", var("x"), var("y"))),
        arc("P", "t", op("add", number(1, var("x")), number(0, var("y")))),
        arc("Q", "t", number(0, var("y"))),
        declarations=ABC,
    )
    assert enabled(text, tmp_path) == ["x=a,y=b", "x=a,y=c"]


def test_negative_numbers_in_multi_sets(tmp_path: Path) -> None:
    """After a backquote they need parentheses; taken, they are patterns."""
    span = named("N", '<finiteintrange start="-2" end="1"/>')
    low, high = in_range(-2, -2, 1), in_range(-1, -2, 1)
    text = net(
        place("P", "N", op("add", number(2, low), high)),
        place("Q", "N"),
        transition("T"),
        arc("P", "T", number(2, low)),
        arc("T", "Q", op("add", number(3, low), high)),
        declarations=span,
    )
    assert size(flat(text, tmp_path)) == (2, 1)


def test_free_variables_range_over_large_sorts(tmp_path: Path) -> None:
    """CPN Tools enumerates at most 100 values; PNML has no such limit."""
    large = named("Large", '<finiteintrange start="0" end="149"/>') + variable("n", "Large")
    text = net(
        place("P", "Dot", number(1, "<dotconstant/>")),
        place("Q", "Large"),
        transition("t"),
        arc("P", "t", number(1, "<dotconstant/>")),
        arc("t", "Q", number(1, var("n"))),
        declarations=large + named("Dot", "<dot/>"),
    )
    assert len(Game(flat(text, tmp_path)).enabled()) == 150


def test_dot_without_declaration(tmp_path: Path) -> None:
    text = net(
        place("P", "dot", number(3, "<dotconstant/>")),
        transition("t"),
        arc("P", "t", number(1, "<dotconstant/>")),
        kind="symmetricnet",
        declarations=ABC,
    )
    assert size(flat(text, tmp_path)) == (4, 3)


def test_booleans_and_anonymous_sorts(tmp_path: Path) -> None:
    flag = named("Flag", "<bool/>") + variable("f", "Flag")
    text = net(
        '<place id="P"><type><structure><bool/></structure></type></place>',
        place("Q", "Flag", number(1, '<booleanconstant value="true"/>')),
        transition("t", op("equality", var("f"), '<booleanconstant value="true"/>')),
        arc("Q", "t", number(1, var("f"))),
        arc("t", "Q", number(1, var("f"))),
        declarations=flag,
    )
    assert size(flat(text, tmp_path)) == (1, 1)


def test_sorts_without_a_name_are_told_apart(tmp_path: Path) -> None:
    one, two = '<finiteintrange start="1" end="2"/>', '<finiteintrange start="3" end="4"/>'
    pair = named("Pair", f"<productsort>{one}{two}</productsort>")
    marking = number(1, op("tuple", in_range(1, 1, 2), in_range(3, 3, 4)))
    found = flat(
        net(
            place("Pair", "Pair", marking),  # the ids of a place and of a sort are apart as well
            place("Number", "Single"),
            transition("move"),
            arc("Pair", "move", number(1, op("tuple", in_range(1, 1, 2), in_range(3, 3, 4)))),
            arc(
                "move",
                "Number",
                op("add", number(1, in_range(1, 1, 2)), number(2, in_range(2, 1, 2))),
            ),
            declarations=named("Single", one) + pair,
        ),
        tmp_path,
    )
    assert size(found) == (2, 1)


def test_philosophers(tmp_path: Path) -> None:
    found = flat(philosophers(3), tmp_path)
    u = unfold(found, Diagnostics())
    assert u is not None
    assert size(found) == unfolded_size(u) == (14, 27)


# --- names -----------------------------------------------------------------------------------------


def test_names_of_constants_that_cpn_ml_does_not_allow(tmp_path: Path) -> None:
    declared = (
        named(
            "S",
            '<cyclicenumeration><feconstant id="one" name="1"/><feconstant id="i-2" name="2"/>'
            '<feconstant id="val" name="val"/><feconstant id="o" name="o"/></cyclicenumeration>',
        )
        + '<variabledecl id="V-1" name="1x"><usersort declaration="S"/></variabledecl>'
    )
    text = net(
        place("P", "S", every("S")),
        transition("t"),
        arc("P", "t", number(1, var("V-1"))),
        declarations=declared,
    )
    found = flat(text, tmp_path)
    assert found.program.colsets["S"].names == ("one", "i_2", "c_val", "c_o")
    assert list(found.program.variables) == ["V_1"]


def test_constants_of_the_same_name_in_two_sorts(tmp_path: Path) -> None:
    one = '<cyclicenumeration><feconstant id="a1" name="a"/></cyclicenumeration>'
    text = net(
        place("P", "A", number(1, const("a1"))),
        place("Q", "B", number(1, const("a2"))),
        declarations=named("A", one) + named("B", one.replace("a1", "a2")),
    )
    found = flat(text, tmp_path)
    assert [found.program.colsets[n].names for n in "AB"] == [("a1",), ("a2",)]


def test_names_given_out_once() -> None:
    names = Names()
    assert names.make(["x", "id"], "v") == "x"
    assert names.make(["x", "id"], "v") == "id"
    assert names.make(["x", "id"], "v") == "x_2"
    assert names.make(["7"], "v") == "v_7"
    assert names.make(["?"], "v") == "v_"  # nothing of it is left
    assert names.make(["if"], "v") == "v_if"
    assert not is_free("List") and not is_free("before") and not is_free("a b") and is_free("Phil")


# --- what is wrong ---------------------------------------------------------------------------------

WRONG = [
    ("<html/>", "1: not-pnml: not a PNML net: the root element is `html`"),
    ("<pnml/>", "1: not-pnml: not a PNML net: `pnml` has no `net`"),
    (net(place("p", "", "x")), "4: pnml-element: `x` is no number"),
    (net(place("p", "", "4000000000")), "4: unsupported-pnml: `4000000000` is too large"),
    (
        net(place("p"), place("p")),
        "5: duplicate-id: place `p` has the id `p`, which is already used",
    ),
    (
        net(place("p"), transition("t"), arc("p", "t", "0")),
        "6: pnml-element: `0` is no positive number",
    ),
    (
        net(place("p"), transition("t"), arc("p", "t", "-1")),
        "6: pnml-element: `-1` is no positive number",
    ),
    (net(place("p"), place("q"), arc("p", "q")), "6: arc-dangling: arc `p-q` connects two places"),
    (
        net(place("p"), arc("p", "t")),
        "5: arc-dangling: arc `p-t` leads to `t`, which is no node of the net",
    ),
    (
        net(place("p"), transition("t"), arc("p", "t", "", "stopwatch")),
        "6: unsupported-pnml: arcs of type `stopwatch` are not supported",
    ),
    (net("<place/>"), "4: pnml-element: a place has no id"),
    (
        net("<plaice id='x'/>"),
        "4: pnml-unknown-element: element `plaice` inside `page` is not known and is ignored",
    ),
    (
        moved(op("equality", var("x"), const("z"))),
        "6: pnml-reference: there is no constant or operator with the id `z`",
    ),
    (
        moved(op("equality", var("z"), const("a"))),
        "6: pnml-reference: there is no variable with the id `z`",
    ),
    (
        moved(op("equality", var("Abc"), const("a"))),
        "6: pnml-reference: `Abc` is declared as `namedsort`, but a variable is needed here",
    ),
    (
        moved(op("equality", var("x"), var("n")), ABC + RANGE),
        "6: pnml-sort: `equality` compares a value of `Abc` with one of `N`",
    ),
    (
        moved(var("x")),
        "6: pnml-sort: a condition is wanted, but `variable` is a term of sort `Abc`",
    ),
    (
        moved(op("lukewarm", var("x"))),
        "6: unsupported-pnml: the operator `lukewarm` is not supported",
    ),
    (moved(op("equality", var("x"))), "6: pnml-element: `equality` has 1 subterms instead of 2"),
    (moved(op("and")), "6: pnml-element: `and` has 0 subterms instead of at least 1"),
    (
        net(place("P", "Abc", number(1, var("n"))), declarations=ABC + RANGE),
        "4: pnml-sort: a multi-set over `Abc` is wanted, but `numberof` is a multi-set over `N`",
    ),
    (
        net(place("P", "N", number(1, in_range(4, 1, 3))), declarations=RANGE),
        "4: pnml-sort: 4 is not in the range `1..3`",
    ),
    (net(place("P", "Q"), declarations=ABC), "4: pnml-reference: there is no sort with the id `Q`"),
    (
        net(place("P", "Abc", op("tuple", const("a"), const("b"))), declarations=ABC),
        "4: pnml-sort: a value of sort `Abc` is wanted, but this is a tuple of 2",
    ),
    (
        net(place("P"), declarations=named("A", sort("A"))),
        "2: pnml-element: the sort `A` contains itself",
    ),
    (
        net(place("P", "E"), declarations=named("E", "<cyclicenumeration/>")),
        "2: pnml-element: the enumeration `E` has no constants",
    ),
    (
        net(place("P", "E"), declarations=named("E", '<finiteintrange start="3" end="1"/>')),
        "2: pnml-element: the range 3..1 is empty",
    ),
    (
        net(place("P", "E"), declarations=named("E", "<string/>")),
        "2: unsupported-pnml: the sort `string` is not supported",
    ),
    (
        net(place("P", "Abc"), transition("t"), arc("P", "t"), declarations=ABC),
        "6: pnml-sort: arc `P` -> `t` has no inscription",
    ),
    (
        net(
            place("P", "Abc", "", "<hlinitialMarking><text>1'a</text></hlinitialMarking>"),
            declarations=ABC,
        ),
        "4: pnml-element: `hlinitialMarking` has a text, but no `structure`",
    ),
    (
        net(place("P"), kind="timednet"),
        "2: pnml-net-type: the net type `http://www.pnml.org/version-2009/grammar/timednet` is not known: "
        "it is read as a place/transition net",
    ),
    (
        net(place("P")).replace("</pnml>", "<net id='m'/></pnml>"),
        "4: pnml-several-nets: the file has 2 nets, only the first, `n`, is read",
    ),
]


@pytest.mark.parametrize(("text", "expected"), WRONG, ids=[e for _, e in WRONG])
def test_what_is_wrong_is_said(text: str, expected: str) -> None:
    found = messages(text)
    if expected.startswith("4: pnml-several-nets"):
        found = [f"4{m[m.index(':') :]}" for m in found]
    assert expected in found


def test_errors_point_to_the_element(tmp_path: Path) -> None:
    """Line and column are those of the XML element that a piece of the inscription came from."""
    text = moved(op("equality", var("x"), const("z")))
    d = Diagnostics()
    document(text, d)
    at = d.sorted()[0].origin
    line = text.splitlines()[at.line - 1]
    assert line[at.column - 1 :].startswith('<useroperator declaration="z"/>')
    assert at.page == "n" and at.element == "transition `t`" and at.part == "guard"


def test_positions_inside_an_inscription() -> None:
    """Each piece of a text knows its own element."""
    text = moved(op("equality", var("x"), op("successor", const("b"))))
    d = Diagnostics()
    found = document(text, d)
    assert found is not None
    guard = found.pages[0].transitions[0].guard
    assert guard is not None and guard.text.text == "x = (succ_Abc b)"
    for piece, element in (("x", "<variable"), ("succ_", "<successor"), ("b)", "<useroperator")):
        line, column = guard.text.position(guard.text.text.index(piece))
        assert text.splitlines()[line - 1][column - 1 :].startswith(element)


def test_entities_are_refused() -> None:
    text = '<!DOCTYPE pnml [<!ENTITY e SYSTEM "file:///etc/passwd">]><pnml><net id="n">&e;</net></pnml>'
    assert [m.split(": ")[1] for m in messages(text)] == ["xml-entity"]


# --- layout ----------------------------------------------------------------------------------------


def test_positions_are_stretched_and_turned() -> None:
    def at(x: int, y: int) -> str:
        return f'<graphics><position x="{x}" y="{y}"/></graphics>'

    text = net(
        place("p", "", "", at(10, 20)),
        transition("t").replace("</transition>", at(10, 60) + "</transition>"),
        arc("p", "t", "1").replace("</arc>", at(30, 40) + "</arc>"),
    )
    d = Diagnostics()
    found = document(text, d)
    assert found is not None and not d.items
    page = found.pages[0]
    p, t = page.places[0].layout, page.transitions[0].layout
    assert p.known and t.known and p.x == t.x
    assert p.y > t.y  # y grows upwards here
    assert p.y - t.y == pytest.approx(130)
    assert page.arcs[0].layout.bends == ((30 * 3.25, -40 * 3.25),)


def test_an_error_has_no_consequences() -> None:
    """Of a place with an unknown sort, and of what uses it, nothing else is said."""
    text = net(
        place("P", "Abd", number(1, const("a"))),
        transition("t"),
        arc("P", "t", number(1, var("x"))),
        declarations=ABC,
    )
    d = Diagnostics()
    found = document(text, d)
    assert found is None and len(d.items) == 1
    assert d.items[0].hint == "did you mean `Abc`?"
