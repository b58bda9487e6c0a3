"""The riveting cell's net in the token game: it plays to the end and sends the rows of the oracle."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from helpers.rivet_rows import Row, printed, rows
from helpers.thorough import amount
from pn2code.cell.divide import divide
from pn2code.cell.load import load as load_cell
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import ArcKind, FlatNet, FlatPlace
from pn2code.net.front import load
from pn2code.semantics.game.token_game import BindingElement, Game
from pn2code.semantics.values.data import Value
from pn2code.semantics.values.multiset import MultiSet

FIRST = (5750.0, 5898.8, 2135.05, -105.0, 0.0, 0.0)
LAST = (6750.0, 5898.8, 2135.05, -105.0, 0.0, 0.0)
TOLERANCE_MM = 1e-9
"""The oracle multiplies matrices where the net has formulas: the last bits may differ."""

READINGS = ("pressed", "drilled", "inserted", "released", "seen")
"""The variables that nothing in the net decides: whether a tool or the camera has done its work."""
DONE, FAILED = 1, 2

Pose = Sequence[float]


@pytest.fixture(scope="module")
def nets(root: Path) -> dict[bool, FlatNet]:
    """The net as it is, and with `safeReturn`."""

    def one(values: dict[str, str]) -> FlatNet:
        d = Diagnostics()
        net = load(root / "examples/riveting/cell.cpn", d, values)
        assert [i.code for i in d.items] == []
        assert net is not None
        return net

    return {False: one({}), True: one({"safeReturn": "true"})}


@dataclass
class Run:
    """What a run has sent to each robot, which transitions have occurred, the final place that holds a token."""

    rows: tuple[list[Row], list[Row]]
    fired: list[str]
    game: Game
    ended: str = ""


def token(pose: Pose) -> Value:
    """A pose as the token game stores records: fields in the order of their labels."""
    x, y, z, rx, ry, rz = (float(v) for v in pose)
    return (rx, ry, rz, x, y, z)


def pose_of(value: Value) -> Row:
    assert isinstance(value, tuple)
    rx, ry, rz, x, y, z = (float(v) for v in value)  # type: ignore[arg-type]
    return (x, y, z, rx, ry, rz)


def place(net: FlatNet, short: str, instance: str) -> FlatPlace:
    return next(p for p in net.places if p.short == short and p.instance == instance)


def play(
    net: FlatNet,
    n: int,
    first: Pose,
    last: Pose,
    *,
    measured: tuple[Pose, Pose] | None = None,
    choose: Callable[[int], int] = lambda size: 0,
    faults: Mapping[str, int] | None = None,
) -> Run:
    """Plays to the end; `measured` replaces what robot 1's camera answers.

    Nothing fails but what `faults` says: {"drilled": 3} is the drill at the third rivet.
    """
    source = place(net, "coordenadas", "Cell/Supervisor")
    game = Game(
        net, {"FLOAT": "float32"}, {source.name: MultiSet.of([(n, token(first), token(last))])}
    )
    channels = [p for p in net.places if p.instance == "Cell"]
    data = [place(net, f"dadosrobo{k}", "Cell").index for k in (1, 2)]
    answer = place(net, "medida1", "Cell").index
    answers = list(measured or ())
    run = Run(([], []), [], game)
    # 500 points are 25,000 steps: only transitions that take from places that have changed are asked
    # again, and only where no place is empty (every input arc of this net takes one token).
    takes = [
        {a.place for a in t.arcs if a.kind in (ArcKind.INPUT, ArcKind.BOTH)}
        for t in net.transitions
    ]
    beside = {
        p.index: [t for t in net.transitions if p.index in takes[t.index]] for p in net.places
    }
    enabled: dict[int, list[BindingElement]] = {}
    failing, read = faults or {}, Counter[str]()
    asked = list(net.transitions)
    while True:
        for t in asked:
            enabled[t.index] = []
            if all(len(game.marking.places[i]) for i in takes[t.index]):
                bindings = game.enabling.enabled(t, game.marking)
                enabled[t.index] = [BindingElement.make(t, b) for b in bindings]
        elements = [
            e
            for index in sorted(enabled)
            for e in enabled[index]
            if all(
                value == (FAILED if read[name] + 1 == failing.get(name) else DONE)
                for name, value in readings(e)
            )
        ]
        if not elements:
            break
        element = elements[choose(len(elements))]
        read.update(name for name, _ in readings(element))
        before = game.marking.places
        game.marking, _ = game.occur(game.marking, element)
        run.fired.append(net.transitions[element.transition].name)
        for k, index in enumerate(data):
            if len(game.marking.places[index]) > len(before[index]):
                (message,) = game.marking.places[index]
                run.rows[k].append(pose_of(message))
        if answers and len(game.marking.places[answer]) > len(before[answer]):
            places = list(game.marking.places)
            places[answer] = MultiSet.of([token(answers.pop(0))])
            game.marking = replace(game.marking, places=tuple(places))
        for p in channels:
            assert len(game.marking.places[p.index]) <= 1, f"`{p.name}` holds two messages"
        changed = [i for i, m in enumerate(game.marking.places) if m is not before[i]]
        asked = [t for i in changed for t in beside[i]]
    held = {p.short for p in net.places if len(game.marking.places[p.index])}
    assert held in ({"Finished", "Waiting"}, {"Failed", "Waiting"})
    run.ended = next(iter(held - {"Waiting"}))
    assert game.marking_text(place(net, run.ended, "Cell/Supervisor").name) == "1`()"
    return run


def readings(element: BindingElement) -> list[tuple[str, Value]]:
    return [(s.name, value) for s, value in element.values if s.name in READINGS]


def same(ours: Sequence[Row], expected: Sequence[Row]) -> None:
    assert len(ours) == len(expected)
    for k, (a, b) in enumerate(zip(ours, expected, strict=True), 1):
        assert a == pytest.approx(b, rel=0, abs=TOLERANCE_MM), f"row {k}"


def test_it_divides_among_supervisor_and_robots(nets: dict[bool, FlatNet], root: Path) -> None:
    d = Diagnostics()
    config = load_cell(root / "examples/riveting/cell.toml", d)
    partition = divide(nets[False], config, d)
    assert partition is not None
    assert not d.items
    assert [o.instance for o in partition.owners] == [
        "Cell/Supervisor",
        "Cell/Robot1",
        "Cell/Robot2",
    ]
    assert len(partition.channels) == 8
    assert [nets[False].places[i].short for i in partition.final_places] == [
        "Finished",
        "Failed",
    ]


def test_table_1_gives_the_rows_of_the_oracle(nets: dict[bool, FlatNet]) -> None:
    run = play(nets[False], 5, FIRST, LAST)
    assert (run.ended, len(run.fired)) == ("Finished", 385)
    expected = rows(5, FIRST, LAST)
    for ours, theirs in zip(run.rows, expected, strict=True):
        assert len(ours) == 22
        assert [printed(r) for r in ours] == [printed(r) for r in theirs]
        same(ours, theirs)
    actions = [name.split(".")[-1] for name in run.fired if name.startswith("Cell.Robot")]
    assert {a: actions.count(a) for a in ("Drill", "Insert", "Press", "Release")} == dict.fromkeys(
        ("Drill", "Insert", "Press", "Release"), 7
    )
    assert actions.count("Measure") == 2
    assert actions.count("MoveHome") == 2


def test_no_row_holds_a_negative_zero(nets: dict[bool, FlatNet]) -> None:
    for out in play(nets[False], 5, FIRST, LAST).rows:
        assert not any(str(v) == "-0.0" for row in out for v in row)


def test_the_safe_return_goes_back_all_the_way(nets: dict[bool, FlatNet]) -> None:
    run = play(nets[True], 5, FIRST, LAST)
    for ours, theirs in zip(run.rows, rows(5, FIRST, LAST, safe_return=True), strict=True):
        same(ours, theirs)
    assert printed(run.rows[0][-1]).split()[0] == "-1000.0000"


def test_the_initial_marking_is_table_1(nets: dict[bool, FlatNet]) -> None:
    net = nets[False]
    game = Game(net, {"FLOAT": "float32"})
    given = Game(
        net,
        {"FLOAT": "float32"},
        {
            place(net, "coordenadas", "Cell/Supervisor").name: MultiSet.of(
                [(5, token(FIRST), token(LAST))]
            )
        },
    )
    assert game.marking == given.marking


def test_a_measured_difference_moves_the_rivets(nets: dict[bool, FlatNet]) -> None:
    measured = (
        (5750.8, 5899.1, 2134.6, -105.0, 0.0, 0.0),
        (6749.2, 5898.0, 2136.0, -104.0, 1.0, 0.0),
    )
    run = play(nets[False], 3, FIRST, LAST, measured=measured)
    for ours, theirs in zip(run.rows, rows(3, FIRST, LAST, measured=measured), strict=True):
        assert len(ours) == 1 + 1 + 2 * 5 + 4 + 1
        same(ours, theirs)


def test_a_difference_of_the_last_reference_alone_sends_no_extra_row(
    nets: dict[bool, FlatNet],
) -> None:
    exact = first_reference(nets[False])
    measured = (exact, (6751.0, 5899.0, 2135.0, *LAST[3:]))
    run = play(nets[False], 2, FIRST, LAST, measured=measured)
    for ours, theirs in zip(run.rows, rows(2, FIRST, LAST, measured=measured), strict=True):
        assert len(ours) == 1 + 2 * 4 + 3 + 1
        same(ours, theirs)


def first_reference(net: FlatNet) -> Row:
    """The first reference as it is stored, in single precision."""
    game = Game(net, {"FLOAT": "float32"})
    ((_, first, _),) = game.marking.places[place(net, "coordenadas", "Cell/Supervisor").index]  # type: ignore[misc]
    return pose_of(first)


@pytest.mark.parametrize("seed", range(3))
def test_the_order_of_firing_does_not_matter(nets: dict[bool, FlatNet], seed: int) -> None:
    rng = random.Random(seed)
    orderly = play(nets[False], 2, FIRST, LAST)
    wild = play(nets[False], 2, FIRST, LAST, choose=rng.randrange)
    assert wild.rows == orderly.rows
    assert wild.game.marking == orderly.game.marking
    assert sorted(wild.fired) == sorted(orderly.fired)


STEPS = ("Press", "Drill", "Insert", "Release")


@pytest.mark.parametrize("rivet", [1, 3, 5])
@pytest.mark.parametrize("reading", ["pressed", "drilled", "inserted", "released"])
def test_after_a_fault_of_a_tool_both_robots_are_out_and_at_home(
    nets: dict[bool, FlatNet], reading: str, rivet: int
) -> None:
    run = play(nets[False], 3, FIRST, LAST, faults={reading: rivet})
    assert run.ended == "Failed"
    done = [name.split(".", 2)[1:] for name in run.fired if name.startswith("Cell.Robot")]
    commands = [f"{robot}.{step}" for robot, step in done if step not in ("Accept", "Report")]
    # What was begun at the failing rivet, the release at any rate, then out and HOME.
    last = 1 + READINGS.index(reading)
    tools = [name.split(".")[1] for name in commands if name.split(".")[1] in STEPS]
    begun = [*STEPS[:last], *([] if reading == "released" else ["Release"])]
    assert tools == [*STEPS * (rivet - 1), *begun]
    released = len(commands) - 1 - commands[::-1].index("Robot2.Release")
    assert sorted(commands[released + 1 :]) == [
        "Robot1.MoveHome",
        "Robot1.MoveLinear",
        "Robot2.MoveHome",
        "Robot2.MoveLinear",
    ]
    for robot in ("Robot1", "Robot2"):
        assert commands.index(f"{robot}.MoveHome") > commands.index(f"{robot}.MoveLinear", released)
    for ours, theirs in zip(run.rows, rows(3, FIRST, LAST), strict=True):
        same(ours, theirs[: 1 + 3 * rivet - 1])
        assert ours[-1][2] == -100.0


@pytest.mark.parametrize("which", [1, 2])
def test_a_reference_that_is_not_found_ends_the_work(nets: dict[bool, FlatNet], which: int) -> None:
    run = play(nets[False], 3, FIRST, LAST, faults={"seen": which})
    assert run.ended == "Failed"
    assert [len(ours) for ours in run.rows] == [1, 1]  # the approach
    assert sum(name.endswith(".MoveHome") for name in run.fired) == 2


@pytest.mark.parametrize(("off", "ended"), [(49.9, "Finished"), (50.1, "Failed")])
@pytest.mark.parametrize("which", [0, 1])
def test_a_reference_too_far_off_ends_the_work(
    nets: dict[bool, FlatNet], which: int, off: float, ended: str
) -> None:
    measured = [first_reference(nets[False]), LAST]
    x, y, *others = measured[which]
    measured[which] = (x + 0.6 * off, y - 0.8 * off, *others)
    assert play(nets[False], 0, FIRST, LAST, measured=(measured[0], measured[1])).ended == ended


def test_faults_can_be_switched_off(root: Path) -> None:
    net = load(root / "examples/riveting/cell.cpn", Diagnostics(), {"faults": "false"})
    assert net is not None
    assert play(net, 0, FIRST, LAST, faults={"drilled": 1, "seen": 2}).ended == "Finished"


coordinate = st.floats(-10_000, 10_000, width=32)
angle = st.floats(-360, 360, width=32)
pose = st.tuples(coordinate, coordinate, coordinate, angle, angle, angle)


@settings(
    max_examples=amount(4, 15),
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(n=st.integers(0, 30), first=pose, last=pose, safe=st.booleans())
def test_any_seam_gives_the_rows_of_the_oracle(
    nets: dict[bool, FlatNet], n: int, first: Pose, last: Pose, safe: bool
) -> None:
    run = play(nets[safe], n, first, last)
    for ours, theirs in zip(run.rows, rows(n, first, last, safe_return=safe), strict=True):
        same(ours, theirs)


def test_many_points(nets: dict[bool, FlatNet]) -> None:
    n = amount(150, 500)
    last = (6750.0, 5998.8, 2035.05, -105.0, 0.0, 0.0)
    run = play(nets[False], n, FIRST, last)
    for ours, theirs in zip(run.rows, rows(n, FIRST, last), strict=True):
        assert len(ours) == 1 + 2 * (n + 2) + (n + 1) + 1
        same(ours, theirs)
