"""The data of a robot program: shared files, the variables of its places, and what messages are read into.

data = Data(partition, machine, config, d)
data.declare()              # False: something has no form in scripts, which was reported
data.place_names[7]         # ["k"]: the variables that hold the token of place 7
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.cell.scalars import ScalarKind, message_scalars
from pn2code.diagnostics import Diagnostics, Note, Origin
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset
from pn2code.robot_scripts import codes
from pn2code.robot_scripts import names as robot_names
from pn2code.robot_scripts.evaluate import Evaluator
from pn2code.robot_scripts.ir import Element, place_element, titled
from pn2code.robot_scripts.machine import Machine, Step
from pn2code.robot_scripts.names import Names, identifier, small_identifier
from pn2code.robot_scripts.not_a_number import may_be_nan
from pn2code.robot_scripts.shapes import Shape, shape_of_colset
from pn2code.robot_scripts.tokens import initial_tokens, unstamped
from pn2code.robot_scripts.unsupported import UnsupportedError
from pn2code.robot_scripts.values import Value, flatten, make
from pn2code.tdl import tree as t


@dataclass(slots=True)
class Data:
    """What a program's places and messages are in its script.

    Args:
        partition, config: the cell.
        machine: the program.
        d: gets the errors.
        names: of the script.
        shapes: of places and messages, by place.
        place_names: the variables of a place, in order of its scalars.
        place_values: the token of a place, made of its variables.
        file_names: of channel places.
        message_names: the variables that the state at hand reads messages into.
        pure: computes what can be known beforehand.
    """

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
    pure: Evaluator = field(init=False)

    def __post_init__(self) -> None:
        primitives = frozenset(self.config.primitives)
        self.pure = Evaluator(self.partition.net.program, primitives, self.names.constant)

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
                    hint="use units, booleans, integers, times, reals, strings, enumerations, "
                    "records and products of these, and lists of booleans, integers, times, reals, strings, "
                    "enumerations or poses (records of six reals `x`, `y`, `z`, `rx`, `ry`, `rz`, in this order), "
                    "or of records and products of these",
                )
                return False
            if is_file and _has_unit(places[p].colset):
                self.d.error(
                    codes.UNSUPPORTED_COLSET,
                    f"the messages of place `{places[p].short}` have a unit among other values, "
                    "which robot scripts do not have",
                    places[p].origins[0],
                    notes=[f"{self.machine.owner.phrase} uses the place"],
                    hint=f"leave the unit out of colour set `{places[p].colset.name}`",
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
                    message_scalars(places[p].colset) or (),
                    place_element(places[p], "channel"),
                )
        # Variables first: their names are theirs alone.
        for p in self.machine.variables:
            names = self.names.own(
                self._variable_stems(p), self.shapes[p], place_element(places[p])
            )
            self._hold(p, names)
        for p in self.machine.control:
            names = self.names.shared(
                self._control_stems(p), self.shapes[p], place_element(places[p])
            )
            self._hold(p, names)
        return all(self._initial(p) for p in (*self.machine.variables, self.machine.start))

    def may_be_nan(self, e: t.Expression) -> bool:
        """Whether the value of an expression of the script may be NaN."""
        return may_be_nan(e, self.names)

    def _hold(self, place: int, names: list[str]) -> None:
        self.place_names[place] = names
        self.place_values[place] = make(self.shapes[place], iter(names))

    def _taking_patterns(self, place: int) -> list[tuple[Step, core.Pat | None]]:
        return [
            (s, term.pattern) for s in self.machine.steps for p, term, _, _ in s.takes if p == place
        ]

    def _control_stems(self, place: int) -> list[str]:
        """The names that all transitions take the data with; else those of the place."""
        shape = self.shapes[place]
        found = [robot_names.of_pattern(p, shape) for _, p in self._taking_patterns(place)]
        if found and found[0] is not None and all(f == found[0] for f in found):
            return found[0]
        return self._place_stems(place)

    def _variable_stems(self, place: int) -> list[str]:
        """As for control places, if the net variable stands for nothing else on the robot's pages."""
        taking = self._taking_patterns(place)
        symbols = {p.symbol for _, p in taking if isinstance(p, core.PVar)}
        if len(symbols) == 1 and all(isinstance(p, core.PVar) for _, p in taking):
            (symbol,) = symbols
            users = {
                s.transition.index for s in self.machine.steps if symbol in s.transition.variables
            }
            if users == {s.transition.index for s, _ in taking}:
                return self._control_stems(place)
        return self._place_stems(place)

    def _place_stems(self, place: int) -> list[str]:
        stem = small_identifier(self.partition.net.places[place].short)
        return robot_names.of_stem(stem, self.shapes[place])

    def _initial(self, place: int) -> bool:
        flat = self.partition.net.places[place]
        assert flat.initial is not None
        ((_, values),) = initial_tokens(*flat.initial, self.partition.net.program)
        assert values is not None
        token, _ = unstamped(values[0])
        try:
            if self.place_names[place]:
                value = self.pure.evaluate(token, {})
                found = flatten(value, self.shapes[place], token.span)
                for name, scalar in zip(self.place_names[place], found, strict=True):
                    self.names.initialise(name, scalar.exp)
        except UnsupportedError as problem:
            self.report(problem, f"initial marking of place `{flat.short}`", flat.origins[0])
            return False
        return True

    def report(self, problem: UnsupportedError, where: str, origin: Origin) -> None:
        """Something that scripts cannot do, and where it came up."""
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
            hint=problem.hint,
        )

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
                element = Element(flat.name, "channel", flat.origins[0], f"message {titled(flat)}")
                names = self.names.shared(stems, shape, element, avoid)
                avoid |= set(names)
                self.message_names[p] = names
                found[p] = make(shape, iter(names))
        return found


def _has_unit(colset: Colset) -> bool:
    scalars = message_scalars(colset) or ()
    kinds = [x.kind for s in scalars for x in (s, *s.elements)]
    return len(kinds) > 1 and ScalarKind.UNIT in kinds


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
