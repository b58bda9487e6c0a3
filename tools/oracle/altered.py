"""`./dev oracle --altered`: nets with the idioms of published models, changed so that they stay well-typed mostly.

    python -m tools.oracle --altered [--count 500] [--first 0] [--jobs 2] [--spaces 3] [--runs] [--save FOLDER]

The nets are those of `idioms.txt` that the engine accepts. What is changed: a number, an operator for one of the same
type, the kind of an arc, its place for another one of the same colour set, a variable for another one, a guard or a
condition for its negation, a priority, a delay, an initial marking, the order of declarations or of arcs. Net 17 is the
same change of the same net every time. Both have to give the same verdict and initial marking; a random run of the
engine is followed here; of every third net (`--spaces`) the state spaces are compared. With `--runs` a verdict
and a run are all that is asked, which takes half of the time. Exit code 1 when something differs.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from random import Random

from tools.oracle import engine
from tools.oracle.alone import BATCH
from tools.oracle.idioms import answers, nets
from tools.oracle.totals import Totals, compared

from helpers.netbuilder import cpn

SKIPPED = {"GlobrefLists", "StatisticsReals", "InstanceNumbers", "InstanceCoefficients"}
"""The engine's state-space tool has something else there than its simulator (`tests/e2e/test_engine_idioms.py`)."""
Change = Callable[[Random, list[str]], bool]
"""Changes the lines of a net; whether it could."""
_ALIKE = (
    ("+", "-", "*"), ("<", "<=", ">", ">="), ("=", "<>"), ("andalso", "orelse"), ("div", "mod"), ("true", "false"),
    ("hd", "List.last"), ("rev", "tl"), ("Int.max", "Int.min"), ("List.filter", "List.takeWhile"), ("foldl", "foldr"),
    ("List.exists", "List.all"), ("1`", "2`", "0`"),
)  # fmt: skip
_TOKEN = re.compile(
    r"\"(?:[^\"\\]|\\.)*\"|\d+`|[A-Za-z_'][\w'.]*|~?\d+\.\d+|\d+|\s+|[-+*/<>=:`@^~!&|#%]+|."
)
_ARC = re.compile(r"(\s+)(in|out|both) (\"[^\"]*\"|\S+) : (.*)", re.DOTALL)
_HEAD = ("net ", "page ", "option ", "use ", "subst ", "#")


def _texts(lines: Sequence[str]) -> list[int]:
    """The lines that hold declarations or inscriptions."""
    return [i for i, x in enumerate(lines) if x.strip() and not x.strip().startswith(_HEAD)]


def _tokens(r: Random, lines: list[str], fits: Callable[[str], bool]) -> tuple[int, list[str], int]:
    """A line, its tokens, and one that fits; the line is -1 if there is none."""
    found = []
    for i in _texts(lines):
        tokens = _TOKEN.findall(lines[i])
        found += [(i, tokens, n) for n, x in enumerate(tokens) if fits(x)]
    return r.choice(found) if found else (-1, [], 0)


def _number(r: Random, lines: list[str]) -> bool:
    i, tokens, n = _tokens(r, lines, str.isdigit)
    if i < 0:
        return False
    old = int(tokens[n])
    tokens[n] = str(
        r.choice([x for x in (old + 1, old - 1, 0, 1, 2, old + 3) if x not in (old, -1)])
    )
    lines[i] = "".join(tokens)
    return True


def _operator(r: Random, lines: list[str]) -> bool:
    group = r.choice([g for g in _ALIKE for _ in range(3 if len(g) > 2 else 1)])
    i, tokens, n = _tokens(r, lines, group.__contains__)
    if i < 0 or (tokens[n] == "=" and lines[i].strip().split()[0] not in ("in", "out", "guard")):
        return False
    tokens[n] = r.choice([x for x in group if x != tokens[n]])
    lines[i] = "".join(tokens)
    return True


def _variable(r: Random, lines: list[str]) -> bool:
    """A variable for another one of its colour set, in an inscription."""
    names = [
        [x.strip() for x in match[1].split(",")]
        for line in lines
        for match in re.finditer(r"\bvar ([\w', ]+):", line)
    ]
    groups = [g for g in names if len(g) > 1]
    if not groups:
        return False
    group = r.choice(groups)
    arcs = [i for i, x in enumerate(lines) if _ARC.fullmatch(x) or "guard" in x]
    found = [
        (i, m) for i in arcs for m in re.finditer(r"[A-Za-z][\w']*", lines[i]) if m[0] in group
    ]
    if not found:
        return False
    i, m = r.choice(found)
    new = r.choice([x for x in group if x != m[0]])
    lines[i] = lines[i][: m.start()] + new + lines[i][m.end() :]
    return True


def _kind(r: Random, lines: list[str]) -> bool:
    """The kind of an arc, or none."""
    arcs = [(i, m) for i, x in enumerate(lines) if (m := _ARC.fullmatch(x))]
    if not arcs:
        return False
    i, m = r.choice(arcs)
    kind = r.choice([k for k in ("in", "out", "both", "both", "inhibit", "reset", "") if k != m[2]])
    if kind in ("inhibit", "reset"):
        lines[i] = f"{m[1]}{kind} {m[3]}\n"
    else:
        lines[i] = f"{m[1]}{kind} {m[3]} : {m[4]}" if kind else ""
    return True


def _place(r: Random, lines: list[str]) -> bool:
    """The place of an arc for another one of the page, of the same colour set."""
    found = []
    page: dict[str, str] = {}
    for i, line in enumerate(lines):
        if line.strip().startswith("page "):
            page = {}
        if m := re.match(r"\s+place (\w+)(?: \w+ \w+)? : (\w+)", line):
            page[m[1]] = m[2]
        if (m := _ARC.fullmatch(line)) and m[3] in page:
            others = [p for p, c in page.items() if c == page[m[3]] and p != m[3]]
            found += [(i, m, other) for other in others]
    if not found:
        return False
    i, m, other = r.choice(found)
    lines[i] = f"{m[1]}{m[2]} {other} : {m[4]}"
    return True


def _guard(r: Random, lines: list[str]) -> bool:
    """The negation of a guard that is one condition; of a guard with several the first is left out."""
    found = [(i, m) for i, x in enumerate(lines) if (m := re.search(r"guard \[(.*)\]", x))]
    if not found:
        return False
    i, m = r.choice(found)
    text = m[1]
    first, comma, rest = text.partition(", ")
    is_whole = first.count("(") == first.count(")") and first.count("[") == first.count("]")
    new = rest if comma and is_whole else f"not ({text})"
    lines[i] = f"{lines[i][: m.start()]}guard [{new}]{lines[i][m.end() :]}"
    return True


def _branches(r: Random, lines: list[str]) -> bool:
    found = [(i, m) for i, x in enumerate(lines) for m in re.finditer(r"\bif (.+?) then\b", x)]
    if not found:
        return False
    i, m = r.choice(found)
    lines[i] = f"{lines[i][: m.start()]}if not ({m[1]}) then{lines[i][m.end() :]}"
    return True


def _transition(r: Random, lines: list[str]) -> bool:
    """A priority or a delay more."""
    found = [i for i, x in enumerate(lines) if x.strip().startswith("trans ")]
    if not found:
        return False
    i = r.choice(found)
    own = "".join(lines[i : i + 6]).split("trans ")[1]
    clause = r.choice(("priority 10", "priority 2000", "delay @+2"))
    if clause.split()[0] in own or (clause[0] == "d" and "timed" not in "".join(lines)):
        return False
    indent = re.match(r"\s*", lines[i])
    assert indent is not None
    lines.insert(i + 1, f"{indent[0]}  {clause}\n")
    return True


def _initial(r: Random, lines: list[str]) -> bool:
    """An initial marking without one of its summands, or twice of it; none."""
    found = [(i, m) for i, x in enumerate(lines) if (m := re.match(r"(\s+place .*?) = (.*)", x))]
    if not found:
        return False
    i, m = r.choice(found)
    parts = m[2].split(" ++ ")
    if len(parts) > 1 and "(" not in m[2].replace("`(", "`"):
        parts.pop(r.randrange(len(parts)))
        lines[i] = f"{m[1]} = {' ++ '.join(parts)}\n"
    elif re.fullmatch(r"\d+`.*", m[2]) and "@" not in m[2]:
        lines[i] = f"{m[1]} = {m[2]} ++ {m[2]}\n"
    else:
        lines[i] = f"{m[1]}\n"
    return True


def _swap(r: Random, lines: list[str]) -> bool:
    """Two neighbours among the declarations, or among the arcs of a transition."""
    words = ("colset ", "var ", "val ", "fun ", "in ", "out ", "both ")
    found = [
        i
        for i in range(len(lines) - 1)
        if all(lines[j].strip().startswith(words) for j in (i, i + 1))
    ]
    if not found:
        return False
    i = r.choice(found)
    lines[i], lines[i + 1] = lines[i + 1], lines[i]
    return True


_CHANGES: tuple[Change, ...] = (
    _number, _number, _number, _number, _operator, _operator, _operator, _variable, _variable, _kind, _kind, _place,
    _place, _guard, _branches, _transition, _initial, _initial, _swap,
)  # fmt: skip


def altered(number: int, texts: Sequence[str]) -> str:
    """The net of that number, in the short form."""
    r = Random(number)
    text = texts[number % len(texts)]
    for _ in range(50):
        lines = text.splitlines(keepends=True)
        if r.choice(_CHANGES)(r, lines) and (new := "".join(lines)) != text:
            if r.random() < 0.7:
                return new
            text = new
    return text


def bases() -> list[str]:
    """The nets that are changed: those that the engine accepts."""
    kept = answers()
    return [t for name, t in nets().items() if kept[name]["accepted"] and name not in SKIPPED]


def batches(numbers: range, folder: Path) -> Iterator[list[Path]]:
    """The files of so many nets at a time."""
    texts = bases()
    for first in range(numbers.start, numbers.stop, BATCH):
        paths = []
        for number in range(first, min(first + BATCH, numbers.stop)):
            path = folder / f"altered{number}.cpn"
            try:
                path.write_bytes(cpn(altered(number, texts)))
            except (ValueError, KeyError):
                continue  # no text of a net any more
            paths.append(path)
        yield paths


def _runs(paths: Sequence[Path], jobs: int) -> list[engine.Answer]:
    return engine.run(paths, steps=25, jobs=jobs, limit=60)


def main(arguments: Sequence[str]) -> int:
    """The exit code: 0 when nothing differs."""
    parser = argparse.ArgumentParser(prog="oracle --altered", description=__doc__)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--spaces", type=int, default=3, help="each so many nets; 0: none")
    parser.add_argument("--runs", action="store_true", help="no markings and state spaces")
    parser.add_argument("--save", type=Path)
    a = parser.parse_args(arguments)
    totals = Totals(a.save)
    with tempfile.TemporaryDirectory() as folder:
        for paths in batches(range(a.first, a.first + a.count), Path(folder)):
            if a.runs:
                for path, only in zip(paths, _runs(paths, a.jobs), strict=True):
                    totals.add(path.stem, path, compared(path, only, only), [only, only])
                print(*totals.lines(), sep="; ", flush=True)
                continue
            said = engine.marking(paths, jobs=a.jobs, limit=60)
            good = [p for p, s in zip(paths, said, strict=True) if "marking" in s]
            runs = dict(zip(good, _runs(good, a.jobs), strict=True))
            chosen = good[:: a.spaces] if a.spaces else []
            asked = engine.space(chosen, seconds=15, nodes=600, graph=True, jobs=a.jobs, limit=60)
            spaces = dict(zip(chosen, asked, strict=True))
            for path, first in zip(paths, said, strict=True):
                run, space = runs.get(path), spaces.get(path)
                found = compared(path, first, run, space)
                totals.add(path.stem, path, found, [first, run, space])
            print(*totals.lines(), sep="; ", flush=True)
    return totals.report()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
