"""A net written in another way behaves as before. `./dev rewritten` does so with all nets that are at hand."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest
from lxml import etree
from tools.rewritten.observed import Observed, observed
from tools.rewritten.rewrites import REWRITES

from helpers.netbuilder import write

NETS = {
    "hierarchical": """
    net Line
      standard
      colset PART = with screw | nut;
      var p: PART;
      var n: INT;
      page Top
        place In : PART = 2`screw ++ 1`nut
        place Between : PART
        place Out : PART
        place Count fusion Made : INT = 1`0
        subst First = Station (From -> In, To -> Between)
        subst Second = Station (From -> Between, To -> Out)
      page Station
        place From port in : PART
        place To port out : PART
        place Free = 1
        place Busy : PART
        place Made fusion Made : INT = 1`0
        trans Begin
          in From : p
          in Free
          out Busy : p
        trans End guard [n < 9]
          in Busy : p
          out To : if p = nut then 1`screw else 1`p
          out Free
          both Made : n
    """,
    "timed": """
    net Clock
      standard
      colset JOB = int timed;
      var j: JOB;
      place Waiting : JOB = 1`1 ++ 1`2 ++ 1`3
      place Machine : JOB = 1`0
      place Over : JOB
      var m: INT;
      trans Work guard [j <> 2]
        in Waiting : j
        both Machine : m
        out Over : 1`j @+ (j * 5)
      trans Turn priority 9000
        in Waiting : 2
        out Waiting : 1`4 @+ 1
    """,
    "priorities": """
    net Order
      standard
      var n, k: INT;
      place A : INT = 1`1 ++ 1`2 ++ 1`3
      place B : INT
      place Lock
      trans First priority 5 guard [n > 1]
        in A : n
        out B : n
        inhibit Lock
      trans Second
        in A : n
        both B : k
        out Lock
    """,
}


@pytest.mark.parametrize("rewrite", REWRITES)
@pytest.mark.parametrize("net", NETS)
def test_it_behaves_as_before(net: str, rewrite: str, tmp_path: Path) -> None:
    path = tmp_path / "net.cpn"
    write(NETS[net], path)
    before = observed(path, 2000)
    tree = etree.parse(path)
    for seed in range(3):
        REWRITES[rewrite](tree.getroot(), Random(seed))
    tree.write(path, encoding="iso-8859-1", xml_declaration=True)
    assert isinstance(before, Observed)
    assert before.is_whole
    assert observed(path, 2000) == before


def test_another_net_is_seen(tmp_path: Path) -> None:
    path = tmp_path / "net.cpn"
    write(NETS["hierarchical"], path)
    before = observed(path, 2000)
    write(NETS["hierarchical"].replace("[n < 9]", "[n > 0]"), path)
    assert observed(path, 2000) != before
