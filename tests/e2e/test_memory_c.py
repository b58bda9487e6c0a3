"""Long runs of nets with strings and lists stay within the memory that they have from the start."""

from __future__ import annotations

import re
import subprocess
import time
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

    process = subprocess.Popen([str(program), "--steps", str(STEPS), "--trace", "/dev/null"])
    largest = 0
    while process.poll() is None:
        largest = max(largest, resident(process.pid))
        time.sleep(0.002)
    assert process.returncode == 0
    assert 0 < largest < MEGABYTES << 10


def resident(pid: int) -> int:
    """Memory of a process, kilobytes; 0 when it has gone. (wait4 includes the tests' own, from before exec.)"""
    try:
        status = Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return 0
    found = re.search(r"^VmHWM:\s+(\d+) kB", status, re.MULTILINE)
    name = re.search(r"^Name:\s+(\S+)", status, re.MULTILINE)
    return int(found[1]) if found and name and name[1] == "simulate" else 0


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
    done = subprocess.run([str(program)], capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 1
    assert "memory for lists and strings is full" in done.stderr
