"""Monitors without functions: the compiled simulator collects what the token game's monitors collect."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from helpers.monitors import Spec, with_monitors
from pn2code.diagnostics import Diagnostics
from pn2code.monitors.simple import Simple
from pn2code.net import front
from pn2code.simulate.choose import Wish, monitors_of, simulate
from pn2code.simulate.run import Request

pytestmark = pytest.mark.cc

SIZE, LENGTH = "Marking size", "List length data collection"
COUNT = "Count transition occurrence data collection"
CONTENT, ENABLED = "Place content break point", "Transition enabled break point"
YES = {"If is empty": "true", "If is enabled": "true"}
NO = {"If is empty": "false", "If is enabled": "false"}
MOVES = """
    net Cell
      standard
      var n: INT;
      place P : INT = 1`1 ++ 1`2 ++ 1`3
      place Q : INT
      trans T
        in P : n
        out Q : n
"""
TIMED = """
    net Cell
      standard
      colset JOB = int timed;
      var j: JOB;
      place P : JOB = 1`1@0 +++ 1`2@3 +++ 1`3@7
      place Q : JOB
      place R : JOB
      trans T
        in P : j
        out Q : j
      trans U
        in Q : 1`2
        out R : 1`2@+2
"""
REAL = (
    TIMED.replace("net Cell", "net Cell\n      option realtimestamp true")
    .replace("@0", "@0.1")
    .replace("@3", "@3.3")
    .replace("@7", "@7.7")
    .replace("@+2", "@++0.2")
)
LISTS = """
    net Cell
      standard
      colset LIST = list STRING;
      var l: LIST;
      place Queue : LIST = 1`[]
      place Go = 3
      trans Push
        in Queue : l
        in Go : ()
        out Queue : "a,\\"]" :: l
"""
SIZES = (Spec("p", SIZE, ["Top.P"]), Spec("q", SIZE, ["Top.Q"]), Spec("t", COUNT, ["Top.T"]))


@pytest.mark.parametrize(
    ("text", "specs", "options", "why"),
    [
        pytest.param(MOVES, SIZES, {}, "finished", id="untimed"),
        pytest.param(TIMED, SIZES, {}, "finished", id="timed"),
        pytest.param(TIMED, SIZES, {"until": 5}, "until", id="until"),
        pytest.param(REAL, SIZES, {"until": 5.3}, "until", id="real clock"),
        pytest.param(REAL, SIZES, {}, "finished", id="real clock to the end"),
        pytest.param(LISTS, [Spec("l", LENGTH, ["Top.Queue"])], {}, "finished", id="lists"),
        pytest.param(
            LISTS.replace("1`[]", "2`[]"), [Spec("l", LENGTH, ["Top.Queue"])], {}, "error", id="two"
        ),
        pytest.param(
            MOVES,
            [*SIZES, Spec("e", CONTENT, ["Top.P"], options=YES)],
            {},
            "breakpoint",
            id="empty",
        ),
        pytest.param(
            MOVES,
            [Spec("f", CONTENT, ["Top.Q"], options=NO), *SIZES],
            {},
            "breakpoint",
            id="not empty",
        ),
        pytest.param(
            TIMED,
            [*SIZES, Spec("n", ENABLED, ["Top.U"], options=YES)],
            {},
            "breakpoint",
            id="enabled",
        ),
        pytest.param(
            TIMED, [*SIZES, Spec("d", ENABLED, ["Top.T"], options=NO)], {}, "breakpoint", id="not"
        ),
        pytest.param(
            MOVES.replace("out Q : n", "out Q : 1 div (n - n)"), SIZES, {}, "error", id="exception"
        ),
    ],
)
def test_both_engines_collect_the_same(
    tmp_path: Path, text: str, specs: list[Spec], options: dict[str, Any], why: str
) -> None:
    path = tmp_path / "net.cpn"
    path.write_bytes(with_monitors(text, *specs))
    d = Diagnostics()
    examined = front.examine(path, d)
    assert examined.flat is not None, [e.message for e in d.errors]
    program = monitors_of(examined, d)
    assert program is not None and Simple.of(program, examined.flat, breakpoints=True) is not None
    request = Request(net=examined.flat, monitors=program, **options)
    compiled, reference = (simulate(request, w, d) for w in (Wish.COMPILED, Wish.REFERENCE))
    assert compiled is not None and reference is not None, [e.message for e in d.errors]
    assert (compiled.why, compiled.steps) == (reference.why, reference.steps)
    assert compiled.why == why
    assert compiled.monitors == reference.monitors
    assert compiled.breakpoint == reference.breakpoint
    assert compiled.final == reference.final
