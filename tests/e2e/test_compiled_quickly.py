"""Nets of many transitions are compiled quickly first, and for longer only where their state space is large."""

from __future__ import annotations

import secrets

import pytest

from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.emission.output import OutputFile
from pn2code.ir import nodes as ir
from pn2code.net.flat import FlatNet
from pn2code.verify.exploring import explore as explore_module
from pn2code.verify.exploring import programs
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import Exploration

pytestmark = pytest.mark.cc

TRANSITIONS = programs.MANY + 1
NODES = 41 * 2
LOOP = "  fun down n = if n > 0 then 1 + down (n - 1) else 0;\n"


def ring(transitions: int, more: str = "", text: str = "n + 1") -> FlatNet:
    """A token with a number that goes around once, and a switch: of a name for which no program has been kept."""
    own = secrets.token_hex(8)
    lines = ["net Ring", "  standard", "  colset N = int;", "  var n : N;", *more.splitlines()]
    lines += [f"  place P{i} : N{' = 1`0' * (i == 0)}" for i in range(transitions)]
    lines += ["  place Off = 1", "  place On", f"  place Own{own}"]
    for i in range(transitions - 1):
        lines += [f"  trans T{i}", f"    in P{i} : n", f"    out P{i + 1} : {text}"]
    lines += ["  trans Switch", "    in Off : ()", "    out On : ()"]
    return flat("\n".join(lines))


@pytest.fixture
def compiled(monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    """How each program was compiled, in order: whether quickly."""
    said: list[bool] = []
    program = programs.program

    def told(*given: object, quick: bool, **more: object) -> object:
        said.append(quick)
        return program(*given, quick=True, **more)  # type: ignore[arg-type]

    monkeypatch.setattr(explore_module.programs, "program", told)
    return said


def explored(net: FlatNet, **limits: int) -> Exploration:
    d = Diagnostics()
    found = explore(net, {}, Limits(**limits), d)  # type: ignore[arg-type]
    assert found is not None, [i.message for i in d]
    return found


@pytest.mark.parametrize(
    ("first", "limit", "ways", "why"),
    [
        (1000, None, [True], "complete"),
        (50, None, [True, False], "complete"),
        (50, 20, [True], "states"),
        (50, 60, [True, False], "states"),
    ],
)
def test_a_second_time_where_the_first_was_too_short(
    compiled: list[bool],
    monkeypatch: pytest.MonkeyPatch,
    first: int,
    limit: int | None,
    ways: list[bool],
    why: str,
) -> None:
    monkeypatch.setattr(programs, "FIRST_STATES", first)
    found = explored(ring(TRANSITIONS), **({} if limit is None else {"max_states": limit}))
    assert (compiled, found.why) == (ways, why)
    if why == "complete":
        assert (found.nodes, found.seen.components) == (NODES, True)


def test_the_same_net_is_generated_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where a place turns out to hold more: the next exploration begins with what was enough for the last one."""
    emit, texts = programs.emit_c.emit, []

    def counted(net: ir.NetIR, version: str) -> tuple[OutputFile, ...]:
        made = emit(net, version)
        texts.append(made[0].text)
        return made

    monkeypatch.setattr(programs.emit_c, "emit", counted)
    filling = flat(
        "net Filling\n  standard\n  var n: INT;\n  place P : INT = 1`40\n  place Q : INT\n"
        "  trans T guard [n > 0]\n    in P : n\n    out P : n - 1\n    out Q : n"
    )
    made = programs.Generated()
    found = [
        explore(filling, {}, Limits(), Diagnostics(), ExploreOptions(generated=made))
        for _ in range(2)
    ]
    assert [x and (x.nodes, x.complete) for x in found] == [(41, True), (41, True)]
    assert len(texts) == len(set(texts)) > 1


def test_few_transitions_are_compiled_once(compiled: list[bool]) -> None:
    assert explored(ring(3)).complete
    assert compiled == [False]


@pytest.mark.parametrize(("first", "ways"), [(100, [True]), (4, [True, False])])
def test_few_transitions_for_those_who_expect_few_states(
    compiled: list[bool], monkeypatch: pytest.MonkeyPatch, first: int, ways: list[bool]
) -> None:
    monkeypatch.setattr(programs, "FIRST_STATES", first)
    found = explore(ring(3), {}, Limits(), Diagnostics(), ExploreOptions(quick=True))
    assert found is not None and (found.why, found.nodes, compiled) == ("complete", 6, ways)


def test_a_stack_that_is_full(compiled: list[bool]) -> None:
    """What needs a deep stack is tried once more with a program that needs less of it."""
    found = explored(ring(TRANSITIONS, LOOP, "down 900000000"))
    assert compiled == [True, False]
    assert found.error is not None and found.error["message"] == explore_module.TOO_DEEP


def test_all_ways_say_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not optimized, optimized, and as large nets are."""
    said = []
    for host in (programs.QUICK, programs.HOST, programs.LARGE):
        monkeypatch.setattr(programs, "QUICK", host)
        found = explored(ring(TRANSITIONS))
        said.append((found.nodes, found.arcs, found.dead, found.bounds, found.fired))
    assert said[0] == said[1] == said[2]


ALL_KINDS = """net Kinds
  standard
  colset K = int with 0..3;
  colset L = list INT;
  var k: K; var l: L; var n: INT;
"""


def test_what_follows_in_a_large_net_with_places_of_all_kinds() -> None:
    """Of a large net one function makes what follows for all transitions: it copies lists, counters, and slots."""
    moves = [
        "  trans Count\n    in C : k\n    out C : (k + 1) mod 4\n    in L : l\n    out L : if k = 3 then k :: l else l",
        "  trans Drop\n    in L : n :: l\n    out L : l\n    in One : n\n    out One : n + k\n    both C : k",
    ]
    places = "  place C : K = 1`0 ++ 1`2\n  place L : L = 1`[1]\n  place One : INT = 1`1\n  place Lost : INT = 3`7"
    found = []
    for others in (0, TRANSITIONS):
        idle = [f"  trans Lose{i} guard [n = {i + 8}]\n    in Lost : n" for i in range(others)]
        net = flat("\n".join([ALL_KINDS, places, *moves, *idle]))
        seen = explored(net, max_states=3000)
        found.append((seen.nodes, seen.arcs, seen.dead, seen.bounds[:4]))
    assert found[0] == found[1]


def test_large_nets_have_one_function_that_makes_what_follows() -> None:
    """Also for places that are not packed: a copy for each transition was a third of the compiler's work."""
    net = flat(
        "net Lists\n  standard\n  colset L = list INT;\n  var l: L; var n: INT;\n"
        + "\n".join(f"  place P{i} : L = 1`[{i}]" for i in range(TRANSITIONS + 1))
        + "\n"
        + "\n".join(
            f"  trans T{i}\n    in P{i} : n :: l\n    out P{i} : l\n    out P{i + 1} : [n + {i}]"
            for i in range(TRANSITIONS)
        )
    )
    files = programs.generated(net, {}, programs.Sizes.start(net, {}), Diagnostics())
    assert files is not None
    text = files[0].text
    assert (text.count("_succeed("), text.count("_enumerate(pn_ctx_t")) == (1, TRANSITIONS)
