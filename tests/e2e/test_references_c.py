"""References that a net changes are a part of its state: what they hold is kept, restored, and tells nodes apart."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.explored import Explorers, agrees
from helpers.netbuilder import flat, write
from helpers.random_references import referring
from helpers.thorough import amount
from helpers.unions import Outcome, check
from pn2code.cli.main import app
from pn2code.conform.core import compare
from pn2code.diagnostics import Diagnostics
from pn2code.net.front import load
from pn2code.verify.exploring.explore import explore
from pn2code.verify.exploring.limits import Limits

pytestmark = pytest.mark.cc

KEPT = """
net Kept
  standard
  var b : BOOL;
  %s
  page Top
    place A = 1`()
    place B
    place C
    place D
    trans T1 code action (%s)
      in A : 1`()
      out B : 1`()
    trans T2 code action (ignore (List.tabulate (50, fn i => Int.toString (i * 7))))
      in B : 1`()
      out C : 1`()
    trans T3 code output (b); action (%s)
      in C : 1`()
      out D : if b then 1`() else raise Fail "wrong"
"""
HELD = {
    "list": ("val l = ref (nil : int list);", "l := List.tabulate (3, fn i => i+1)", "!l = [1,2,3]"),
    "string": ('globref s = "";', 's := "ab" ^ Int.toString 7', '!s = "ab7"'),
    "intinf": ("val n = ref (IntInf.fromInt 0);", "n := IntInf.pow (10, 40)", "!n > 7"),
    "tuple": ('val t = ref (1, ["x"]);', 't := (2, ["y" ^ "z"])', 't = t andalso #2 (!t) = ["yz"]'),
    "option": ("val o1 = ref (NONE : string option);", 'o1 := SOME ("a" ^ "b")', '!o1 = SOME "ab"'),
    "reference": ("val r = ref (ref 1);", "r := ref 5; !r := 6", "!(!r) = 6"),
    "array": ('val a = Array.array (2, "");', 'Array.update (a, 1, "q" ^ "r")', 'Array.sub (a, 1) = "qr"'),
    "function": ("val f = ref (fn (x : int) => x);", "f := (fn x => x + hd [4])", "(!f) 1 = 5"),
    "captured": (
        "val (get, put) = let val c = ref [0] in (fn () => !c, fn x => c := x :: !c) end;",
        "put 3",
        "get () = [3, 0]",
    ),
}  # fmt: skip

COUNT = """
net Count
  standard
  globref n = 0;
  page Top
    place A = 1`()
    place B
    trans Up guard [!n < 5] code action (n := !n + 1)
      both A : 1`()
    trans Down guard [!n > 0] code action (n := !n - 1)
      both A : 1`()
    trans End guard [!n = 3]
      in A : 1`()
      out B : 1`()
"""


@pytest.mark.parametrize("name", [*HELD][:: amount(3, 1)])
def test_what_a_reference_holds_stays(sanitized: Explorers, name: str) -> None:
    """In CPN Tools too: this net has four nodes there, and no exception."""
    assert agrees(sanitized, flat(KEPT % HELD[name])) == "same"


def test_nodes_differ_in_what_references_hold(tmp_path: Path) -> None:
    """Six values of the counter, and the end; CPN Tools sees one marking, and not the dead one."""
    d = Diagnostics()
    net = load(write(COUNT, tmp_path / "count.cpn"), d, {})
    assert net is not None
    found = explore(net, {}, Limits(traces=0), d)
    assert found is not None
    assert (found.nodes, found.arcs, found.dead_count) == (7, 11, 1)
    report = compare(net, {}, d)
    assert report is not None
    assert (report.nodes, report.complete, report.deviation) == (7, True, None)


def test_no_state_space_where_a_guard_assigns() -> None:
    d = Diagnostics()
    net = flat(COUNT.replace("[!n = 3]", "[(n := !n + 1; true)]"))
    assert explore(net, {}, Limits(traces=0), d) is None
    assert [e.code for e in d.errors] == ["state-space-search-effect"]
    assert "`Top.End`" in next(iter(d.errors)).message


@pytest.mark.parametrize("number", range(amount(1, 80)))
def test_random_nets_with_references(sanitized: Explorers, number: int) -> None:
    """Also with two threads asked for, depth first, and in walks; `./dev fuzz --references N` takes more."""
    done: Outcome = check(sanitized, referring(number, 16))
    assert done.nets >= 8, done


ASKED = {
    "never { !n > 5 }": "yes",
    "never { !n = 4 }": "no",
    "always { !n = 3 } || tokens(B) = 0": "yes",
    "reachable { !n = 5 }": "yes",
    "ctl AG ({ !n = 0 } -> EF { !n = 5 } || tokens(B) = 1)": "yes",
    "ltl G (fires(Up, { !n = 4 }) -> { !n = 5 })": "no",
    "ltl G (fires(Up, { !n = 4 }) -> X { !n = 5 })": "yes",
    "every { !n = 5 } is followed by { !n = 4 }": "yes",
}


def test_properties_read_what_references_hold(tmp_path: Path) -> None:
    """They are a part of the state; the runs are looked at again by the token game, which has them there, too."""
    net = write(COUNT, tmp_path / "count.cpn")
    options = [x for text in ASKED for x in ("--property", text)]
    traces = ("--traces", str(tmp_path))
    done = CliRunner().invoke(app, ["verify", str(net), "--json", *traces, *options])
    assert "bug in pn2code" not in done.stderr
    rows = json.loads(done.stdout)["properties"]
    assert [r["answer"] for r in rows] == list(ASKED.values())
    changing = CliRunner().invoke(
        app, ["verify", str(net), "--property", "never { (n := 2; true) }"]
    )
    assert changing.exit_code == 1 and "changes a reference" in changing.stderr
