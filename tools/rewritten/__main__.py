"""`python -m tools.rewritten NET_OR_FOLDER ...`, or `--cells N`: written in other ways, they must behave as before."""

from __future__ import annotations

import argparse
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from random import Random

from lxml import etree
from tools.rewritten.cells import compare
from tools.rewritten.observed import Observed, observed
from tools.rewritten.rewrites import REWRITES


def main() -> int:
    """One line for each net that behaves otherwise; exit code 1 if there is one."""
    parser = argparse.ArgumentParser(prog="tools.rewritten", description=__doc__)
    parser.add_argument(
        "--markings", type=int, default=300, help="of each net (default: %(default)s)"
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--keep", type=Path, default=Path(".rewritten"), help="where those go that differ"
    )
    parser.add_argument("--bytes", type=int, default=200_000, help="larger files are left out")
    parser.add_argument("--only", nargs="*", default=list(REWRITES), choices=list(REWRITES))
    parser.add_argument(
        "--cells", type=int, help="so many random cells instead, and what `verify` says"
    )
    parser.add_argument("nets", nargs="*", type=Path)
    given = parser.parse_args()
    if given.cells is not None:
        return compare(given.cells, given.seed, given.only, given.keep)
    count: Counter[str] = Counter()
    for net in _nets(given.nets, given.bytes):
        before = observed(net, given.markings)
        count["nets"] += 1
        count["refused"] += isinstance(before, str)
        for name, tree in _rewritten(net, given.only, given.seed):
            with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
                path = Path(folder, net.name)
                tree.write(path, encoding="iso-8859-1", xml_declaration=True)
                after = observed(path, given.markings)
                same = _are_same(before, after)
                count[f"{name} {'same' if same else 'OTHER'}"] += 1
                if not same:
                    print(f"{net} {name}: {_words(before)} -> {_words(after)}", flush=True)
                    given.keep.mkdir(parents=True, exist_ok=True)
                    (given.keep / f"{name}-{net.name}").write_bytes(path.read_bytes())
    print(dict(sorted(count.items())))
    return 1 if any("OTHER" in name for name in count) else 0


def _nets(paths: list[Path], most: int) -> Iterator[Path]:
    for path in paths:
        found = [path] if path.is_file() else sorted(path.rglob("*.cpn"))
        yield from (p for p in found if p.stat().st_size <= most)


def _rewritten(net: Path, names: list[str], seed: int) -> Iterator[tuple[str, etree._ElementTree]]:
    """The net in each way by itself, and in all at once."""
    r = Random(f"{seed} {net.name}")
    ways = [(name, (name,)) for name in names]
    ways += [("all", tuple(names))] if len(names) > 1 else []
    for label, chosen in ways:
        parser = etree.XMLParser(
            resolve_entities=False, no_network=True, load_dtd=False, huge_tree=True
        )
        try:
            tree = etree.parse(net, parser)
        except etree.XMLSyntaxError:
            return
        changed = [REWRITES[name](tree.getroot(), r) for name in chosen]
        if any(changed):
            yield label, tree


def _are_same(before: Observed | str, after: Observed | str) -> bool:
    """All numbers where all was seen, otherwise the layers that both have seen whole."""
    if isinstance(before, str) or isinstance(after, str):
        return before == after
    if before.is_whole and after.is_whole:
        return before == after
    most = min(len(before.layers), len(after.layers)) - 1
    return before.layers[:most] == after.layers[:most]


def _words(seen: Observed | str) -> str:
    return (
        seen if isinstance(seen, str) else f"{seen.nodes}/{seen.arcs}/{seen.dead} {seen.layers[:6]}"
    )


if __name__ == "__main__":
    raise SystemExit(main())
