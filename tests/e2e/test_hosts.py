"""All hosts on a few random nets with references; `make hosts` takes two thousand."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from helpers.explored import Explorers
from helpers.hosts import HOSTS, Hosts
from helpers.thorough import amount

pytestmark = pytest.mark.cc


def test_all_hosts(sanitized: Explorers, tmp_path: Path) -> None:
    own = Path(shutil.copytree(sanitized.host, tmp_path / "host"))
    hosts = Hosts.beside(replace(sanitized, folder=tmp_path, host=own))
    for number in range(100, amount(101, 180)):
        assert hosts.compare(number, 12).nets >= 6
    assert all(hosts.steps[name] >= 20 for name in HOSTS), hosts.steps
