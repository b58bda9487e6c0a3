"""`./dev fuzz --nets N`: random nets, compiled, and walked through next to the token game; failures are made small.

    python -m tools.fuzz.walks [--nets 50] [--seed 1] [--steps 40] [--save FOLDER] [--sanitize]

Net 17 is the same net on every machine. A net must be accepted, must compile, and the compiled program must do what the
token game does. Of a net that breaks this, lines are left out as long as it still breaks it in the same way.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
import traceback
from collections import Counter
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does: the tests' helpers

from helpers.compiled import FAST, SANITIZERS, Workshop
from helpers.netbuilder import write
from helpers.random_nets import random_net
from helpers.walks import Walk, walk

ROOT = Path(__file__).resolve().parents[2]


def play(text: str, workshop: Workshop, *, seed: int, steps: int) -> Walk:
    """Read, compile and walk through a net of the short form."""
    path = write(text, workshop.folder / "random.cpn")
    try:
        return walk(path, "random", workshop, steps=steps, seed=seed, seconds=30.0)
    except Exception:
        return Walk("random", "crash", detail=traceback.format_exc()[-1500:])


def kind(result: Walk) -> str:
    """What is the same of failures with the same cause, as far as one can tell."""
    text = re.sub(r"[`'\"(\[{].*?[`'\")\]}]|\d+", "#", result.detail)
    return f"{result.verdict} {' '.join(text.split())[:60]}"


def smaller(text: str, workshop: Workshop, wanted: str, *, seed: int, steps: int) -> str:
    """The text with as few lines as possible for the same kind of failure."""
    lines = text.splitlines()
    size = max(1, len(lines) // 4)
    while size:
        start = 1
        while start < len(lines):
            fewer = lines[:start] + lines[start + size :]
            try:
                result = play("\n".join(fewer), workshop, seed=seed, steps=steps)
            except (ValueError, KeyError):
                result = None
            if result is not None and kind(result) == wanted:
                lines = fewer
            else:
                start += size
        size //= 2
    return "\n".join(lines)


def main() -> int:
    """Walk through many nets; 1 when one fails."""
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz.walks", description=__doc__)
    parser.add_argument("--nets", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1, help="of the first net; further ones follow")
    parser.add_argument("--steps", type=int, default=40)
    parser.add_argument("--save", type=Path, default=ROOT / ".fuzz", help="where failures go")
    parser.add_argument("--sanitize", action="store_true", help="compile with sanitizers")
    options = parser.parse_args()
    counts: Counter[str] = Counter()
    steps = 0
    seen: set[str] = set()
    with tempfile.TemporaryDirectory(prefix="pn2code-walks-") as folder:
        workshop = Workshop.open(Path(folder), SANITIZERS if options.sanitize else FAST)
        for number in range(options.seed, options.seed + options.nets):
            text = random_net(Random(number))
            result = play(text, workshop, seed=number, steps=options.steps)
            counts[result.verdict if result.verdict != "agrees" else f"agrees ({result.end})"] += 1
            steps += result.steps
            if result.verdict == "agrees":
                continue
            what = kind(result)
            print(f"walks: net {number}: {what}", file=sys.stderr, flush=True)
            if what in seen:
                continue
            seen.add(what)
            text = smaller(text, workshop, what, seed=number, steps=options.steps)
            options.save.mkdir(parents=True, exist_ok=True)
            path = options.save / f"net{number}.txt"
            path.write_text(f"{text}\n\n# {result.detail}\n")
            print(f"{text}\n  -> {result.detail}\n  saved as {path}", flush=True)
    print(f"walks: {dict(counts)}; {steps} steps")
    return int(bool(seen))


if __name__ == "__main__":
    sys.exit(main())
