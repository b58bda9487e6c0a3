"""Which parts the collision library has in the cell: exactly those that a question is about.

shown = Shown(backend)
shown.show([part, held])
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.robot.bullet import BulletBackend
from pn2code.robot.part import Part


class Shown:
    """Keeps what is shown; all who ask one backend share it."""

    def __init__(self, backend: BulletBackend) -> None:
        self.backend = backend
        self._shown: dict[str, Part] = {}

    def show(self, parts: Iterable[Part]) -> None:
        """Exactly these parts are in the cell."""
        shown = list(parts)
        wanted = {p.name: p for p in shown}
        assert len(wanted) == len(shown), "each part has a name of its own"
        for name in [n for n in self._shown if n not in wanted]:
            del self._shown[name]
            self.backend.hide_part(name)
        for name, part in wanted.items():
            if self._shown.get(name) is not part:
                self.backend.set_part(part)
                self._shown[name] = part
