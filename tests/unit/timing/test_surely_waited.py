"""How long a run surely waits: what the tie of two ends adds is taken off, and nothing else."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, cast

from pn2code.cell.partition import OwnerKind
from pn2code.timing.answers import Cycle, Ending, between
from pn2code.timing.doings import FOREVER, NS, Doing, Doings
from pn2code.timing.longest import Arc
from pn2code.timing.look import Measured
from pn2code.timing.search import MOST, TIE, Search
from pn2code.timing.too_long import seen_too_long, surely_waited, too_long
from pn2code.timing.unstopped import Unstopped
from pn2code.timing.waits import longest_wait

MS = NS // 1000
ASK, WORK, END = 0, 1, 2
OVER, CALM, STOPPED, UNSURE = 8, 9, 10, 11


def timed_cell(work_ns: int, most: int = MOST) -> Search:
    """A supervisor in a timed net asks a device, which works, and ends; no time stamp lies ahead."""
    owners = [
        SimpleNamespace(index=0, kind=OwnerKind.SUPERVISOR),
        SimpleNamespace(index=1, kind=OwnerKind.DEVICE),
    ]
    net = SimpleNamespace(timed=True, places=[])
    graph = SimpleNamespace(
        why="",
        partition=SimpleNamespace(net=net, owners=owners, final_places=(), channels=()),
        running=SimpleNamespace(firing=CALM, ending=-1, stopped=STOPPED, owing={}, unsure=UNSURE),
        elements=[SimpleNamespace(is_step=False, owner=owner) for owner in (0, 1, 0)],
        arcs=[[(ASK, 1)], [(WORK, 2)], [(END, 3)], []],
        marked=[{}, {}, {}, {OVER: 1}],
        over={3},
    )
    work = Doing(work_ns, None, ())
    doings: Any = SimpleNamespace(
        graph=graph,
        why="",
        stops=False,
        homes=(),
        arm_of={},
        of=lambda element, _: work if element == WORK else None,
        waits=lambda _: 0,
    )
    search = Search(cast(Doings, doings), most)
    search.explore()
    return search


def measured(search: Search, timeout: int = 120 * NS) -> Measured:
    """With the runs that nothing stops."""
    return Measured(search, cast(Any, None), Unstopped(search, timeout))


def test_whole_seconds_in_which_nothing_ends_are_waited_for() -> None:
    """A command of 3.4 s was one of 2.4 s to 3.4 s, and one of 18.456 s could have been one of 9.2 s."""
    for ns in (3_400 * MS, 18_456 * MS, 3_000 * MS, 400 * MS):
        search = timed_cell(ns)
        assert not search.why
        first, second = (lambda mark: mark == ASK), (lambda mark: mark == END)
        wait = longest_wait(search.successors, first, second, search.ends)
        assert wait.ns is not None and ns <= wait.ns <= ns + TIE
        surely, shown = surely_waited(search, wait, first, second)
        assert ns - TIE <= surely <= ns, (ns, surely)
        assert [mark for _, mark in shown.way if mark >= 0] == [ASK, WORK, END]


def test_what_was_seen_before_a_limit_may_be_too_long() -> None:
    first, second = (lambda mark: mark == ASK), (lambda mark: mark == END)
    search = timed_cell(18_456 * MS, 4)
    assert search.why == "situations"
    found = seen_too_long(measured(search), first, second, 17 * NS)
    assert found is not None and found.wait.ns == 18 * NS and found.ns is None, (
        "then the work is not done yet"
    )
    assert seen_too_long(measured(search), first, second, 18 * NS) is None
    search.why = "overtaken"
    assert seen_too_long(measured(search), first, second, 17 * NS) is None
    assert seen_too_long(measured(timed_cell(18_456 * MS)), first, second, 17 * NS) is None


@dataclass
class Tied:
    """A graph whose marked arcs are longer by the time in which something else should have ended."""

    successors: list[list[Arc]]
    late: dict[int, int]

    def held_up(self, _: int, way: Iterable[tuple[int, int]]) -> int:
        return sum(self.late.get(mark, 0) for _, mark in way)

    def surely(self) -> list[list[Arc]]:
        return [[(n, ns - self.late.get(m, 0), m) for n, ns, m in x] for x in self.successors]


def test_a_run_without_ties_that_waits_nearly_as_long() -> None:
    """The longest one, of 10 s, is 5 ms of ties; another one waits for 9.999 s without any."""
    both = [(2, 10_000 * MS, 1), (2, 9_999 * MS, 2)]
    graph: list[list[Arc]] = [[(1, 0, 0)], both, [(3, 0, 9)], []]
    search = cast(Search, Tied(graph, {1: 5 * MS}))
    first, second = (lambda mark: mark == 0), (lambda mark: mark == 9)
    wait = longest_wait(graph, first, second, ())
    assert wait.ns == 10_000 * MS
    surely, shown = surely_waited(search, wait, first, second)
    assert surely == 9_999 * MS and [mark for _, mark in shown.way] == [0, 2, 9]


def test_a_bound_is_rounded_outwards() -> None:
    assert (
        between(10 * NS, 10 * NS)
        == "between 9.999 s and 10.001 s, as durations are known to a millisecond"
    )
    assert between(10 * NS, 10_009 * MS) == (
        "between 9.999 s and 10.010 s, as what ends within a millisecond of each other may end in either order"
    )
    cycle = Cycle((Ending(("Done",), NS, 4 * NS),), "", (), NS, 9 * NS, (), 100)
    assert cycle.within(3.9) == ("no", "a run takes at least 3.999 s")
    assert cycle.within(4.0)[1].startswith("the longest cycle takes between 3.999 s and 4.001 s")


def stopping_cell(first_ns: int = FOREVER, *, halts: bool = False) -> Search:
    """Two devices are asked: the first one's command cannot be done, or its script stops; the other's takes 3 s."""
    owners = [
        SimpleNamespace(index=0, kind=OwnerKind.SUPERVISOR),
        SimpleNamespace(index=1, kind=OwnerKind.DEVICE),
        SimpleNamespace(index=2, kind=OwnerKind.DEVICE),
    ]
    first, other, over = 1, 3, 2
    works = [] if halts else [[(first, 5)], [(first, 6)]]
    graph = SimpleNamespace(
        why="",
        partition=SimpleNamespace(
            net=SimpleNamespace(timed=False, places=[]),
            owners=owners,
            final_places=(),
            channels=(),
        ),
        running=SimpleNamespace(firing=CALM, ending=-1, stopped=STOPPED, owing={}, unsure=UNSURE),
        elements=[SimpleNamespace(is_step=False, owner=owner) for owner in (0, 1, 0, 2)],
        arcs=[
            [(ASK, 1)],
            [(other, 2), *((first, 5) for _ in works[:1]), *((first, 4) for _ in range(halts))],
            [(over, 3), *((first, 6) for _ in works[:1])],
            [],
            [],
            [(other, 6)],
            [(over, 3)],
        ],
        marked=[{}, {}, {}, {}, {STOPPED: 1}, {}, {}],
        over=set(),
    )
    fault = "it is out of reach" if first_ns >= FOREVER else ""
    made = {first: Doing(first_ns, None, (), fault), other: Doing(3 * NS, None, ())}
    if halts:
        del made[first]
    doings: Any = SimpleNamespace(
        graph=graph,
        why="",
        stops=False,
        homes=(),
        arm_of={},
        of=lambda element, _: made.get(element),
        waits=lambda _: 0,
    )
    search = Search(cast(Doings, doings))
    search.explore()
    return search


def test_what_others_do_after_a_fault_is_no_run() -> None:
    """It was shown as a run that waits for 3 s, though the cell stops as soon as it has asked."""
    events = (lambda mark: mark == ASK), (lambda mark: mark == END)
    for search, is_real in (
        (stopping_cell(), False),
        (stopping_cell(halts=True), False),
        (stopping_cell(2 * NS), True),
    ):
        wait = longest_wait(search.successors, *events, ())
        assert wait.ns == 3 * NS
        assert bool(search.stopped()) == (not is_real)
        one = measured(search)
        assert one.runs.is_all == is_real
        assert (too_long(one, wait, events, 2 * NS, ()) is not None) == is_real
        search.why = "situations"
        assert (seen_too_long(one, *events, 2 * NS) is not None) == is_real
