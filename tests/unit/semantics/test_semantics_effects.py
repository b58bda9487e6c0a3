"""What expressions may do besides giving a value."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.semantics.evaluation.effects import Effect, Effects, effects_of, outside

NET = """
    net Effects
      standard
      globref count = 0;
      colset DIE = int with 1..6;
      val luck = discrete (1, 6)
      fun throw () = DIE.ran ()
      fun twice f = f () + f ()
      fun even 0 = true | even n = odd (n - 1)
        and odd 0 = false | odd n = (count := n; even (n - 1))
      fun unused () = exponential 1.0
      val (get, set) = let val c = ref 0 in (fn () => !c, fn x => c := x) end
      var n: INT;
      page Top
        place A : INT = 1`1
        place B : INT = 1`luck
        trans T
          in A : n
          out B : {}
"""


@pytest.mark.parametrize(
    ("text", "effects"),
    [
        ("n + 1", set()),
        ("print \"a\"; n", set()),
        ("throw ()", {Effect.DRAW}),
        ("twice throw", {Effect.DRAW}),
        ("if n > 0 then n else discrete (0, n)", {Effect.DRAW}),
        ("luck", {Effect.DRAW}),
        ("!count", {Effect.READ}),
        ("get ()", {Effect.READ}),
        ("(set 3; 1)", {Effect.READ, Effect.WRITE}),
        ("if even n then 1 else 2", {Effect.READ, Effect.WRITE}),
        ("valOf (TextIO.inputLine (TextIO.openIn \"f\")) = \"\"", {Effect.LOOK}),
    ],
)  # fmt: skip
def test_effects(text: str, effects: set[Effect]) -> None:
    if text.endswith('""'):
        text = f"if {text} then 1 else 2"
    net = flat(NET.format(f"({text})"))
    (out,) = [a for a in net.transitions[0].arcs if a.kind.value == "output"]
    assert out.inscription is not None
    assert Effects(net.program).of(out.inscription.value) == effects


def test_a_net_that_depends_on_more_than_itself() -> None:
    drawn = flat(NET.format("n"))
    assert outside(Effects(drawn.program), drawn), "its initial marking is drawn"
    sure = flat(NET.format("n").replace("1`luck", "1`1"))
    assert not outside(Effects(sure.program), sure), "functions that nothing uses do not count"


def test_the_effects_of_a_program_are_found_once() -> None:
    nets = [flat(text.format("n")) for text in (NET, NET.replace("discrete (1, 6)", "6"))]
    first = [effects_of(net.program) for net in nets]
    assert all(effects_of(n.program) is found for n, found in zip(nets, first, strict=True))
    assert [outside(found, net) for found, net in zip(first, nets, strict=True)] == [True, False]


def test_a_term_is_looked_through_once(monkeypatch: pytest.MonkeyPatch) -> None:
    net = flat(NET.format("throw ()"))
    found, looked = Effects(net.program), []
    look = Effects._looked_up
    monkeypatch.setattr(Effects, "_looked_up", lambda e, x: looked.append(x) or look(e, x))
    arcs = [a.inscription.value for a in net.transitions[0].arcs if a.inscription]
    assert [found.of(*arcs), found.of(None, *arcs), found.of(*arcs)] == [{Effect.DRAW}] * 3
    assert len(looked) == len(arcs) == 2
