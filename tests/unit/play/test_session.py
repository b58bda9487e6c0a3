"""A game that is played by somebody: steps, back and on, changes by hand, expressions, filters."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.played import marking, of, session
from helpers.shown import PAIR
from pn2code.diagnostics import Diagnostics
from pn2code.play import bindings, saving
from pn2code.play.session import Session
from pn2code.play.trouble import Trouble
from pn2code.play.view import View
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.token_game import Game
from pn2code.simulate import reference
from pn2code.simulate.run import Request
from pn2code.trace.replay import replay
from pn2code.trace.script import Trace

TIMED = """
net Timed
  standard
  colset T = int timed;
  var n : INT;
  page Top
    place A : T = 1`1 ++ 1`2
    place B : T
    trans Go guard [n < 9]
      in A : n
      out B : n + 1 @+ 5
    trans Back priority 100
      in B : n
      out A : n @+ 2
"""
REFERENCES = """
net Counted
  standard
  globref count = 0;
  fun up () = (count := !count + 1; !count);
  var n, m : INT;
  page Top
    place A : INT = 1`0
    trans Go code output (m); action up ()
      in A : n
      out A : m
"""


def number(game: Session, short: str) -> int:
    return next(t.index for t in game.net.transitions if t.short == short)


def place(game: Session, short: str) -> int:
    return next(p.index for p in game.net.places if p.short == short)


class TestSteps:
    def test_they_are_those_of_simulate(self, tmp_path: Path) -> None:
        game = session(tmp_path, PAIR, seed=5)
        trace = tmp_path / "simulated.trace.jsonl"
        request = Request(net=game.net, steps=40, seed=5, trace=trace)
        outcome = reference.run(request, Diagnostics())
        for _ in range(40):
            game.step()
        assert outcome.final == game.game.marking
        steps = [(s.transition.index, s.bound) for s in Trace.open(trace, game.net).steps()]
        elements = [game.history.entry(i).element for i in range(40)]
        assert [(e.transition, e.binding) for e in elements if e] == steps

    def test_back_and_on(self, tmp_path: Path) -> None:
        game = session(tmp_path, TIMED)
        seen = [(game.game.marking, game.game.steps)]
        for _ in range(12):
            game.step()
            seen.append((game.game.marking, game.game.steps))
        for k in (3, 0, 12, 7, 7, 11):
            game.go(k)
            assert (game.game.marking, game.game.steps) == seen[k]
        game.undo()
        game.redo()
        assert game.game.marking == seen[11][0]
        game.go(4)
        game.step()
        assert game.history.length == 5
        with pytest.raises(Trouble, match="nothing was taken back"):
            game.redo()
        game.go(0)
        with pytest.raises(Trouble, match="this is the beginning"):
            game.undo()

    def test_what_is_not_enabled_does_not_occur(self, tmp_path: Path) -> None:
        game = session(tmp_path, TIMED)
        before = game.game.marking
        with pytest.raises(Trouble, match="`Back` is not enabled"):
            game.fire_any(number(game, "Back"))
        with pytest.raises(Trouble, match="no such transition"):
            game.fire_any(99)
        assert game.game.marking is before and game.history.length == 0

    def test_references_go_back_with_the_steps(self, tmp_path: Path) -> None:
        game = session(tmp_path, REFERENCES)
        for _ in range(5):
            game.step()
        game.go(2)
        game.step()
        assert marking(game) == {"Top.A": "1`3"}

    def test_the_memory_for_undo_ends(self, tmp_path: Path) -> None:
        game = session(tmp_path, TIMED, most_bytes=8_000)
        for _ in range(12):
            game.step()
        assert 0 < game.history.forgotten < 12 and game.history.position == 12
        with pytest.raises(Trouble, match=r"cannot be taken back: they were more"):
            while True:
                game.undo()
        game.go(12)
        file = tmp_path / "all.trace.jsonl"
        saving.save(game, file)
        result = replay(file, game.net, files=Files(None))
        assert result.ok and result.steps == 12

    def test_an_exception_of_the_net_is_told_and_changes_nothing(self, tmp_path: Path) -> None:
        text = PAIR.replace("out Out : n + 1", "out Out : 10 div (n - 1)")
        game = session(tmp_path, text)
        before = game.game.marking
        with pytest.raises(Trouble) as raised:
            for seed in range(50):
                game.set_seed(seed)
                before = game.game.marking
                game.step()
                game.undo()
        assert "Div" in raised.value.message and raised.value.rows[0]["id"]
        assert game.game.marking == before

    def test_a_lone_seed_decides(self, tmp_path: Path) -> None:
        game = session(tmp_path, PAIR)
        game.set_seed(9)
        for _ in range(20):
            game.step()
        first = game.game.marking
        game.begin()
        for _ in range(20):
            game.step()
        assert game.game.marking == first


class TestTime:
    def test_the_clock_moves_on_when_nothing_is_enabled(self, tmp_path: Path) -> None:
        game = session(tmp_path, TIMED)
        with pytest.raises(Trouble, match="the clock stands"):
            game.advance()
        game.step()
        game.step()
        assert game.later() == 5
        game.advance()
        assert game.game.marking.time == 5
        game.undo()
        assert game.game.marking.time == 0
        game.redo()
        game.step()
        file = tmp_path / "run.trace.jsonl"
        saving.save(game, file)
        assert replay(file, game.net).ok


class TestByHand:
    def test_a_changed_marking_begins_a_run(self, tmp_path: Path) -> None:
        game = session(tmp_path, PAIR)
        for _ in range(3):
            game.step()
        game.edit(place(game, "A"), "1`20 ++ 2`30")
        assert marking(game)["Top.A"] == "1`20++\n2`30" and game.game.steps == 0
        for _ in range(4):
            game.step()
        file = tmp_path / "edited.trace.jsonl"
        saving.save(game, file)
        result = replay(file, game.net)
        assert result.ok and result.steps == 4 and result.marking == game.game.marking
        game.go(2)
        saving.save(game, file)
        assert replay(file, game.net).marking == game.game.marking

    def test_a_timed_token_is_available_now_unless_it_has_a_stamp(self, tmp_path: Path) -> None:
        game = session(tmp_path, TIMED)
        game.step()
        game.step()
        game.advance()
        game.edit(place(game, "B"), "1`7")
        assert marking(game)["Top.B"] == "1`7@5"
        game.edit(place(game, "B"), "1`7@5+++\n1`8@30")
        assert marking(game)["Top.B"] == "1`7@5+++\n1`8@30"
        game.edit(place(game, "B"), "1`7@0")  # in a trace it would go at time 0
        with pytest.raises(Trouble, match="cannot be saved as a trace"):
            game.step()
            saving.save(game, tmp_path / "no.trace.jsonl")
        assert not (tmp_path / "no.trace.jsonl").exists()

    @pytest.mark.parametrize(
        ("text", "why", "part"),
        [
            ('1`"x"', "int", '"x"'),
            ("1`n", "is not declared", "n"),
            ("1`(2", "", None),
            ("1`(hd [])", "Empty", None),
        ],
    )
    def test_what_is_wrong_is_told_with_its_place(
        self, tmp_path: Path, text: str, why: str, part: str | None
    ) -> None:
        game = session(tmp_path, PAIR)
        before = game.game.marking
        with pytest.raises(Trouble) as raised:
            game.edit(place(game, "A"), text)
        row = raised.value.rows[0]
        assert why in raised.value.message
        if part is not None:
            assert row["text"][row["from"] : row["to"]] == part
        assert game.game.marking is before and game.history.length == 0

    def test_a_token_outside_its_colour_set_is_refused(self, tmp_path: Path) -> None:
        text = PAIR.replace("  var n : INT;", "  colset SMALL = int with 0..50;  var n : SMALL;")
        game = session(tmp_path, text.replace(" : INT", " : SMALL"))
        with pytest.raises(Trouble, match="illegal colour 51"):
            game.edit(place(game, "A"), "1`51")


class TestExpressions:
    @pytest.mark.parametrize(
        ("text", "kind", "value"),
        [
            ("length (Mark.Top'A 1) + 1", "int", "3"),
            ("Mark.Top'A 1", "int list", "[1,2]"),
            ('(~3, "a", [SOME 1, NONE], {b = 2.5, a = true})',
             "int * string * int option list * {a: bool, b: real}",
             '(~3,"a",[SOME(1),NONE],{a=true,b=2.5})'),
            (r'("a\"b\\\nü", [#"\t", #"x"])', "string * char list", r'("a\"b\\\nü",[#"\t",#"x"])'),
            ("Vector.fromList [1, 2]", "int vector", "#[1,2]"),
            ("fn f => fn x => f (f x)", "('a -> 'a) -> 'a -> 'a", "fn"),
            ("(NONE, [], fn x => x = x)", "'a option * 'b list * (''c -> bool)", "(NONE,[],fn)"),
            ("fn x => x + 1", "int -> int", "fn"),
            ("()", "unit", "()"),
            ("step ()", "IntInf.int", "2"),
        ],
    )  # fmt: skip
    def test_values_and_types(self, tmp_path: Path, text: str, kind: str, value: str) -> None:
        game = session(tmp_path, PAIR)
        for _ in range(2):
            game.step()
        game.go(0) if "Mark" in text else None
        assert game.evaluate(text) == (kind, value)

    def test_nothing_of_the_net_changes(self, tmp_path: Path) -> None:
        game = session(tmp_path, REFERENCES)
        assert game.evaluate("(count := 40; up ())") == ("int", "41")
        assert game.evaluate("!count") == ("int", "0")
        game.step()
        assert marking(game) == {"Top.A": "1`1"}

    def test_what_raises_or_does_not_end_is_told(self, tmp_path: Path) -> None:
        game = session(tmp_path, PAIR)
        with pytest.raises(Trouble, match="raised the exception"):
            game.evaluate("1 div 0")
        with pytest.raises(Trouble, match="was given up"):
            game.evaluate("let fun f x = f x in f 1 end")
        with pytest.raises(Trouble, match="the net has no place"):
            game.evaluate("Mark.Top'Nowhere 1")


class TestBindings:
    def test_a_part_of_the_binding_filters(self, tmp_path: Path) -> None:
        text = PAIR.replace("1`1 ++ 1`2", "List.tabulate (30, fn i => i)")
        game = session(tmp_path, text)
        (t,) = game.game.enabled_transitions(game.game.marking)
        found = bindings.listed(game.game, t, game.typist.filters("n > 10, n mod 7 = 0", t))
        assert [list(e.binding.values()) for e in found.elements] == [[14], [21], [28]]
        assert not found.is_cut
        cut = bindings.listed(game.game, t, most=5)
        assert len(cut.elements) == 5 and cut.is_cut
        assert game.typist.filters(" , n = (fn (a, b) => a) (1, 2)", t)

    def test_a_wrong_filter_is_told(self, tmp_path: Path) -> None:
        game = session(tmp_path, PAIR)
        t = game.net.transitions[0]
        for text in ("m = 1", "n + 1", "n ="):
            with pytest.raises(Exception, match=r"\w"):
                game.typist.filters(text, t)


class TestTraces:
    def test_a_saved_run_can_be_loaded(self, tmp_path: Path) -> None:
        game = session(tmp_path, TIMED)
        for _ in range(9):
            game.step()
        file = tmp_path / "run.trace.jsonl"
        saving.save(game, file)
        last = game.game.marking
        (tmp_path / "b").mkdir()
        other = of(tmp_path / "net.cpn", tmp_path / "b")
        assert saving.load(other, file) == "9 steps were loaded"
        assert other.game.marking == last and other.history.position == 9
        other.go(0)
        assert other.game.marking == Game(other.net).marking

    def test_the_clock_is_that_of_the_end(self, tmp_path: Path) -> None:
        game = session(tmp_path, TIMED)
        game.step()
        game.step()
        game.advance(3)
        file = tmp_path / "run.trace.jsonl"
        saving.save(game, file)
        (tmp_path / "b").mkdir()
        other = of(tmp_path / "net.cpn", tmp_path / "b")
        assert replay(file, game.net).ok
        assert saving.load(other, file) == "2 steps were loaded"
        assert other.game.marking == game.game.marking and other.game.marking.time == 3
        # What is enabled before does occur before.
        text = file.read_text().splitlines()
        file.write_text("\n".join([*text[:2], text[-1]]) + "\n")
        saving.load(other, file)
        assert other.game.marking.time == 0

    def test_what_is_not_possible_ends_it(self, tmp_path: Path) -> None:
        game = session(tmp_path, TIMED)
        for _ in range(4):
            game.step()
        file = tmp_path / "run.trace.jsonl"
        saving.save(game, file)
        lines = file.read_text().splitlines()
        lines[3] = lines[3].replace('"n": ', '"n": 9')
        file.write_text("\n".join(lines) + "\n")
        said = saving.load(game, file)
        assert said.startswith("2 steps were loaded; the next is not possible")
        assert game.history.position == 2

    @pytest.mark.parametrize("text", ["", "nothing\n", "{}\n", "[1]\n", '{"trace": 2}\n'])
    def test_what_is_no_trace_leaves_the_game(self, tmp_path: Path, text: str) -> None:
        game = session(tmp_path, TIMED)
        game.step()
        (tmp_path / "x").write_text(text)
        with pytest.raises(Trouble, match="this is no trace"):
            saving.load(game, tmp_path / "x")
        assert game.history.position == 1


RAISES = """
net Raises
  standard
  colset L = list INT;
  var n : INT;
  var l : L;
  page Top
    place A : INT = 1`1 ++ 1`2
    place B : L = 1`[]
    place C : INT
    trans Good
      in A : n
      out C : n
    trans Bad priority 50 guard [hd l > 0]
      in B : l
      out C : 0
    trans Mend
      in B : l
      out B : 7::l
"""

RAISED = "`Top.Bad` raised the exception `Empty`"


class TestRaising:
    """A transition that raises an exception stops neither the others nor the game."""

    def test_the_others_are_enabled_and_occur(self, tmp_path: Path) -> None:
        game = session(tmp_path, RAISES)
        view = View(game)
        state = view.state()
        good, bad, mend = (number(game, x) for x in ("Good", "Bad", "Mend"))
        assert state["enabled"] == [good, mend]
        assert state["error"] is None and state["later"] is None
        ((told,),) = [state["raising"]]
        assert told["transition"] == bad and RAISED in told["message"]
        game.fire_any(good)
        assert game.history.position == 1
        with pytest.raises(Trouble, match=RAISED):
            game.fire_any(bad)
        # As in CPN Tools, a step at random ends where it looks at that transition.
        with pytest.raises(Trouble, match=RAISED):
            game.step()
        assert game.history.position == 1
        game.fire_any(mend)
        state = view.state()
        assert state["raising"] == [] and state["enabled"] == {"more": [bad], "less": [good, mend]}
        with pytest.raises(Trouble, match="is not enabled"):  # `Bad` has a higher priority now
            game.fire_any(good)
        game.fire_any(bad)
        assert game.history.position == 3

    def test_what_was_played_can_be_saved_and_loaded(self, tmp_path: Path) -> None:
        game = session(tmp_path, RAISES.replace(" priority 50", ""))
        for name in ("Good", "Mend"):
            game.fire_any(number(game, name))
            trace = tmp_path / f"{name}.trace.jsonl"
            saving.save(game, trace)  # it is looked at again
            before = game.game.marking
            saving.load(game, trace)
            assert game.game.marking == before

    def test_where_nothing_else_is_enabled_the_net_cannot_go_on(self, tmp_path: Path) -> None:
        game = session(
            tmp_path, RAISES[: RAISES.index("    trans Mend")].replace("1`1 ++ 1`2", "empty")
        )
        state = View(game).state()
        assert state["enabled"] == [] and RAISED in state["error"]["message"]
        assert len(state["raising"]) == 1
