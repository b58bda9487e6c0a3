"""Edits of cell_config.c that no state shows: its memory, and what is linked, have to be as they are generated."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from pn2code.conform.folder import compare
from pn2code.diagnostics import Diagnostics
from pn2code.emission.output import OutputFile

NAME = "cell_config.c"
EDITS = {
    "fewer counters": (r"s_fired_of\[\d+U\]", "s_fired_of[1U]"),
    "narrower counters": (r"uint64_t s_fired_of", "uint32_t s_fired_of"),
    "counters of whatever type": (r"uint64_t s_fired_of", "s_fired_of"),
    "wider numbers of places": (r"uint32_t s_final", "uint64_t s_final"),
    "units of memory": (r"max_align_t s_arena", "char s_arena"),
    "fewer counters said later": (
        r"\n    \.needs = ",
        "\n    .room.transition_count = 9U,\n    .needs = ",
    ),
    "less memory for lists": (r"s_arena\[\d+U /", "s_arena[64U /"),
    "a larger claim": (r"sizeof s_arena", "2U * sizeof s_arena"),
    "no marking": (r"net_marking_t marking;", "char marking;"),
    "the size of the marking": (r"sizeof s_marking", "1U"),
    "more transitions": (r"\.transition_count = ", ".transition_count = 1"),
    "nothing is cleaned up": (r"\.collect = \w+", ".collect = NULL"),
    "timers do not wake": (r"\.next_time = \w+", ".next_time = NULL"),
    "another word": (r"\nstatic", "\n#define sizeof 3 *\nstatic"),
}


@pytest.fixture(scope="module")
def config(root: Path) -> str:
    """A cell_config.c of a net with timers and lists."""
    text = (root / "generated/riveting" / NAME).read_text(encoding="utf-8")
    text = re.sub(r"\.next_time = \w+", ".next_time = pn_next_time", text)
    return re.sub(r"\.collect = \w+", ".collect = pn_marking_collect", text)


def judged(folder: Path, fresh: str, edited: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    (folder / NAME).write_text(edited, encoding="utf-8")
    found = compare(folder, [OutputFile(NAME, fresh)], Diagnostics())
    assert found is not None
    return found[0].edited, found[0].differing


@pytest.mark.parametrize("name", EDITS)
def test_what_no_state_shows_is_a_difference(name: str, config: str, tmp_path: Path) -> None:
    pattern, new = EDITS[name]
    edited = re.sub(pattern, new, config, count=1)
    assert edited != config, name
    assert judged(tmp_path, config, edited) == ((), (NAME,))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (".reply_timeout_s = 1", ".reply_timeout_s = 2"),
        ("static uint64_t s_fired_of", "/* s_arena[1U]; */\nstatic  uint64_t\n  s_fired_of"),
        (".room = {", ".room =\n    {"),
        ('.side = "supervisor"', '.side = "a /* b, .room = { } "'),
    ],
)
def test_the_rest_is_compared_by_what_it_does(
    old: str, new: str, config: str, tmp_path: Path
) -> None:
    assert old in config
    assert judged(tmp_path, config, config.replace(old, new, 1)) == ((NAME,), ())
