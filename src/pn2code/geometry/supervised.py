"""What `generate` would say of the supervisor of a cell that is changed, as with a place that is proposed.

refused = Supervised(partition, config)
refused(changed)            # "" if it passes all checks that the cell passes as it is; else what is wrong
"""

from __future__ import annotations

from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.verify.codes import CONTROL_OPEN
from pn2code.verify.controller.proofs import prove

UNKNOWN = "whether `generate` takes its supervisor then is not known"


class Supervised:
    """Of a cell as it is: what is wrong with it already is no news."""

    def __init__(self, partition: Partition, config: CellConfig) -> None:
        self._partition, self._config = partition, config
        self._known: frozenset[str] | None = None

    def __call__(self, changed: Partition) -> str:
        """What is wrong with a changed cell, and was not so before; "": nothing."""
        wrong, is_known = self._said(changed)
        if wrong and self._known is None:
            self._known = frozenset(self._said(self._partition)[0])
        new = [says for check, says in wrong.items() if check not in (self._known or ())]
        if new:
            return new[0]
        return "" if is_known else UNKNOWN

    def _said(self, partition: Partition) -> tuple[dict[str, str], bool]:
        """The errors, by what they are about, and whether all is known."""
        d = Diagnostics()
        prove(partition, self._config, d)
        is_known = all(x.code != CONTROL_OPEN for x in d.items)
        return {x.message.partition(":")[0]: x.message for x in d.errors}, is_known
