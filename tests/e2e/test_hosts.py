"""All hosts on a few random nets with references; `make hosts` takes two thousand."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.explored import SANITIZERS
from helpers.hosts import HOSTS, Hosts
from helpers.thorough import amount

pytestmark = pytest.mark.cc


def test_all_hosts(tmp_path: Path) -> None:
    hosts = Hosts.open(tmp_path / "hosts", SANITIZERS)
    for number in range(100, amount(101, 180)):
        assert hosts.compare(number, 12).nets >= 6
    assert all(hosts.steps[name] >= 20 for name in HOSTS), hosts.steps
