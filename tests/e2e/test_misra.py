"""The deployed supervisor breaks no required rule of MISRA C:2012 that docs/misra.md does not name (tools/misra.py)."""

from __future__ import annotations

import importlib.metadata
import shutil
from collections import Counter
from pathlib import Path

import pytest
from tools import misra

from helpers.remembered import remembered


def test_what_is_committed(root: Path) -> None:
    folder = root / "generated" / "riveting"
    files = sorted(path for path in folder.rglob("*") if path.suffix in (".c", ".h"))
    own = (folder / "Makefile", Path(misra.__file__), misra.ADDON)
    assert {folder / name for name in misra.SOURCES} <= {*files}

    def look() -> list[list[tuple[str, int]]]:
        required, advisory = misra.findings(folder)
        return [[("/".join(of), n) for of, n in required.items()], [*advisory.items()]]

    version = importlib.metadata.version("cppcheck-py")
    found = remembered("misra", [*own, *files, version], look)
    required = Counter({tuple(of.split("/", 1)): n for of, n in found[0]})
    advisory = Counter(dict(found[1]))

    assert (
        advisory["2.5"] > 0
    )  # which takes a comparison of files: of a macro that none of them uses
    assert misra.mistakes(required, misra.PAGE.read_text(encoding="utf-8")) == []


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
