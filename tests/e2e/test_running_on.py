"""Programs that go on by themselves, that have ended, and that are late: in what is proved, and in runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from e2e.test_running_cell import ACT, ECHO, ONE, SLOW, TOOL, net, ran, toml, write
from e2e.test_running_ends import blocking, said

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

# B blinks, and waits for nothing.
BLINK = net(
    ONE
    + """    place Mute : INT
    trans Hush
      in Mute : k
      out toB : k
    trans HearB
      in Mute : k
      in fromB : k
""",
    {
        "A": ECHO,
        "B": """    place On = 1
    place Never : INT
    trans Blink code action act ()
      both On : ()
    trans Listen
      in Never : n
      in ask : k
      out say : k
""",
    },
    ACT + "  var n: INT;\n",
)
# B's script ends without an answer, and the supervisor has something to wait for when A has answered.
ENDED = net(
    ONE.replace("      in fromA : k\n      out Finished", "      in fromA : k\n      out Timer")
    .replace("out Timer : ()", "out Timer : ()@+5")
    .replace("out toA : 1", "out toA : 1\n      out toB : 1")
    .replace("    place Armed\n", "    place Armed\n    place Timer : TU\n")
    + """    place Mute : INT
    trans Leave
      in Timer : ()
      out Finished : ()
    trans HearB
      in Mute : k
      in fromB : k
""",
    {
        "A": SLOW,
        "B": """    place Waiting = 1
    place Over
    place Mute : INT
    trans Accept
      in Waiting : ()
      in ask : k
      out Over : ()
    trans Answer
      in Mute : k
      out say : k
""",
    },
    ACT + "  colset TU = unit timed;\n",
)
# The robot is told A, then B, and looks at the file of A first: it never takes B.
TWO = """
    net cell
      standard
      var k: INT;
      page Top
        place fa : INT
        place fb : INT
        place done : INT
        subst Supervisor = Sup (fa -> fa, fb -> fb, done -> done)
        subst A = Rob (fa -> fa, fb -> fb, done -> done)
      page Sup
        place fa port out : INT
        place fb port out : INT
        place done port in : INT
        place Start = 1
        place Armed
        place Finished
        trans Ask
          in Start : ()
          out fa : 1
          out fb : 1
          out Armed : ()
        trans Got
          in Armed : ()
          in done : k
          out Finished : ()
      page Rob
        place fa port in : INT
        place fb port in : INT
        place done port out : INT
        place Waiting = 1
        place PA
        place PB
        place Over
        trans TA
          in Waiting : ()
          in fa : k
          out PA : ()
        trans TB
          in Waiting : ()
          in fb : k
          out PB : ()
        trans RA
          in PA : ()
          out Over : ()
          out done : 1
        trans RB
          in PB : ()
          out Over : ()
          out done : 2
"""
TWO_CELL = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "fa"
file = "fa.robcad"
[[channel]]
place = "fb"
file = "fb.robcad"
kind = "flag"
[[channel]]
place = "done"
file = "done.robcad"
[devices.A]
instance = "A"
"""


def test_a_device_that_blinks_keeps_nobody_from_anything(tmp_path: Path) -> None:
    """Without fairness the others may stand still for ever; with it their programs run."""
    finished = "ltl F tokens(Finished) = 1"
    cell = toml(["A", "B"], TOOL)
    flag = 'file = "toB.robcad"\nkind = "flag"'
    assert flag in cell
    cell = cell.replace(flag, flag.replace("flag", "data"))
    named = ", ".join(f"weak {t}" for t in ("Ask", "End", '"Top.A.Accept"', '"Top.A.Answer"'))
    fair = ("weak all", "strong all", named)
    holds = (finished, *(f"{finished} assuming {x}" for x in fair))
    found = said(write(tmp_path, BLINK, cell), holds=holds)
    answers = [(p["answer"], p["why"]) for p in found["properties"]]
    assert answers == [("no", None), *[("yes", None)] * 3]
    whole = found["medium"][0]
    assert (whole["answer"], whole["why"]) == ("yes", None)
    assert blocking(found)["answer"] == "yes"


def test_what_a_script_may_come_to_is_not_promised(tmp_path: Path) -> None:
    """More is looked at than it does: that is enough for what is never so, and not for what can be."""
    asks = [
        "reachable tokens(PB) >= 1",
        "ctl EF tokens(PB) >= 1",
        "ctl AG (!(tokens(PB) >= 1) || !(tokens(PA) >= 1))",
        "never tokens(PA) >= 1 && tokens(PB) >= 1",
        "ltl F tokens(Finished) = 1",
        "ltl F tokens(Finished) = 1 assuming weak all",
        "never tokens(PB) >= 1",
        "reachable tokens(PA) >= 1",
        "ctl EF tokens(PA) >= 1 && EF tokens(PB) >= 1",
        "ctl AG EF (tokens(PA) >= 1 || tokens(Over) >= 1)",
    ]
    found = said(write(tmp_path, TWO, TWO_CELL), holds=tuple(asks))
    answers = [p["answer"] for p in found["properties"]]
    assert answers[:4] == ["inconclusive", "inconclusive", "yes", "yes"]
    assert answers[5] == "inconclusive"
    assert answers[6:8] == ["inconclusive", "yes"]
    assert answers[8:] == ["inconclusive", "inconclusive"]  # one run does not show all of it
    assert "fewer orders" in found["properties"][5]["why"]
    assert "would have seen another one" in found["properties"][6]["why"]


@pytest.mark.parametrize("name", ["ended", "late"])
def test_lockstep_stops_for_what_stops_the_supervisor(name: str, tmp_path: Path) -> None:
    """A script that has ended and owes an answer, and an answer that is late while nothing else happens (I8)."""
    if name == "ended":
        text = ENDED
        cell, why = toml(["A", "B"], TOOL), "B has finished, but it owes an answer to toB.robcad"
    else:
        text = net(ONE, {"A": SLOW}, ACT)
        cell = toml(["A"], TOOL.replace("2.0", "9.0"))
        cell = cell.replace("final =", "reply_timeout_s = 4\nfinal =")
        why = "A has not answered toA.robcad for 4 s"
    last = ran(write(tmp_path, text, cell))[-1]
    assert why in str(last.get("reason")), last
    if name == "late":
        assert last["t"] == pytest.approx(4.0)


# B sends again and again; the supervisor takes a message only while it waits for A, and then before all else.
FLOOD = net(
    ONE
    + """    trans HearB priority P_HIGH
      both Armed : ()
      in fromB : k
    place Mute : INT
    trans Hush
      in Mute : k
      out toB : k
""",
    {
        "A": SLOW,
        "B": """    place On = 1
    place Never : INT
    trans Send code action act ()
      both On : ()
      out say : 1
    trans Listen
      in Never : n
      in ask : k
      out say : k
""",
    },
    ACT + "  var n: INT;\n",
)


def few() -> str:
    """FLOOD with a channel of two colours, which are counted."""
    head, b = FLOOD.split("  page PB\n")
    text = head.replace("fromB : INT", "fromB : FEW").replace(
        "fromB port in : INT", "fromB port in : FEW"
    )
    text = text.replace("  page Top", "  colset FEW = int with 1..2;\n  page Top", 1)
    return text + "  page PB\n" + b.replace("say port out : INT", "say port out : FEW")


@pytest.mark.parametrize("text", [few(), FLOOD], ids=["few colours", "one of many"])
def test_messages_that_gather_end_the_exploration(text: str, tmp_path: Path) -> None:
    """No limit is set: a channel in which more and more messages lie needs none, whatever their colour set."""
    found = said(write(tmp_path, text, toml(["A", "B"], TOOL)))
    assert found["why"] in ("messages", "infinite")
    assert found["nodes"] < 100_000
    channels = next(c for c in found["controller"] if c["check"] == "channels")
    assert channels["answer"] == "no" and "fromB" in channels["says"]
