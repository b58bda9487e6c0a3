"""`./dev simulated`: every net of the collections, simulated by both engines from the same seed; their runs compared.

    python -m tools.simulated [--steps 200] [--seed 1] [--only TEXT] [--replay]

What is compared is what users get: the exit code, the trace character by character, and the JSON object, which has
the final marking, the time, why the run ended, what the monitors and the code segments said; of an error, which one it
is and where. With `--replay` both engines repeat the trace, too. A net that the compiler does not support is simulated
by one engine and only repeated. Exit code 1 if a net differs.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from typer.testing import CliRunner

from helpers.walks import nets
from pn2code.cli.main import app
from pn2code.cli.options import Exit

ENGINES = ("compiled", "reference")

OWN = ("engine", "seconds", "interpreted")
"""What the engines may say differently."""

Call = Callable[..., tuple[int, str, str]]
"""What the command is given, and its exit code, standard output and standard error output."""


def call(*arguments: object) -> tuple[int, str, str]:
    """The command, within this process."""
    result = CliRunner().invoke(app, [str(a) for a in arguments])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.exit_code, result.stdout, result.stderr


def compared(
    net: Path, folder: Path, *, steps: int, seed: int, repeat: bool, pn2code: Call = call
) -> tuple[str, str]:
    """What became of a net, in a word, and the details."""
    said: dict[str, tuple[int, dict[str, Any], list[str]]] = {}
    for engine in ENGINES:
        trace = folder / f"{engine}.trace.jsonl"
        trace.unlink(missing_ok=True)
        wanted = ("--steps", steps, "--seed", seed, "--trace", trace, "--engine", engine)
        code, printed, errors = pn2code("simulate", net, "--json", *wanted)
        if not printed.strip():
            if engine == "compiled" and pn2code("check", net)[0] == Exit.OK:
                continue  # only the compiler does not take it
            return "rejected", f"{code} {errors}"
        result = {k: v for k, v in json.loads(printed).items() if k not in OWN}
        result["error"] = place_of(result["error"])
        said[engine] = code, result, _lines(trace)
    if repeat:
        for engine in said:
            for by in ENGINES if len(said) > 1 else ("reference",):
                trace = folder / f"{engine}.trace.jsonl"
                code, printed, errors = pn2code("replay", trace, net, "--json", "--engine", by)
                if code != Exit.OK:
                    return "differs", f"run by {engine}, repeated by {by}: {printed} {errors}"
    if len(said) == 1:
        return "one engine", str(said["reference"][1]["steps"])
    codes, results, traces = zip(*said.values(), strict=True)
    if codes[0] != codes[1]:
        return "differs", f"exit codes {codes}"
    for key in results[0]:
        if results[0][key] != results[1].get(key):
            return "differs", f"{key}: {results[0][key]!r} and {results[1].get(key)!r}"
    if traces[0] != traces[1]:
        pairs = zip(*traces, strict=False)
        first = next((p for p in pairs if p[0] != p[1]), tuple(map(len, traces)))
        return "differs", f"traces: {first}"
    return "agrees", f"{results[0]['steps']} {results[0]['why']}"


def place_of(error: dict[str, Any] | None) -> dict[str, Any] | None:
    """Where an error is and what it is: the engines describe it in words of their own."""
    if error is None:
        return None
    what = re.search(r"(?:raised (?:the exception )?|cannot go on: )`([^`]*)`", error["message"])
    return {**error, "message": what.group(1) if what else error["message"]}


def _lines(trace: Path) -> list[str]:
    """The lines of a trace, without who has written it."""
    if not trace.exists():
        return []
    first, *others = trace.read_text(encoding="utf-8").splitlines()
    header = {k: v for k, v in json.loads(first).items() if k != "by"}
    return [json.dumps(header), *others]


def main() -> int:
    """Simulate all nets; one line each."""
    parser = argparse.ArgumentParser(prog="tools.simulated", description=__doc__)
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="nets whose path contains this text")
    parser.add_argument("--replay", action="store_true", help="repeat the traces, too")
    options = parser.parse_args()
    root = Path(__file__).resolve().parents[1]
    shared = Path(os.environ.get("PN2CODE_SHARED", root.parent / "shared"))
    counts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        for path in nets(shared):
            if options.only not in path.as_posix():
                continue
            verdict, detail = compared(
                path, Path(name), steps=options.steps, seed=options.seed, repeat=options.replay
            )
            counts[verdict] += 1
            short = " ".join(detail.split())[:600]
            print(f"{verdict:10} {path.relative_to(shared)}  {short}", flush=True)
    print(dict(counts))
    return 1 if counts["differs"] else 0


if __name__ == "__main__":
    sys.exit(main())
