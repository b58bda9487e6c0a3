"""Shared files of a robot whose messages come late, or never, where somebody wants that.

    files = LateFiles(shared, grace_s)
    files.fates["flag1_externo"] = Fate(5.0)     # of the next message on this channel
    files.deliver(now)                           # again and again: publishes what is due

For the robot such a message is written. Until it arrives, the channel counts as full, as while a reader is slow.
"""

from __future__ import annotations

from collections.abc import Callable

from pn2code.base.frozen import frozen
from pn2code.channels import ScalarValue, SharedDirectory
from pn2code.run.files import RobotFiles
from pn2code.tdl.requests import FileError


@frozen
class Fate:
    """What becomes of a message: it comes so many seconds late; None: never."""

    late: float | None


class LateFiles(RobotFiles):
    """`RobotFiles` with fates.

    Args:
        shared, grace_s: as there.
        now: the time of the run, s.
        heard: is told of the channel and the fate of each message that does not go out at once.

    Attributes:
        fates: of the next message, by channel.
    """

    def __init__(
        self,
        shared: SharedDirectory,
        grace_s: float,
        now: Callable[[], float],
        heard: Callable[[str, Fate], None],
    ) -> None:
        super().__init__(shared, grace_s)
        self.fates: dict[str, Fate] = {}
        self._now, self._heard = now, heard
        self._late: dict[str, tuple[float, tuple[ScalarValue, ...]]] = {}

    def write(self, name: str, values: tuple[ScalarValue, ...]) -> None:
        """Publishes a message, now, later, or never."""
        if name in self._late:
            self._failed(FileError(f"channel-overrun: the message before it on {name} is late"))
        fate = self.fates.pop(name, None)
        if fate is None or not self._guarded(lambda: self.shared.is_taken(name)):
            super().write(name, values)
            return
        if fate.late is not None:
            self._late[name] = (self._now() + fate.late, values)
        self._heard(name, fate)

    def deliver(self, now: float) -> list[str]:
        """Publishes what is due; the channels."""
        due = [name for name, (at, _) in self._late.items() if at <= now]
        for name in due:
            super().write(name, self._late.pop(name)[1])
        return due

    def finished(self) -> None:
        """What is still on its way arrives before this robot says that it is done."""
        self.deliver(float("inf"))
        super().finished()
