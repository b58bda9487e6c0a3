"""Writes `results/`: each case of the suite, evaluated by Poly/ML (`poly`, Debian package polyml)."""

from __future__ import annotations

import shutil
import subprocess
import sys

from suite import BY_HAND, FOLDER, Case, NotShowable, Session, cases, declarations, topics

MARK = "@@"


def evaluate(found: list[Case]) -> tuple[dict[int, str], list[str]]:
    """Number -> result, and what went wrong."""
    program = [(FOLDER / "prelude.sml").read_text(encoding="ascii")]
    program.append(
        "\n".join(line for line in declarations().splitlines() if "fun check_int" not in line)
    )
    problems: list[str] = []
    session = Session()
    for case in found:
        try:
            program.append(session.define(case))
        except NotShowable as problem:
            problems.append(f"{case.name}: {case.text}\n{problem}")
            continue
        program.append(f'val () = print ("{MARK}{case.number}\\t" ^ {case.function} () ^ "\\n");')
    run = subprocess.run(
        ["poly", "-q", "--error-exit"], input="\n".join(program[:2]), capture_output=True, text=True
    )
    if run.returncode:
        problems.append(run.stdout)
    run = subprocess.run(["poly", "-q"], input="\n".join(program), capture_output=True, text=True)
    results: dict[int, str] = {}
    errors: list[str] = []
    for line in run.stdout.splitlines():
        if line.startswith(MARK):
            number, result = line[len(MARK) :].split("\t")
            results[int(number)] = result
        elif "error" in line:
            errors.append(line)
    missing = [case.name for case in found if case.number not in results]
    if missing:
        problems.append(f"no result for {', '.join(missing)}")
        problems += errors
    return results, problems


def main() -> int:
    if shutil.which("poly") is None:
        print("poly is missing: apt-get install polyml", file=sys.stderr)
        return 2
    (FOLDER / "results").mkdir(exist_ok=True)
    failed = False
    total = 0
    for topic in topics():
        found = cases(topic)
        total += len(found)
        if topic in BY_HAND:
            continue
        results, problems = evaluate(found)
        failed |= bool(problems)
        print(*problems, sep="\n", file=sys.stderr, end="\n" if problems else "")
        rows = (
            f"{c.number}\t{results[c.number]}\t{c.text}\n" for c in found if c.number in results
        )
        (FOLDER / "results" / f"{topic}.tsv").write_text("".join(rows), encoding="ascii")
    print(f"{total} cases in {len(topics())} topics")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
