"""`./dev oracle --idioms`: nets with the idioms of published models, and what the engine of CPN Tools says of them.

    python -m tools.oracle --idioms [NAME ...] [--first 0] [--count 361] [--portion 20] [--jobs 2]
        # asks again; 0 when nothing has changed
    python -m tools.oracle --idioms --seed 7 [...] [--save FOLDER]
        # other runs, compared with pn2code; 0 when nothing differs

`idioms.txt` has the nets in the short form, each begins with `net NAME`. `tests/golden/engine_idioms.json` has the
answers: errors or the initial marking, a random run, the size of the state space. `tests/e2e/test_engine_idioms.py`
compares them with pn2code, without the engine. So many nets are asked about at a time; what differs is printed, and
what was answered is written down, after each portion. A line of progress says with which `--first` to go on.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import re
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.oracle import engine
from tools.oracle.totals import Totals, compared

from helpers.netbuilder import cpn

TEXTS = Path(__file__).with_name("idioms.txt")
ANSWERS = engine.ROOT / "tests" / "golden" / "engine_idioms.json"
STEPS = 25
NODES = 1500
RECORDED = 1209
"""The seed of the answers that are kept."""


def nets() -> dict[str, str]:
    """The nets by name."""
    parts = re.split(r"^(?=net \w+$)", TEXTS.read_text(encoding="utf-8"), flags=re.MULTILINE)
    return {part.split()[1]: part for part in parts if part.startswith("net ")}


def answers() -> dict[str, engine.Answer]:
    """What was recorded, by name."""
    kept: dict[str, engine.Answer] = json.loads(ANSWERS.read_text(encoding="utf-8"))
    return kept


def digest(text: str) -> str:
    """Tells whether a net has changed."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _written(texts: Mapping[str, str], folder: Path) -> dict[str, Path]:
    """The files of nets, by name."""
    paths = {name: folder / f"{name}.cpn" for name in texts}
    for name, path in paths.items():
        path.write_bytes(cpn(texts[name]))
    return paths


def ask(texts: Mapping[str, str], jobs: int = 1) -> dict[str, engine.Answer]:
    """What the engine says of nets, shortened to what is compared."""
    with tempfile.TemporaryDirectory() as folder:
        paths = _written(texts, Path(folder))
        said = dict(zip(texts, engine.marking(list(paths.values()), jobs=jobs), strict=True))
        good = [name for name, answer in said.items() if "marking" in answer]
        files = [paths[name] for name in good]
        runs = dict(zip(good, engine.run(files, steps=STEPS, jobs=jobs), strict=True))
        asked = engine.space(files, seconds=20, nodes=NODES, jobs=jobs)
        spaces = dict(zip(good, asked, strict=True))
    return {
        name: _kept(texts[name], answer, runs.get(name), spaces.get(name))
        for name, answer in said.items()
    }


def _kept(
    text: str, answer: engine.Answer, run: engine.Answer | None, space: engine.Answer | None
) -> engine.Answer:
    """What is recorded of a net."""
    kept: dict[str, Any] = {"digest": digest(text), "accepted": answer["accepted"]}
    kept["errors"] = [
        {k: e[k] for k in ("id", "what", "by")} | {"message": e["message"][:100]}
        for e in answer["errors"]
    ]
    if "failure" in answer:
        kept["failure"] = {k: answer["failure"][k] for k in ("kind", "stage")}
        kept["failure"]["message"] = answer["failure"]["message"][:100]
    if run is not None and space is not None:
        kept["marking"] = answer["marking"]
        kept["run"] = {k: v for k, v in run.items() if k not in ("net", "errors")}
        if space.get("entire"):
            kept["space"] = {
                k: space[k] for k in ("nodes", "arcs", "scc", "entire", "stopped_by_error")
            }
            kept["space"] |= {"dead": space["dead"], "home": space["home"]}
    return kept


def portions(names: Sequence[str], size: int, first: int, count: int) -> Iterator[Sequence[str]]:
    """So many of the names at a time, from the first that is wanted."""
    chosen = names[first : first + count]
    for at in range(0, len(chosen), size):
        yield chosen[at : at + size]


def differences(now: engine.Answer, before: engine.Answer | None) -> list[str]:
    """What has changed in the answer about a net: a line each."""
    if before is None:
        return ["it had no answer"]
    return [
        f"{key}: {json.dumps(now.get(key))[:200]} instead of {json.dumps(before.get(key))[:200]}"
        for key in sorted(now.keys() | before.keys())
        if now.get(key) != before.get(key)
    ]


def _again(texts: Mapping[str, str], kept: dict[str, engine.Answer], jobs: int) -> int:
    """Ask about nets again, and write down the answers; how many have changed."""
    changed = 0
    for name, now in ask(texts, jobs).items():
        found = differences(now, kept.get(name))
        for line in found:
            print(f"{name} {line}", flush=True)
        changed += bool(found)
        kept[name] = now
    rows = {name: kept[name] for name in nets() if name in kept}
    ANSWERS.write_text(json.dumps(rows, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return changed


def _other_runs(texts: Mapping[str, str], seed: int, jobs: int, totals: Totals) -> int:
    """Runs of another seed beside pn2code; how many nets differ."""
    before = totals.wrong
    with tempfile.TemporaryDirectory() as folder:
        paths = _written(texts, Path(folder))
        said = engine.run(list(paths.values()), steps=4 * STEPS, jobs=jobs, seed=seed, limit=60)
        for (name, path), answer in zip(paths.items(), said, strict=True):
            totals.add(name, path, compared(path, answer, answer), [answer, answer])
    return totals.wrong - before


def main(arguments: Sequence[str]) -> int:
    """Asks about the named nets, or all; 0 when nothing has changed."""
    texts = nets()
    parser = argparse.ArgumentParser(prog="oracle --idioms", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="of the nets; all by default")
    parser.add_argument("--seed", type=int, default=RECORDED, help="of the engine's runs")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=len(texts))
    parser.add_argument("--portion", type=int, default=20)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--save", type=Path)
    a = parser.parse_args(arguments)
    unknown = [name for name in a.names if name not in texts]
    if unknown:
        parser.error(f"there is no net `{unknown[0]}` in {TEXTS.name}")
    names = a.names or list(texts)
    kept = answers() if ANSWERS.is_file() else {}
    totals = Totals(a.save)
    done, wrong = a.first, 0
    for portion in portions(names, a.portion, a.first, a.count):
        wanted = {name: texts[name] for name in portion}
        if a.seed == RECORDED:
            wrong += _again(wanted, kept, a.jobs)
        else:
            wrong += _other_runs(wanted, a.seed, a.jobs, totals)
        done += len(portion)
        print(f"{done} of {len(names)} nets, {wrong} differ; go on with --first {done}", flush=True)
    if a.seed != RECORDED:
        print(*totals.lines(), sep="\n")
    return 1 if wrong else 0
