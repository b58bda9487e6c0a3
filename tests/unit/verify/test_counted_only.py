"""An explorer that had to be ended has said how many markings it had seen: that is told, and nothing more."""

from __future__ import annotations

import re
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from helpers.netbuilder import flat
from pn2code.cli.verify_sizes import dead_markings
from pn2code.verify.exploring.explore import LATE_PART
from pn2code.verify.exploring.explorer_process import _counted_only
from pn2code.verify.exploring.result import Exploration
from pn2code.verify.exploring.result_rows import row
from pn2code.verify.report.text import report
from pn2code.verify.report.webpage import webpage

NET = flat("net N place P : UNIT = 1`() trans T in P : ()")
LAST = {"states": 33_000_000, "arcs": 99_000_000, "depth": 7, "seconds": 52.0, "phase": "explore"}
FOUND = Exploration.of(NET, _counted_only(NET, LAST), 0.0)


def test_what_was_counted_is_told() -> None:
    assert (FOUND.nodes, FOUND.arcs, FOUND.depth, FOUND.why) == (
        33_000_000,
        99_000_000,
        7,
        "seconds",
    )
    assert not FOUND.complete and not FOUND.seen.markings
    assert Exploration.of(NET, _counted_only(NET, {}), 0.0).nodes == 0


def test_nothing_is_said_of_what_was_seen() -> None:
    """Neither that no dead marking was seen, nor that a transition was not."""
    said = row(NET, FOUND)
    assert (said["dead_markings"], said["dead_transitions"], said["bounds"]) == (None, None, [])
    assert dead_markings(FOUND) == "not known"
    text = report(NET, FOUND, None)
    assert "Nodes:  33000000" in text and "Not known" in text
    assert "None was seen" not in text and "not seen to occur\n" not in text


def test_a_page_of_a_part_does_not_say_that_there_is_no_dead_marking() -> None:
    for found, dead in ((FOUND, "not known"), (replace(FOUND, told=True), "none was seen")):
        page = webpage(NET, found, {}, datetime(2020, 1, 1, tzinfo=UTC))
        assert f"Dead markings</th><td>{dead}</td>" in page


def test_the_explorer_speaks_before_it_is_ended() -> None:
    """What it says when it is late must come before the deadline after which it is ended."""
    source = Path(__file__).parents[3] / "cnative/src/explore/explore.c"
    part = re.search(r"#define LAST_PART (\S+)", source.read_text(encoding="ascii"))
    assert part is not None
    assert LATE_PART * float(part[1]) < 1.0
