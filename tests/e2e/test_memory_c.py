"""Long runs of nets with strings and lists stay within the memory that they have from the start."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from helpers.compiled import Workshop, lowered
from helpers.netbuilder import flat

pytestmark = pytest.mark.cc

NET = """
    net Long
      standard
      colset INTS = list INT;
      colset U = union Leaf + Text: STRING + Numbers: INTS;
      fun cut s = if String.size s > 200 then String.substring (s, 150, 50) else s
      fun turn nil = nil | turn (x :: rest) = rest ^^ [x]
      val seen = ref ([] : string list)
      var s: STRING;
      var l: INTS;
      var u: U;
      place Strings : STRING = 1`"a" ++ 1`"b"
      place Lists : INTS = 1`[1, 2, 3, 4, 5]
      place Unions : U = 1`Leaf
      trans Grow
        in Strings : s
        in Unions : u
        out Strings : cut (s ^ String.map Char.toUpper "xyz" ^ Int.toString (String.size s))
        out Unions : Text (s ^ "!")
        code input (s); action (seen := List.take (s :: !seen, Int.min (5, length (!seen))));
      trans Turn
        in Lists : l
        in Unions : u
        out Lists : turn (List.map (fn x => (x * 7 + 1) mod 1000) l)
        out Unions : Numbers l
"""
STEPS = 300_000
MEGABYTES = 64


def test_a_long_run(fast_workshop: Workshop, tmp_path: Path) -> None:
    net, d = lowered(flat(NET))
    assert net is not None, [(e.code, e.message) for e in d.errors]
    program = fast_workshop.build(net, tmp_path / "net", "simulate")

    command = [str(program), "--steps", str(STEPS), "--trace", "/dev/null"]
    assert 0 < most_resident(command) < MEGABYTES << 10


MEASURE = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


def most_resident(command: Sequence[str]) -> int:
    """Most memory of a program, kilobytes. It counts what its parent had at the start, so that is a small one."""
    measure = [sys.executable, "-S", "-E", "-c", MEASURE, *command]
    return int(subprocess.run(measure, capture_output=True, text=True, check=True).stdout)


def test_a_value_that_is_too_large_is_an_error(fast_workshop: Workshop, tmp_path: Path) -> None:
    net, _ = lowered(
        flat("""
        net Large
          standard
          var s: STRING;
          place A : STRING = 1`"0123456789"
          trans Double
            in A : s
            out A : s ^ s
    """)
    )
    assert net is not None
    program = fast_workshop.build(net, tmp_path / "net", "simulate")
    done = subprocess.run([str(program)], capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 1
    assert "memory for lists and strings is full" in done.stderr
