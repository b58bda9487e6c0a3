"""When a script asks what: most wait for their messages before they ask anything, also of the program's own data."""

from __future__ import annotations

from pathlib import Path

import pytest

from e2e.test_running_cell import examined, ran, write
from helpers.thorough import amount

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

TOML = """[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "flag"
file = "flag.robcad"
kind = "flag"
[[channel]]
place = "job"
file = "job.robcad"
kind = "data"
[[channel]]
place = "done"
file = "done.robcad"
kind = "flag"
[devices.robot1]
instance = "Robot"
"""


def cell(rounds: int, sends: str, asks: str, count: int = 0) -> str:
    """A supervisor that asks some times and then finishes, and a device that counts.

    Args:
        rounds: how often it asks.
        sends: what it sends then.
        asks: the transitions from `Waiting`.
        count: with which number the device begins.
    """
    return f"""net cell
  standard
  var j, k, n: INT;
  page Top
    place flag : INT
    place job : INT
    place done : INT
    subst Supervisor = Sup (flag -> flag, job -> job, done -> done)
    subst Robot = Rob (flag -> flag, job -> job, done -> done)
  page Sup
    place flag port out : INT
    place job port out : INT
    place done port in : INT
    place Start = 1
    place Armed
    place Left : INT = 1`{rounds}
    place Finished
    trans Ask guard [n > 0]
      in Start : ()
      in Left : n
      out Left : n - 1
      out Armed : ()
{sends}    trans Got
      in Armed : ()
      in done : k
      out Start : ()
    trans Never guard [n < 0]
      in Start : ()
      both Left : n
      out flag : 9
      out job : 9
      out Finished : ()
    trans End guard [n = 0]
      in Start : ()
      in Left : n
      out Finished : ()
  page Rob
    place flag port in : INT
    place job port in : INT
    place done port out : INT
    place Waiting = 1
    place Over
    place Count : INT = 1`{count}
{asks}    trans Answer
      in Over : ()
      out Waiting : ()
      out done : 1
    place Nowhere
    trans Idle
      both Nowhere : ()
      in job : j
"""


def takes(name: str, guard: str, *messages: str) -> str:
    """A transition from `Waiting`."""
    text = f"    trans {name} guard [{guard}]\n      in Waiting : ()\n      in Count : n\n"
    text += "      out Count : n + 1\n      out Over : ()\n"
    return text + "".join(f"      in {m}\n" for m in messages)


FLAG, JOB = "      out flag : 1\n", "      out job : 1\n"
ONE = takes("Accept", "n < 3", "flag : k")
# Both take the same message.
TWO = ONE + takes("Accept2", "n >= 7", "flag : k")
BOTH = takes("Accept", "k > 5", "flag : k", "job : j")
# The flag tells them apart, and the count says whether anything is done.
COMMON = takes("Short", "k = 1 andalso n < 3", "flag : k") + takes(
    "Long", "k = 2 andalso n < 3", "flag : k", "job : j"
)
LATER = takes("Short", "k = 2", "flag : k") + takes("Long", "k = 1, j = 5", "flag : k", "job : j")
# The count tells what is waited for: it is asked at once.
APART = takes("Short", "n = 0", "flag : k") + takes("Long", "n = 1", "flag : k", "job : j")
PEEKING = takes("Short", "n = 0, k = 2", "flag : k") + takes("Long", "n = 1", "job : j")
DEEP = takes("Short", "n = 0", "flag : k") + takes("Long", "n = 1, k = 2", "flag : k", "job : j")
MIXED = DEEP.replace("n = 1, k = 2", "n = 1 andalso k = 2")  # asked with the message
# Whichever comes first.
RACE = takes("Short", "n < 3", "flag : k") + takes("Long", "n < 4", "job : j")


@pytest.mark.parametrize(
    ("net", "ends"),
    [
        (cell(3, FLAG, ONE), True),
        (cell(4, FLAG, ONE), False),
        (cell(3, FLAG, TWO), True),
        (cell(4, FLAG, TWO), False),
        (cell(0, FLAG, ONE, count=5), True),
        (cell(1, FLAG, BOTH), None),
        (cell(1, FLAG + JOB, BOTH), False),
        (cell(3, FLAG, COMMON), True),
        (cell(4, FLAG, COMMON), False),
        (cell(0, FLAG, COMMON, count=3), True),
        (cell(0, FLAG, LATER, count=3), True),
        (cell(1, FLAG, LATER), None),
        (cell(1, FLAG + JOB, LATER), False),
        (cell(0, FLAG, APART, count=5), False),
        (cell(1, FLAG, APART), True),
        (cell(1, FLAG, PEEKING), False),
        (cell(1, FLAG, DEEP, count=1), None),
        (cell(1, FLAG + JOB, DEEP, count=1), False),
        (cell(1, FLAG, MIXED, count=1), False),
        (cell(0, FLAG, RACE, count=5), False),
        (cell(1, FLAG, RACE, count=3), None),
        (cell(3, FLAG, RACE), True),
    ][:: amount(2, 1)],
    ids=[
        "one", "one too many", "two", "two too many", "never asked", "half a message",
        "both messages", "common", "common too many", "common never", "later never",
        "later half", "later", "apart", "apart once", "peeking", "deep half", "deep",
        "mixed", "race", "race waits", "race ends",
    ][:: amount(2, 1)],
)  # fmt: skip
def test_a_script_stops_where_the_check_says(net: str, ends: bool | None, tmp_path: Path) -> None:
    """`ends`: None, if the script waits for ever instead of stopping: that is a deadlock."""
    folder = write(tmp_path / "cell", net, TOML)
    found = examined(folder).checks["non-blocking"]
    stops = "none of its transitions is possible there" in found.says
    assert (found.answer == "yes", stops) == (ends is True, ends is False), found.says
    lines = ran(folder)
    finished = any(x.get("transition") == "Top.Supervisor.End" for x in lines)
    assert (ends is False) == any("nothing can happen" in str(x.get("reason")) for x in lines)
    assert ends is False or finished == (ends is True), lines
