"""How much memory a deployed program gets for lists, strings and moves; that it is enough."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections import defaultdict
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from helpers.compiled import lowered
from helpers.netbuilder import flat
from helpers.thorough import amount
from pn2code.base.resources import cnative_folder
from pn2code.diagnostics import Diagnostics, render
from pn2code.emission import arena_size, c_flags
from pn2code.emission.write import write
from pn2code.ir.allocating import ALLOCATING, MOVES
from pn2code.lowering.passes import arena
from pn2code.lowering.passes.analysis import bounded
from pn2code.pipeline import Generated
from pn2code.toolchain import build

pytestmark = pytest.mark.cc

_EDGE = re.compile(r'^edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"', re.MULTILINE)
SANITIZERS = "-fsanitize=address,undefined -fno-sanitize-recover=all"
_PARTS = ("value", "marking", "channel", "port", "supervisor")


def test_the_functions_that_allocate_are_known(tmp_path: Path) -> None:
    """Those of the runtime that come to `pn_arena_alloc` by any calls."""
    if shutil.which("gcc") is None:
        pytest.skip("the call graph needs gcc")
    callers: dict[str, set[str]] = defaultdict(set)
    for part in _PARTS:
        for source in sorted((cnative_folder() / "src" / part).glob("*.c")):
            if source.name == "messages.c":
                continue
            made = tmp_path / f"{source.stem}.o"
            command = [
                "gcc", c_flags.STANDARD, "-O0", "-DPN_FLAT_TYPES", "-DPN_TRACE", "-DPN_MONITOR", "-fcallgraph-info",
                f"-I{cnative_folder() / 'include'}", "-c", str(source), "-o", str(made),
            ]  # fmt: skip
            subprocess.run(command, check=True, cwd=tmp_path)
            for caller, callee in _EDGE.findall(made.with_suffix(".ci").read_text()):
                callers[callee.rpartition("/")[2]].add(caller.rpartition("/")[2])
    found: set[str] = set()
    waiting = ["pn_arena_alloc"]
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += callers[name]
    names = {name.rpartition(":")[2] for name in found}
    public = {n for n in names if n.startswith("pn_")}  # what begins otherwise is static
    assert public == ALLOCATING | MOVES
    # The host comes there only by tokens that arrive, which are counted.
    own = {n for n in names if n.startswith("sup_")}
    assert own == {"sup_read_inputs", "sup_run_cell"}


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("riveting", {}),
        ("sorting", {}),
        ("timed", {"parts": "1", "orders": "1"}),  # a million states with three parts
    ][: amount(1, 3)],
)
def test_the_examples_run_in_what_is_proven(
    name: str,
    values: dict[str, str],
    of_example: Callable[..., Generated],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    example = of_example(name, **({"values": values} if values else {}))
    made = _written(example, tmp_path)
    config = (tmp_path / "cell_config.c").read_text()
    assert made < 100_000 and "proven to be enough" in config
    # As it is, but not optimized: that would take five times as long.
    monkeypatch.setenv("SANITIZE", f"-g1 -O0 {SANITIZERS}")

    assert _dry_run(tmp_path, example).returncode == 0

    # Without it, there is a fault: so the run above says something.
    (tmp_path / "cell_config.c").write_text(config.replace(f"s_arena[{made}U /", "s_arena[64U /"))
    done = _dry_run(tmp_path, example)
    assert done.returncode == 1 and "is used up" in done.stderr


def test_lists_have_the_usual_size(of_example: Callable[[str], Generated], tmp_path: Path) -> None:
    assert _written(of_example("shared-zone"), tmp_path) == arena_size.DEFAULT
    head = (tmp_path / "cell_config.c").read_text().partition("#include")[0]
    assert "4,194,304 bytes" in head and "not proven (the net has lists" in " ".join(head.split())


def _written(made: Generated, folder: Path) -> int:
    write(folder, made.files)
    return made.arena


def _dry_run(folder: Path, made: Generated) -> subprocess.CompletedProcess[str]:
    d = Diagnostics()
    built = build.build(folder, made.files, d, target="supervisor.sanitize")
    assert built is not None, render.report(d)
    command = ["./supervisor.sanitize", "--dry-run", "--quiet"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


# --- nets ---

NET = """
net n
  colset INT = int;
  colset FOUR = product INT * INT * INT * INT;
  colset LONG = product FOUR * FOUR * FOUR * FOUR * INT;
  colset T = int timed;
  globref count = 0;
  var n, k: INT;
  page P
    place A : INT = 1`1 ++ 1`2
    place B : T = 1`1 @ 0
    place C : INT
    place L : LONG
    trans Go
      in A : n
      out C : {out}
    trans Wait
      in A : k
      in B : {taken}
      out B : 1 @+ 1
"""


def _size(out: str = "n", taken: str = "n", arriving: tuple[str, ...] = ()) -> arena_size.ArenaSize:
    net = flat(NET.replace("{out}", out).replace("{taken}", taken))
    compiled, _ = lowered(net)
    assert compiled is not None
    places = tuple(replace(p, arrives=p.name in arriving) for p in compiled.places)
    return arena_size.of(bounded(replace(compiled, places=places)), None)


def test_moves_are_counted() -> None:
    move = arena.MOVE + arena.ALIGNMENT
    # Three are put at the start; `Wait` takes two tokens and puts one.
    assert _size().is_proven and _size().bytes == 2 * (3 * move + 3 * move)
    # A timed place gives its tokens one by one.
    assert _size(taken="4`n").bytes == 2 * (3 * move + 3 * move + 3 * arena.MOVE)
    # 17 integers do not fit on the stack; A's do.
    assert _size(arriving=("P.A",)) == _size()
    assert _size(arriving=("P.L",)).bytes == 2 * (3 * move + max(3 * move, 17 * arena.SCALAR + 16))


@pytest.mark.parametrize(
    ("net", "why"),
    [
        ({"out": "String.size (Int.toString n)"}, "pn_string"),
        ({"taken": "k`k"}, "computed number of timed tokens"),
        ({"out": "List.tabulate (n, fn x => x)"}, "lists"),
        ({"out": "(count := !count + 1; !count)"}, "references"),
    ],
)
def test_what_cannot_be_counted_has_the_usual_size(net: dict[str, str], why: str) -> None:
    found = _size(**net)
    assert not found.is_proven and found.bytes == arena_size.DEFAULT and why in found.why
