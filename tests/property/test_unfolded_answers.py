"""What the unfolded net tells of random nets, and what the judge says of all of their markings."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from random import Random

from helpers import netbuilder
from helpers.unfoldable_nets import properties_of, unfoldable_net
from helpers.unfolded_compared import differences
from pn2code.diagnostics import Diagnostics
from pn2code.properties.judge import TooManyNodesError
from pn2code.semantics.game.errors import GameError
from pn2code.verdict.asked import gather
from pn2code.verdict.opened import read
from pn2code.verdict.unfolded.askable import why_not

SEEDS = range(1000, 1012)


def test_random_nets(tmp_path: Path) -> None:
    seen: Counter[str] = Counter()
    for seed in SEEDS:
        r = Random(seed)
        opened = read(netbuilder.write(unfoldable_net(r), tmp_path / "net.cpn"), {}, Diagnostics())
        assert opened is not None
        asked = gather(opened, properties_of(r, opened.flat, 6), None, Diagnostics(), found=False)
        if why_not(opened.flat):
            continue
        try:
            wrong = list(
                differences(opened, asked, tmp_path, seen, most=600, seconds=600.0, whole=True)
            )
        except (TooManyNodesError, GameError):
            continue
        assert not wrong, (seed, wrong)
    assert seen["nets"] >= 6
    assert seen["yes"] >= 10 and seen["no"] >= 10 and seen["runs"] >= 5, seen
    assert seen["certificates"] >= 1, seen
    assert seen["inconclusive"] < seen["yes"] + seen["no"], seen
