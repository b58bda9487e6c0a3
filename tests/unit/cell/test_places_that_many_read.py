"""A place that several owners read is refused with what the net says, and with what to draw instead."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers import small_cell
from pn2code.cell.divide import divide
from pn2code.cell.load import load
from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.diagnostic import Diagnostic
from pn2code.net import front

NET = """
net cell
  standard
  var k, n: INT;
  page Top
    place value : INTINITIAL
    subst Supervisor = Sup (value -> value)
    subst One = Reader (value -> value)
    subst Two = Reader (value -> value)
  page Sup
    place value port io : INT
    place Ready = 1
    trans Set
      both Ready : ()
SETTER
  page Reader
    place value port io : INT
    place Idle = 1
    trans Look
      both Idle : ()
READER
"""
TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
[devices.one]
instance = "One"
[devices.two]
instance = "Two"
[[channel]]
place = "value"
file = "value.txt"
"""
REPLACES = "      in value : n\n      out value : n + 1"
EACH = "give each reader a channel of its own"


def refused(folder: Path, setter: str, reader: str, net: str = NET) -> Diagnostic:
    text = net.replace("SETTER", setter).replace("READER", reader)
    text = text.replace("INITIAL", " = 1`0")
    small_cell.write(folder, text, TOML)
    d = Diagnostics()
    config, flat = load(folder / "cell.toml", d), front.load(folder / "cell.cpn", d)
    assert config is not None and flat is not None, [str(i) for i in d]
    assert divide(flat, config, d) is None
    return next(e for e in d.errors if e.code == "channel-direction")


@pytest.mark.parametrize(
    "reader", ["      both value : k", "      in value : k\n      out value : k"]
)
def test_a_value_that_stays(reader: str, tmp_path: Path) -> None:
    found = refused(tmp_path, REPLACES, reader)
    said = "channel `Top.value` is set by `supervisor` and looked at by `one`, `two`: a value that"
    assert found.message.startswith(said)
    assert found.hint.startswith('write `kind = "register"` into its table')


def test_a_value_that_a_device_sets(tmp_path: Path) -> None:
    text = NET.replace("subst Two = Reader", "subst Two = Sup")
    found = refused(
        tmp_path, "      both value : n", "      in value : k\n      out value : k + 1", text
    )
    assert "is set by `one` and looked at by `supervisor`, `two`" in found.message
    assert EACH in found.hint and "What the supervisor sets can be a register" in found.hint


def test_a_token_for_one_of_several(tmp_path: Path) -> None:
    found = refused(tmp_path, "      out value : 3", "      in value : k")
    assert (
        found.message == "channel `Top.value` is written by `supervisor` and read by `one`, `two`"
    )
    assert "for one of its readers, whoever takes it first" in found.hint and EACH in found.hint


def test_what_two_set_is_neither(tmp_path: Path) -> None:
    found = refused(tmp_path, REPLACES, "      in value : k\n      out value : k + 1")
    assert "is written by `supervisor`, `one`, `two`" in found.message
    assert found.hint.startswith("exactly one owner must have output arcs to it")
