"""Robot pages -> robot programs.

A robot's part of the net is understood as a state machine (`robot_machine`) with data (`robot_data`), each transition
becomes statements (`robot_steps`), each state a decision among its transitions (`robot_states`), and the graph of
states becomes loops and branches (`robot_structure`).

    Waiting --Accept--> Commanded --MoveJoint [k = JOINT]--> Done --Report--> Waiting

    loop
      wait until filled(flag1_interno)
      read flag1_interno into k
      ...
      if k = JOINT then
"""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.cell.codes import CELL_VALUE
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Owner, OwnerKind, Partition
from pn2code.diagnostics import Diagnostics, Note
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot_scripts.analyse import analyse
from pn2code.robot_scripts.data import Data
from pn2code.robot_scripts.ir import (
    LeftOut,
    Node,
    Region,
    RobotIR,
    place_element,
    statements,
    transition_element,
)
from pn2code.robot_scripts.machine import Machine
from pn2code.robot_scripts.names import Names, small_identifier
from pn2code.robot_scripts.procedures import extract
from pn2code.robot_scripts.states import States
from pn2code.robot_scripts.structure import Tree, structure
from pn2code.tdl import flow
from pn2code.tdl import tree as t
from pn2code.tdl.paths import all_names, expressions_of, files_in


def lower_robots(
    partition: Partition, config: CellConfig, d: Diagnostics
) -> tuple[RobotIR, ...] | None:
    """The programs of all robots; None when an error was reported."""
    before = len(d.errors)
    out = []
    for owner in partition.owners:
        if owner.kind is not OwnerKind.SUPERVISOR:
            found = Diagnostics()
            ir = _lower(partition, owner, config, found)
            if ir is not None:
                out.append(ir)
            # Instances of one page have the same mistakes: said once.
            said = {(x.code, x.message, x.origin.line, x.origin.column) for x in d}
            for x in found:
                if (x.code, x.message, x.origin.line, x.origin.column) not in said:
                    d.items.append(x)
    _unasked(out, partition, config, d, all_made=len(d.errors) == before)
    return tuple(out) if len(d.errors) == before else None


def awaited_first(partition: Partition, machine: Machine, place: int) -> frozenset[int]:
    """The channels of the messages that a script waits for at a control place before it asks any condition.

    Where they are the same for all transitions, the net says so; else whether their conditions exclude each other
    decides, as it does for the script (`States`).
    """
    taken = [
        frozenset(p for p, *_ in s.takes if p in machine.channels)
        for s in machine.steps_from(place)
    ]
    common = frozenset.intersection(*taken) if taken else frozenset()
    if not common or len(set(taken)) == 1 or partition.config is None:
        return common
    data = Data(partition, machine, partition.config, Diagnostics())
    return States(data).awaited_first(place) if data.declare() else frozenset()


def _unasked(
    programs: Sequence[RobotIR],
    partition: Partition,
    config: CellConfig,
    d: Diagnostics,
    *,
    all_made: bool,
) -> None:
    """Sensors that no program asks: a misspelt variable would otherwise go unnoticed.

    Where not all programs could be made (perhaps for lack of just this sensor), only those whose variable the net
    does not have.
    """
    asked = {
        s.sensor
        for ir in programs
        for body in (ir.body, *(p for _, p in ir.procedures))
        for s in flow.walk(statements(body))
        if isinstance(s, t.Sense)
    }
    names = {v.name for x in partition.net.transitions for v in x.variables}
    for sensor in config.sensors:
        if sensor.name not in asked and (all_made or sensor.variable not in names):
            d.error(
                CELL_VALUE,
                f"no robot or device asks sensor `{sensor.name}`: none of them leaves variable "
                f"`{sensor.variable}` open",
                sensor.origin,
                notes=[
                    Note(
                        f"transition `{t.name}` has a value for it, by its guard or an arc",
                        t.origin,
                    )
                    for t in partition.net.transitions
                    if any(v.name == sensor.variable for v in t.variables)
                ],
                hint=did_you_mean(
                    sensor.variable,
                    names - {sensor.variable},
                    "a sensor is asked where nothing in the net gives its variable a value: let the transition leave "
                    "it open, and decide in the guards of those that follow",
                ),
            )


def _lower(
    partition: Partition, owner: Owner, config: CellConfig, d: Diagnostics
) -> RobotIR | None:
    before = len(d.errors)
    machine = analyse(partition, owner, d)
    if machine is None:
        return None
    data = Data(partition, machine, config, d)
    if not data.declare() or len(d.errors) != before:
        return None
    states = States(data)
    trees = states.trees()
    if len(d.errors) != before:
        return None
    return _assembled(data, trees, states.left_out)


def _assembled(data: Data, trees: dict[int, Tree], left_out: Sequence[LeftOut]) -> RobotIR:
    """The program of a robot's states."""
    machine, names, places = data.machine, data.names, data.partition.net.places
    labels = {p: names.unique(small_identifier(places[p].short)) for p in machine.control}
    clash = {x for x in labels.values() if list(labels.values()).count(x) > 1}
    unique = {p: f"{x}_{i}" if x in clash else x for i, (p, x) in enumerate(labels.items())}
    whole = structure(machine.start, trees, lambda p: unique[p], data.may_be_nan)
    used, files = _used(whole)
    taken: set[str] = set()

    def procedure(first: Region) -> str:
        stem = small_identifier(first.element.rpartition(".")[2])
        name, n = names.unique(stem), 1
        while name in taken:
            n += 1
            name = names.unique(f"{stem}_{n}")
        taken.add(name)
        return name

    body, procedures = extract(whole, procedure)
    constants = names.declared_constants(used | _needed_constants(names))
    return RobotIR(
        name=machine.owner.name,
        instance=machine.owner.instance,
        page=machine.steps[0].transition.page,
        origin=places[machine.start].origins[0],
        files=tuple(f for name, f in names.files.items() if name in files),
        constants=constants,
        variables=names.declared_variables(used),
        states=tuple(place_element(places[p]) for p in machine.control),
        left_out=(
            *(
                LeftOut(transition_element(x), f"place `{p.short}` can never hold a token")
                for x, p in machine.dead
            ),
            *left_out,
        ),
        procedures=procedures,
        body=body,
        kind=machine.owner.kind.value,
    )


def _needed_constants(names: Names) -> set[str]:
    """Constants that initial values or other constants use."""
    exps = [v.initial for v in names.variables.values() if v.initial is not None]
    for c in names.constants.values():
        assert isinstance(c.declaration, t.Const)
        if not isinstance(c.declaration.value, t.Value):
            exps.append(c.declaration.value)
    return all_names(exps)


def _used(body: Sequence[Node]) -> tuple[set[str], set[str]]:
    """The names that statements mention: variables and constants; files."""
    names: set[str] = set()
    files: set[str] = set()

    def look(e: t.Expression) -> None:
        names.update(all_names([e]))
        files.update(files_in(e))

    for s in flow.walk(statements(body)):
        match s:
            case t.If(branches):
                for b in branches:
                    look(b.condition)
            case t.While(condition):
                look(condition)
            case t.Loop():
                pass
            case t.Exit(condition):
                if condition is not None:
                    look(condition)
            case _:
                for e in expressions_of(s):
                    look(e)
                match s:
                    case t.Read(file, targets):
                        files.add(file.name)
                        names.update(x.name for x in targets)
                    case t.Write(file) | t.Clear(file):
                        files.add(file.name)
                    case t.Assign(target) | t.Measure(_, target) | t.Sense(_, target):
                        names.add(target.name)
                    case _:
                        pass
    return names, files
