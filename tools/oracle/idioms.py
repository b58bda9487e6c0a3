"""`./dev oracle --idioms`: nets with the idioms of published models, and what the engine of CPN Tools says of them.

    python -m tools.oracle --idioms [NAME ...]     # asks again; 0 when nothing has changed

`idioms.txt` has the nets in the short form, each begins with `net NAME`. `tests/golden/engine_idioms.json` has the
answers: errors or the initial marking, a random run, the size of the state space. `tests/e2e/test_engine_idioms.py`
compares them with pn2code, without the engine.
"""

from __future__ import annotations

import hashlib
import json
import re
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.oracle import engine

from helpers.netbuilder import cpn

TEXTS = Path(__file__).with_name("idioms.txt")
ANSWERS = engine.ROOT / "tests" / "golden" / "engine_idioms.json"
STEPS = 25
NODES = 1500


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


def ask(texts: dict[str, str]) -> dict[str, engine.Answer]:
    """What the engine says of nets, shortened to what is compared."""
    with tempfile.TemporaryDirectory() as folder:
        paths = {name: Path(folder) / f"{name}.cpn" for name in texts}
        for name, path in paths.items():
            path.write_bytes(cpn(texts[name]))
        said = dict(zip(texts, engine.marking(list(paths.values())), strict=True))
        good = [name for name, answer in said.items() if "marking" in answer]
        files = [paths[name] for name in good]
        runs = dict(zip(good, engine.run(files, steps=STEPS), strict=True))
        spaces = dict(zip(good, engine.space(files, seconds=20, nodes=NODES), strict=True))
    found = {}
    for name, answer in said.items():
        kept = {"digest": digest(texts[name]), "accepted": answer["accepted"]}
        kept["errors"] = [
            {k: e[k] for k in ("id", "what", "by")} | {"message": e["message"][:100]}
            for e in answer["errors"]
        ]
        if "failure" in answer:
            kept["failure"] = {k: answer["failure"][k] for k in ("kind", "stage")}
            kept["failure"]["message"] = answer["failure"]["message"][:100]
        if name in runs:
            kept["marking"] = answer["marking"]
            kept["run"] = {k: v for k, v in runs[name].items() if k not in ("net", "errors")}
            space = spaces[name]
            if space.get("entire"):
                kept["space"] = {
                    k: space[k] for k in ("nodes", "arcs", "scc", "entire", "stopped_by_error")
                }
                kept["space"] |= {"dead": space["dead"], "home": space["home"]}
        found[name] = kept
    return found


def main(arguments: Sequence[str]) -> int:
    """Asks about the named nets, or all; 0 when nothing has changed."""
    texts = nets()
    before = answers() if ANSWERS.is_file() else {}
    wanted = {name: texts[name] for name in arguments or texts}
    now = {**before, **ask(wanted)}
    kept = {name: now[name] for name in texts if name in now}
    ANSWERS.write_text(json.dumps(kept, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    changed = [name for name in wanted if kept[name] != before.get(name)]
    print(f"{len(wanted)} nets, {len(changed)} answers have changed: {' '.join(changed)}")
    return 1 if changed else 0
