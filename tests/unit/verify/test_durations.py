"""How long an answer takes where waits and delays are computed (`verify.controller.replies`, `durations`)."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.small_cell import NET, TOML, write
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.verdict.opened import read
from pn2code.verify.controller.replies import Replies

HEAD = """  colset FEW = int with 0..9;
  colset TIMED = unit timed;
  val SHORT = 0.25;
  fun pause (s : real) = ();
  fun rest (a, b) = pause (a + b);
  fun dwell 1 = pause 1.0 | dwell n = pause 1.5;
  var f: FEW;
"""
DRILL = "    trans Drill guard [k = DRILL] code action drill ()\n      in Told : k\n"


def replies(folder: Path, action: str, limit: float) -> Replies:
    """Of the small cell, whose robot does this instead of drilling."""
    net = NET.replace("  val MOVE", f"{HEAD}  val MOVE", 1)
    of = "f" if " f" in action else "k"
    code = f"code input ({of}); action {action}"
    drill = DRILL.replace("code action drill ()", code).replace("Told : k", f"Told : {of}")
    drill = drill.replace("[k = DRILL]", f"[{of} = DRILL]")
    return of_net(folder, net.replace(DRILL, drill), limit)


def of_net(folder: Path, net: str, limit: float) -> Replies:
    assert net != NET
    toml = TOML.replace("final =", f"reply_timeout_s = {limit}\nfinal =")
    toml = toml.replace("[primitives]", '[primitives]\npause = { command = "wait" }')
    d = Diagnostics()
    opened = read(write(folder, net, toml), {}, d)
    assert opened is not None and opened.config is not None, [x.message for x in d.errors]
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None, [x.message for x in d.errors]
    return Replies.of(partition, opened.config)


@pytest.mark.parametrize(
    ("action", "needs"),
    [
        ("pause (SHORT * 4.0 + Real.fromInt 1)", "2 s"),
        ("rest (0.5, SHORT)", "0.75 s"),
        ("let val t = 2.5 in pause t end", "2.5 s"),
        ("pause (if k = 2 then 1.0 else 3.0)", "3 s"),
        ("pause (real f)", "9 s"),
        ("(drill (); pause (real f / 2.0))", "5.5 s"),
        ("dwell k", "1.5 s"),
    ],
)
def test_what_has_few_values_is_computed(action: str, needs: str, tmp_path: Path) -> None:
    assert f"`robot1` may need {needs} for an answer" in replies(tmp_path / "a", action, 0.5).late
    found = replies(tmp_path / "b", action, 60)
    assert found.late == "" and f"take at most {needs};" in found.premise


@pytest.mark.parametrize(
    ("action", "what"),
    [
        ("pause (real k)", "the time `real k` of `pause` is computed"),
        ("rest (real k, SHORT)", "of `pause` is computed"),
        ("let val t = real k in pause t end", "the time `t` of `pause` is computed"),
        ("if k > 3 then drill () else pause (real k)", "of `pause` is computed"),
    ],
)
def test_what_may_be_any_number_is_not_known(action: str, what: str, tmp_path: Path) -> None:
    found = replies(tmp_path, action, 60)
    assert what in found.late and "is not known" in found.late, found
    assert found.premise == "", "nothing is said of a largest time"


@pytest.mark.parametrize(
    ("action", "needs", "what"),
    [
        ("(fn f => (f (); f (); f ())) drill", "", "what calls `drill` is computed"),
        ("(fn f => (f (); f ())) (fn () => drill ())", "", "what calls `fn () => drill ()`"),
        ("let val g = drill in (g (); g (); g ()) end", "", "what calls `drill`"),
        ("let val g = fn () => drill () in (g (); g (); g ()) end", "3 s", ""),
        ("let fun g a b = (drill (); pause b) in (g 1 0.5; g 2 1.0) end", "3.5 s", ""),
        ("(alias (); alias ())", "", "what `alias` calls is computed"),
    ],
)
def test_functions_that_are_values(action: str, needs: str, what: str, tmp_path: Path) -> None:
    net = NET.replace("  val MOVE", f"{HEAD}  val MOVE", 1)
    net = net.replace("  var n, k: INT;", "  val alias = drill;\n  var n, k: INT;", 1)
    drill = DRILL.replace("code action drill ()", f"code input (k); action {action}")
    found = of_net(tmp_path, net.replace(DRILL, drill), 60)
    assert what in found.late and bool(found.late) == bool(what), found
    assert f"take at most {needs};" in found.premise if needs else found.premise == ""


@pytest.mark.parametrize(
    ("delay", "late"),
    [
        ("2", ""),
        ("f", ""),
        ("k", "the delay of `Drill`, `k`, is computed"),
        ("(2 * k + 1)", "the delay of `Drill`"),
    ],
)
def test_computed_delays(delay: str, late: str, tmp_path: Path) -> None:
    of = "f" if "f" in delay else "k"
    drill = f"    trans Drill guard [{of} = DRILL]\n      in Told : {of}\n      out Over : ()@+{delay}\n"
    net = NET.replace("  val MOVE", f"{HEAD}  val MOVE", 1).replace(
        "place Over", "place Over : TIMED"
    )
    net = net.replace(DRILL + "      out Over : ()\n", drill)
    found = of_net(tmp_path, net, 60)
    assert late in found.late and bool(found.late) == bool(late), found
    most = {"2": "2 s", "f": "9 s"}.get(delay)
    assert most is None or f"take at most {most};" in found.premise


@pytest.mark.parametrize(
    ("action", "needs", "what"),
    [
        ("List.app (fn _ => drill ()) xs", "4 s", ""),
        ("List.app (fn x => (drill (); pause 0.5)) (List.rev (tl xs))", "6 s", ""),
        (
            "List.app (fn x => pause (real x)) [1, 2]",
            "",
            "the time `real x` of `pause` is computed",
        ),
        ("List.app pause [0.5, 0.25]", "", "the time of `pause` is computed"),
        ("List.app bore xs", "4 s", ""),
        ("(List.app bore (1 :: xs); drill ())", "6 s", ""),
        ("along (List.map (fn x => x) xs)", "4 s", ""),
        ("(along [1]; along xs; along [])", "5 s", ""),
        ("let val ys = if k = 2 then xs else [1] in List.app bore ys end", "4 s", ""),
        ("List.app (fn x => List.app bore xs) xs", "16 s", ""),
        ("(List.foldl (fn (x, t) => (drill (); t + x)) 0 xs; ())", "4 s", ""),
        ("List.app bore []", "0 s", ""),
        ("List.app bore ys", "", "how many items `ys` of `List.app` has is computed"),
        ("List.app (fn x => moveHome ()) ys", "0 s", ""),
        ("along ys", "", "(a colour set of lists with a longest length, `with 0..n`, would tell)"),
        ("case xs of [] => () | x :: rest => List.app bore rest", "", "how many items `rest`"),
        ("List.app (alias 1) xs", "", "is computed"),
        ("(along2 (xs, 1); along2 ([1], 2))", "5 s", ""),
        ("let val p = (ys, 1) in (along2 ([1], 2); along2 p) end", "", "how many items `l`"),
        ("List.app bore (xs ^^ [1])", "5 s", ""),
    ],
)
def test_commands_for_each_item_of_a_list(
    action: str, needs: str, what: str, tmp_path: Path
) -> None:
    declared = """  colset SPOTS = list FEW with 0..4;
  colset ANY = list FEW;
  var xs: SPOTS;
  var ys: ANY;
  fun bore x = drill ();
  fun along l = List.app bore l;
  fun alias x = fn y => drill ();
  fun along2 (l, n) = List.app bore l;
"""
    net = NET.replace("  val MOVE", f"{HEAD}  val MOVE", 1)
    net = net.replace("  var n, k: INT;", f"{declared}  var n, k: INT;", 1)
    net = net.replace(
        "    place Over\n",
        "    place Over\n    place Xs : SPOTS = 1`[1]\n    place Ys : ANY = 1`[1]\n",
    )
    drill = DRILL.replace("code action drill ()", f"code input (k, xs, ys); action {action}")
    drill += "      both Xs : xs\n      both Ys : ys\n"
    found = of_net(tmp_path, net.replace(DRILL, drill), 60)
    assert what in found.late and bool(found.late) == bool(what), found
    assert f"take at most {needs};" in found.premise if needs else found.premise == ""
