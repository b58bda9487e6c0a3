"""Loops and branches recovered from state graphs: the same traces as the graph, and a readable shape.

Graphs are run directly and as structured scripts. A state's tree asks bits of an input sequence; the
trace is the marks of the states and edges passed.
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.scripts import checked, diagnosed, parsed, run
from helpers.thorough import amount
from pn2code.robot_scripts.ir import Line, Node, statements
from pn2code.robot_scripts.structure import (
    Branches,
    Halt,
    Then,
    To,
    Tree,
    leaves,
    simplify,
    structure,
)
from pn2code.tdl import tree as t
from pn2code.tdl.flow import walk
from pn2code.tdl.pretty import program as printed
from pn2code.tdl.pretty import statements as lines
from pn2code.tdl.types import Type

STEPS = 40
"""Marks looked at in each run; graphs with cycles go on for ever."""


def mark(name: str) -> Node:
    return Line(t.Mark(name, ()))


def ask(i: int) -> t.Expression:
    """Bit `i` of the input, which lasts for ever by coming round."""
    return t.Binary(
        "=",
        t.Binary("mod", t.Binary("div", t.Name("feed"), t.Value(2**i)), t.Value(2)),
        t.Value(1),
    )


def shape(start: int, trees: dict[int, Tree]) -> str:
    return "\n".join(lines(statements(structure(start, trees, lambda s: f"s{s}", lambda _: False))))


def gotos(start: int, trees: dict[int, Tree]) -> int:
    body = statements(structure(start, trees, lambda s: f"s{s}", lambda _: False))
    return sum(isinstance(s, t.Goto) for s in walk(body))


def to(mark_: str, target: int) -> Tree:
    return Then((mark(mark_),), To(target))


def when(condition: str, then: Tree, otherwise: Tree) -> Tree:
    return Branches(((t.Name(condition), then),), otherwise)


def when_bit(i: int, then: Tree, otherwise: Tree) -> Tree:
    return Branches(((ask(i), then),), otherwise)


# --- shapes ------------------------------------------------------------------------------------


def test_a_line_of_states_is_a_sequence() -> None:
    trees = {1: to("a", 2), 2: to("b", 3), 3: Halt(over=True)}
    assert shape(1, trees) == "mark a\nmark b"


def test_a_cycle_is_a_loop() -> None:
    assert shape(1, {1: to("a", 2), 2: to("b", 1)}) == "loop\n  mark a\n  mark b\nend loop"


def test_branches_that_meet_again_stand_before_the_state_where_they_meet() -> None:
    trees = {
        1: when("c", to("a", 2), when("d", to("b", 2), to("e", 2))),
        2: to("f", 1),
    }
    assert shape(1, trees) == (
        "loop\n  if c then\n    mark a\n  else\n    if d then\n      mark b\n    else\n      mark e\n    end if\n"
        "  end if\n  mark f\nend loop"
    )


def test_a_chain_with_a_stop() -> None:
    stop = Then((Line(t.Stop((t.Value("no"),))),), Halt())
    trees: dict[int, Tree] = {
        1: to("accept", 2),
        2: Branches(((t.Name("c"), to("a", 3)), (t.Name("d"), to("b", 3))), stop),
        3: to("report", 1),
    }
    assert shape(1, trees) == (
        'loop\n  mark accept\n  if c then\n    mark a\n  elsif d then\n    mark b\n  else\n    stop "no"\n  end if\n'
        "  mark report\nend loop"
    )


def test_a_loop_that_decides_first_is_a_while() -> None:
    trees = {1: when("c", to("a", 1), to("b", 2)), 2: Halt(over=True)}
    assert shape(1, trees) == "while c loop\n  mark a\nend loop\nmark b"


def test_a_loop_that_decides_first_the_other_way_round() -> None:
    trees = {1: when("c", To(2), to("a", 1)), 2: to("b", 3), 3: Halt(over=True)}
    assert shape(1, trees) == "while not c loop\n  mark a\nend loop\nmark b"


def test_a_loop_left_from_its_middle_has_an_exit() -> None:
    trees = {1: to("a", 2), 2: when("c", To(3), to("b", 1)), 3: to("z", 4), 4: Halt(over=True)}
    assert shape(1, trees) == "loop\n  mark a\n  exit when c\n  mark b\nend loop\nmark z"


def test_a_while_keeps_the_stop_of_its_last_decision() -> None:
    stop = Then((Line(t.Stop((t.Value("no"),))),), Halt())
    trees = {
        1: Branches(((t.Name("c"), to("a", 1)), (t.Name("d"), to("b", 2))), stop),
        2: Halt(over=True),
    }
    assert shape(1, trees) == (
        'while c loop\n  mark a\nend loop\nif d then\n  mark b\nelse\n  stop "no"\nend if'
    )


def test_nested_loops() -> None:
    trees = {
        1: to("outer", 2),
        2: when("c", to("inner", 2), to("out", 3)),
        3: when("d", To(4), to("again", 1)),
        4: to("finish", 5),
        5: Halt(over=True),
    }
    assert shape(1, trees) == (
        "loop\n  mark outer\n  while c loop\n    mark inner\n  end loop\n  mark out\n  exit when d\n"
        "  mark again\nend loop\nmark finish"
    )
    assert gotos(1, trees) == 0


def test_an_irreducible_graph_uses_labels() -> None:
    """Two entries into the cycle 2 <-> 3."""
    trees = {
        1: when("c", to("a", 2), to("b", 3)),
        2: to("d", 3),
        3: when("e", to("f", 2), to("g", 4)),
        4: Halt(over=True),
    }
    assert gotos(1, trees) > 0
    text = shape(1, trees)
    for label in {
        w.removeprefix("goto ")
        for w in text.split("\n")
        for w in [w.strip()]
        if w.startswith("goto ")
    }:
        assert f"{label}:" in text


def test_a_jump_over_a_merge_uses_a_label() -> None:
    trees = {
        1: when("c", to("a", 3), when("d", to("b", 2), to("e", 2))),
        2: to("f", 3),
        3: to("g", 1),
    }
    assert gotos(1, trees) >= 1


def test_an_exit_leads_to_what_stands_behind_its_loop() -> None:
    """The inner loop 2 is left for 1 (the outer loop begins anew) and for 3, which stands behind it."""
    trees = {
        1: to("a", 2),
        2: Branches(((ask(0), to("b", 1)), (ask(1), to("c", 3)), (ask(2), to("d", 3))), to("e", 2)),
        3: when_bit(3, to("f", 1), Then((mark("g"),), Halt(over=True))),
    }
    for value in range(16):
        expected = []
        for name in walk_graph(1, trees, value):
            expected.append(name)
            if len(expected) == STEPS:
                break
        assert run_script(script(1, trees, value))[: len(expected)] == expected


def test_the_program_may_end_inside_a_loop() -> None:
    trees = {1: when("c", Then((mark("a"),), Halt(over=True)), to("b", 1))}
    assert (
        shape(1, trees)
        == "loop\n  if c then\n    mark a\n    return\n  else\n    mark b\n  end if\nend loop"
    )


def test_simplify_does_not_take_an_inner_exit_for_its_own() -> None:
    """`while` must not swallow a loop whose body leaves it elsewhere."""
    trees = {
        1: when("c", Then((mark("a"),), when("d", To(2), To(1))), to("b", 2)),
        2: Halt(over=True),
    }
    text = shape(1, trees)
    assert "while" not in text and text.startswith("loop")


# --- the same behaviour ------------------------------------------------------------------------


def walk_graph(start: int, trees: dict[int, Tree], value: int) -> Iterator[str]:
    """The marks of a run of the graph itself."""
    tree = trees[start]
    position = [value, 0]

    def test(condition: t.Expression) -> bool:
        assert isinstance(condition, t.Binary) and isinstance(condition.left, t.Binary)
        inner = condition.left.left
        assert isinstance(inner, t.Binary) and isinstance(inner.right, t.Value)
        return position[0] // int(inner.right.value) % 2 == 1

    while True:
        match tree:
            case Then(nodes, rest):
                for n in nodes:
                    assert isinstance(n, Line)
                    if isinstance(n.statement, t.Mark):
                        yield n.statement.transition
                    elif isinstance(n.statement, t.Stop):
                        yield "stop"
                        return
                    else:  # the input turns round by one bit
                        position[0] = position[0] // 2 + (position[0] % 2) * 2**19
                tree = rest
            case Branches(branches, otherwise):
                tree = next((b for c, b in branches if test(c)), otherwise)
            case To(state):
                tree = trees[state]
            case Halt():
                return


TURN = Line(
    t.Assign(
        t.Target("feed"),
        t.Binary(
            "+",
            t.Binary("div", t.Name("feed"), t.Value(2)),
            t.Binary("*", t.Binary("mod", t.Name("feed"), t.Value(2)), t.Value(2**19)),
        ),
    )
)


def script(start: int, trees: dict[int, Tree], value: int) -> str:
    body = statements(structure(start, trees, lambda s: f"s{s}", lambda _: False))
    variable = t.Variable("feed", t.TypeName(Type.INT), t.Value(value))
    return printed(t.Program("graph", (variable,), (), body))


def run_script(text: str) -> list[str]:
    result = run(checked(text), step_limit=3000)
    marks = [name for name, _ in result.marks]
    if getattr(result.end, "message", "").startswith("the end"):
        marks.append("stop")
    return marks


@st.composite
def graphs(draw: st.DrawFn) -> dict[int, Tree]:
    """Any graph: reducible or not, with dead ends, self-loops, states that nothing leads to."""
    size = draw(st.integers(1, 7))
    stop = Then((Line(t.Stop((t.Value("the end"),))),), Halt())

    def leaf(name: str) -> Tree:
        kind = draw(st.integers(0, 12))
        if kind == 0:
            return stop
        if kind == 1:
            return Then((mark(f"{name}_over"),), Halt(over=True))
        target = To(draw(st.integers(1, size)))
        return Then((mark(name), TURN), target)

    def tree(name: str) -> Tree:
        count = draw(st.integers(0, 3))
        if count == 0:
            return leaf(name)
        branches = tuple((ask(i), leaf(f"{name}_{i}")) for i in range(count))
        found: Tree = Branches(branches, leaf(f"{name}_else"))
        return Then((mark(name),), found) if draw(st.booleans()) else found

    return {s: tree(f"t{s}") for s in range(1, size + 1)}


@settings(max_examples=amount(40, 150), deadline=None, derandomize=True)
@given(graphs(), st.integers(0, 2**20 - 1))
def test_the_structured_program_has_the_traces_of_the_graph(
    trees: dict[int, Tree], value: int
) -> None:
    expected = []
    for name in walk_graph(1, trees, value):
        expected.append(name)
        if len(expected) == STEPS:
            break
    text = script(1, trees, value)
    assert run_script(text)[: len(expected)] == expected
    if len(expected) < STEPS:
        assert run_script(text) == expected


@settings(max_examples=amount(15, 60), deadline=None, derandomize=True)
@given(graphs())
def test_every_state_that_can_be_reached_is_there_once(trees: dict[int, Tree]) -> None:
    """Nothing is duplicated: as many marks in the script as in the trees that can be reached."""
    reached = {1}
    todo = [1]
    while todo:
        for n in leaves(trees[todo.pop()]):
            if n not in reached:
                reached.add(n)
                todo.append(n)

    def marks(tree: Tree) -> list[str]:
        match tree:
            case Then(nodes, rest):
                own = [
                    n.statement.transition
                    for n in nodes
                    if isinstance(n, Line) and isinstance(n.statement, t.Mark)
                ]
                return own + marks(rest)
            case Branches(branches, otherwise):
                return [m for _, b in branches for m in marks(b)] + marks(otherwise)
            case _:
                return []

    body = statements(structure(1, trees, lambda s: f"s{s}", lambda _: False))
    found = sorted(s.transition for s in walk(body) if isinstance(s, t.Mark))
    assert found == sorted(m for s in reached for m in marks(trees[s]))


@settings(max_examples=amount(15, 60), deadline=None, derandomize=True)
@given(graphs())
def test_structured_programs_have_no_unreachable_statements(trees: dict[int, Tree]) -> None:
    text = script(1, trees, 0)
    assert not [x for x in diagnosed(text) if "tdl-unused]" not in x]


@pytest.mark.parametrize("text", ["loop exit when a b := 1 end loop"])
def test_simplify_knows_exits(text: str) -> None:
    """`loop exit when a ...` is `while not a`: shown on nodes made by hand."""
    (loop,) = parsed(f"program p begin {text} end program").body
    assert isinstance(loop, t.Loop)
    from pn2code.robot_scripts.ir import Repeat

    (node,) = simplify([Repeat(None, tuple(Line(s) for s in loop.body))], lambda _: False)  # type: ignore[arg-type]
    assert isinstance(node, Repeat) and node.condition == t.Unary("not", t.Name("a"))
