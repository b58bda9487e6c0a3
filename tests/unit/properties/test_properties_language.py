"""The language of properties: what its sentences mean, and what is said about wrong ones."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from helpers.netbuilder import write
from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.diagnostics.render import report
from pn2code.net import front
from pn2code.properties import meaning as m
from pn2code.properties import sources
from pn2code.properties.bind import Binder, Written
from pn2code.properties.chunks import blanked
from pn2code.properties.questions import questions

NET = """
    net Shop
      standard
      colset D = int timed;
      colset R = record a : INT * b : STRING;
      var n : INT;  var x : D;  var r : R;
      globref seen = 0;
      fun small m = List.all (fn v => v <= 3) m;
      page Top
        place Stock : INT = 1`1
        place "Go on" : D = 1`1
        place Box : R
        trans Sell
          in Stock : n
          out Stock : n
        trans Wait
          both "Go on" : x
        subst Left = Sub (Inp -> Stock)
        subst Right = Sub (Inp -> Stock)
      page Sub
        place Inp port in : INT
        place Own : INT
        trans Sell
          in Inp : n
          out Own : n
"""


@pytest.fixture(scope="module")
def examined(tmp_path_factory: pytest.TempPathFactory) -> front.Examined:
    d = Diagnostics()
    found = front.examine(write(NET, tmp_path_factory.mktemp("shop") / "shop.cpn"), d)
    assert found.flat is not None, report(d)
    return found


def bound(examined: front.Examined, *written: Written) -> tuple[m.Properties, str]:
    """The properties, and the diagnostics as text."""
    d = Diagnostics()
    assert examined.flat is not None and examined.typed is not None
    binder = Binder(examined.flat, examined.typed.elaborator, d)
    for one in written:
        binder.add(one)
    return binder.properties(), report(d)


def option(text: str) -> Written:
    return sources.from_option(text, 1)


def asked(examined: front.Examined, text: str) -> str:
    """What the explorer is asked."""
    found, said = bound(examined, option(text))
    assert not said, said
    return "; ".join(questions(found).splitlines())


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("deadlock free", "dead; not 0; ? invariant 1"),
        ("deadlock free except {true}", "dead; not 0; pred 0; or 1 2; ? invariant 3"),
        ("bound Top'Stock <= 3", "? bound 0 0 3"),
        ("bound 1 <= Stock <= 3", "? bound 0 1 3"),
        ("bound 2 <= Sub'Own 2", "? bound 4 2 -"),
        ("always {true} && !dead", "pred 0; dead; not 1; and 0 2; ? invariant 3"),
        ("never {true}", "pred 0; not 0; ? invariant 1"),
        ("reachable {true}", "pred 0; not 0; ? invariant 1"),
        ("mutex Top'Stock, Box", "pred 0; pred 1; and 0 1; not 2; ? invariant 3"),
        ("ctl EX<Top'Sell> dead", "dead; exa 0 0; ? initially 1"),
        ("ctl AX<Top'Sell> dead", "dead; not 0; exa 0 1; not 2; ? initially 3"),
        ("ctl A[dead U enabled(Wait)]", "dead; enabled 1; au 0 1; ? initially 2"),
        ("ctl AG EF initial", "initial; ef 0; ag 1; ? initially 2"),
        ("ctl E[dead W initial]", "dead; initial; eu 0 1; eg 0; or 2 3; ? initially 4"),
        (
            "every fires(Top'Sell) is followed by fires(Wait) within 3 firings",
            "? within-firings f0 f1 3",
        ),
        ("every dead is followed by initial within 5 time", "dead; initial; ? within-time s0 s1 5"),
        (
            "ltl G F fires(Wait) assuming weak Wait, strong Sub'Sell 2",
            "? lasso; automaton 2 0; accepting 1; arc 0 0; arc 0 1 -f1; arc 1 1 -f1; weak 1; strong 3; end",
        ),
        (
            "every {true} is followed by fires(Wait)",
            "pred 0; ? lasso; automaton 2 0; accepting 1; arc 0 0; arc 0 1 +0 -f1; arc 1 1 -f1; end",
        ),
        (
            "every fires(Wait) is followed by dead",
            "dead; ? lasso; automaton 2 0; accepting 1; arc 0 0; arc 0 1 +f1; arc 1 1 -0; end",
        ),
    ],
)
def test_meaning(examined: front.Examined, text: str, expected: str) -> None:
    assert asked(examined, text) == expected


def test_seconds_of_a_cell_are_no_whole_numbers(examined: front.Examined) -> None:
    """Of 1.9 s the integer clock of its net counts one; what commands take is compared with 1.9 s."""
    d = Diagnostics()
    assert examined.flat is not None and examined.typed is not None
    binder = Binder(examined.flat, examined.typed.elaborator, d, is_cell=True)
    binder.add(option("every fires(Top'Sell) is followed by fires(Wait) within 1.9 seconds"))
    assert not d.items, report(d)
    found = binder.properties()
    assert questions(found).splitlines() == ["? within-time f0 f1 1"]
    (asked_,) = (p.asked for p in found.properties)
    assert isinstance(asked_, m.Response) and (asked_.time, asked_.units) == ("1.9", "1")


@pytest.mark.parametrize(
    ("left", "right"),
    [
        ("always {true} -> {false} -> dead", "always {true} -> ({false} -> dead)"),
        ("always {true} || {false} && dead", "always {true} or ({false} and dead)"),
        ("always !{true} && dead", "always (not {true}) && dead"),
        ("ltl {true} U {false} U dead", "ltl {true} U ({false} U dead)"),
        ("ltl G {true} -> F dead", "ltl (G {true}) -> (F dead)"),
        ("ltl !{true} W dead && initial", "ltl ((!{true}) W dead) && initial"),
        ("always tokens(Stock) = 1", "always tokens(Top'Stock 1) == 1"),
        ('always enabled("Top.Sell")', "always enabled(Top'Sell 1)"),
        ("always { small (Mark.Top'Stock 1) }", "always {small (Mark.Top'Stock 1)}"),
    ],
)
def test_equal_sentences(examined: front.Examined, left: str, right: str) -> None:
    assert asked(examined, left) == asked(examined, right)


@pytest.mark.parametrize(
    ("temporal", "single"),
    [
        ("ctl AG (tokens(Stock) <= 3)", "always tokens(Stock) <= 3"),
        ("ctl !EF (tokens(Stock) > 3)", "never tokens(Stock) > 3"),
        ("ctl EF (tokens(Stock) > 3)", "reachable tokens(Stock) > 3"),
        ("ltl G (tokens(Stock) <= 3)", "always tokens(Stock) <= 3"),
    ],
)
def test_what_single_markings_decide_is_asked_of_them(
    examined: front.Examined, temporal: str, single: str
) -> None:
    """So that one that is seen decides it, whatever is not seen."""
    assert asked(examined, temporal) == asked(examined, single)


def test_fair_paths_and_steps_are_not_single_markings(examined: front.Examined) -> None:
    for text in ("ltl G (tokens(Stock) <= 3) assuming strong all", "ltl G F (tokens(Stock) <= 3)"):
        assert "automaton" in asked(examined, text)
    assert "? initially" in asked(examined, "ctl AG EF (tokens(Stock) <= 3)")


def test_large_properties(examined: front.Examined) -> None:
    """Hundreds of parts, and items that exclude each other; nesting has a limit."""
    many = " && ".join(f"tokens(Stock) <= {i}" for i in range(600))
    assert asked(examined, f"always {many}").count("and ") == 599
    assert asked(examined, f"ltl X G ({many})").count("automaton ") == 1
    items = ", ".join(f"tokens(Stock) = {i}" for i in range(60))
    assert asked(examined, f"mutex {items}").count("not ") == 60 * 59 // 2
    for text in (
        "always " + "!" * 400 + "dead",
        "ltl " + "X " * 400 + "dead",
        "always " + "(" * 5000,
    ):
        found, said = bound(examined, option(text))
        assert not found.properties
        assert said.count("error[property-syntax]") == 1
    assert "X X X" in bound(examined, option("ltl " + "X " * 190 + "dead"))[0].properties[0].holds


def test_conditions_know_the_places_they_look_at(examined: front.Examined) -> None:
    found, said = bound(
        examined,
        option(
            'always { size (Mark.Top\'Go_on) + size (Mark.Sub\'Own 2) > 0 andalso {a=1, b="}"} = {b="}", a=1} }'
        ),
    )
    assert not said, said
    (predicate,) = found.predicates
    assert [place for _, place in predicate.places] == [1, 4]
    assert [str(symbol.type) for symbol, _ in predicate.places]


def test_equal_conditions_are_one(examined: front.Examined) -> None:
    found, _ = bound(
        examined,
        Written("a", "", SourceText("always {true}", Origin("x"))),
        Written("b", "", SourceText("never { true }", Origin("x"))),
        Written("c", "", SourceText("never {not true} || {true}", Origin("x"))),
    )
    assert [(p.name, p.text) for p in found.predicates] == [("a", "true"), ("c", "not true")]


WRONG = [
    ("", "the property is empty", 1),
    ("alway dead", "`alway` is no kind of property", 1, "did you mean `always`?"),
    ("always", "ends here, but a condition is expected", 7),
    ("always {", "this brace is not closed", 8),
    ("always { \"}\" ", "this brace is not closed", 8),
    ("always Stock", "`Stock` cannot be used here", 8, "tokens(Stock) >= 1"),
    ("always dead && ", "ends here", 15),
    ("always (dead", "ends here", 13),
    ("ltl GF dead", "`GF` cannot be used here", 5, "write `G F`"),
    ("ltl {true} andalso dead", "`andalso` cannot be used here", 12, "write `&&` or `and`"),
    ("always {true} & dead", "`&` cannot be used here", 15, "write `&&`"),
    ("ctl A[dead]", "`U` (or `W`, `R`) is expected", 5),
    ("ctl G dead", "`G` has no quantifier", 5, "`AG` or `EG`"),
    ("ctl dead U initial", "`U` has no quantifier", 5, "A[p U q]"),
    ("ltl AG dead", "`AG` quantifies paths", 5, "write `G`"),
    ("always F dead", "`F` is about other markings", 8),
    ("always fires(Wait)", "`fires` says something about a step", 8, "enabled(T)"),
    ("ctl AG fires(Wait)", "`fires` says something about a step", 8, "EX<T> p"),
    ("ltl F fires(Wait, { })", "this condition is empty", 20, "fires(Page'Transition 1"),
    ("ltl F fires(Wait, { zz > 3 })", "`zz` is not declared", 21),
    ("ltl F fires(Wait, dead)", "`dead` cannot be used here", 19),
    ("always fires(Wait, { true })", "`fires` says something about a step", 8),
    ("bound Top'Stok <= 3", "the net has no place `Top'Stok`", 7, "did you mean `Top'Stock`?"),
    ("bound Shop'Stock <= 3", "the net has no place", 7, "did you mean `Top'Stock`?"),
    ("bound Wait <= 3", "the net has no place `Wait`", 7, "`Wait` is a transition"),
    ("always enabled(Stock)", "the net has no transition `Stock`", 16, "`Stock` is a place"),
    ("always enabled(Sell)", "there are several transitions `Sell`", 16, "`Top'Sell`"),
    ("always enabled(Sub'Sell)", "transition `Sub'Sell` has 2 instances", 16, "there are 1, 2"),
    ("always enabled(Sub'Sell 3)", "has no instance 3", 16, "instances 1, 2"),
    ('bound "Top.Stok" <= 3', "the net has no place `Top.Stok`", 7, "`Top.Stock`"),
    ("bound 4 <= Stock <= 3", "no number is at least 4", 12),
    ("bound Stock <= 99999999999 ", "", 0),
    ("bound Stock <= 9999999999999999999", "is too large", 16, "at most 18 digits"),
    (f"bound {'9' * 5000} <= Stock", "is too large", 7),
    (f"always tokens(Stock) < {'9' * 5000}", "is too large", 24),
    (f"always enabled(Sub'Sell {'9' * 5000})", "is too large", 25),
    (f"every dead is followed by dead within {'9' * 500}.5 time", "is too large", 39),
    (f"every dead is followed by dead within {'9' * 500} firings", "is too large", 39),
    ("always tokens(Stock, Bix) <= 9", "the net has no place `Bix`", 22, "`Top'Box`"),
    ("always tokens(Stock) <= 9999999999", "greater than any number of tokens", 8),
    ("always { Mark.Top'Stok 1 = [] }", "the net has no place `Top'Stok`", 10, "did you mean `Top'Stock`?"),
    ("always { Mark.Sub'Own = [] }", "place `Sub'Own` has 2 instances", 10),
    ("always { Mark.Top'Stock 2 = [] }", "has no instance 2", 10),
    ("always { size (Mark.Top'Stock 1) }", "condition is `int`, but `bool` is expected", 10),
    ("always { n > 3 }", "`n` is not declared", 10, "a variable of the net"),
    ("always { smal (Mark.Top'Stock 1) }", "`smal` is not declared", 10, "did you mean `small`?"),
    ("always { Mark.Top'Stock 1 = [\"a\"] }", "`string`", 30),
    ("always { Mark.Top'Go_on 1 = [1] }", "`int timed`", 30),
    ("always { }", "this condition is empty", 9),
    ("every dead is followd by initial", "`followd` cannot be used here", 15, "did you mean `followed`?"),
    ("every dead && fires(Wait) is followed by dead within 3 firings", "an event with `within`", 7),
    ("every dead is followed by initial within 2.5 time", "counts integers", 1, "`within 2 time` says the same"),
    ("every dead is followed by initial within 2.5 firings", "cannot be used here", 46),
    ("ltl G dead assuming strong Sel", "the net has no transition `Sel`", 28, "`Top'Sell`"),
    ("mutex Stock", "ends here", 12),
    ("ctl EX<Sel> dead", "no transition `Sel`", 8),
]  # fmt: skip


@pytest.mark.parametrize("case", WRONG, ids=lambda c: c[0][:80])
def test_wrong(
    examined: front.Examined, case: tuple[str, str, int] | tuple[str, str, int, str]
) -> None:
    """One message, at the right column, with a hint."""
    text, message, column = case[:3]
    if text == "bound Stock <= 99999999999 ":
        assert "? bound 0 0 99999999999" in asked(examined, text)
        return
    found, said = bound(examined, option(text))
    assert not found.properties
    assert said.count("error[") == 1, said
    assert message in said
    assert f"command line:1:{column}\n" in said
    assert "= help: " in said
    assert "pn2code explain" not in said
    if len(case) > 3:
        assert case[3] in said.split("= help: ")[1]


FILE = """\
# properties
[[property]]
name = "small"
says = "few are in stock"
holds = "always {{ small (Mark.Top'Stock 1) andalso \\"a\\" <> {wrong} }}"

[[property]]
name = "goes on"
holds = '''
ltl
   G F fires({transition})'''
fair = ["weak Wait", "strong Top'Sell"]
expect = false
"""


def from_text(folder: Path, text: str, examined: front.Examined) -> tuple[m.Properties, str]:
    d = Diagnostics()
    path = folder / "shop.properties.toml"
    path.write_text(text, encoding="utf-8")
    written = sources.from_file(path, d)
    assert examined.flat is not None and examined.typed is not None
    found = sources.bind(written, examined.flat, examined.typed.elaborator, d)
    return found, report(d)


def test_file(examined: front.Examined, tmp_path: Path) -> None:
    text = FILE.format(wrong='\\"b\\"', transition="Wait")
    found, said = from_text(tmp_path, text, examined)
    assert not said, said
    small, on = found.properties
    assert (small.says, small.expect, small.kind) == ("few are in stock", True, "always")
    assert (on.expect, on.fair) == (False, ("weak Top'Wait 1", "strong Top'Sell 1"))
    assert on.holds == "ltl G F fires(Wait)"
    assert sources.beside(Path("a/b.c.cpn")) == Path("a/b.c.properties.toml")


@pytest.mark.parametrize(
    ("wrong", "transition", "line", "column"), [("7", "Wait", 5, 61), ('\\"b\\"', "Wit", 11, 14)]
)
def test_positions_in_a_file(
    examined: front.Examined, tmp_path: Path, wrong: str, transition: str, line: int, column: int
) -> None:
    text = FILE.format(wrong=wrong, transition=transition)
    _, said = from_text(tmp_path, text, examined)
    assert f"shop.properties.toml:{line}:{column}\n" in said, said
    assert "property `" in said


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x = 1", "unknown key `x`"),
        ("property = 3", "`property` is no array of tables"),
        ("[[property]]\nholds = 'deadlock free'", "`name` is missing"),
        ("[[property]]\nname = 'a'", "`holds` is missing"),
        ("[[property]]\nname = 'a'\nhold = 'deadlock free'", "unknown key `hold`"),
        ("[[property]]\nname = 'a'\nholds = 3", "`holds` is `3`"),
        ("[[property]]\nname = 'a'\nholds = 'deadlock free'\nexpect = 1", "`expect` is `1`"),
        ("[[property]]\nname = 'a'\nholds = 'deadlock free'\nfair = 'T'", "`fair` is `T`"),
        (
            "[[property]]\nname = 'a'\nholds = 'deadlock free'\nfair = ['all']",
            "fairness is assumed of paths",
        ),
        ("[[property]]\nname = 'a'\nholds = 'ltl F dead'\nfair = ['weak']", "ends here"),
        ("[[property]]\nname = 'a'\nholds = 'deadlock free'\n" * 2, "there are two properties `a`"),
        ("[[property]\n", "not a TOML file"),
        ("property = [{name = 'a', holds = 'alway dead'}]", "`alway` is no kind"),
    ],
)
def test_wrong_files(examined: front.Examined, tmp_path: Path, text: str, message: str) -> None:
    _, said = from_text(tmp_path, text, examined)
    assert message in said
    assert "shop.properties.toml" in said


def test_stamps_are_explained(examined: front.Examined) -> None:
    found, said = bound(examined, option("always { List.all (fn v => v > 1) (Mark.Top'Go_on 1) }"))
    assert not found.properties
    assert (
        "= note: the marking of a timed place has stamps: `ms (Mark.Page'Place 1)` removes" in said
    )
    found, said = bound(
        examined, option("always { List.all (fn v => v = true) (Mark.Top'Stock 1) }")
    )
    assert not found.properties and "stamps" not in said


def test_a_file_without_properties(tmp_path: Path) -> None:
    d = Diagnostics()
    (tmp_path / "a.toml").write_text("# nothing yet\n")
    assert sources.from_file(tmp_path / "a.toml", d) == []
    assert not d.has_errors and "there are no properties in this file" in report(d)


def test_missing_file(tmp_path: Path) -> None:
    d = Diagnostics()
    assert sources.from_file(tmp_path / "none.toml", d) == []
    assert "error[property-file]: cannot read" in report(d)


def test_where_cpn_ml_ends() -> None:
    hidden = "{" + "\0" * 20 + "}"
    assert blanked('a { {x = "}", (* } *)} } b') == ("a " + hidden + " b", None)
    assert blanked("a } b") == ("a } b", None)
    assert blanked("a { } { (* } ") == ("", 6)
    assert blanked('"Top.{x" {y}') == ('"Top.{x" {\0}', None)


def test_members_of_a_fusion_set_are_one_place(tmp_path: Path) -> None:
    text = """
    net Plant
      standard
      page Top
        place Alarm fusion Alarms = 1
        subst Left = Sub ()
      page Sub
        place Alarm fusion Alarms = 1
        place Own = 1
    """
    d = Diagnostics()
    found = front.examine(write(text, tmp_path / "plant.cpn"), d)
    assert found.flat is not None, report(d)
    one = asked(found, "bound Alarm <= 1")
    for path in ("Top'Alarm", '"Fusion.Alarms"', '"Top.Alarm"', '"Top.Left.Alarm"'):
        assert asked(found, f"bound {path} <= 1") == one


def test_the_examples_that_play_shows_are_properties(examined: front.Examined, root: Path) -> None:
    page = (root / "templates/web/asking.js").read_text(encoding="utf-8")
    examples = re.findall(r'"(.+)",', page.split("const EXAMPLES = [")[1].split("];")[0])
    assert len(examples) == 4
    for text in examples:
        for name, own in (("Place", "Stock"), ("Transition", "Sell"), ("Other", "Wait")):
            text = text.replace(f"Page'{name}", f"Top'{own}")
        assert asked(examined, text)
