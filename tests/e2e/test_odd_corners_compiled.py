"""Odd corners, all in one net, compiled and walked through next to the token game."""

from __future__ import annotations

import re
import textwrap
from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered
from helpers.netbuilder import flat
from helpers.odd_corners import CASES, HEAD

pytestmark = pytest.mark.cc


def together() -> str:
    """A net with a page for each case that neither stops nor needs a net of its own."""
    pages = [
        f"page P{i}\n{textwrap.indent(body.strip(), '  ')}"
        for i, (_, body, _, wanted) in enumerate(CASES)
        if not isinstance(wanted, str) and not re.search(r"^(page|option)", body.strip(), re.M)
    ]
    assert len(pages) > 60
    return HEAD + textwrap.indent("\n".join(pages), "  ")


def test_compiled_nets_agree(fast_workshop: Workshop, tmp_path: Path) -> None:
    net = flat(together())
    ir, d = lowered(net)
    assert ir is not None, [e.message for e in d.errors]
    program = fast_workshop.build(ir, tmp_path / "net")
    assert agrees(net, program, seed=3, steps=150) > 100
