"""A script that waits for one of several messages, in the cell with its medium: what was there before it, it finds."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.cell_texts import head
from helpers.netbuilder import cpn
from pn2code.cell.divide import divide
from pn2code.cell.partition import Partition
from pn2code.channel_model.check import Answer, Run, whole
from pn2code.channel_model.rules import Rules
from pn2code.cli.nets import open_net
from pn2code.diagnostics import Diagnostics
from pn2code.verify.exploring.limits import Limits

HEAD = """net cell
  standard
  page Top
    place first : UNIT
    place go : UNIT
    place again : UNIT
    place last : UNIT
    place on : UNIT
    place up : UNIT
    place end : UNIT
    subst Supervisor = Sup (first -> first, go -> go, again -> again, last -> last, on -> on, up -> up, end -> end)
    subst Device = Dev (first -> first, go -> go, again -> again, last -> last, on -> on, up -> up, end -> end)
  page Sup
    place first port out : UNIT
    place go port out : UNIT
    place again port out : UNIT
    place last port out : UNIT
    place on port in : UNIT
    place up port in : UNIT
    place end port in : UNIT
    place S0 = 1
    place S1
    place S2
    place S3
    place Finished
    trans Begin
      in S0 : ()
      out S1 : ()
      out go : ()
%s
    trans More
      in S1 : ()
      in on : ()
      out S2 : ()
      out again : ()
    trans Last
      in S2 : ()
      in up : ()
      out S3 : ()
      out last : ()
%s
    trans End
      in S3 : ()
      in end : ()
      out Finished : ()
  page Dev
    place first port in : UNIT
    place go port in : UNIT
    place again port in : UNIT
    place last port in : UNIT
    place on port out : UNIT
    place up port out : UNIT
    place end port out : UNIT
    place W0 = 1
    place W1
    place W2
    place W3
    place Lost
    trans Go
      in W0 : ()
      in go : ()
      out W1 : ()
      out on : ()
    trans Again
      in W1 : ()
      in again : ()
      out W2 : ()
      out up : ()
    trans First
      in W2 : ()
      in first : ()
      out W3 : ()
    trans Overtaken
      in W2 : ()
      in last : ()
      out Lost : ()
    trans Then
      in W3 : ()
      in last : ()
      out W0 : ()
      out end : ()
"""
CELL = head(order="documented") + '[devices.Device]\ninstance = "Device"\n'
CHANNELS = ("first", "go", "again", "last", "on", "up", "end")
FIRST = "      out first : ()"


RACE = """net cell
  standard
  page Top
    place a : UNIT
    place c : UNIT
    place f : UNIT
    place end : UNIT
    subst Supervisor = Sup (a -> a, c -> c, f -> f, end -> end)
    subst Device = Dev (a -> a, c -> c, f -> f, end -> end)
  page Sup
    place a port out : UNIT
    place c port out : UNIT
    place f port out : UNIT
    place end port in : UNIT
    place S0 = 1
    place S1
    place Finished
    trans Begin
      in S0 : ()
      out S1 : ()
      out a : ()
      out c : ()
      out f : ()
    trans End
      in S1 : ()
      in end : ()
      out Finished : ()
  page Dev
    place a port in : UNIT
    place c port in : UNIT
    place f port in : UNIT
    place end port out : UNIT
    place W = 1
    place X
    place Y
    place Z
    place Lost
    trans One
      in W : ()
%s
      out X : ()
    trans Two
      in W : ()
%s
      out Lost : ()
    trans AfterOne
      in X : ()
%s
      out Z : ()
      out end : ()
"""
THIRD = """    trans Three
      in W : ()
      in c : ()
      out Y : ()
    trans AfterThree
      in Y : ()
      in a : ()
      in f : ()
      out Z : ()
      out end : ()
"""


def race(one: tuple[str, ...], two: tuple[str, ...], more: str) -> str:
    """A device that waits for the messages of `One` or of `Two`, or more; after `Two` it is lost."""
    others = tuple(m for m in ("a", "c", "f") if m not in one)
    needs = ("\n".join(f"      in {m} : ()" for m in x) for x in (one, two, others))
    return RACE % tuple(needs) + more


def asked(folder: Path, begin: str, last: str, order: tuple[str, ...]) -> Answer:
    """The cell with its medium."""
    return look(folder, HEAD % (begin, last), [(c, "flag") for c in order])


def look(folder: Path, net: str, channels: list[tuple[str, str]]) -> Answer:
    """The same of any net and its channels, each with its kind."""
    (folder / "cell.cpn").write_bytes(cpn(net))
    files = (f'[[channel]]\nplace = "{c}"\nfile = "{c}.txt"\nkind = "{k}"\n' for c, k in channels)
    (folder / "cell.toml").write_text(CELL + "".join(files))
    opened, d = open_net(folder, {}), Diagnostics()
    partition = divide(opened.flat, opened.config, d)
    assert isinstance(partition, Partition), [str(x) for x in d]
    found = whole(partition, {}, Run(Limits(threads=1), d), Rules())
    assert not d.has_errors
    return found


@pytest.mark.cc
@pytest.mark.parametrize("order", [CHANNELS, CHANNELS[::-1]])
def test_what_was_there_before_the_wait_is_found(tmp_path: Path, order: tuple[str, ...]) -> None:
    """`first` is written a cycle before the device is told to go on, and so before it waits for one of two messages."""
    assert asked(tmp_path, FIRST, "", order).answer == "yes"


@pytest.mark.cc
def test_what_comes_during_the_wait_may_be_missed(tmp_path: Path) -> None:
    """The message that comes first in the script may be written after the other one has been seen."""
    assert asked(tmp_path, "", FIRST, CHANNELS[::-1]).answer == "no"


@pytest.mark.cc
@pytest.mark.parametrize(
    ("one", "two"),
    [(("a",), ("f",)), (("f",), ("f", "a")), (("f", "a"), ("f",))],
    ids=["other", "more", "fewer"],
)
def test_what_comes_between_two_looks_may_overtake(
    tmp_path: Path, one: tuple[str, ...], two: tuple[str, ...]
) -> None:
    """`c`, then `a`, then `f` are written.

    The script has found `c` and asks for `one`, which is not there; then `a` and `f` come, and it finds `two`.
    """
    channels = [("c", "data"), ("a", "data"), ("f", "flag"), ("end", "flag")]
    assert look(tmp_path, race(one, two, THIRD), channels).answer == "inconclusive"


@pytest.mark.cc
def test_of_two_messages_the_first_one_is_taken(tmp_path: Path) -> None:
    """Without a third message, whatever ends the wait, the script asks for `a` again, and that came before `f`."""
    channels = [("c", "data"), ("a", "data"), ("f", "flag"), ("end", "flag")]
    net = race(("a",), ("f",), "").replace("    place Y\n", "")
    assert look(tmp_path, net, channels).answer == "yes"
