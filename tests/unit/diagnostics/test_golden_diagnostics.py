"""Wrong nets and what is said about them, word for word (`./dev golden` renews the expected texts)."""

from __future__ import annotations

import re

import pytest

from helpers.diagnostic_cases import Case, files, read
from pn2code.diagnostics.codes import all_codes

CASES = [case for path in files() for case in read(path)[1]]


@pytest.mark.parametrize("case", CASES, ids=lambda c: f"{c.file}: {c.name}")
def test_what_is_said(case: Case) -> None:
    assert case.actual() == case.out


def test_there_are_many_cases() -> None:
    assert len(CASES) >= 400
    assert len({(c.file, c.name) for c in CASES}) == len(CASES)


def test_something_is_said_and_it_helps() -> None:
    """Each mistake is found, named by a code that is declared, and has a hint of its own."""
    declared = {c.code for c in all_codes()}
    for case in CASES:
        codes = re.findall(r"^(?:error|warning|note)\[(.*)\]: ", case.out, flags=re.M)
        assert codes, (case.file, case.name)
        assert set(codes) <= declared, (case.file, case.name)
        for message in case.out.split("\n\n"):
            assert "= help: " in message, (case.file, case.name)
            assert "`pn2code explain" not in message, (case.file, case.name)
            assert "Traceback" not in message, (case.file, case.name)


def test_messages_are_in_one_style() -> None:
    """Lower case, no full stop, names in back-ticks that come in pairs."""
    for case in CASES:
        for message in re.findall(r"^(?:error|warning|note)\[.*\]: (.*)$", case.out, flags=re.M):
            assert not message.endswith("."), (case.name, message)
            assert not message[0].isupper() or message.startswith("CPN Tools"), (case.name, message)
            quoted = re.sub(r'"[^"]*`[^"]*"', "", message)  # names with a back-tick are in quotes
            assert quoted.count("`") % 2 == 0, (case.name, message)
