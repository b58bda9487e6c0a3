"""Place/transition nets straight from PNML: as the front end reads them, or left to it."""

from __future__ import annotations

import re
import tarfile
from pathlib import Path

import pytest

from helpers.pnml_nets import load
from pn2code.cli.contest import _tables
from pn2code.contest.ptnet import tables_of
from pn2code.diagnostics import Diagnostics

NET = """<?xml version="1.0"?>
<pnml xmlns="http://www.pnml.org/version-2009/grammar/pnml">
 <net id="n" type="http://www.pnml.org/version-2009/grammar/ptnet">
  <name><text>a net</text></name>
  <page id="one">
   <arc id="early" source="p" target="t"><inscription><text> 2 </text></inscription></arc>
   <place id="p"><name><text>7</text></name><graphics><position x="1" y="2"/></graphics>
    <initialMarking><graphics/><text>3</text></initialMarking></place>
   <place id=" q "/>
   <transition id="t"><name><text>t</text></name></transition><place id="r"/>
   <transition id="alone"/>
   <arc id="a" source="t" target="q"/>
   <arc id="b" source="t" target="q"><name><text>9</text></name></arc>
   <arc id="c" source="t" target="r"/>
   <toolspecific tool="x" version="1"><place id="p"><initialMarking><text>5</text></initialMarking></place>
   </toolspecific>
  </page>
 </net>
</pnml>
"""


def test_as_the_front_end_reads_it(tmp_path: Path) -> None:
    path = tmp_path / "model.pnml"
    path.write_text(NET, encoding="utf-8")
    tables = tables_of(path)
    assert tables == _tables(load(path), Diagnostics())
    assert tables is not None and tables.initial == (3, 0, 0)
    assert (tables.pre, tables.post) == (({0: 2}, {}), ({1: 2, 2: 1}, {}))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("</page>", '</page><page id="two"/>'),
        ("</page>", '<page id="two"/></page>'),
        (
            "</page>",
            '</page><page id="two"><place id="s"><initialMarking><text>1</text></initialMarking></place>'
            '<transition id="u"/><arc id="d" source="s" target="u"/></page>',
        ),
        ("</page>", '</page><page id="two"><arc id="d" source="r" target="alone"/></page>'),
        ('<place id="r"/>', '<referencePlace id="r" ref="q"/>'),
        (
            '<place id="r"/>',
            '<referencePlace id="r" ref="s"><name><text>s</text></name><graphics/></referencePlace>'
            '<page id="two"><referencePlace id="s" ref="v"/></page><page id="three"><place id="v"/>'
            '<referenceTransition id="u" ref="t"/><arc id="d" source="u" target="v"/></page>',
        ),
        ('target="q"/>', 'target="q"><type value="normal"/></arc>'),
        ('target="r"', 'target="r" type="normal"'),
        ("<?xml", "<?xml"),
    ],
)
@pytest.mark.parametrize("prefix", ["", "x:"])
def test_pages_and_references_as_the_front_end_reads_them(
    tmp_path: Path, old: str, new: str, prefix: str
) -> None:
    assert old in NET
    path = tmp_path / "model.pnml"
    text = NET.replace(old, new)
    if prefix:
        text = re.sub(r"<(/?)(?=\w)", rf"<\1{prefix}", text).replace("xmlns=", "xmlns:x=")
    path.write_text(text, encoding="utf-8")
    tables = tables_of(path)
    assert tables is not None
    assert tables == _tables(load(path), Diagnostics())


def test_large_numbers(tmp_path: Path) -> None:
    """Tables have no limit of their own."""
    path = tmp_path / "model.pnml"
    path.write_text(NET.replace("<text>3</text>", "<text>10000000000</text>"), encoding="utf-8")
    tables = tables_of(path)
    assert tables is not None and tables.initial[0] == 10_000_000_000 and not tables.fits()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("grammar/ptnet", "grammar/symmetricnet"),
        ("<pnml ", '<!DOCTYPE pnml [<!ENTITY e "1">]><pnml '),
        ("</net>", '</net><net id="m" type="http://www.pnml.org/version-2009/grammar/ptnet"/>'),
        ("</pnml>", ""),
        ('<place id="r"/>', '<place id="p"/>'),
        ('<place id="r"/>', '<place id="t"/>'),
        ('<place id="r"/>', '<place id="a"/>'),
        ('<arc id="c"', '<arc id="a"'),
        ('<arc id="c"', '<arc id="p"'),
        ('<place id="r"/>', "<place/>"),
        ('<place id="r"/>', '<referencePlace id="r" ref="r"/>'),
        ('<place id="r"/>', '<referencePlace id="r" ref="t"/>'),
        ('<place id="r"/>', '<referencePlace id="r" ref="nowhere"/>'),
        ('<place id="r"/>', '<referencePlace id="r"/>'),
        ('<place id="r"/>', '<referencePlace id="p" ref="q"/>'),
        ('<place id="r"/>', '<referencePlace id="r" ref="s"/><referencePlace id="s" ref="r"/>'),
        ('<place id="r"/>', '<referenceTransition id="r" ref="t"/>'),
        ('target="r"', 'target="nowhere"'),
        ('target="r"', 'target="alone"'),
        ('target="r"', 'target="r" type="inhibitor"'),
        ('target="q"/>', 'target="q"><type value="reset"/></arc>'),
        ('target="q"/>', 'target="q"><type><text>inhibitor</text></type></arc>'),
        ("</page>", '<page id="x">' * 50 + "</page>" * 51),
        ("<text> 2 </text>", "<text>0</text>"),
        ("<text> 2 </text>", "<text>Default,2</text>"),
        ("<text> 2 </text>", "2"),
        ("<text> 2 </text>", "<text>2</text><text>3</text>"),
        ("<text>3</text>", "<text>1234567890123456789</text>"),
        ("<text>3</text>", "3"),
    ],
)
def test_what_is_unusual_is_left_to_the_front_end(tmp_path: Path, old: str, new: str) -> None:
    assert old in NET
    path = tmp_path / "model.pnml"
    path.write_text(NET.replace(old, new), encoding="utf-8")
    assert tables_of(path) is None


def test_the_nets_of_the_contest(shared: Path, tmp_path: Path) -> None:
    """Inputs of different tools, some with units and positions."""
    folder = shared / "mcc" / "contest" / "inputs"
    if not folder.is_dir():
        pytest.skip(f"no inputs of the Model Checking Contest at {folder}")
    for name in ("Philosophers-PT-000005", "ShieldRVs-PT-001A", "HypertorusGrid-PT-d2k1p8b00"):
        path = tmp_path / f"{name}.pnml"
        with tarfile.open(folder / f"{name}.tgz") as archive:
            file = archive.extractfile(f"{name}/model.pnml")
            assert file is not None
            path.write_bytes(file.read())
        tables = tables_of(path)
        assert tables is not None and tables == _tables(load(path), Diagnostics())
