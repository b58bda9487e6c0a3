"""Whether a run that has come to its end has failed there, where a token's value tells it (`failed` in `[report]`)."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from itertools import chain
from typing import Any

from pn2code.cell.partition import Partition
from pn2code.properties.failing import Failing
from pn2code.trace.replay import replay_lines


def failed_in(
    failing: Failing,
    partition: Partition,
    header: Mapping[str, Any],
    events: Iterable[Mapping[str, Any]],
) -> list[str]:
    """The conditions that hold at the end of a merged trace, which the token game plays."""
    if not failing:
        return []
    storage = partition.config.storage if partition.config is not None else {}
    lines = (json.dumps(line) for line in chain([{**header, "by": "run"}], events))
    result = replay_lines(lines, partition.net, storage)
    if not result.ok or result.game is None:
        return failing.not_known(result.why)
    return failing.in_(result.game, result.game.marking)
