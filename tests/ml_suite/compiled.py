"""The cases of the suite in compiled nets: a net has a place for each case, whose initial marking is the result.

Called as a program, it writes `not_compiled.txt` anew: every case that is not right, with what is wrong.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from helpers.compiled import Workshop, lowered, run
from helpers.netbuilder import flat
from ml_suite.suite import FOLDER, Case, NotShowable, Session, cases, topics
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import STRING, UNIT, TFun
from pn2code.net.flat import FlatNet, Form

FLAGS = ("-O0",)
NET = 'net Suite\n  standard\n  place P : STRING = 1`""'


def outcomes(found: Sequence[Case], workshop: Workshop, name: str) -> dict[str, str]:
    """Name -> result in compiled code, or what is wrong.

    Where something fails as a whole, the cases are divided until it is known which one it is.
    """
    session = Session()
    results: dict[str, str] = {}
    good = []
    for case in found:
        try:
            session.define(case)
            good.append(case)
        except NotShowable as problem:
            results[case.name] = f"refused: {problem}"
    todo = [good] if good else []
    while todo:
        some = todo.pop()
        folder = workshop.folder / f"{name}-{some[0].number}-{len(some)}"
        made = _compiled(net_of(session, some), workshop, folder)
        if not isinstance(made, str):
            results |= {case.name: text for case, text in zip(some, made, strict=True)}
        elif len(some) == 1:
            results[some[0].name] = made
        else:
            middle = len(some) // 2
            todo += [some[:middle], some[middle:]]
    return results


def net_of(session: Session, some: Sequence[Case]) -> FlatNet:
    """Each case is the initial marking of a place."""
    base = flat(NET)
    program = session.elaborator.program()
    [place] = base.places
    assert place.initial is not None
    span = place.initial[0].span
    places = []
    for i, case in enumerate(some):
        symbol = program.globals[case.function]
        function = core.Var(symbol, TFun(UNIT, STRING), span)
        value = core.Apply(function, core.RecordExp((), UNIT, span), STRING, span)
        changed = replace(
            place, index=i, name=f"Top.P{i}", short=f"P{i}", initial=(value, Form.TOKEN)
        )
        places.append(changed)
    return replace(base, program=program, places=tuple(places))


def _compiled(net: FlatNet, workshop: Workshop, folder: Path) -> list[str] | str:
    """The texts in all places, or why there are none."""
    try:
        ir, d = lowered(net, capacity={p.name: 1 for p in net.places})
    except Exception as problem:  # a bug of the compiler is a finding of this test
        return f"the compiler fails: {type(problem).__name__} {problem}"
    if ir is None:
        return f"not compiled: {d.errors[0].message}"
    try:
        [line] = run(workshop.build(ir, folder), 1, 0)
    except AssertionError as problem:
        error = next((x for x in str(problem).splitlines() if "error" in x), str(problem))
        return f"C compiler: {error}"
    if "error" in line:
        return f"the program stops: {line['error']}"
    return [line["marking"][p.name][0][1] for p in net.places]


def main() -> None:
    """Writes the list."""
    wrong: list[str] = []
    total = 0
    with tempfile.TemporaryDirectory() as name:
        workshop = Workshop.open(Path(name), FLAGS)
        for topic in sys.argv[1:] or topics():
            found = cases(topic)
            results = outcomes(found, workshop, topic)
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
