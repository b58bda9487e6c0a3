"""SPIN as a second opinion: the Promela model of a net has as many states and arcs as the net.

SPIN counts one state and two arcs more, for the step in which the model sets up the initial marking.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from helpers.netbuilder import flat as cpn_net
from helpers.pnml_nets import flat, load, philosophers, unfolded_size
from pn2code.convert import promela
from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.net.flat import FlatNet
from pn2code.unfold.unfold import unfold

pytestmark = pytest.mark.cc

TOKENS = """
    net Tokens
      standard
      colset C = with r | g;
      var c: C;
      page Top
        place P : C = 300`r ++ 2`g
        place Q : C
        trans Go
          in P : c
          out Q : c
        trans Clear
          in Q : 3`g
          reset Q
        trans Last
          inhibit P
          in Q : c
"""


@pytest.fixture(scope="module", autouse=True)
def _spin() -> None:
    if shutil.which("spin") is None or shutil.which("gcc") is None:
        pytest.skip("SPIN is not installed (apt-get install spin)")


def spin(net: FlatNet, folder: Path) -> tuple[int, int]:
    """States and arcs that SPIN counts, without its own first step."""
    d = Diagnostics()
    u = unfold(net, d)
    assert u is not None, [e.message for e in d.errors]
    text = promela.emit(u, d, source="net", version="test")
    assert text is not None
    (folder / "net.pml").write_text(text, encoding="utf-8")

    def run(*command: str) -> str:
        done = subprocess.run(
            command, cwd=folder, capture_output=True, text=True, timeout=600, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    run("spin", "-a", "net.pml")
    run("gcc", "-O0", "-w", "-DSAFETY", "-DNOREDUCE", "-o", "pan", "pan.c")
    out = run("./pan", "-m1000000", "-w20")
    assert "errors: 0" in out, out
    states = re.search(r"(\d+) states, stored", out)
    arcs = re.search(r"(\d+) transitions", out)
    assert states is not None and arcs is not None
    return int(states[1]) - 1, int(arcs[1]) - 2


def test_philosophers(tmp_path: Path) -> None:
    net = flat(philosophers(5), tmp_path)
    u = unfold(net, Diagnostics())
    assert u is not None
    assert spin(net, tmp_path) == unfolded_size(u)


def test_many_tokens_inhibitors_and_resets(tmp_path: Path) -> None:
    net = cpn_net(TOKENS)
    u = unfold(net, Diagnostics())
    assert u is not None
    assert spin(net, tmp_path) == unfolded_size(u)


@pytest.mark.parametrize("n", [4])
def test_database(n: int, shared: Path, tmp_path: Path) -> None:
    """The distributed database has a formula: 1 + n * 3^(n-1) markings."""
    path = next(
        iter(sorted(shared.glob("corpus/nets/cpn-io+cpn-js/**/DistributedDataBase.cpn"))), None
    )
    if path is None:
        pytest.skip("the collection lacks the distributed database")
    net = front.load(path, Diagnostics(), {"n": str(n)})
    assert net is not None
    expected = 1 + n * 3 ** (n - 1), 2 * n * (1 + (n - 1) * 3 ** (n - 2))
    assert spin(net, tmp_path) == expected


@pytest.mark.parametrize("name", ["LamportFastMutEx-COL-2"])
def test_contest(name: str, shared: Path, tmp_path: Path) -> None:
    path = shared / "mcc" / f"{name}.pnml"
    if not path.is_file():
        pytest.skip("the nets of the Model Checking Contest are absent")
    rows = (
        r.split("\t")
        for r in (shared / "mcc" / "expected.tsv").read_text(encoding="utf-8").splitlines()
    )
    expected = next((int(r[1]), int(r[2])) for r in rows if r[0] == name)
    assert spin(load(path), tmp_path) == expected
