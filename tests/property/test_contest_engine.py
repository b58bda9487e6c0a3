"""The engine for tables against the whole graph, worked out in Python: every method alone, on random nets."""

from __future__ import annotations

import random
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers.random_tables import Graph, random_branching, random_condition, random_tables
from helpers.thorough import amount
from pn2code.contest import linear
from pn2code.contest.engine import Answer, Space, Task, ask, engine
from pn2code.contest.formulas import AtMost, Constant, Fireable, Formula, Op, Tokens
from pn2code.contest.tables import Tables
from pn2code.diagnostics import Diagnostics

NETS = amount(30, 150)
PROCESSOR_S = 3
"""Of processor time; it takes a tenth of that."""
SECONDS = 600.0
"""Never needed: all methods come to their end."""


@pytest.fixture(scope="module")
def program() -> Iterator[Path]:
    """The engine."""
    with engine(Diagnostics()) as found:
        assert found is not None
        yield found


def nets() -> Iterator[tuple[random.Random, Tables, Graph]]:
    """Random nets with small graphs."""
    found = 0
    for seed in range(10 * NETS):
        draw = random.Random(seed)
        tables = random_tables(draw)
        graph = Graph.of(tables)
        if graph is not None and len(graph.markings) > 2:
            found += 1
            yield draw, tables, graph
        if found == NETS:
            return


def answers(
    program: Path, tables: Tables, questions: list[str], method: str, *, seconds: float = SECONDS
) -> dict[int, Answer]:
    """Final answers, by the number of the question."""
    task = Task(method, tables.text(questions), seconds, 1024)
    found: dict[int, Answer] = {}
    for a in ask(program, [task]):
        if isinstance(a, Answer) and a.is_final:
            assert a.number not in found, "each question is answered once"
            found[a.number] = a
    return found


def test_reachability_and_bounds(program: Path) -> None:
    reached = 0
    for draw, tables, graph in nets():
        conditions = [random_condition(draw, tables) for _ in range(8)]
        sums = [Tokens(tuple(draw.sample(sorted(tables.places), 2))) for _ in range(2)]
        questions = [tables.reach(i, f) for i, f in enumerate(conditions)]
        questions += [tables.bound(8 + i, s) for i, s in enumerate(sums)]
        questions.append("10 reach dead")
        wanted: dict[int, bool | int] = {i: bool(graph.where(f)) for i, f in enumerate(conditions)}
        wanted |= {
            8 + i: max(graph.value(s, m) for m in graph.markings) for i, s in enumerate(sums)
        }
        wanted[10] = any(not s for s in graph.successors)
        reached += sum(1 for i in range(8) if wanted[i])
        for method in ("reach", "explore"):
            found = answers(program, tables, questions, method)
            assert {n: a.value for n, a in found.items()} == wanted, (method, tables)
    assert 0.2 < reached / (8 * NETS) < 0.95, "the conditions decide something"


def with_many_bindings(tables: Tables, copies: int, *, together: bool) -> Tables:
    """The same steps, each as that of so many bindings of its transition, which are numbered together or in turn."""
    n = len(tables.pre)
    order = [t for _ in range(copies) for t in range(n)]
    order = sorted(order) if together else order
    of = {t: tuple(i for i, x in enumerate(order) if x == t) for t in range(n)}
    return Tables(
        tables.initial,
        tuple(tables.pre[t] for t in order),
        tuple(tables.post[t] for t in order),
        tables.places,
        {x: tuple(i for t in own for i in of[t]) for x, own in tables.transitions.items()},
    )


def test_one_of_very_many_bindings_is_enabled(program: Path) -> None:
    """Then what is enabled is looked at, and only some bindings for a guess how far it is."""
    for draw, tables, graph in list(nets())[:20]:
        many = with_many_bindings(tables, 300, together=draw.random() < 0.5)
        conditions = [random_condition(draw, tables) for _ in range(8)]
        formulas = [random_branching(draw, tables) for _ in range(6)]
        questions = [many.reach(i, f) for i, f in enumerate(conditions)]
        wanted = {i: bool(graph.where(f)) for i, f in enumerate(conditions)}
        for method in ("reach", "explore"):
            found = answers(program, many, questions, method)
            assert {n: a.value for n, a in found.items()} == wanted, (method, tables)
        questions = [many.ctl(i, f) for i, f in enumerate(formulas)]
        found = answers(program, many, questions, "ctl")
        assert {n: a.value for n, a in found.items()} == {
            i: 0 in graph.where(f) for i, f in enumerate(formulas)
        }


def test_what_is_enabled_costs_no_more_where_a_transition_has_very_many_bindings(
    program: Path, tmp_path: Path
) -> None:
    """None of 200,000 bindings is enabled in any of 16,384 markings, in each of which 14 other transitions are."""
    bits, idle = 14, 200_000
    pre = [{p: 1} for p in range(2 * bits)] + [{2 * bits: 1}] * idle
    post = [{p ^ 1: 1} for p in range(2 * bits)] + [{2 * bits: 1}] * idle
    names = {"idle": tuple(range(2 * bits, 2 * bits + idle))}
    net = Tables((*([1, 0] * bits), 0), tuple(pre), tuple(post), {}, names)
    file = tmp_path / "net"
    file.write_text(net.text([net.reach(0, Fireable(("idle",)))]), encoding="ascii")
    limited = ["prlimit", f"--cpu={PROCESSOR_S}", str(program)]
    command = [*limited, str(file), "explore", "600", "1024", "1"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.stdout.split()[:3] == ["answer", "0", "no"], done


def test_walks_find_what_is_there_and_nothing_else(program: Path) -> None:
    for draw, tables, graph in list(nets())[:20]:
        conditions = [random_condition(draw, tables) for _ in range(8)]
        there = [i for i, f in enumerate(conditions) if graph.where(f)]
        questions = [tables.reach(i, f) for i, f in enumerate(conditions) if i in there]
        found = answers(program, tables, questions, "walk") if questions else {}
        assert set(found) <= set(there) and all(a.value is True for a in found.values())


def test_a_walk_comes_to_where_one_step_in_a_thousand_does_not_lead_away(program: Path) -> None:
    """Each of 40 tokens can go from its first place to its second, and from there in 60 ways to its third."""
    n, ways = 40, 60
    initial = [1] * n + [0] * (2 * n)
    steps = [({i: 1}, {n + i: 1}) for i in range(n)]
    steps += [({n + i: 1}, {2 * n + i: 1}) for i in range(n) for _ in range(ways)]
    steps += [({2 * n + i: 1}, {i: 1}) for i in range(n)]
    second = tuple(f"p{p}" for p in range(n, 2 * n))
    tables = Tables(
        tuple(initial), tuple(pre for pre, _ in steps), tuple(post for _, post in steps),
        {f"p{p}": (p,) for p in range(3 * n)}, {f"t{t}": (t,) for t in range(len(steps))},
    )  # fmt: skip
    task = tables.reach(0, AtMost(Constant(n), Tokens(second)))
    assert answers(program, tables, [task], "walk", seconds=20.0)[0].value is True


def test_successors_cost_what_changes_however_many_transitions_take_from_a_place(
    program: Path,
) -> None:
    count = 60_000
    tables = Tables(
        (1, *([0] * 50)),
        tuple({0: 1} for _ in range(count)), tuple({1 + t % 50: 1} for t in range(count)),
        {f"p{p}": (p,) for p in range(51)}, {"t": tuple(range(count))},
    )  # fmt: skip
    one = AtMost(Constant(1), Tokens(("p50",)))
    task = tables.ctl(0, Op("E", (Op("X", (one,)),)))
    assert answers(program, tables, [task], "ctl", seconds=4.0)[0].value is True


def test_branching_time(program: Path) -> None:
    true = 0
    for draw, tables, graph in nets():
        formulas = [random_branching(draw, tables) for _ in range(10)]
        questions = [tables.ctl(i, f) for i, f in enumerate(formulas)]
        found = answers(program, tables, questions, "ctl")
        wanted = {i: 0 in graph.where(f) for i, f in enumerate(formulas)}
        assert {n: a.value for n, a in found.items()} == wanted, tables
        true += sum(wanted.values())
    assert 0.2 < true / (10 * NETS) < 0.8


def test_linear_time(program: Path) -> None:
    """Formulas of linear time that say the same as one of CTL, and those about what happens for ever."""
    for draw, tables, graph in nets():
        p, q, r = (random_condition(draw, tables, 1) for _ in range(3))
        everywhere = set(range(len(graph.markings)))
        a, b, c = graph.where(p), graph.where(q), graph.where(r)
        cases: list[tuple[Formula, bool]] = [
            (formula, 0 in graph.where(formula))
            for formula in (
                _all("G", p), _all("F", p), _all("U", p, q), _all("X", p), _all("G", Op("or", (p, q))),
            )
        ]  # fmt: skip
        cases += [
            (_all("G", Op("F", (p,))), not graph.lasts(everywhere - a, everywhere)),
            (_all("F", Op("G", (p,))), not graph.lasts(everywhere, everywhere - a)),
            (  # if p comes again and again, so does q
                Op(
                    "A",
                    (
                        Op(
                            "or",
                            (Op("F", (Op("G", (Op("not", (p,)),)),)), Op("G", (Op("F", (q,)),))),
                        ),
                    ),
                ),
                not graph.lasts(everywhere - b, a),
            ),
            (_all("X", Op("X", (r,))), all(k in c for j in graph.next(0) for k in graph.next(j))),
        ]
        questions = [linear.question(tables, i, f) for i, (f, _) in enumerate(cases)]
        found = answers(program, tables, questions, "ltl")
        assert {n: not x.value for n, x in found.items()} == {
            i: w for i, (_, w) in enumerate(cases)
        }, tables


@pytest.mark.parametrize("seed", [1, 2, 5])
def test_runs_of_many_parts_that_turn_by_themselves(program: Path, seed: int) -> None:
    """2^40 markings: a run is found that keeps one of the parts where it is, and one that comes again and again to
    where 30 of them have turned."""
    parts = range(40)
    names = {f"{what}{i}": (2 * i + k,) for i in parts for k, what in enumerate(("rests", "runs"))}
    pre = [{2 * i + k: 1} for i in parts for k in range(2)]
    post = [{2 * i + 1 - k: 1} for i in parts for k in range(2)]
    moves = {f"t{i}": (i,) for i in range(len(pre))}
    tables = Tables((1, 0) * len(parts), tuple(pre), tuple(post), names, moves)
    runs = AtMost(Constant(1), Tokens(("runs0",)))
    many = AtMost(Constant(30), Tokens(tuple(f"runs{i}" for i in parts)))
    formulas = [_all("G", Op("F", (Op("not", (runs,)),)))]
    if seed == 5:
        formulas.append(_all("F", Op("G", (Op("not", (many,)),))))
    texts = [linear.question(tables, i, f) for i, f in enumerate(formulas)]
    found = list(ask(program, [Task("ltl", tables.text(texts), SECONDS, 24, seed)]))
    assert [a.value for a in found if isinstance(a, Answer)] == [True] * len(formulas)


def _all(operator: str, *parts: Formula) -> Formula:
    return Op("A", (Op(operator, parts),))


def test_sizes(program: Path) -> None:
    for _, tables, graph in nets():
        found = list(ask(program, [Task("count", tables.text([]), SECONDS, 1024)]))
        assert found == [Space(*graph.sizes, sum(not s for s in graph.successors))]


def test_a_net_without_an_end_is_not_known(program: Path) -> None:
    """A place that fills for ever: the methods end with their time or memory, and say what they have seen."""
    tables = Tables((0,), ({},), ({0: 1},), {"p": (0,)}, {"t": (0,)})
    questions = [tables.bound(0, Tokens(("p",))), "1 reach not sum 1 0 1 1000"]
    for method in ("explore", "reach"):
        task = Task(method, tables.text(questions), 2.0, 64)
        found = [a for a in ask(program, [task]) if isinstance(a, Answer) and a.is_final]
        assert [(a.number, a.value) for a in found] == [(1, True)], method


def test_tables_that_are_wrong_are_refused(program: Path) -> None:
    tables = Tables((0,), ({},), ({0: 1},), {"p": (0,)}, {"t": (0,)})
    for wrong in (
        "0 reach sum 1 7 1 0",
        "0 reach enabled 1 3",
        "0 reach EF true",
        "0 says true",
        "0 ctl",
    ):
        with pytest.raises(RuntimeError, match="the engine for tables"):
            list(ask(program, [Task("reach", tables.text([wrong]), 1.0, 64)]))
