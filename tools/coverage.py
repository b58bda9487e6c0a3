"""`./dev coverage`: which branches of the supervisor, its channels and its port the tests come to.

    python -m tools.coverage [--least PERCENT] [--files] [TEST ...] [-- OPTION OF PYTEST ...]

Runs the tests that start supervisors (or those that are named) with compilers in front of the path that compile
`supervisor/`, `channel/` and `port/` with `--coverage`, without optimization and without sanitizers (they have branches
of their own), wherever a test compiles them. What the programs then write is added up: a source is compiled in several
ways (`-DPN_TRACE`, `-DPN_MONITOR`, the needs of a cell), and of each line the way counts of which most branches are
taken. A process that is killed writes nothing. Exit code 1 if a test fails, or if fewer branches are taken than PERCENT
of all.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PARTS = ("supervisor", "channel", "port")
TESTS = (
    "test_branches", "test_supervisor_host", "test_supervisor_rows", "test_generated_supervisor", "test_dry_runs",
    "test_faults", "test_riveting_faults", "test_messages_c", "test_message_cell", "test_minimal_cell",
    "test_input_sizes", "test_bad_coordinates",
    "test_monitor_random_draws", "test_monitor_references", "test_timed_channels", "test_files_c",
    "test_library_files_c", "test_shared_files", "test_running_ends", "test_who_waits", "test_order_of_asking",
    "test_dry_run_turns",
)  # fmt: skip
WRAPPER = """\
#!{python}
# A compiler that compiles what is to be counted with --coverage, each source in a folder of its own.
import re, shutil, subprocess, sys, tempfile
from pathlib import Path

COMPILER, STORE = {compiler!r}, {store!r}
PART = re.compile(r"(^|/)src/({parts})/\\w+\\.c$")
words = sys.argv[1:]
sources = [w for w in words if PART.search(w)]
target = words[words.index("-o") + 1] if "-o" in words else None
flags, rest, after = [], [], False
for word in words:
    if after or word == "-o":
        after = word == "-o"
    elif not word.endswith((".c", ".o", ".so", ".a")) and word != "-c" and not word.startswith(("-l", "-Wl,")):
        flags.append(word)
for word in words:
    if word not in sources:
        rest.append(word)
        continue
    made = str(Path(tempfile.mkdtemp(dir=STORE)) / (Path(word).stem + ".o"))
    counting = ["-O0", "-fno-sanitize=all", "--coverage", "-c", word, "-o", made]
    if code := subprocess.call([COMPILER, *flags, *counting]):
        sys.exit(code)
    if "-c" in words:
        shutil.copyfile(made, target or Path(made).name)
    else:
        rest.append(made)
if "-c" in words and sources and not any(w.endswith(".c") for w in rest):
    sys.exit(0)
sys.exit(subprocess.call([COMPILER, *rest, *([] if "-c" in words else ["-lgcov"])]))
"""


@dataclass
class Line:
    """What is known of a line of C.

    Args:
        function: in which it is.
        count: how often it was reached.
        branches: by the number of branches that a compilation has there, how often each was taken.
    """

    function: str
    count: int = 0
    branches: dict[int, list[int]] = field(default_factory=dict)

    def add(self, count: int, taken: list[int]) -> None:
        """What one compilation's programs did."""
        self.count += count
        if taken:
            before = self.branches.get(len(taken), [0] * len(taken))
            self.branches[len(taken)] = [a + b for a, b in zip(before, taken, strict=True)]

    @property
    def taken(self) -> list[int]:
        """Of the compilation in which most branches of the line were taken."""
        known = self.branches.values()
        return max(known, key=lambda t: (sum(n > 0 for n in t), -len(t)), default=[])


Files = dict[str, dict[int, Line]]


def collect(store: Path, gcov: str) -> Files:
    """All counts, by file and line."""
    files: Files = defaultdict(dict)
    for notes in sorted(store.glob("*/*.gcno")):
        done = subprocess.run(
            [gcov, "--json-format", "--stdout", "--branch-probabilities", notes.name],
            cwd=notes.parent, capture_output=True, text=True, check=True,
        )  # fmt: skip
        for found in json.loads(done.stdout)["files"]:
            parts = Path(found["file"]).parts
            if len(parts) < 2 or parts[-2] not in PARTS or not parts[-1].endswith(".c"):
                continue
            of_file = files["/".join(parts[-2:])]
            for line in found["lines"]:
                known = of_file.setdefault(line["line_number"], Line(line.get("function_name", "")))
                known.add(line["count"], [b["count"] for b in line["branches"]])
    return files


def sums(lines: dict[int, Line]) -> tuple[int, int, int, int]:
    """Lines that were reached, lines, branches that were taken, branches."""
    taken = [n for line in lines.values() for n in line.taken]
    reached = sum(line.count > 0 for line in lines.values())
    return reached, len(lines), sum(n > 0 for n in taken), len(taken)


def table(files: Files) -> Iterator[str]:
    """The figures as Markdown."""
    yield "| file | lines | branches |"
    yield "|---|---|---|"
    rows = [(name, sums(lines)) for name, lines in sorted(files.items())]
    rows.append(("all", tuple(map(sum, zip(*(r for _, r in rows), strict=True)))))  # type: ignore[arg-type]
    for name, (reached, lines, taken, branches) in rows:
        of_lines, of_branches = 100 * reached / max(lines, 1), 100 * taken / max(branches, 1)
        yield f"| `{name}` | {of_lines:.1f} % of {lines:,} | {of_branches:.1f} % of {branches:,} |"


def untaken(files: Files) -> Iterator[tuple[str, int, str]]:
    """Where a branch is never taken: file, line, C."""
    for name, lines in sorted(files.items()):
        text = (ROOT / "cnative" / "src" / name).read_text(encoding="utf-8").splitlines()
        for number, line in sorted(lines.items()):
            if 0 in line.taken:
                yield name, number, text[number - 1].strip()


def missing(files: Files) -> Iterator[str]:
    """What no test comes to: file, line, function, C."""
    for name, lines in sorted(files.items()):
        text = (ROOT / "cnative" / "src" / name).read_text(encoding="utf-8").splitlines()
        for number, line in sorted(lines.items()):
            left = sum(n == 0 for n in line.taken)
            if line.count == 0 or left:
                what = f"{left} of {len(line.taken)}" if line.taken else "line"
                code = text[number - 1].strip() if number <= len(text) else ""
                yield f"{name}:{number} {line.function}: {what}: {code}"


def run_tests(store: Path, tests: list[str], options: list[str]) -> int:
    """Runs pytest with compilers that count in front of the path."""
    programs = store / "bin"
    programs.mkdir()
    compiler = shutil.which("gcc")
    if compiler is None:
        sys.exit("coverage: gcc is not installed")
    for name in ("gcc", "cc"):
        path = programs / name
        text = WRAPPER.format(
            python=sys.executable, compiler=compiler, store=str(store), parts="|".join(PARTS)
        )
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755)
    env = {**os.environ, "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}", "CC": "gcc"}
    # Programs that pn2code remembers are not to be mixed with those that count.
    env |= {"PN2CODE_COUNTING": "1", "XDG_CACHE_HOME": str(store / "cache")}
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-q", *tests, *options], cwd=ROOT, env=env, check=False
    ).returncode


def main() -> int:
    """Run the tests, print the table and what is missing."""
    parser = argparse.ArgumentParser(prog="tools.coverage")
    parser.add_argument(
        "tests", nargs="*", help="files of tests; without, those that start supervisors"
    )
    parser.add_argument("--least", type=float, default=0.0, help="percent of the branches")
    parser.add_argument("--files", action="store_true", help="the table alone")
    words = sys.argv[1:]
    at = words.index("--") if "--" in words else len(words)
    given = parser.parse_args(words[:at])
    tests = given.tests or [f"tests/e2e/{name}.py" for name in TESTS]
    with tempfile.TemporaryDirectory(prefix="pn2code-coverage-") as folder:
        code = run_tests(Path(folder), tests, words[at + 1 :])
        files = collect(Path(folder), "gcov")
    print("\n".join(table(files)))
    if not given.files:
        print("\nnot reached:", *missing(files), sep="\n")
    _, _, taken, branches = map(sum, zip(*map(sums, files.values()), strict=True))
    is_enough = 100 * taken >= given.least * branches
    return 1 if code != 0 or not is_enough else 0


if __name__ == "__main__":
    raise SystemExit(main())
