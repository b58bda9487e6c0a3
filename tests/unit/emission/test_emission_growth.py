"""What is generated for transitions with more and more of one thing, and what it takes to compile; without a clock."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.emission import c_flags
from pn2code.emission.output import OutputFile
from pn2code.simulate import programs
from pn2code.toolchain import programs as toolchain


def generated(text: str) -> tuple[OutputFile, ...]:
    d = Diagnostics()
    found = programs.generated(flat(text), {}, d)
    assert found is not None, list(d)
    return found


def with_arcs(count: int) -> str:
    """One transition that takes a number from each of so many places and puts it back."""
    lines = ["net Arcs", "  standard"]
    lines += [f"  place P{i} : INT = 1`{i}" for i in range(count)]
    lines += [f"  var {', '.join(f'v{i}' for i in range(count))}: INT;", "  trans T"]
    for i in range(count):
        lines += [f"    in P{i} : v{i}", f"    out P{i} : v{i}"]
    return "\n".join(lines)


def joining(count: int) -> str:
    """One transition that joins so many strings."""
    joined = " ^ ".join(f'"k{i}" ^ s' for i in range(count // 2))
    return f"""net Joining
  standard
  var s: STRING;
  place P : STRING = 1`"a"
  trans T
    in P : s
    out P : String.substring ({joined}, 0, 1)
"""


MEASURED = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


def size(files: tuple[OutputFile, ...]) -> int:
    return sum(len(f.text) for f in files)


def test_code_of_a_transition_grows_with_its_arcs() -> None:
    """Each arc is a loop in the loops before; indented to the end, 200 arcs would have four times what 100 have."""
    sizes = [size(generated(with_arcs(n))) for n in (50, 100, 200)]
    assert sizes[2] <= 2.1 * sizes[1] <= 4.5 * sizes[0], sizes


@pytest.mark.cc
def test_loops_in_loops_do_not_fill_the_memory_while_they_are_compiled(tmp_path: Path) -> None:
    """200 of them took gcc 300 MB, 600 of them 1,400 MB."""
    compiler = toolchain.Compiler.find(programs.HOST, Diagnostics())
    assert compiler is not None
    files = generated(with_arcs(200))
    for f in (*programs.HOST.runtime(), *files):
        path = tmp_path / f.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f.text, encoding="utf-8")
    flags = toolchain.net_flags(programs.HOST, compiler, "".join(f.text for f in files))
    command = [*compiler.command, *toolchain.FLAGS, *flags, "-Iruntime/include", "-I."]
    # What begins a process counts for it until it is another program: a small one begins the compiler.
    measured = [sys.executable, "-S", "-c", MEASURED, *command, "-c", "net.c"]
    done = subprocess.run(measured, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert 1_000 < int(done.stdout) < 200_000, f"{done.stdout} KB"


def test_a_net_with_a_long_function_is_large() -> None:
    """However short it is otherwise: gcc's time for one function grows with the square of its length."""
    short, long = ("".join(f.text for f in generated(joining(n))) for n in (100, 1_500))
    assert c_flags.for_net(short) == ()
    assert len(long) < c_flags.LARGE
    assert c_flags.for_net(long) == c_flags.QUICKER


def test_long_tables_and_many_short_functions_are_not_long_functions() -> None:
    rows = "    { 1, 2 },\n" * 5_000
    assert c_flags.for_net(f"static const int s_table[][2] = {{\n{rows}}};\n") == ()
    function = "static int f(void)\n{\n    return 0;\n}\n\n"
    assert c_flags.for_net(function * 5_000) == ()
