"""`./dev oracle --mutants`: published nets with one inscription or declaration changed, before the engine and pn2code.

    python -m tools.oracle --mutants [--count 1000] [--first 0] [--jobs 2] [--save FOLDER]

The nets are those beside the repository that the engine accepts. Mutant 17 is the same change of the same net every
time. Both have to give the same verdict and, where it is accepted, the same initial marking; exit code 1 when they
do not.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from random import Random

from lxml import etree
from tools.oracle import engine
from tools.oracle.alone import BATCH
from tools.oracle.totals import Totals, compared

LARGEST = 150_000
"""Bytes; larger nets cost much time and have nothing that smaller ones lack."""
_TOKEN = re.compile(r"\"[^\"]*\"|[A-Za-z_'][\w']*|~?\d+(?:\.\d+)?|[ \t\n]+|[-+*/<>=:`@^~!&|#%]+|.")
_WORD = re.compile(r"[A-Za-z_'][\w']*")
_OPERATORS = (
    ("++", "+"), ("+", "-"), ("+", "^"), ("^", "+"), ("@+", "@"), ("=", "<>"), ("<", "<="), ("::", "^^"),
    ("andalso", "orelse"), ("++", "--"), ("`", "+"), (",", ";"), ("=", ":="), ("-", "~"), ("*", "/"), ("div", "/"),
    ("=>", "="), ("[", "("), (")", "]"),
)  # fmt: skip
_TYPES = ("INT", "BOOL", "STRING", "UNIT", "REAL")
Change = Callable[[Random, list[str], list[str]], None]


def texts(root: etree._Element) -> list[etree._Element]:
    """The elements that hold an inscription or a declaration."""
    found = [e for e in root.iter("ml") if e.text and e.text.strip()]
    for tag in ("type", "initmark", "cond", "time", "code", "priority", "annot"):
        found += [t for e in root.iter(tag) for t in e.findall("text") if t.text and t.text.strip()]
    found += [e for e in root.iter("id") if e.getparent().tag in ("var", "color", "type", "list")]
    return found


def changed(r: Random, text: str, others: list[str]) -> str:
    """The text with one change."""
    tokens = _TOKEN.findall(text)
    for _ in range(20):
        copy = list(tokens)
        r.choice(_CHANGES)(r, copy, others)
        new = "".join(copy)
        if new != text:
            return new
    return text + " +"


def _at(r: Random, tokens: list[str], wanted: Callable[[str], object]) -> int | None:
    found = [i for i, t in enumerate(tokens) if wanted(t)]
    return r.choice(found) if found else None


def _remove(r: Random, tokens: list[str], others: list[str]) -> None:
    at = _at(r, tokens, str.strip)
    if at is not None:
        del tokens[at]


def _double(r: Random, tokens: list[str], others: list[str]) -> None:
    at = _at(r, tokens, str.strip)
    if at is not None:
        tokens.insert(at, tokens[at] + " ")


def _swap(r: Random, tokens: list[str], others: list[str]) -> None:
    a, b = (_at(r, tokens, str.strip) for _ in "ab")
    if a is not None and b is not None:
        tokens[a], tokens[b] = tokens[b], tokens[a]


def _rename(r: Random, tokens: list[str], others: list[str]) -> None:
    at = _at(r, tokens, _WORD.fullmatch)
    words = sorted({w for text in others for w in _WORD.findall(text)})
    if at is not None and words:
        tokens[at] = r.choice(words)


def _misspell(r: Random, tokens: list[str], others: list[str]) -> None:
    at = _at(r, tokens, _WORD.fullmatch)
    if at is not None:
        tokens[at] += "q"


def _number(r: Random, tokens: list[str], others: list[str]) -> None:
    at = _at(r, tokens, lambda t: t[0].isdigit())
    if at is not None:
        tokens[at] = r.choice(("0", "7", "1.5", "~2", '"a"', "true", "()", "[]", "10000000000"))


def _digit(r: Random, tokens: list[str], others: list[str]) -> None:
    """Another number: mostly accepted, with another marking."""
    at = _at(r, tokens, str.isdigit)
    if at is not None:
        tokens[at] = str(r.choice((int(tokens[at]) + 1, r.randint(0, 9), 0)))


def _operator(r: Random, tokens: list[str], others: list[str]) -> None:
    found = [(i, b) for i, t in enumerate(tokens) for a, b in _OPERATORS if t == a]
    if found:
        at, new = r.choice(found)
        tokens[at] = new


def _parenthesis(r: Random, tokens: list[str], others: list[str]) -> None:
    at = _at(r, tokens, lambda t: t in "()[]{}")
    if at is not None:
        tokens[at] = " "


def _other(r: Random, tokens: list[str], others: list[str]) -> None:
    tokens[:] = [r.choice(others)]


def _type(r: Random, tokens: list[str], others: list[str]) -> None:
    at = _at(r, tokens, lambda t: t.isupper() and len(t) > 1)
    if at is not None:
        tokens[at] = r.choice(_TYPES)


def _empty(r: Random, tokens: list[str], others: list[str]) -> None:
    tokens.clear()


_CHANGES: tuple[Change, ...] = (
    _remove, _remove, _double, _swap, _rename, _rename, _rename, _misspell, _number, _digit, _digit, _digit, _operator,
    _operator, _parenthesis, _other, _other, _type, _empty,
)  # fmt: skip


def bases(shared: Path) -> list[Path]:
    """The nets that are changed, in a fixed order; not those that take in other files."""
    nets = sorted((shared / "corpus" / "nets").rglob("*.cpn"))
    return [p for p in nets if p.stat().st_size <= LARGEST and b"<use" not in p.read_bytes()]


def mutant(base: Path, number: int) -> bytes:
    """The net with the change of that number."""
    r = Random(number)
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
    root = etree.fromstring(base.read_bytes(), parser)
    places = texts(root)
    at = r.choice(places)
    at.text = changed(r, at.text or "", [p.text or "" for p in places])
    return bytes(etree.tostring(root, encoding="iso-8859-1", xml_declaration=True))


def batches(numbers: range, folder: Path, nets: Sequence[Path]) -> Iterator[list[Path]]:
    """The files of so many mutants at a time, each in a folder with what lies beside the net."""
    for first in range(numbers.start, numbers.stop, BATCH):
        paths = []
        for number in range(first, min(first + BATCH, numbers.stop)):
            base = nets[number % len(nets)]
            home = folder / str(number)
            home.mkdir()
            for beside in base.parent.iterdir():
                if beside != base:
                    (home / beside.name).symlink_to(beside)
            path = home / base.name
            path.write_bytes(mutant(base, number))
            paths.append(path)
        yield paths


def main(arguments: Sequence[str]) -> int:
    """The exit code: 0 when nothing differs."""
    parser = argparse.ArgumentParser(prog="oracle --mutants", description=__doc__)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--save", type=Path)
    a = parser.parse_args(arguments)
    nets = bases(engine.program().parents[1])
    totals = Totals(a.save)
    with tempfile.TemporaryDirectory() as folder:
        for paths in batches(range(a.first, a.first + a.count), Path(folder), nets):
            for path, said in zip(paths, engine.marking(paths, jobs=a.jobs), strict=True):
                name = f"mutant{path.parent.name}"
                totals.add(name, path, compared(path, said), [said])
    return totals.report()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
