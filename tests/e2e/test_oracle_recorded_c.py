"""What the engine of CPN Tools said of the functions of colour sets: compiled nets say the same, too."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from tests.oracle.recorded import rows
from tests.oracle.texts import NET

from helpers.compiled import Workshop, lowered, run
from helpers.netbuilder import flat
from helpers.thorough import THOROUGH

pytestmark = [
    pytest.mark.cc,
    pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler"),
]
TEXTS = {
    "string": "({})", "int": "Int.toString ({})", "bool": "Bool.toString ({})",
    "order": '(case {} of LESS => "LESS" | EQUAL => "EQUAL" | GREATER => "GREATER")',
}  # fmt: skip
IN_A_PLACE = 40


def cases() -> list[tuple[str, str]]:
    """An expression of type string, and its value; a text for an exception. One in four, without `make thorough`."""
    found = []
    for expression, answer in rows("colsets")[:: 1 if THOROUGH else 4]:
        value = re.fullmatch(r"value: (.*) : (\w+)", answer)
        if value:
            text = value[1]
            if value[2] == "string":
                text = re.sub(
                    r"\\(.)", lambda m: {"n": "\n", "t": "\t"}.get(m[1], m[1]), text[1:-1]
                )
            found.append((TEXTS[value[2]].format(expression), text))
        elif answer == "raised: CPN'Error":
            found.append(
                (f'(ignore ({expression}); "nothing") handle CPN\'Error _ => "error"', "error")
            )
    return found


def test_compiled_nets_say_the_same(fast_workshop: Workshop, tmp_path: Path) -> None:
    all_cases = cases()
    places = [all_cases[i : i + IN_A_PLACE] for i in range(0, len(all_cases), IN_A_PLACE)]
    text = NET + "".join(
        f'  place P{i} : STRING = 1`(String.concatWith "|" [{", ".join(f"({e})" for e, _ in some)}])\n'
        for i, some in enumerate(places)
    )
    ir, d = lowered(flat(text))
    assert ir is not None, [e.message for e in d.errors]
    [line] = run(fast_workshop.build(ir, tmp_path / "net"), 1, 0)
    assert "error" not in line, line
    for i, some in enumerate(places):
        found = line["marking"][f"Top.P{i}"][0][1].split("|")
        assert list(zip([e for e, _ in some], found, strict=True)) == some
