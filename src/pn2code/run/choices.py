"""What a person may let a sensor say: its values as texts, and those with which a program can go on.

choices = choices_of(config, net, {"robot1": program})
choices["robot1", "camera"].texts()            # ("1", "2"); None: too many to be listed
permitted(robot.interpreter, robot.files, (1, 2))     # -> (1, 2)
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from pn2code.base.frozen import frozen
from pn2code.cell.config import CellConfig
from pn2code.cell.scalars import Scalar
from pn2code.channels.scalars import Malformed, format_scalars
from pn2code.net.flat import FlatNet
from pn2code.run.sensors import Value, parsed, usable, values_of
from pn2code.tdl.check import CheckedProgram
from pn2code.tdl.interpret import Interpreter
from pn2code.tdl.requests import Fault, Files
from pn2code.tdl.requests import Scalar as SensedValue

MOST_LISTED = 64
"""Values that are shown one by one."""


@frozen
class Choice:
    """A sensor as a robot or device asks it.

    Args:
        party: who asks.
        sensor: its name; variable: of the net, which it decides.
        scalar: its values.
        says: what it tells, in the words of cell.toml; "": it has none.
    """

    party: str
    sensor: str
    variable: str
    scalar: Scalar
    says: str = ""

    @property
    def allowed(self) -> str:
        """Which values it has, in words, where they are not listed."""
        low, high = self.scalar.low, self.scalar.high
        is_bounded = low is not None and high is not None
        between = f" from {self.text(low)} to {self.text(high)}" if is_bounded else ""
        return f"a value of {self.scalar.colset}{between}"

    def values(self) -> tuple[Value, ...] | None:
        """All values, in the order of the colour set; None: too many, or not bounded."""
        values = values_of(self.scalar, MOST_LISTED)
        return None if values is None else tuple(values)

    def texts(self) -> tuple[str, ...] | None:
        """`values`, as they are written."""
        values = self.values()
        return None if values is None else tuple(map(self.text, values))

    def text(self, value: object) -> str:
        """A value as it is written; truth values as in the net."""
        if isinstance(value, bool):
            return "true" if value else "false"
        if not isinstance(value, int | float | str):
            return ""
        return format_scalars((self.scalar,), (value,)) or str(value)

    def value(self, text: str) -> Value | Malformed:
        """The value of a text, or what is wrong with it."""
        found = parsed((self.scalar,), text)
        return found if isinstance(found, Malformed) else found[0]


def choices_of(
    config: CellConfig, net: FlatNet, programs: Mapping[str, CheckedProgram]
) -> dict[tuple[str, str], Choice]:
    """All sensors that these programs ask, by program and sensor."""
    sensors = {sensor.name: (sensor, scalar) for sensor, scalar in usable(config, net)}
    found: dict[tuple[str, str], Choice] = {}
    for party, program in programs.items():
        for name in program.sensors:
            if name in sensors:
                sensor, scalar = sensors[name]
                found[party, name] = Choice(party, name, sensor.variable, scalar, sensor.tells)
    return found


class _Imagined:
    """Shared files in which nothing is changed: what is taken or written in them is only remembered."""

    def __init__(self, files: Files) -> None:
        self._files = files
        self._taken: set[str] = set()

    def read(self, name: str) -> tuple[SensedValue, ...] | None:
        return None if name in self._taken else self._files.read(name)

    def clear(self, name: str) -> None:
        self._taken.add(name)

    def write(self, name: str, values: tuple[SensedValue, ...]) -> None:
        pass


def permitted(
    asking: Interpreter, files: Files, values: Iterable[SensedValue]
) -> tuple[SensedValue, ...]:
    """Those of the values with which a program goes on until it commands something, waits, or ends.

    Args:
        asking: has asked a sensor, and waits for what it says.
        files: the shared files as they are.
    """
    found = []
    for value in values:
        after = asking.twin(_Imagined(files)).resume(value)
        if not isinstance(after, Fault):
            found.append(value)
    return tuple(found)
