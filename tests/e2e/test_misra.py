"""The deployed supervisor breaks no required rule of MISRA C:2012 that docs/misra.md does not name (tools/misra.py)."""

from __future__ import annotations

import shutil
from collections import Counter
from pathlib import Path

import pytest
from tools import misra

from helpers.thorough import THOROUGH


def test_what_is_committed() -> None:
    """As it was found, where nothing has changed since; `make thorough` looks again."""
    assert all((misra.COMMITTED / name).is_file() for name in misra.SOURCES)
    kept = misra.recorded(misra.COMMITTED)
    if kept is None or THOROUGH:
        found = misra.findings(misra.COMMITTED)
        assert kept in (None, found)
        kept = found
    required, advisory = kept
    assert (
        advisory["2.5"] > 0
    )  # which takes a comparison of files: of a macro that none of them uses
    assert misra.mistakes(required, misra.PAGE.read_text(encoding="utf-8")) == []


def test_what_was_found_counts_only_for_what_was_looked_at(root: Path, tmp_path: Path) -> None:
    folder, record = tmp_path / "riveting", tmp_path / "misra.json"
    shutil.copytree(root / "generated" / "riveting", folder)
    found = Counter({("17.1", "a.c"): 2, ("8.2", "b.c"): 1}), Counter({"2.5": 3})
    assert misra.recorded(folder, record) is None
    misra.write_down(folder, found, record)
    assert misra.recorded(folder, record) == found
    for name in ("net.c", "net.h", "Makefile", "runtime/src/channel/pn_channel.c"):
        before = (folder / name).read_text()
        (folder / name).write_text(f"{before} ")
        assert misra.recorded(folder, record) is None, name
        (folder / name).write_text(before)
    assert misra.recorded(folder, record) == found
    (folder / "more.h").write_text("")
    assert misra.recorded(folder, record) is None


def test_rows_and_findings_have_to_fit() -> None:
    page = "| 17.1 | `a.c` | a reason |\n| 22.8 | `b.c` | another |\n"

    assert misra.mistakes(Counter({("17.1", "a.c"): 2, ("22.8", "b.c"): 1}), page) == []
    assert misra.mistakes(Counter({("17.1", "a.c"): 2, ("14.2", "a.c"): 1}), page) == [
        "rule 14.2 is broken in a.c (1 times)",
        "the deviation from 22.8 in b.c is not needed any more",
    ]
    assert misra.mistakes(Counter({("17.3", "a.c"): 1}), "| 17.3 | `a.c` | no |\n") == [
        "there is no deviation from the mandatory rule 17.3"
    ]


def test_a_broken_rule_is_found(
    root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "riveting"
    shutil.copytree(root / "generated" / "riveting", folder)
    with (folder / "cell_config.c").open("a") as config:
        config.write(
            "int bad(int a);\nint bad(int a) { if (a) goto end; a = 010; end: return a; }\n"
            "extern int (*worse)();\n"
        )
    monkeypatch.setattr(misra, "SOURCES", ("cell_config.c",))

    required, _ = misra.findings(folder)

    assert ("7.1", "cell_config.c") in required
    assert ("8.2", "cell_config.c") in required  # what follows the name of a pointer
