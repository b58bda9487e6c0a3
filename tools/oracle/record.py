"""`./dev record`: what the engine of CPN Tools says of the example nets, kept in `tests/golden/engine`.

    python -m tools.oracle.record [--random | EXAMPLE...]

Of each net, or of those that are named: whether it is accepted, the numbers of its state space, and a random run to
its end; with `--random`, of random nets the same with their initial markings, in `tests/golden/engine_random.json`.
`tests/e2e/test_engine_answers.py` compares them with pn2code, without the engine. To be called again when an example
changes.
"""

from __future__ import annotations

import hashlib
import json
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.oracle import engine
from tools.oracle.alone import text
from tools.oracle.engine import ROOT, NoOracleError

from helpers.netbuilder import cpn

FOLDER = ROOT / "tests" / "golden" / "engine"
RANDOM = ROOT / "tests" / "golden" / "engine_random.json"
NUMBERS = range(5_000, 5_020)
"""Of the random nets."""
STEPS = 5_000
SEEDS = range(1, 7)
"""Of the runs; the longest one is kept."""


def nets() -> list[Path]:
    """The example nets."""
    return sorted((ROOT / "examples").glob("*/*.cpn"))


def answer(net: Path, run: engine.Answer, space: engine.Answer) -> engine.Answer:
    """What is kept.

    Raises:
        NoOracleError: the engine does not accept the net, or does not come to the end of it.
    """
    if not space.get("entire") or run.get("stopped_by_error") or "steps" not in run:
        raise NoOracleError(f"{net}: no answer to the end: {space} {run.get('stop')}")
    numbers = {k: space[k] for k in ("nodes", "arcs", "scc")}
    return {
        "net": net.relative_to(ROOT).as_posix(),
        "sha256": hashlib.sha256(net.read_bytes()).hexdigest(),
        "accepted": space["accepted"],
        "space": numbers | {"dead": len(space["dead"]), "home": len(space["home"])},
        "run": {k: run[k] for k in ("steps", "final_time", "final_marking", "stop")},
    }


def random_nets() -> None:
    """Asks about the random nets, whose texts are kept, too."""
    texts = [text(number) for number in NUMBERS]
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / f"net{number}.cpn" for number in NUMBERS]
        for path, net in zip(paths, texts, strict=True):
            path.write_bytes(cpn(net))
        answers = zip(
            engine.marking(paths),
            engine.run(paths, steps=12),
            engine.space(paths, seconds=20, nodes=400),
            strict=True,
        )
        kept = [
            {"text": net, "marking": marking, "run": run, "space": space}
            for net, (marking, run, space) in zip(texts, answers, strict=True)
        ]
    for entry in kept:
        for said in (entry["marking"], entry["run"], entry["space"]):
            assert isinstance(said, dict)
            del said["net"]
    RANDOM.write_text(json.dumps(kept, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    print(f"{len(kept)} random nets")


def record(arguments: Sequence[str]) -> int:
    """The exit code: 0 when all nets have an answer."""
    try:
        if arguments == ["--random"]:
            random_nets()
            return 0
        known = [net for net in nets() if not arguments or net.parent.name in arguments]
        if len(known) < len(arguments):
            raise NoOracleError(f"known examples: {', '.join(n.parent.name for n in nets())}")
        tries = [engine.run(known, steps=STEPS, seed=seed) for seed in SEEDS]
        runs = [
            max(some, key=lambda r: len(r.get("steps", ()))) for some in zip(*tries, strict=True)
        ]
        spaces = engine.space(known, seconds=600)
        for net, run, space in zip(known, runs, spaces, strict=True):
            kept = answer(net, run, space)
            text = json.dumps(kept, indent=1, ensure_ascii=False)
            (FOLDER / f"{net.parent.name}.json").write_text(text + "\n", encoding="utf-8")
            print(f"{net.parent.name}: {kept['space']}, {len(run['steps'])} steps")
    except NoOracleError as reason:
        print(f"record: {reason}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(record(sys.argv[1:]))
