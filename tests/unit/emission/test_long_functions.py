"""Which functions of generated C are long: their bodies are found from the line `{` to the line `}`."""

from __future__ import annotations

import re
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from pn2code.emission import c_flags

BODY = re.compile(r"^\{\n.*?^\}$", re.MULTILINE | re.DOTALL)


@given(st.lists(st.sampled_from(["{", "}", "{\n", "}\n", "\n", " ", "x;\n"]), max_size=14))
def test_as_an_expression_finds_them(parts: list[str]) -> None:
    text = "".join(parts)
    assert list(c_flags._lengths(text)) == [len(body[0]) for body in BODY.finditer(text)]


def test_of_the_riveting_cell(root: Path) -> None:
    text = (root / "generated/riveting/net.c").read_text(encoding="utf-8")
    found = [len(body[0]) for body in BODY.finditer(text)]
    assert len(found) > 100
    assert list(c_flags._lengths(text)) == found


def test_one_that_is_long_makes_a_net_large() -> None:
    within = c_flags.LONG_FUNCTION - len("{\n\n}")
    assert not c_flags.is_large("void f(void)\n{\n" + ";" * within + "\n}\n")
    assert c_flags.is_large("void f(void)\n{\n" + ";" * (within + 1) + "\n}\n")
