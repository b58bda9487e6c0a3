"""`./dev contest`: the inputs of the Model Checking Contest beside the repository, one examination after the other.

    ./dev contest [--seconds 60] [--models TEXT] [--sample] [--every N] [--examinations NAME ...] [--log FILE] [--table]

Each examination of each input is asked by `pn2code contest` with that time, and compared with the verdicts on which the
contest's tools agreed. What has been asked with the same time is in the log, and not asked again: the run may be
interrupted and resumed. `--sample` takes one input of each family, the one in the middle by name; `--every N` takes one
of N by name. The log names what was not answered. `--table` only prints the table of the log, as in docs/contest.md.
Exit code 1 if an answer is wrong.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tarfile
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pn2code.contest.words import ALL, FORMULAS

ROOT = Path(__file__).resolve().parent.parent
GRACE_S = 30.0
"""After its time a command is ended, and counts as one that knows nothing."""

Verdicts = dict[tuple[str, str], dict[str, str]]
"""(input, examination) -> number of the formula or name of the quantity -> verdict."""


def main() -> int:
    """The exit code: 1 if an answer is wrong."""
    parser = argparse.ArgumentParser(prog="./dev contest", description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0, help="for each examination")
    parser.add_argument("--models", default="", help="only inputs with this in their names")
    parser.add_argument("--sample", action="store_true", help="one input of each family")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="one of N inputs")
    parser.add_argument("--examinations", nargs="*", default=list(ALL), choices=ALL)
    parser.add_argument("--log", type=Path, default=Path("contest.jsonl"))
    parser.add_argument("--table", action="store_true", help="ask nothing, print the table")
    a = parser.parse_args()
    folder = Path(os.environ.get("PN2CODE_SHARED", ROOT.parent / "shared")) / "mcc" / "contest"
    if not a.table:
        if not folder.is_dir():
            parser.error(f"no inputs at {folder} (set PN2CODE_SHARED)")
        found = sorted((folder / "inputs").glob("*.tgz"))
        found = (_sample(found) if a.sample else found)[:: max(1, a.every)]
        archives = [p for p in found if a.models in p.stem]
        _ask_all(archives, _verdicts(folder / "verdicts.tsv"), a.examinations, a.seconds, a.log)
    rows = [r for r in _logged(a.log) if r["seconds"] == a.seconds]
    print("\n".join(_table(rows)))
    wrong = [r for r in rows if r["wrong"]]
    for row in wrong:
        print(f"WRONG {row['model']} {row['examination']}: {', '.join(row['wrong'])}")
    return 1 if wrong else 0


def _sample(archives: list[Path]) -> list[Path]:
    """One input of each family, the one in the middle."""
    families: dict[str, list[Path]] = defaultdict(list)
    for archive in archives:
        families[archive.stem.split("-")[0]].append(archive)
    return [found[len(found) // 2] for found in families.values()]


def _ask_all(
    archives: list[Path], verdicts: Verdicts, wanted: list[str], seconds: float, log: Path
) -> None:
    done = {(r["model"], r["examination"]) for r in _logged(log) if r["seconds"] == seconds}
    for archive in archives:
        model = archive.stem
        open_ = [e for e in wanted if (model, e) in verdicts and (model, e) not in done]
        if not open_:
            continue
        with tempfile.TemporaryDirectory() as name:
            with tarfile.open(archive) as tar:
                tar.extraction_filter = getattr(tarfile, "data_filter", None)  # 3.11.2 has none
                tar.extractall(name)
            for examination in open_:
                row = _asked(Path(name) / model, examination, seconds, verdicts[model, examination])
                with log.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(row) + "\n")
                print(
                    f"{model} {examination}: {row['right']} of {row['asked']}"
                    + (f", WRONG: {row['wrong']}" if row["wrong"] else "")
                    + f", {row['took']:.1f} s",
                    flush=True,
                )


def _asked(
    folder: Path, examination: str, seconds: float, verdicts: dict[str, str]
) -> dict[str, Any]:
    command = [sys.executable, "-m", "pn2code", "contest", str(folder), examination]
    began = time.monotonic()
    try:
        done = subprocess.run(
            [*command, "--max-seconds", str(seconds)],
            capture_output=True,
            text=True,
            timeout=seconds + GRACE_S,
        )
        lines, error = (
            done.stdout.splitlines(),
            done.stderr.strip()[-300:] if done.returncode else "",
        )
    except subprocess.TimeoutExpired:
        lines, error = [], "it did not end in its time"
    said = dict(_said(lines, examination))
    return {
        "model": folder.name,
        "examination": examination,
        "seconds": seconds,
        "took": round(time.monotonic() - began, 2),
        "asked": len(verdicts),
        "right": sum(said.get(k) == v for k, v in verdicts.items()),
        "open": sorted(k for k in verdicts if k not in said),
        "wrong": [
            f"{k} {said[k]} {v}" for k, v in verdicts.items() if said.get(k) not in (None, v)
        ],
        "error": error,
    }


def _said(lines: list[str], examination: str) -> Iterator[tuple[str, str]]:
    for line in lines:
        words = line.split()
        if words[:1] == ["STATE_SPACE"]:
            yield words[1], words[2]
        elif words[:1] == ["FORMULA"] and words[2] != "CANNOT_COMPUTE":
            yield words[1].rpartition("-")[2] if examination in FORMULAS else "", words[2]


def _verdicts(path: Path) -> Verdicts:
    found: Verdicts = defaultdict(dict)
    for line in path.read_text(encoding="utf-8").splitlines():
        model, examination, formula, verdict = line.split("\t")
        if examination in ALL:
            found[model, examination][formula] = verdict
    return found


def _logged(log: Path) -> list[dict[str, Any]]:
    if not log.exists():
        return []
    return [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]


def _table(rows: list[dict[str, Any]]) -> Iterator[str]:
    """Answers by family and examination."""
    names = [e for e in ALL if any(r["examination"] == e for r in rows)]
    totals: dict[tuple[str, str], list[int]] = defaultdict(lambda: [0, 0])
    for r in rows:
        family = r["model"].split("-")[0]
        for key in ((family, r["examination"]), ("", r["examination"])):
            totals[key][0] += r["right"]
            totals[key][1] += r["asked"]
    yield "| family | " + " | ".join(names) + " |"
    yield "|---|" + "---|" * len(names)
    for family in [*sorted({k[0] for k in totals if k[0]}), ""]:
        cells = [totals.get((family, e)) for e in names]
        shown = [f"{c[0]}/{c[1]}" if c else "" for c in cells]
        yield f"| {family or 'all'} | " + " | ".join(shown) + " |"
    shares = [100.0 * c[0] / c[1] if (c := totals.get(("", e))) and c[1] else 0.0 for e in names]
    yield "| % | " + " | ".join(f"{s:.1f}" for s in shares) + " |"


if __name__ == "__main__":
    sys.exit(main())
