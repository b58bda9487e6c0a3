"""Components, home markings, liveness and fairness of small random graphs against their definitions."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from helpers.explored import explorer_test
from helpers.thorough import amount

pytestmark = pytest.mark.cc

PARTS = ("scc", "properties", "fairness", "memory")
ADDRESSES = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")
THREADS = ("-fsanitize=thread",)
VARIANTS: dict[str, tuple[int | str, ...]] = {
    "few": (1500, "-DTRANSITIONS=3", "-DNODES=14", *ADDRESSES),
    "many": (500, "-DTRANSITIONS=46", "-DNODES=14", "-DEX_TRIED=1U"),
    "no-sweeps": (
        500,
        "-DTRANSITIONS=40",
        "-DNODES=14",
        "-DEX_LEAST_SWEEPS=1U",
        "-DEX_MOST_SWEEPS=1U",
    ),
    "threads": (
        100,
        "-DTRANSITIONS=3",
        "-DNODES=200",
        "-DEX_SWEEP_BLOCK=64U",
        "-DEX_TRIED=1U",
        *THREADS,
    ),
}
"""Numbers of graphs. Bits of a node take one, two, four and eight bytes; sweeps do nearly all, or are given up soon."""


@pytest.mark.parametrize("variant", VARIANTS)
def test_against_definitions(tmp_path: Path, variant: str) -> None:
    graphs, *flags = VARIANTS[variant]
    graphs = int(graphs) // amount(8, 1)
    program = explorer_test(tmp_path, "explore_graphs", PARTS, *map(str, flags))
    said = subprocess.run(
        [program, "1", str(graphs)], capture_output=True, text=True, check=False, timeout=600
    )
    assert said.stdout + said.stderr == "fine\n"
