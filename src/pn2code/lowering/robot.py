"""Robot pages -> robot programs.

A robot's part of the net is understood as a state machine with data (`robot_machine`), each transition
becomes statements (`robot_steps`), each state a decision among its transitions (here), and the graph of
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
from dataclasses import dataclass, field

from pn2code.cell.codes import CELL_VALUE
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Owner, OwnerKind, Partition
from pn2code.diagnostics import Diagnostics, Note, Origin
from pn2code.diagnostics.near import did_you_mean
from pn2code.lowering import robot_codes as codes
from pn2code.lowering import robot_names
from pn2code.lowering.robot_evaluate import Evaluator
from pn2code.lowering.robot_guards import covering, exclusive
from pn2code.lowering.robot_ir import (
    Comment,
    Element,
    LeftOut,
    Line,
    Node,
    Region,
    RobotIR,
    statements,
)
from pn2code.lowering.robot_machine import Machine, Outcome, Step, analyse, tokens
from pn2code.lowering.robot_names import Names, identifier
from pn2code.lowering.robot_procedures import extract
from pn2code.lowering.robot_steps import Situation, StepTranslator, header
from pn2code.lowering.robot_structure import Branches, Halt, Then, To, Tree, structure
from pn2code.lowering.robot_values import (
    FALSE,
    TRUE,
    Shape,
    UnsupportedError,
    Value,
    conjunction,
    disjunction,
    flatten,
    leaves,
    make,
    shape_of_colset,
)
from pn2code.ml import core
from pn2code.net.flat import FlatPlace, FlatTransition
from pn2code.tdl import flow
from pn2code.tdl import tree as t
from pn2code.tdl.paths import all_names, expressions_of, files_in, names_in
from pn2code.tdl.pretty import expression


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
    if len(d.errors) == before:
        _unasked(out, partition, config, d)
    return tuple(out) if len(d.errors) == before else None


def _unasked(
    programs: Sequence[RobotIR], partition: Partition, config: CellConfig, d: Diagnostics
) -> None:
    """Sensors that no program asks: a misspelt variable would otherwise go unnoticed."""
    asked = {
        s.sensor
        for ir in programs
        for body in (ir.body, *(p for _, p in ir.procedures))
        for s in flow.walk(statements(body))
        if isinstance(s, t.Sense)
    }
    names = {v.name for x in partition.net.transitions for v in x.variables}
    for sensor in config.sensors:
        if sensor.name not in asked:
            d.error(
                CELL_VALUE,
                f"sensor `{sensor.name}` is asked by nobody: no robot or device leaves variable "
                f"`{sensor.variable}` open",
                sensor.origin,
                hint=did_you_mean(sensor.variable, names - {sensor.variable}),
            )


def _lower(
    partition: Partition, owner: Owner, config: CellConfig, d: Diagnostics
) -> RobotIR | None:
    before = len(d.errors)
    machine = analyse(partition, owner, d)
    if machine is None:
        return None
    translator = _Translator(partition, machine, config, d)
    if not translator.declare() or len(d.errors) != before:
        return None
    trees = translator.trees()
    if len(d.errors) != before:
        return None
    return translator.assemble(trees)


@dataclass(slots=True)
class _Translator:
    partition: Partition
    machine: Machine
    config: CellConfig
    d: Diagnostics
    names: Names = field(default_factory=Names)
    shapes: dict[int, Shape] = field(default_factory=dict)
    place_names: dict[int, list[str]] = field(default_factory=dict)
    place_values: dict[int, Value] = field(default_factory=dict)
    file_names: dict[int, str] = field(default_factory=dict)
    message_names: dict[int, list[str]] = field(default_factory=dict)
    """the variables that the state at hand reads messages into"""
    never: list[LeftOut] = field(default_factory=list)
    pure: Evaluator = field(init=False)
    step: StepTranslator = field(init=False)

    def __post_init__(self) -> None:
        program = self.partition.net.program
        primitives = frozenset(self.config.primitives)
        self.pure = Evaluator(program, primitives, self.names.constant)
        self.step = StepTranslator(
            self.machine, self.names, self.config.primitives, self.pure,
            self.place_names, self.shapes, self.file_names,
            {s.variable: s.name for s in self.config.sensors}, self.config.storage,
        )  # fmt: skip

    # --- declarations ---

    def declare(self) -> bool:
        """Files, then the variables of places, then their initial values; False after a report."""
        places = self.partition.net.places
        used = {p for s in self.machine.steps for p, *_ in s.takes}
        put = {p for s in self.machine.steps for o in s.outcomes for p, _ in o.puts}
        program = self.partition.net.program
        for p in [*self.machine.channels, *self.machine.variables, *self.machine.control]:
            if p not in used | put:
                continue
            is_file = p in self.machine.channels
            shape = shape_of_colset(
                places[p].colset, program, self.config.storage, in_order=is_file
            )
            if shape is None:
                self.d.error(
                    codes.UNSUPPORTED_COLSET,
                    f"place `{places[p].short}` has colour set `{places[p].colset.name}`, "
                    "which robot scripts do not have",
                    places[p].origins[0],
                    notes=[f"{self.machine.owner.phrase} uses the place"],
                    hint="use units, booleans, integers, reals, strings, enumerations, "
                    "and records and products of these",
                )
                return False
            self.shapes[p] = shape
        for p, channel in self.machine.channels.items():
            if p in used | put:
                reads = channel.reader == self.machine.owner.index
                direction = t.Direction.INPUT if reads else t.Direction.OUTPUT
                self.file_names[p] = self.names.file(
                    channel.name,
                    channel.file,
                    direction,
                    self.shapes[p],
                    _place_element(places[p], "channel"),
                )
        # Variables first: their names are theirs alone.
        for p in self.machine.variables:
            names = self.names.own(
                self.variable_stems(p), self.shapes[p], _place_element(places[p])
            )
            self.hold(p, names)
        for p in self.machine.control:
            names = self.names.shared(
                self.control_stems(p), self.shapes[p], _place_element(places[p])
            )
            self.hold(p, names)
        return all(self.initial(p) for p in (*self.machine.variables, self.machine.start))

    def hold(self, place: int, names: list[str]) -> None:
        self.place_names[place] = names
        self.place_values[place] = make(self.shapes[place], iter(names))

    def taking_patterns(self, place: int) -> list[tuple[Step, core.Pat | None]]:
        return [
            (s, term.pattern) for s in self.machine.steps for p, term, _, _ in s.takes if p == place
        ]

    def control_stems(self, place: int) -> list[str]:
        """The names that all transitions take the data with; else those of the place."""
        shape = self.shapes[place]
        found = [robot_names.of_pattern(p, shape) for _, p in self.taking_patterns(place)]
        if found and found[0] is not None and all(f == found[0] for f in found):
            return found[0]
        return self.place_stems(place)

    def variable_stems(self, place: int) -> list[str]:
        """As for control places, if the net variable stands for nothing else on the robot's pages."""
        taking = self.taking_patterns(place)
        symbols = {p.symbol for _, p in taking if isinstance(p, core.PVar)}
        if len(symbols) == 1 and all(isinstance(p, core.PVar) for _, p in taking):
            (symbol,) = symbols
            users = {
                s.transition.index for s in self.machine.steps if symbol in s.transition.variables
            }
            if users == {s.transition.index for s, _ in taking}:
                return self.control_stems(place)
        return self.place_stems(place)

    def place_stems(self, place: int) -> list[str]:
        stem = identifier(self.partition.net.places[place].short).lower()
        return robot_names.of_stem(stem, self.shapes[place])

    def initial(self, place: int) -> bool:
        flat = self.partition.net.places[place]
        assert flat.initial is not None
        ((_, values),) = tokens(*flat.initial)
        assert values is not None
        try:
            if self.place_names[place]:
                value = self.pure.evaluate(values[0], {})
                found = flatten(value, self.shapes[place], values[0].span)
                for name, leaf in zip(self.place_names[place], found, strict=True):
                    self.names.initialise(name, leaf.exp)
        except UnsupportedError as problem:
            self.report(problem, f"initial marking of place `{flat.short}`", flat.origins[0])
            return False
        return True

    def report(self, problem: UnsupportedError, where: str, origin: Origin) -> None:
        self.d.error(
            problem.code,
            problem.message,
            problem.span,
            notes=[
                Note(
                    f"{where}, in the program of {self.machine.owner.phrase}",
                    origin,
                )
            ],
        )

    # --- states ---

    def trees(self) -> dict[int, Tree]:
        """For each control place the decision what happens there."""
        return {p: self.state(p) for p in self.machine.control}

    def state(self, place: int) -> Tree:
        steps = self.machine.steps_from(place)
        if not steps:
            return Halt(over=True)
        try:
            messages = self.messages(place, steps)
        except UnsupportedError as problem:
            self.report(
                problem, f"transition `{steps[0].transition.short}`", steps[0].transition.origin
            )
            return Halt()
        situations: list[Situation] = []
        for s in steps:
            try:
                situations.append(self.step.situation(s, {**self.place_values, **messages}))
            except UnsupportedError as problem:
                self.report(problem, f"transition `{s.transition.short}`", s.transition.origin)
        if len(situations) != len(steps):
            return Halt()
        self.warn_of_choices(situations)
        return self.decide(place, situations)

    def messages(self, place: int, steps: Sequence[Step]) -> dict[int, Value]:
        """Script variables for the messages that the transitions of a state take."""
        found: dict[int, Value] = {}
        for s in steps:
            # Only what one transition needs at a time must be kept apart.
            known = [self.message_names[p] for p, *_ in s.takes if p in found]
            avoid = {*self.place_names[place], *(name for names in known for name in names)}
            bound = {
                v
                for p, term, _, _ in s.takes
                if p not in self.machine.channels
                for v in _names(term.pattern)
            }
            for p, term, _, _ in s.takes:
                if p not in self.machine.channels or p in found:
                    continue
                shape, flat = self.shapes[p], self.partition.net.places[p]
                stems = robot_names.of_pattern(term.pattern, shape)
                if stems is None or _names(term.pattern) & bound:
                    stems = robot_names.of_stem(identifier(self.machine.channels[p].name), shape)
                element = Element(
                    flat.name, "channel", flat.origins[0], f"message {flat.short} ({flat.id})"
                )
                names = self.names.shared(stems, shape, element, avoid)
                avoid |= set(names)
                self.message_names[p] = names
                found[p] = make(shape, iter(names))
        return found

    def warn_of_choices(self, situations: list[Situation]) -> None:
        for i, a in enumerate(situations):
            for b in situations[i + 1 :]:
                # Conditions on different messages say nothing about each other.
                both = set(a.channels) & set(b.channels)
                if not self.exclude(self.known(a, both)[0], self.known(b, both)[0]):
                    first, second = a.step.transition, b.step.transition
                    self.d.warning(
                        codes.CHOICE,
                        f"transitions `{first.short}` and `{second.short}` may be enabled together: "
                        f"the script of {self.machine.owner.phrase} prefers `{first.short}`",
                        second.origin,
                        notes=[
                            Note(
                                f"`{first.short}` comes first (priority, then order in the file)",
                                first.origin,
                            )
                        ],
                        hint="add guards that exclude each other if that is not what is meant",
                    )

    def exclude(self, a: t.Expression, b: t.Expression) -> bool:
        return exclusive(a, b, self.names.constant_values)

    def known(self, s: Situation, channels: set[int]) -> tuple[t.Expression, t.Expression]:
        """What can be said of a transition's conditions when only these messages have come, and what cannot."""
        others = {n for c in s.channels if c not in channels for n in self.message_names[c]}
        early = [c for c in s.remote if not all_names([c]) & others]
        late = [c for c in s.remote if all_names([c]) & others]
        return conjunction([*s.local, *early]), conjunction(late)

    def decide(self, place: int, situations: list[Situation]) -> Tree:
        """The tree of a state, by what its transitions wait for (docs/tdl.md, "Translation")."""
        if len(situations) == 1 or len({frozenset(s.channels) for s in situations}) == 1:
            return self.together(place, situations)
        units = self.units(situations)
        apart = all(
            self.exclude(a.own_condition, b.own_condition)
            for i, u in enumerate(units)
            for v in units[i + 1 :]
            for a in u
            for b in v
        )
        if apart:
            branches = [
                (
                    disjunction([s.own_condition for s in u]),
                    self.together(place, [_without_own(u[0])] if len(u) == 1 else u),
                )
                for u in units
            ]
            return self.chain(place, branches, [u[0].step for u in units])
        common = set.intersection(*(set(s.channels) for s in situations))
        if common and all(
            self.exclude(self.known(a, common)[0], self.known(b, common)[0])
            for i, a in enumerate(situations)
            for b in situations[i + 1 :]
        ):
            return self.by_common(place, situations, common)
        if all(not s.remote for s in situations):
            return self.race(place, situations)
        self.d.error(
            codes.UNSUPPORTED_PROGRAM,
            f"the transitions of place `{self.places[place].short}` wait for different messages and look into them",
            self.places[place].origins[0],
            notes=[
                Note(f"transition `{s.step.transition.short}`", s.step.transition.origin)
                for s in situations
            ],
            hint="take the message first, then decide in a further place",
        )
        return Halt()

    @property
    def places(self) -> tuple[FlatPlace, ...]:
        return self.partition.net.places

    def units(self, situations: list[Situation]) -> list[list[Situation]]:
        """Transitions grouped: those that wait for the same messages and are told apart only by them."""
        units: list[list[Situation]] = []
        for s in situations:
            home = next(
                (
                    u
                    for u in units
                    if set(u[0].channels) == set(s.channels)
                    and any(not self.exclude(x.own_condition, s.own_condition) for x in u)
                ),
                None,
            )
            if home is None:
                units.append([s])
            else:
                home.append(s)
        return units

    def together(self, place: int, situations: list[Situation]) -> Tree:
        """Transitions that wait for the same messages: wait, read, decide."""
        front = self.receive(situations[0].channels)
        if len(situations) == 1:
            only = situations[0]
            own: list[Node] = [header(only.step, self.machine)]
            if only.condition == TRUE:
                return self.occur(only, [*own, *front])
            inside = self.occur(only, [] if front else own)
            tree = self.chain(place, [(only.condition, inside)], [only.step])
            return Then((self.region(only, [*own, *front]),), tree) if front else tree
        branches = [
            (s.condition, self.occur(s, [header(s.step, self.machine)])) for s in situations
        ]
        tree = self.chain(place, branches, [s.step for s in situations])
        if not front:
            return tree
        flat = self.places[place]
        comment = Comment(f"{flat.short}: take a message, then decide")
        return Then((Region(flat.name, "place", flat.origins[0], (comment, *front)),), tree)

    def by_common(self, place: int, situations: list[Situation], common: set[int]) -> Tree:
        """Transitions that a message they all take tells apart: take it, decide, then wait for the rest."""
        branches = []
        for s in situations:
            first, late = self.known(s, common)
            rest = [c for c in s.channels if c not in common]
            own: list[Node] = [header(s.step, self.machine), *self.receive(rest)]
            if late == TRUE:
                branches.append((first, self.occur(s, own)))
            else:
                inner = self.chain(place, [(late, self.occur(s, []))], [s.step])
                branches.append((first, Then((self.region(s, own),), inner)))
        flat = self.places[place]
        front = (
            Comment(f"{flat.short}: take a message, then decide"),
            *self.receive([c for c in situations[0].channels if c in common]),
        )
        tree = self.chain(place, branches, [s.step for s in situations])
        return Then((Region(flat.name, "place", flat.origins[0], front),), tree)

    def race(self, place: int, situations: list[Situation]) -> Tree:
        """Transitions that wait for different messages: whichever comes first, in documented order."""
        ready = [
            conjunction([s.own_condition, *(_filled(self.file_names[c]) for c in s.channels)])
            for s in situations
        ]
        branches = [
            (c, self.occur(s, [header(s.step, self.machine), *self.receive(s.channels, wait=False)]))
            for c, s in zip(ready, situations, strict=True)
        ]  # fmt: skip
        tree = self.chain(place, branches, [s.step for s in situations])
        flat = self.places[place]
        if not any(c == TRUE for c in ready):
            own = [s.own_condition for s in situations]
            condition = disjunction(ready)
            if isinstance(tree, Branches):  # the wait ends only when one of them holds
                *others, (_, last) = branches
                tree = Branches(tuple(others), last) if others else last
            front: tuple[Node, ...] = (
                Comment(f"{flat.short}: whichever message comes first"),
                Line(t.WaitUntil(condition)),
            )
            tree = Then((Region(flat.name, "place", flat.origins[0], front),), tree)
            if TRUE not in own and not covering(own, self.names.constant_values):
                return Branches(((disjunction(own), tree),), self.stuck(place, own))
        return tree

    def receive(self, channels: Sequence[int], *, wait: bool = True) -> list[Node]:
        """Wait for messages and copy them."""
        out: list[Node] = []
        for c in channels:
            file = t.Target(self.file_names[c])
            if wait:
                out.append(Line(t.WaitUntil(_filled(file.name))))
            names = self.message_names[c]
            if names:
                out.append(Line(t.Read(file, tuple(t.Target(n) for n in names))))
        return out

    def chain(
        self,
        place: int,
        branches: list[tuple[t.Expression, Tree]],
        steps: list[Step],
    ) -> Tree:
        """`if ... elsif ...`; what no condition covers is a `stop` that names state and values."""
        kept: list[tuple[t.Expression, Tree]] = []
        otherwise: Tree | None = None
        for (condition, tree), s in zip(branches, steps, strict=True):
            if otherwise is not None:
                self.leave_out(s.transition, "a transition that comes before it is always possible")
            elif condition == FALSE:
                self.leave_out(s.transition, "its guard is never true")
            elif condition == TRUE:
                otherwise = tree
            else:
                kept.append((condition, tree))
        if otherwise is None and len(kept) > 1:
            conditions = [c for c, _ in kept]
            if covering(conditions, self.names.constant_values):
                otherwise = kept.pop()[1]
        if otherwise is None:
            otherwise = self.stuck(place, [c for c, _ in branches])
        return Branches(tuple(kept), otherwise) if kept else otherwise

    def leave_out(self, transition: FlatTransition, reason: str) -> None:
        self.never.append(LeftOut(_transition_element(transition), reason))

    def stuck(self, place: int, conditions: list[t.Expression]) -> Tree:
        """`stop`, saying where the program is and the values for which no condition holds."""
        flat = self.places[place]
        own = [x.exp for x in leaves(self.place_values[place])]
        asked = [e for c in conditions for e in names_in(c) if e.name in self.names.variables]
        parts: list[t.Expression] = []
        text = f"{flat.short}: nothing can happen"
        for i, e in enumerate(dict.fromkeys([*own, *asked])):
            label = expression(e)
            parts += [t.Value(f"{text} with {label} =" if i == 0 else f"and {label} ="), e]
        stop = Line(t.Stop(tuple(parts) or (t.Value(text),)))
        return Then((Region(flat.name, "place", flat.origins[0], (stop,)),), Halt())

    # --- occurrence ---

    def occur(self, s: Situation, front: list[Node]) -> Tree:
        """A transition's statements and where control goes."""
        try:
            actions, env = self.step.act(s)
            nodes = [*front, *actions, *self.step.occur(s, env)]
            outcomes = s.step.outcomes
            ends = [
                (self.outcome_condition(o, env), self.step.put(s, o, env), self.machine.target(o))
                for o in outcomes
            ]
        except UnsupportedError as problem:
            self.report(
                problem, f"transition `{s.step.transition.short}`", s.step.transition.origin
            )
            return Halt()
        live = [e for e in ends if e[0] != FALSE]
        *others, last = live
        if not others:
            return Then((self.region(s, [*nodes, *last[1]]),), To(last[2]))
        branches = tuple((c, self.end(s, puts, target)) for c, puts, target in others)
        return Then((self.region(s, nodes),), Branches(branches, self.end(s, last[1], last[2])))

    def end(self, s: Situation, puts: list[Node], target: int) -> Tree:
        return Then((self.region(s, puts),), To(target)) if puts else To(target)

    def outcome_condition(self, o: Outcome, env: dict[int, Value]) -> t.Expression:
        out: list[t.Expression] = []
        for condition, holds in o.conditions:
            (leaf,) = leaves(self.pure.evaluate(condition, env))
            if isinstance(leaf.exp, t.Value):
                out.append(t.Value(leaf.exp.value is holds))
            else:
                out.append(leaf.exp if holds else t.Unary("not", leaf.exp))
        return conjunction(out)

    def region(self, s: Situation, nodes: list[Node]) -> Region:
        transition = s.step.transition
        return Region(transition.name, "transition", transition.origin, tuple(nodes))

    # --- the whole ---

    def assemble(self, trees: dict[int, Tree]) -> RobotIR:
        """The program."""
        labels = {
            p: self.names.unique(identifier(self.places[p].short).lower())
            for p in self.machine.control
        }
        clash = {x for x in labels.values() if list(labels.values()).count(x) > 1}
        unique = {p: f"{x}_{i}" if x in clash else x for i, (p, x) in enumerate(labels.items())}
        whole = structure(self.machine.start, trees, lambda p: unique[p])
        used, files = _used(whole)
        taken: set[str] = set()

        def procedure(first: Region) -> str:
            stem = identifier(first.element.rpartition(".")[2]).lower()
            name, n = self.names.unique(stem), 1
            while name in taken:
                n += 1
                name = self.names.unique(f"{stem}_{n}")
            taken.add(name)
            return name

        body, procedures = extract(whole, procedure)
        constants = self.names.declared_constants(used | self._needed_constants())
        owner, net = self.machine.owner, self.partition.net
        first = self.machine.steps[0].transition
        return RobotIR(
            name=owner.name,
            instance=owner.instance,
            page=first.page,
            origin=self.places[self.machine.start].origins[0],
            files=tuple(f for name, f in self.names.files.items() if name in files),
            constants=constants,
            variables=self.names.declared_variables(used),
            states=tuple(_place_element(net.places[p]) for p in self.machine.control),
            left_out=(
                *(
                    LeftOut(_transition_element(x), f"place `{p.short}` can never hold a token")
                    for x, p in self.machine.dead
                ),
                *self.never,
            ),
            procedures=procedures,
            body=body,
            kind=owner.kind.value,
        )

    def _needed_constants(self) -> set[str]:
        """Constants that initial values or other constants use."""
        exps = [v.initial for v in self.names.variables.values() if v.initial is not None]
        for c in self.names.constants.values():
            assert isinstance(c.declaration, t.Const)
            if not isinstance(c.declaration.value, t.Value):
                exps.append(c.declaration.value)
        return all_names(exps)


def _without_own(s: Situation) -> Situation:
    """The situation where its conditions on the program's own data have been tested already."""
    return Situation(s.step, s.env, s.channels, (), s.remote, s.sensed)


def _filled(file: str) -> t.Expression:
    return t.CallExpression("filled", (t.Name(file),))


def _names(pattern: core.Pat | None) -> set[str]:
    match pattern:
        case core.PVar(symbol):
            return {symbol.name}
        case core.PAs(symbol, inner):
            return {symbol.name} | _names(inner)
        case core.PRecord(fields):
            return {n for _, p in fields for n in _names(p)}
        case core.PCon(_, argument):
            return _names(argument)
        case _:
            return set()


def _place_element(p: FlatPlace, kind: str = "place") -> Element:
    return Element(p.name, kind, p.origins[0], f"place {p.short} ({p.id})")


def _transition_element(x: FlatTransition) -> Element:
    return Element(x.name, "transition", x.origin, f"{x.short} ({x.id})")


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
