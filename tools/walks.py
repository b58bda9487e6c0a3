"""`./dev walks`: every net of the collections compiled and walked through next to the token game; the results as JSON.

    python -m tools.walks [--steps 1000] [--seconds 60] [--seed 1] [--only TEXT] [--again FILE] [-o FILE]

Exit code 1 if a net differs.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from helpers.compiled import FAST, Workshop
from helpers.walks import Walk, nets, walk


def main() -> int:
    """Walk through all nets; one line each on the standard error output."""
    parser = argparse.ArgumentParser(prog="tools.walks")
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=60.0, help="per net")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="nets whose path contains this text")
    parser.add_argument(
        "--again",
        type=Path,
        help="only those that an earlier output of this says `time` or `differs` of",
    )
    parser.add_argument("-o", "--output", type=Path)
    options = parser.parse_args()
    earlier = json.loads(options.again.read_text())["nets"] if options.again else []
    finished = {
        r["net"]: Walk(**r) for r in earlier if r["end"] != "time" and r["verdict"] != "differs"
    }
    root = Path(__file__).resolve().parents[1]
    shared = Path(os.environ.get("PN2CODE_SHARED", root.parent / "shared"))
    results: list[Walk] = []
    with tempfile.TemporaryDirectory() as folder:
        workshop = Workshop.open(Path(folder), FAST)
        for path in nets(shared):
            name = path.relative_to(shared).as_posix()
            if options.only not in name:
                continue
            result = finished.get(name) or walk(
                path,
                name,
                workshop,
                steps=options.steps,
                seed=options.seed,
                seconds=options.seconds,
            )
            results.append(result)
            if name in finished:
                continue
            detail = " ".join(result.detail.split())[:300]
            print(
                f"{result.verdict:12}{result.steps:6} {result.end:6}{result.runs:4} {name}  {detail}",
                file=sys.stderr,
                flush=True,
            )
    counts = Counter(r.verdict for r in results)
    ends = Counter(r.end for r in results if r.verdict == "agrees")
    report = {
        "steps": options.steps,
        "seed": options.seed,
        "verdicts": dict(sorted(counts.items())),
        "ends": dict(sorted(ends.items())),
        "nets": [r.as_json() for r in results],
    }
    text = json.dumps(report, indent=1) + "\n"
    if options.output is None:
        print(text, end="")
    else:
        options.output.write_text(text)
    print(f"{dict(counts)}; of those that agree: {dict(ends)}", file=sys.stderr)
    return 1 if counts["differs"] else 0


if __name__ == "__main__":
    sys.exit(main())
