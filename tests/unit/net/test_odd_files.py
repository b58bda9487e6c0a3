"""Files as programs write them: elements that are missing, empty, or as CPN Tools shows them while nothing is written.

Each is a file of CPN Tools with one piece of text changed. The engine's verdict and initial markings were recorded.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.game.report import places
from pn2code.semantics.game.token_game import Game

NET = """
net Base
  standard
  colset PH = index ph with 1..3;
  colset PAIR = product PH * BOOL;
  colset U = union Num : INT + Nil;
  val k = 2;
  var p : PH; var b : BOOL; var n : INT; var u : U;
  page Top
    place A : PH = PH.all ()
    place B : PAIR
    place C fusion F : INT = 2`1
    place D : U = Num 3
    trans Step guard [p <> ph 2]
      in A : p
      out B : (p, b)
    trans Fuse guard [n < 4]
      in C : n
      out C : n + 1
      in D : u
      out D : u
    subst Sub = Below (I -> B, O -> A)
  page Below
    place I port in : PAIR
    place O port out : PH
    place G fusion F : INT = 2`1
    trans Go
      in I : (p, b)
      out O : p
"""
ALL_PH = "1`ph(1)++\n1`ph(2)++\n1`ph(3)"
DECLARED = (
    "<color id='C1'><id>TT</id>%s</color><var id='V1'><type><id>TT</id></type><id>vv</id></var>"
    "<ml id='M1'>val shown = TT.mkstr</ml></globbox>"
)
INSIDE = r"</globbox>"

VARIANTS: dict[str, tuple[str, str, bool]] = {
    "as it is": ("<text>Step</text>", "<text>Step</text>", True),
    "no document type": (r"<!DOCTYPE.*?>", "", True),
    "no XML declaration": (r"<\?xml.*?\?>\s*", "", True),
    "no version": (r' tool="CPN Tools" version="[^"]*"', "", True),
    "no instances": (r"<instances>.*?</instances>", "", True),
    "no ids of texts": (r'<(annot|type) id="[^"]*">', r"<\1>", True),
    "no name of a page": (r'<pageattr name="Top"', "<pageattr", True),
    "no names": (r"<text>(Step|A)</text>", "<text/>", True),
    "directions in small letters": ("PtoT", "ptot", True),
    "both directions otherwise": ('orientation="PtoT"', 'orientation="BothDir"', True),
    "arc of a transition that is missing": ('<transend idref="[^"]*"/>', '<transend idref="X"/>', True),
    "arc to a place that is missing": ('<placeend idref="[^"]*"/>', '<placeend idref="X"/>', False),
    "an empty inscription": (r"(<text[^>]*>)p(</text>)", r"\1\2", False),
    "no subpage": ('subpage="[^"]*"', 'subpage="X"', False),
    "blanks in an assignment": (r'portsock="\(([^,]*),([^)]*)\)', r'portsock="( \1 , \2 )', True),
    "no fusion set": (r"<fusion .*?</fusion>", "", True),
    "blocks in blocks": (
        r"<globbox>(.*?)</globbox>",
        r"<globbox><block id='X'><id>All</id><block id='Y'><id>In</id>\1</block></block></globbox>",
        True,
    ),
    "a character section": (r"(<ml id=[^>]*>)([^<]*)", r"\1<![CDATA[\2]]>", True),
    "a comment in a declaration": ("<globbox>", "<globbox><ml id='M'>val z = 1;<!-- in --></ml>", True),
    "a priority": ("</cond>", "</cond><priority id='P'><text>3</text></priority>", True),
    "no priority": ("</cond>", "</cond><priority id='P'><text/></priority>", True),
    "the editor's delay and code": (
        "</cond>",
        "</cond><time id='T'><text>@+</text></time><code id='K'><text>input ();\noutput ();\naction\n();</text></code>",
        True,
    ),
    "the editor's initial marking": (r"Num 3", " INIT MARK\n", True),
    "not quite the editor's initial marking": (r"Num 3", "INIT  MARK", False),
    "a space that does not break": (r"PH\.all", "PH.all&#160;", False),
    "an integer without bounds": (INSIDE, DECLARED % "<int><with><ml/><ml> </ml></with></int>", True),
    "an integer with one bound": (INSIDE, DECLARED % "<int><with><ml>1</ml></with></int>", False),
    "a string without bounds": (INSIDE, DECLARED % "<string><with><ml/><ml/></with></string>", True),
    "a string without lengths": (
        INSIDE,
        DECLARED % "<string><with><ml>\"a\"</ml><ml>\"z\"</ml><and><ml/><ml/></and></with></string>",
        True,
    ),
    "a real without bounds": (INSIDE, DECLARED % "<real><with><ml/><ml/></with></real>", True),
    "a list without lengths": (INSIDE, DECLARED % "<list><id>INT</id><with><ml/><ml/></with></list>", True),
    "a list with one length": (INSIDE, DECLARED % "<list><id>INT</id><with><ml>1</ml><ml/></with></list>", False),
    "a truth value without names": (INSIDE, DECLARED % "<bool><with><id/><id/></with></bool>", True),
    "a truth value with one name": (INSIDE, DECLARED % "<bool><with><id>no</id><id/></with></bool>", False),
    "a unit without a name": (INSIDE, DECLARED % "<unit><with><id/></with></unit>", True),
    "an enumeration without values": (INSIDE, DECLARED % "<enum/>", False),
    "a product of one": (INSIDE, DECLARED % "<product><id>INT</id></product>", False),
}  # fmt: skip
"""What is changed into what, and whether the engine accepts the net."""
OTHER_MARKINGS = {"the editor's initial marking": {"D": "empty"}}


def changed(pattern: str, replacement: str) -> bytes:
    """The file, with the first piece of text that fits replaced."""
    text, done = re.subn(pattern, replacement, cpn(NET).decode("latin-1"), count=1, flags=re.DOTALL)
    assert done
    return text.encode("latin-1")


@pytest.mark.parametrize("name", VARIANTS)
def test_as_the_engine_reads_it(name: str, tmp_path: Path) -> None:
    pattern, replacement, accepted = VARIANTS[name]
    path = tmp_path / "net.cpn"
    path.write_bytes(changed(pattern, replacement))
    net = front.load(path, d := Diagnostics(), compute=compute)
    assert (net is not None) == accepted, [i.message for i in d.items]
    if net is None:
        assert d.errors
        return
    found = {r["name"]: r["marking"] for r in places(net, Game(net, seed=1).marking)}
    wanted = {"C": "2`1", "D": "1`Num(3)", "G": "2`1"} | OTHER_MARKINGS.get(name, {})
    assert {place: found[place] for place in wanted} == wanted
    assert ALL_PH in found.values()


def test_empty_names_of_truth_values_are_the_usual_ones(tmp_path: Path) -> None:
    path = tmp_path / "net.cpn"
    path.write_bytes(changed(INSIDE, DECLARED % "<bool><with><id/><id/></with></bool>"))
    net = front.load(path, Diagnostics(), compute=compute)
    assert net is not None
    assert dict(net.program.colsets)["TT"].names == ("false", "true")
