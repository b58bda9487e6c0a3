"""Nets of cells in which a supervisor gives tasks to programs, each as soon as those are done that it waits for.

net = task_net(HEAD, {"F": "Feeder", "A": "Arm"}, [("F", told(0, "feed ()")), ("A", told(1, "fetch ()"))], {(0, 1)})
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

Task = tuple[str, Sequence[str]]
"""Whose it is, and the transitions and places on that page that do it."""
Waits = Iterable[tuple[int, int]]
"""Of two tasks the second one waits for the first one."""


def told(i: int, does: str) -> list[str]:
    """The transition that does what it is told, and nothing else."""
    return [
        f"    trans Do{i} code action ({does})",
        *("      in Waiting : ()", f"      in f : {i}", "      out Waiting : ()", f"      out d : {i}"),
    ]  # fmt: skip


def task_net(head: str, parties: Mapping[str, str], tasks: Sequence[Task], waits: Waits) -> str:
    """The whole net.

    Args:
        head: up to the first line of the top page.
        parties: the programs, each a page, by the letters of their channels: `fA` with commands, `dA` with answers.
        waits: beside that each program does its tasks in their order.
    """
    owners = [party for party, _ in tasks]
    lines = [head.rstrip(), *_top(parties), *_supervisor(parties, owners, waits)]
    for party, name in parties.items():
        lines += [f"  page {name}", "    place f port in : INT", "    place d port out : INT"]
        lines.append("    place Waiting = 1")
        for own, does in tasks:
            lines += does if own == party else ()
    return "\n".join(lines) + "\n"


def _top(parties: Mapping[str, str]) -> list[str]:
    lines = [f"    place {c}{p} : INT" for p in parties for c in "fd"]
    sockets = ", ".join(f"{c}{p} -> {c}{p}" for p in parties for c in "fd")
    lines.append(f"    subst Supervisor = Sup ({sockets})")
    return [
        *lines,
        *(f"    subst {name} = {name} (f -> f{p}, d -> d{p})" for p, name in parties.items()),
    ]


def _supervisor(parties: Mapping[str, str], owners: Sequence[str], waits: Waits) -> list[str]:
    edges = sorted({*waits, *_in_turn(owners)})
    lines = ["  page Sup"]
    lines += [f"    place f{p} port out : INT" for p in parties]
    lines += [f"    place d{p} port in : INT" for p in parties]
    lines += [f"    place After{i}Before{j}" for i, j in edges]
    for i, party in enumerate(owners):
        lines += [f"    place Ready{i} = 1", f"    place Busy{i}", f"    place Done{i}"]
        lines += [f"    trans Send{i}", f"      in Ready{i} : ()"]
        lines += [f"      in After{a}Before{b} : ()" for a, b in edges if b == i]
        lines += [f"      out f{party} : {i}", f"      out Busy{i} : ()"]
        lines += [f"    trans Got{i}", f"      in Busy{i} : ()", f"      in d{party} : {i}"]
        lines += [f"      out After{a}Before{b} : ()" for a, b in edges if a == i]
        lines.append(f"      out Done{i} : ()")
    lines += ["    place Finished", "    trans Finish"]
    lines += [f"      in Done{i} : ()" for i in range(len(owners))]
    return [*lines, "      out Finished : ()"]


def _in_turn(owners: Sequence[str]) -> Waits:
    last: dict[str, int] = {}
    for j, party in enumerate(owners):
        if party in last:
            yield last[party], j
        last[party] = j
