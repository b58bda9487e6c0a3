"""Messages of robots that come out one after the other in the cell as it runs."""

from __future__ import annotations

from pathlib import Path

from helpers.netbuilder import cpn
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.verdict.opened import read
from pn2code.verify.controller.staged_channels import staged

# A tells B and the supervisor in one transition; later it sends the supervisor the same data with their flag.
NET = """net cell
  standard
  var k, j: INT;
  page Top
    place d : INT
    place x : INT
    place g : INT
    subst Supervisor = Sup (d -> d, g -> g)
    subst A = PA (d -> d, x -> x, g -> g)
    subst B = PB (x -> x)
  page Sup
    place d port in : INT
    place g port in : INT
    place Wait = 2
    place Finished
    trans Both
      in Wait : ()
      in d : k
      in g : j
      out Finished : ()
    trans Alone
      in Wait : ()
      in g : j
      out Finished : ()
  page PA
    place d port out : INT
    place x port out : INT
    place g port out : INT
    place W = 1
    place W1
    place W2
    place W3
    trans T1
      in W : ()
      out W1 : ()
      out d : 1
      out x : 1
    trans T2
      in W1 : ()
      out W2 : ()
      out g : 1
    trans T3
      in W2 : ()
      out W3 : ()
      out d : 2
      out g : 2
  page PB
    place x port in : INT
    place V = 1
    place V1
    trans U
      in V : ()
      in x : k
      out V1 : ()
"""
KINDS = {"d": "data", "x": "flag", "g": "flag"}


def names(folder: Path, net: str) -> list[str]:
    """Of the channels whose messages come out one after the other."""
    text = '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]\n'
    for c, kind in KINDS.items():
        text += f'[[channel]]\nplace = "{c}"\nfile = "{c}.txt"\nkind = "{kind}"\n'
    text += '[devices.A]\ninstance = "A"\n[devices.B]\ninstance = "B"\n'
    (folder / "cell.cpn").write_bytes(cpn(net))
    (folder / "cell.toml").write_text(text)
    d = Diagnostics()
    found = read(folder, {}, d)
    assert found is not None and found.config is not None, [i.message for i in d]
    partition = divide(found.flat, found.config, d)
    assert partition is not None, [i.message for i in d]
    return [c.name for c in staged(partition)]


def test_a_flag_does_not_come_out_before_its_data(tmp_path: Path) -> None:
    # Data that come out after x would come out after g of `T3` as well, if g were there at once.
    assert names(tmp_path, NET) == ["d", "x", "g"]


def test_data_and_their_flag_alone_are_there_at_once(tmp_path: Path) -> None:
    assert (
        names(tmp_path, NET.replace("      out d : 1\n      out x : 1\n", "      out x : 1\n"))
        == []
    )
