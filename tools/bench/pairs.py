"""Commands of this checkout beside those of another one: processor time of whole processes, in turn, and the ratios.

What else a machine does makes both slower alike, so that a ratio says something on a busy machine, too.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from statistics import median

from tests.helpers.netbuilder import cpn
from tools.bench import measures as m

NEW = "OUT"
"""Stands for a folder that is not there yet."""


def commands(net: Path) -> list[tuple[str, ...]]:
    """What is measured; `net` is a small one."""
    examples = [str((m.ROOT / "examples" / name).relative_to(m.ROOT)) for name in m.CELLS]
    return [
        ("--help",),
        *(("check", cell) for cell in examples),
        *(("generate", cell, "-o", NEW) for cell in examples),
        ("verify", str(net)),
    ]


def measure(other: Path, repeat: int) -> int:
    """Prints the table; 1 when a command answers differently in the two.

    Args:
        other: the root of the other checkout.
        repeat: how many pairs.
    """
    sources = (other.resolve() / "src", m.ROOT / "src")
    print("| command | other checkout, s | this one, s | ratio | spread of the ratio |")
    print("|---|---|---|---|---|")
    differs = False
    with tempfile.TemporaryDirectory(prefix="pn2code-bench-") as name:
        folder = Path(name)
        net = folder / "ring.cpn"
        net.write_bytes(cpn(m.RING.replace("mod 1000", "mod 100")))
        for command in commands(net):
            codes = {_once(source, command, folder)[1] for source in sources}  # warms all caches up
            differs = differs or len(codes) > 1
            seen: tuple[list[float], list[float]] = ([], [])
            for k in range(repeat):
                for which in (0, 1) if k % 2 else (1, 0):
                    seen[which].append(_once(sources[which], command, folder)[0])
            shown = " ".join(Path(x).name if Path(x) == net else x for x in command if x != NEW)
            print(_row(shown.removesuffix(" -o"), *seen), flush=True)
    if differs:
        print("bench: a command ends with another exit code in the other checkout", file=sys.stderr)
    return int(differs)


def _row(shown: str, old: Sequence[float], new: Sequence[float]) -> str:
    ratios = [b / a for a, b in zip(old, new, strict=True)]
    spread = f"{min(ratios):.2f} .. {max(ratios):.2f}"
    return (
        f"| `{shown}` | {median(old):.2f} | {median(new):.2f} | {median(ratios):.2f} | {spread} |"
    )


def _once(source: Path, command: Sequence[str], folder: Path) -> tuple[float, int]:
    """Seconds of a processor, child processes included, and the exit code."""
    out = folder / "out"
    environment = {**os.environ, "PYTHONPATH": str(source)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # as for any user: compiled Python is kept
    words = [str(out) if x == NEW else x for x in command]
    process = subprocess.Popen(
        [sys.executable, "-m", "pn2code", *words],
        cwd=m.ROOT, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    shutil.rmtree(out, ignore_errors=True)
    return used.ru_utime + used.ru_stime, process.returncode
