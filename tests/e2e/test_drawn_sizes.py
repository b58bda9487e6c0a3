"""Sizes of places in a program whose net draws random numbers: the state space is one of many, and proves no bound."""

from __future__ import annotations

from pathlib import Path

import pytest

from e2e.test_conform_references import CELL, NET
from helpers.netbuilder import write
from helpers.processes import pn2code

pytestmark = pytest.mark.cc


def test_what_was_drawn_is_no_bound(tmp_path: Path) -> None:
    text = NET.replace(" code output (n); action (count := !count + 1; !count)", "")
    text = text.replace(" guard [!count < 3]", "").replace("out order : n", "out order : 1")
    text = text.replace(
        "trans End guard [!count >= 3]\n      in Ready : ()", "trans End\n      in Ended : ()"
    )
    text = text.replace("out Ready : ()", "out Ended : ()\n      out Log : (discrete (1, 6))`1")
    text = text.replace(
        "    place Wait\n", "    place Wait\n    place Ended\n    place Log : INT\n"
    )
    write(text, tmp_path / "cell.cpn")
    (tmp_path / "cell.toml").write_text(CELL)
    done = pn2code("generate", tmp_path, "-o", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    head = (tmp_path / "out" / "net.c").read_text().split("*/", 1)[0]
    said = head.split("with the random numbers and files that there were", 1)[1]
    assert "Top.Supervisor.Log: room for" in said
    assert "as it runs" not in head
