"""The cases of the suite in compiled nets: a net has a place for each case, whose initial marking is the result.

Called as a program, it writes `not_compiled.txt` anew: every case that is not right, with what is wrong.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

import json

from helpers.compiled import Workshop, lowered
from helpers.netbuilder import write
from ml_suite.suite import FOLDER, Case, NotShowable, Session, cases, declarations, topics
from pn2code.diagnostics import Diagnostics
from pn2code.net.front import load

FLAGS = ("-O0",)


def outcomes(found: list[Case], workshop: Workshop) -> dict[str, str]:
    """Name -> result in compiled code, or what is wrong.

    Where something fails as a whole, the cases are divided until it is known which one it is.
    """
    session = Session()
    texts: dict[str, str] = {}
    results: dict[str, str] = {}
    for case in found:
        try:
            texts[case.name] = session.define(case)
        except NotShowable as problem:
            results[case.name] = f"refused: {problem}"
    good = [case for case in found if case.name in texts]
    todo = [good] if good else []
    while todo:
        some = todo.pop()
        made = _compiled(some, texts, workshop)
        if isinstance(made, dict):
            results.update(made)
        elif len(some) == 1:
            results[some[0].name] = made
        else:
            middle = len(some) // 2
            todo += [some[:middle], some[middle:]]
    return results


def _compiled(some: list[Case], texts: dict[str, str], workshop: Workshop) -> dict[str, str] | str:
    """The results of cases in one net, or what is wrong with it."""
    with tempfile.TemporaryDirectory(dir=workshop.folder) as name:
        folder = Path(name)
        lines = [declarations(), *(texts[case.name] for case in some)]
        (folder / "cases.sml").write_text("\n".join(lines), encoding="ascii")
        places = [f"  place P{i} : STRING = {case.function} ()" for i, case in enumerate(some)]
        text = "\n".join(["net Suite", "  standard", '  use "cases.sml"', *places])
        d = Diagnostics()
        net = load(write(text, folder / "suite.cpn"), d)
        if net is None:
            return f"not accepted: {d.errors[0].message}"
        try:
            ir, d = lowered(net)
        except Exception as problem:  # a bug of the compiler is a finding of this test
            return f"the compiler fails: {type(problem).__name__} {problem}"
        if ir is None:
            return f"not compiled: {d.errors[0].message}"
        try:
            program = workshop.build(ir, folder / "program")
        except Exception as problem:
            error = next((x for x in str(problem).splitlines() if "error" in x), str(problem))
            return f"C compiler: {error}"
        run = subprocess.run(
            [str(program), "1", "0"], capture_output=True, text=True, timeout=120, check=False
        )
        if run.returncode or not run.stdout:
            return f"the program stops with {run.returncode}: {run.stderr[-200:]}"
        line = json.loads(run.stdout.splitlines()[0])
        if "error" in line:
            return f"the program stops: {line['error']}"
        names = {p.short: p.name for p in net.places}
        tokens = [line["marking"][names[f"P{i}"]] for i in range(len(some))]
        return {case.name: t[0][1] if t else "" for case, t in zip(some, tokens, strict=True)}


def main() -> None:
    """Writes the list."""
    wrong: list[str] = []
    total = 0
    with tempfile.TemporaryDirectory() as name:
        workshop = Workshop.open(Path(name), FLAGS)
        for topic in sys.argv[1:] or topics():
            found = cases(topic)
            results = outcomes(found, workshop)
            total += len(found)
            for case in found:
                result = results[case.name]
                if result != case.expected:
                    reason = ascii(" ".join(result.split()))[1:-1][:160]
                    known = reason.startswith(("refused", "not ", "the ", "C compiler"))
                    wrong.append(f"{case.name} {reason if known else f'gives {reason}'}")
                    print(wrong[-1], f"({case.text[:60]})", flush=True)
            print(f"{topic}: done", flush=True)
    if len(sys.argv) == 1:
        head = "# Cases that compiled nets do not get right yet: name, then the reason.\n"
        text = head + "".join(f"{line}\n" for line in wrong)
        (FOLDER / "not_compiled.txt").write_text(text, encoding="ascii")
    print(f"{total - len(wrong)} of {total} cases are right")


if __name__ == "__main__":
    main()
