"""Makes docs/conformance.md: `./dev conformance [--walks FILE]`, or
`python -m pn2code.engine_comparison FOLDER [-o FILE] [--walks FILE]`.

FOLDER has `corpus` and `semantics-suite`.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from pn2code.engine_comparison import compare, suite
from pn2code.engine_comparison.document import document
from pn2code.engine_comparison.expressions import compare_expressions
from pn2code.engine_comparison.finding import NOTHING, Finding, State
from pn2code.engine_comparison.spaces import explored

LARGEST_SPACE = 10_000


def main() -> int:
    """Compare everything; exit code 1 when an answer differs."""
    parser = argparse.ArgumentParser(prog="conformance", description=__doc__)
    parser.add_argument("folder", type=Path, help="with `corpus` and `semantics-suite`")
    parser.add_argument("-o", "--output", type=Path, help="the document (default: stdout)")
    parser.add_argument("--walks", type=Path, help="what `./dev walks -o FILE` has written")
    parser.add_argument("--largest", type=int, default=LARGEST_SPACE, help="state spaces up to")
    parser.add_argument("--only", default="", help="only nets whose path contains this")
    parser.add_argument("--no-explorer", action="store_true", help="compile no explorers")
    options = parser.parse_args()
    sys.setrecursionlimit(20_000)
    corpus = options.folder / "corpus"
    nets = []
    spaces = {}
    for path in compare.paths(corpus):
        if options.only in path:
            print(path, file=sys.stderr, flush=True)
            nets.append(compare.compare(corpus, path, max_nodes=options.largest))
            spaces[path] = NOTHING if options.no_explorer else explored(corpus, path)
    tiny = options.folder / "semantics-suite"
    graphs = {name: suite.compare_graph(tiny, name) for name in suite.names(tiny)}
    expressions = compare_expressions(tiny)
    walks = _walks(options.walks)
    text = document(
        nets, walks, graphs, expressions, about_walks=_about(options.walks), spaces=spaces
    )
    if options.output is None:
        print(text, end="")
    else:
        options.output.write_text(text, encoding="utf-8")
    differs = any(n.state is State.DIFFERS for n in nets)
    return int(differs or any(f.state is State.DIFFERS for f in spaces.values()))


_VERDICTS = {
    "agrees": State.AGREES,
    "differs": State.DIFFERS,
    "unsupported": State.UNSUPPORTED,
    "rejected": State.NOTHING,
}


def _walks(file: Path | None) -> dict[str, Finding]:
    """What `./dev walks` has found, by path below the folder of the collections."""
    if file is None:
        return {}
    data = json.loads(file.read_text(encoding="utf-8"))
    return {
        entry["net"]: Finding(_VERDICTS[entry["verdict"]], entry["detail"])
        for entry in data["nets"]
    }


def _about(file: Path | None) -> str:
    """How far the walks went."""
    if file is None:
        return ""
    data = json.loads(file.read_text(encoding="utf-8"))
    ends = data["ends"]
    said = (
        ("steps", "all steps were made: {}"),
        ("dead", "only short runs to a dead marking exist: {}"),
        ("error", "only short runs to an error exist, which is the same in both: {}"),
        ("time", "stopped after some seconds: {}"),
    )
    return (
        f"Compiled walks, including the semantics suite, make {data['steps']:,} steps of each net, restart "
        "after a dead marking or an error, and compare everything before each step. Nets that agree, by how their "
        f"walks ended: {'; '.join(words.format(ends[k]) for k, words in said if ends.get(k))}."
    )


if __name__ == "__main__":
    sys.exit(main())
