"""All hosts on a few random nets with references; `make hosts` takes two thousand."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from helpers.explored import Explorers
from helpers.hosts import HOSTS, Hosts
from helpers.thorough import THOROUGH, amount

pytestmark = pytest.mark.cc


def test_all_hosts(request: pytest.FixtureRequest, tmp_path: Path) -> None:
    """With sanitizers in `make thorough` (`test_compiled_core` has others for some hosts in each run)."""
    made: Explorers = request.getfixturevalue("sanitized" if THOROUGH else "explorers")
    own = Path(shutil.copytree(made.host, tmp_path / "host"))
    hosts = Hosts.beside(replace(made, folder=tmp_path, host=own))
    for number in range(100, amount(101, 180)):
        assert hosts.compare(number, 12).nets >= 6
    assert all(hosts.steps[name] >= 20 for name in HOSTS), hosts.steps
