"""Warnings that somebody has looked at and accepts, with the reason: `[[accept]]` of cell.toml.

    rule = Rule("robot-choice", ("Robot1'Put", "Robot1'Take"), "Put is more urgent", origin)
    rule.accepts(item)      # a warning with this code, about exactly these elements

Elements are named as the message names them: `PAGE'NAME`, or the name alone; a key of cell.toml with those around it,
`sensors.door.sees`. What says how a verification has come out is no such warning.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from pn2code.base.frozen import frozen
from pn2code.diagnostics.codes import require_code
from pn2code.diagnostics.diagnostic import Diagnostic, Severity
from pn2code.diagnostics.origin import Origin

_NAME = re.compile(r"`([^`]*)`")
_KEY = "key "


@frozen
class Rule:
    """What is accepted.

    Args:
        code: of the warnings.
        elements: what they are about: all of it, in any order.
        reason: why that is well.
        origin: where it stands.
    """

    code: str
    elements: tuple[str, ...]
    reason: str
    origin: Origin

    def accepts(self, item: Diagnostic) -> bool:
        """Whether it is about this warning."""
        is_warning = item.severity is Severity.WARNING and not require_code(item.code).is_answer
        if not is_warning or item.code != self.code:
            return False
        left = list(elements(item))
        if len(left) != len(self.elements):
            return False
        for own in sorted(self.elements, key=lambda own: own not in left):  # whole names first
            found = next((x for x in left if own in (x, x.partition("'")[2])), None)
            if found is None:
                return False
            left.remove(found)
        return True


def elements(item: Diagnostic) -> tuple[str, ...]:
    """What a diagnostic is about, each element once: that of its place, and those of its notes."""
    origins = [item.origin, *(n.origin for n in item.notes if n.origin is not None)]
    return tuple(dict.fromkeys(_called(origins)))


def _called(origins: Iterable[Origin]) -> Iterator[str]:
    for at in origins:
        words = _NAME.findall(at.element) or ([at.element] if at.element else [])
        if words:
            page = f"{at.page}'" if at.page else ""
            yield page + " -> ".join(words)
        elif at.part.startswith(_KEY):
            yield at.part.removeprefix(_KEY).replace("`", "")
