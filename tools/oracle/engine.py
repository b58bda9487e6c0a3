"""The real engine of CPN Tools, asked: the program `oracle` beside the project (see `PN2CODE_SHARED`).

    check([net]), marking([net]), instances([net]), run([net], steps=40), space([net], graph=True)
        -> what it says of each net, in their order, as dictionaries
    evaluate(["map f [1]", ...], net=net) -> what it says of each expression, in their order

What the dictionaries hold is written in the README beside the program. A net of which it says nothing has a
`failure`. Nothing here decides who is right.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
Answer = dict[str, Any]


class NoOracleError(Exception):
    """The engine cannot be asked here; the message says why and what to do."""


def program() -> Path:
    """Where the program is.

    Raises:
        NoOracleError: it is not there.
    """
    shared = Path(os.environ.get("PN2CODE_SHARED", ROOT.parent / "shared"))
    path = shared / "oracle" / "oracle"
    if not path.is_file():
        raise NoOracleError(
            f"no engine of CPN Tools at {path}; set PN2CODE_SHARED to the folder that holds `oracle/oracle`"
        )
    return path


def _asked(arguments: Sequence[str], text: str = "") -> Iterator[Answer]:
    """Its answers, one a line, while it works; whoever stops listening ends it.

    Raises:
        NoOracleError: it cannot work on this machine, or it was asked wrongly.
    """
    with tempfile.TemporaryDirectory() as folder:
        question, errors = Path(folder, "question"), Path(folder, "errors")
        question.write_text(text, encoding="utf-8", errors="surrogateescape")
        with question.open("rb") as stdin, errors.open("wb") as stderr:
            process = subprocess.Popen(
                [sys.executable, str(program()), *arguments],
                stdin=stdin,
                stdout=subprocess.PIPE,
                stderr=stderr,
                text=True,
            )
        try:
            for line in process.stdout or ():
                yield json.loads(line)
            if process.wait() in (2, 3):
                said = errors.read_text(encoding="utf-8", errors="replace").strip()
                raise NoOracleError(said or "the oracle cannot work here and does not say why")
        finally:
            process.terminate()
            process.communicate()


def _nets(verb: str, nets: Sequence[Path | str], *options: str) -> list[Answer]:
    """The answers about nets; none are asked for none."""
    if not nets:
        return []
    found = list(_asked([verb, "--json", *options, "--", *map(str, nets)]))
    if len(found) != len(nets):
        raise NoOracleError(
            f"the oracle was asked {verb} of {len(nets)} nets and answered {len(found)}"
        )
    return found


def _common(jobs: int, seed: int, limit: float | None) -> list[str]:
    options = [f"--jobs={jobs}", f"--seed={seed}"]
    return options if limit is None else [*options, f"--limit={limit:g}"]


def check(
    nets: Sequence[Path | str], *, jobs: int = 1, seed: int = 1209, limit: float | None = None
) -> list[Answer]:
    """Whether each net is `accepted`, and its `errors`."""
    return _nets("check", nets, *_common(jobs, seed, limit))


def marking(
    nets: Sequence[Path | str], *, jobs: int = 1, seed: int = 1209, limit: float | None = None
) -> list[Answer]:
    """The initial `marking` of each place instance of each net."""
    return _nets("marking", nets, *_common(jobs, seed, limit))


def instances(
    nets: Sequence[Path | str], *, jobs: int = 1, seed: int = 1209, limit: float | None = None
) -> list[Answer]:
    """The page `instances` of each net."""
    return _nets("instances", nets, *_common(jobs, seed, limit))


def run(
    nets: Sequence[Path | str],
    *,
    steps: int = 100,
    jobs: int = 1,
    seed: int = 1209,
    limit: float | None = None,
) -> list[Answer]:
    """A random run of each net."""
    return _nets("run", nets, f"--steps={steps}", *_common(jobs, seed, limit))


def space(
    nets: Sequence[Path | str],
    *,
    seconds: int = 60,
    nodes: int = 0,
    graph: bool = False,
    jobs: int = 1,
    seed: int = 1209,
    limit: float | None = None,
) -> list[Answer]:
    """The state space of each net."""
    graphs = ["--graph"] if graph else []
    bounds = [f"--seconds={seconds}", f"--nodes={nodes}"]
    return _nets("space", nets, *bounds, *graphs, *_common(jobs, seed, limit))


def evaluate(
    expressions: Sequence[str], *, net: Path | str | None = None, each: float = 5, seed: int = 1209
) -> Iterator[Answer]:
    """The `type` and `value`, or the `error`, of each expression (or declaration), as they come.

    The line of an answer is the index of its expression here; expressions may have several lines.
    """
    if not expressions:
        return
    places: dict[int, int] = {}
    text, line = [], 1
    for index, expression in enumerate(expressions):
        places[line] = index
        text.append(f"{expression}\n;;\n")
        line += expression.count("\n") + 2
    options = [] if net is None else [f"--net={net}"]
    asked = ["eval", "--json", f"--each={each:g}", f"--seed={seed}", *options, "-"]
    for answer in _asked(asked, "".join(text)):
        yield {**answer, "line": places[answer["line"]]}
